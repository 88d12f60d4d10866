/* SPDX-License-Identifier: MIT
 * Ramp queue. See rtl/passo_ramp_queue.v.
 */
#include "passo_model.h"
#include "passo_words.h"

enum { INDEX_CONTROL = 0, INDEX_VELOCITY_LOW = 1, INDEX_TICKS = 2, INDEX_STEP_HIGH = 3, INDEX_LAST = 4 };

static const uint32_t VELOCITY_MAX_HIGH = 0x8000u;

static unsigned depth(const struct passo_parameters *parameters)
{
	return 1u << parameters->ramp_queue_log2;
}

static uint16_t wrap(unsigned ramp, const struct passo_parameters *parameters)
{
	return (uint16_t)(ramp & (2u * depth(parameters) - 1u));
}

uint8_t passo_ramp_queue_refusal(
    const struct passo_ramp_queue *queue, const struct passo_bus *bus, bool blocked)
{
	const uint32_t high = bus->data >> 16;

	if (blocked)
		return PASSO_VERDICT_BUSY;
	if (queue->full)
		return PASSO_VERDICT_QUEUE_FULL;
	switch (queue->index) {
	case INDEX_CONTROL:
		return (bus->data & ~PASSO_RAMP_CONTROL_DEFINED) != 0u || high > VELOCITY_MAX_HIGH
		         ? PASSO_VERDICT_BAD_VALUE
		         : PASSO_VERDICT_OK;
	case INDEX_VELOCITY_LOW:
		return queue->velocity_is_max && bus->data != 0u ? PASSO_VERDICT_BAD_VALUE : PASSO_VERDICT_OK;
	case INDEX_STEP_HIGH:
		return high != 0u ? PASSO_VERDICT_BAD_VALUE : PASSO_VERDICT_OK;
	default:
		return PASSO_VERDICT_OK;
	}
}

bool passo_ramp_queue_checks_now(const struct passo_ramp_queue *queue, uint32_t data)
{
	return queue->index == INDEX_CONTROL && passo_unpack_ramp_control(data).now;
}

struct passo_ramp passo_ramp_queue_front(
    const struct passo_ramp_queue *queue, const struct passo_parameters *parameters)
{
	const uint32_t *words = queue->words[queue->read_ramp & (depth(parameters) - 1u)];
	const struct passo_ramp_control control = passo_unpack_ramp_control(words[0]);

	return (struct passo_ramp){
	    .last = control.last,
	    .mirror = control.mirror,
	    .shape = control.shape,
	    .velocity_end = (uint64_t)control.velocity_high << 32 | words[1],
	    .ticks = words[2],
	    .progress_step = (uint64_t)words[3] << 32 | words[4],
	};
}

static uint8_t next_index(uint8_t index)
{
	return index == INDEX_LAST ? INDEX_CONTROL : (uint8_t)(index + 1u);
}

void passo_ramp_queue_clock(struct passo_ramp_queue *queue, const struct passo_parameters *parameters,
    const struct passo_bus *bus, const struct passo_channel_wires *wires, bool take, bool take_now)
{
	const bool check = wires->ramp_push && bus->check;
	const bool write_high = wires->ramp_push && bus->write;
	const bool write_low = queue->write_low;
	const uint8_t index = queue->index;
	const uint16_t write_ramp = queue->write_ramp;
	const uint16_t read_ramp = queue->read_ramp;

	queue->write_low = write_high;
	queue->full = queue->room == queue->checked;
	if ((check || write_high) && index == INDEX_CONTROL) {
		queue->velocity_is_max = bus->data >> 16 == VELOCITY_MAX_HIGH;
		queue->is_now = passo_unpack_ramp_control(bus->data).now;
	}
	if (check || write_low)
		queue->index = next_index(index);
	if (check && index == INDEX_LAST)
		queue->checked = wrap(queue->checked + 1u, parameters);
	if (take)
		queue->read_ramp = wrap(read_ramp + 1u, parameters);
	if (take_now) {
		queue->read_ramp = queue->now_ramp;
		queue->now_pending = false;
	}
	if (write_low)
		queue->words[write_ramp & (depth(parameters) - 1u)][index] = bus->data;
	if (write_low && index == INDEX_LAST) {
		queue->write_ramp = wrap(write_ramp + 1u, parameters);
		if (queue->is_now) {
			queue->now_ramp = write_ramp;
			queue->now_pending = true;
		}
	}
	queue->room =
	    (uint16_t)(depth(parameters) - wrap((unsigned)queue->write_end - read_ramp, parameters));
	if (bus->frame) {
		if (bus->commit)
			queue->write_end = wrap((unsigned)write_ramp + queue->checked, parameters);
		queue->index = INDEX_CONTROL;
		queue->checked = 0;
	}
	if (wires->stopped) {
		queue->now_pending = false;
		queue->read_ramp = queue->write_end = write_ramp;
	}
	queue->valid = read_ramp != write_ramp;
}
