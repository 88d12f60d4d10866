/* SPDX-License-Identifier: MIT
 * Ramp: velocity over time. See rtl/passo_ramp.v.
 *
 * Loading a ramp, and shape and scale, take the same clocks as in the RTL but happen at once, in the last of
 * them.
 */
#include "passo_model.h"

static const uint32_t LOAD_CLOCKS = 11;
static const uint32_t LOAD_NOW_CLOCKS = 12; /* one more, for the queue to drop what is before it */

uint32_t passo_ramp_latency(const struct passo_ramp_unit *ramp, const struct passo_tables *tables,
    const struct passo_parameters *parameters, uint8_t channel)
{
	const uint32_t look_up = 4; /* from CHOOSE: start, round, mirror, look up */
	const uint32_t multiply =
	    21; /* from the channel's turn at the tables: two reads, 16 bits, sum, mirror */
	const uint32_t scale = 54; /* start, difference, 24 bits in two halves each, sum */
	const uint32_t x = (uint32_t)((ramp->progress + (UINT64_C(1) << 23)) >> 24);
	const uint32_t x_mirrored = ramp->mirror ? (1u << 24) - x : x;

	if (ramp->shape == PASSO_SHAPE_LINEAR || x_mirrored >> 24 != 0u)
		return look_up + scale;
	const uint32_t slots = 2u * parameters->channels;
	const uint32_t turn = 2u * channel;
	const uint32_t slot_then = (tables->slot + look_up) % slots;
	const uint32_t wait = (turn + slots - slot_then) % slots;
	return look_up + wait + multiply + scale;
}

void passo_ramp_make_velocity(struct passo_ramp_unit *ramp, const struct passo_tables *tables)
{
	const uint32_t s = passo_shape_value(tables, ramp->shape, ramp->mirror, ramp->progress);

	ramp->velocity_next = passo_scale_velocity(ramp->v_start, ramp->v_end, s);
	ramp->progress = (ramp->progress + ramp->progress_step) & (PASSO_ONE_Q48 - 1u);
	ramp->ticks--;
	ramp->ends_next = false;
	ramp->ready = true;
}

static void load(struct passo_ramp_unit *ramp, const struct passo_ramp *command)
{
	ramp->v_start = ramp->v_end;
	ramp->v_end = command->velocity_end;
	ramp->last = command->last;
	ramp->mirror = command->mirror;
	ramp->shape = command->shape;
	ramp->ticks = command->ticks;
	ramp->progress_step = command->progress_step;
	ramp->progress = command->progress_step >> 1;
}

static void choose(struct passo_ramp_unit *ramp, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires)
{
	if (channel->ramp_queue.now_pending) {
		ramp->take_now = true;
		ramp->v_end = ramp->velocity;
		ramp->step = PASSO_RAMP_LOAD;
		ramp->wait = LOAD_NOW_CLOCKS;
	} else if (ramp->ticks != 0u) {
		ramp->step = PASSO_RAMP_WORK;
		ramp->wait = passo_ramp_latency(ramp, inputs->tables, inputs->parameters, channel->number);
	} else if (!ramp->last && wires->ramp_valid) {
		ramp->step = PASSO_RAMP_LOAD;
		ramp->wait = LOAD_CLOCKS;
	} else {
		ramp->velocity_next = ramp->last ? 0u : ramp->v_end;
		ramp->ends_next = ramp->last;
		ramp->dry = !ramp->last && ramp->v_end != 0u;
		ramp->ready = true;
		ramp->step = PASSO_RAMP_IDLE;
	}
}

static void stop(struct passo_ramp_unit *ramp)
{
	ramp->step = PASSO_RAMP_IDLE;
	ramp->take_now = false;
	ramp->ready = false;
	ramp->ends_next = false;
	ramp->velocity = 0;
	ramp->ticks = 0;
	ramp->last = false;
}

void passo_ramp_clock(struct passo_ramp_unit *ramp, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires, bool *take,
    bool *take_now)
{
	const uint64_t velocity_next = ramp->velocity_next;
	const bool ends_next = ramp->ends_next;

	*take = false;
	*take_now = ramp->take_now;
	ramp->take_now = false;
	ramp->dry = false;

	switch (ramp->step) {
	case PASSO_RAMP_CHOOSE:
		choose(ramp, channel, inputs, wires);
		break;
	case PASSO_RAMP_LOAD:
		if (--ramp->wait == 0u) {
			const struct passo_ramp front =
			    passo_ramp_queue_front(&channel->ramp_queue, inputs->parameters);
			load(ramp, &front);
			*take = true;
			ramp->step = PASSO_RAMP_CHOOSE;
		}
		break;
	case PASSO_RAMP_WORK:
		if (--ramp->wait == 0u) {
			passo_ramp_make_velocity(ramp, inputs->tables);
			ramp->step = PASSO_RAMP_IDLE;
		}
		break;
	case PASSO_RAMP_IDLE:
		break;
	}

	if (wires->prepare) {
		ramp->v_end = 0;
		ramp->velocity = 0;
		ramp->ticks = 0;
		ramp->last = false;
		ramp->ready = false;
		ramp->ends_next = false;
		ramp->step = PASSO_RAMP_CHOOSE;
	}
	if (wires->advance)
		ramp->tick_count = (ramp->tick_count + 1u) & ((1u << inputs->parameters->tick_log2) - 1u);
	if (wires->next) {
		ramp->velocity = velocity_next;
		ramp->ready = false;
		if (!ends_next)
			ramp->step = PASSO_RAMP_CHOOSE;
	}
	if (wires->begin_profile)
		ramp->tick_count = 0;
	if (wires->drain)
		ramp->velocity = (uint64_t)channel->registers.drain_velocity << 16;
	if (wires->stopped)
		stop(ramp);
}
