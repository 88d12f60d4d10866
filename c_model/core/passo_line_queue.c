/* SPDX-License-Identifier: MIT
 * Line queue. See rtl/passo_line_queue.v.
 */
#include "passo_model.h"
#include "passo_words.h"

enum { INDEX_CONTROL = 0, INDEX_SUBSTEPS = 1, INDEX_STEPS = 2 };

static unsigned depth(const struct passo_parameters *parameters)
{
	return 1u << parameters->line_queue_log2;
}

/* Axes that lines move. */
static unsigned lined(const struct passo_parameters *parameters)
{
	return (unsigned)parameters->axes - parameters->tracked;
}

/* Of a line: control, M, N_i, and with OUTPUTS its output word. */
static unsigned last_index(const struct passo_parameters *parameters)
{
	return INDEX_STEPS + lined(parameters) - 1u + parameters->outputs;
}

static bool is_output(const struct passo_parameters *parameters, unsigned index)
{
	return index == (unsigned)INDEX_STEPS + lined(parameters);
}

static uint16_t wrap(unsigned line, const struct passo_parameters *parameters)
{
	return (uint16_t)(line & (2u * depth(parameters) - 1u));
}

uint8_t passo_line_queue_refusal(const struct passo_line_queue *queue,
    const struct passo_parameters *parameters, const struct passo_bus *bus, bool blocked)
{
	const uint32_t defined = passo_pack_line_control(&(struct passo_line_control){
	    .directions = (uint8_t)((1u << lined(parameters)) - 1u), .endless = true, .last = true});

	if (blocked)
		return PASSO_VERDICT_BUSY;
	if (queue->full)
		return PASSO_VERDICT_QUEUE_FULL;
	if (queue->index == INDEX_CONTROL && (bus->data & ~defined) != 0u)
		return PASSO_VERDICT_BAD_VALUE;
	if (queue->index == INDEX_SUBSTEPS && (bus->data == 0u || bus->data > PASSO_SUBSTEPS_MAX))
		return PASSO_VERDICT_BAD_VALUE;
	if (is_output(parameters, queue->index)) {
		const struct passo_line_output output = passo_unpack_line_output(bus->data);
		const bool bad_raster = output.raster && (parameters->raster == 0u || output.power != 0u);
		return (bus->data & ~PASSO_LINE_OUTPUT_DEFINED) != 0u || bad_raster ? PASSO_VERDICT_BAD_VALUE
		                                                                    : PASSO_VERDICT_OK;
	}
	if (queue->index >= INDEX_STEPS && bus->data > queue->checked_substeps)
		return PASSO_VERDICT_BAD_VALUE;
	return PASSO_VERDICT_OK;
}

static void write_word(struct passo_line *line, unsigned index, uint32_t data)
{
	const struct passo_line_control control = passo_unpack_line_control(data);

	switch (index) {
	case INDEX_CONTROL:
		line->last = control.last;
		line->endless = control.endless;
		line->directions = control.directions;
		break;
	case INDEX_SUBSTEPS:
		line->substeps = data;
		break;
	default:
		line->steps[index - INDEX_STEPS] = data;
		break;
	}
}

static void clock_writing(struct passo_line_queue *queue, const struct passo_parameters *parameters,
    const struct passo_bus *bus, bool push)
{
	const bool complete = queue->index == last_index(parameters);
	const unsigned place = queue->write_line & (depth(parameters) - 1u);
	const uint8_t index = queue->index;

	if (push && (bus->check || bus->write)) {
		queue->index = complete ? INDEX_CONTROL : (uint8_t)(index + 1u);
		if (index == INDEX_SUBSTEPS)
			queue->checked_substeps = bus->data;
		if (complete && bus->check)
			queue->checked = wrap(queue->checked + 1u, parameters);
		if (bus->write && is_output(parameters, index))
			queue->output_words[place] = bus->data;
		else if (bus->write)
			write_word(&queue->lines[place], index, bus->data);
		if (complete && bus->write)
			queue->write_line = wrap(queue->write_line + 1u, parameters);
	}
	if (bus->frame) {
		queue->index = INDEX_CONTROL;
		queue->checked = 0;
	}
}

/* Synchronous read of the block RAM: addresses and contents before the edge. */
static void read_memory(struct passo_line_queue *queue, const struct passo_parameters *parameters, bool take)
{
	const struct passo_line *next = &queue->lines[queue->next_line & (depth(parameters) - 1u)];
	const struct passo_line *current = &queue->lines[queue->current_line];

	if (take) {
		queue->last = next->last;
		queue->endless = next->endless;
		queue->last_substep = next->substeps - 1u;
	}
	queue->directions = current->directions;
	queue->output_word = queue->output_words[queue->current_line];
	for (unsigned axis = 0; axis < lined(parameters); axis++)
		queue->steps[axis] = current->steps[axis];
}

void passo_line_queue_clock(struct passo_line_queue *queue, const struct passo_parameters *parameters,
    const struct passo_bus *bus, const struct passo_channel_wires *wires)
{
	const uint16_t write_line = queue->write_line;
	const uint16_t next_line = queue->next_line;

	const unsigned occupied = (unsigned)queue->write_end - next_line + (queue->has_place ? 1u : 0u);

	queue->full = queue->room == queue->checked;
	queue->room = wrap(depth(parameters) - occupied, parameters);
	if (bus->frame && bus->commit)
		queue->write_end = wrap((unsigned)write_line + queue->checked, parameters);
	read_memory(queue, parameters, wires->take);
	clock_writing(queue, parameters, bus, wires->line_push);
	if (wires->take) {
		queue->current_line = next_line & (uint16_t)(depth(parameters) - 1u);
		queue->next_line = wrap(next_line + 1u, parameters);
		queue->has_place = true;
	}
	if (wires->finished)
		queue->has_place = false;
	queue->next_valid = !wires->take && !wires->stopped && next_line != write_line;
	if (wires->stopped) {
		queue->write_line = queue->write_end = queue->next_line = 0;
		queue->has_place = false;
	}
}
