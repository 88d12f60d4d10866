/* SPDX-License-Identifier: MIT
 * Ramp: velocity over time. See rtl/passo_ramp.v and rtl/passo_ramp_numbers.v.
 * Each step takes as many clocks as in the RTL; its effect takes place in the last of them.
 */
#include "passo_model.h"

enum { COPY_CLOCKS = 24, FETCH_CLOCKS = 8, FETCH_NO_TICKS_CLOCKS = 7, TAKE_CLOCKS = 5, STEP_CLOCKS = 8 };

/* ramp_take is asserted in this clock of TAKE, counted from the last one. */
enum { TAKE_WAIT = 2 };

static const uint64_t PROGRESS_MASK = (UINT64_C(1) << 49) - 1u;

static void begin_step(struct passo_ramp_unit *ramp, enum passo_ramp_step step, uint32_t clocks)
{
	ramp->step = step;
	ramp->wait = clocks;
}

static uint32_t work_clocks(const struct passo_ramp_unit *ramp, const struct passo_tables *tables,
    const struct passo_parameters *parameters, uint8_t channel)
{
	const uint32_t served = 3; /* from the channel's slot at the tables */
	const uint32_t shape = 19;
	const uint32_t scale = 50;

	if (!ramp->loaded || ramp->shape == PASSO_SHAPE_LINEAR)
		return scale;
	const uint32_t slots = 2u * parameters->channels;
	const uint32_t turn = 2u * channel;
	const uint32_t slot_then = (tables->slot + 1u) % slots;
	const uint32_t wait = 1u + (turn + slots - slot_then) % slots;
	return wait + served + shape + scale;
}

void passo_ramp_make_velocity(struct passo_ramp_unit *ramp, const struct passo_tables *tables)
{
	const uint32_t s = passo_shape(tables, ramp->shape, ramp->progress);
	const uint64_t a = ramp->mirror ? ramp->v_end : ramp->v_start;
	const uint64_t b = ramp->mirror ? ramp->v_start : ramp->v_end;
	const uint64_t step = 2u * ramp->progress_step;

	ramp->velocity_next = passo_interpolate(a, b, s);
	ramp->progress = (ramp->mirror ? ramp->progress - step : ramp->progress + step) & PROGRESS_MASK;
	ramp->ticks--;
	ramp->ready = true;
}

void passo_ramp_hold(struct passo_ramp_unit *ramp, uint32_t ticks)
{
	const uint64_t step = 2u * ramp->progress_step * ticks;

	ramp->progress = (ramp->mirror ? ramp->progress - step : ramp->progress + step) & PROGRESS_MASK;
	ramp->ticks -= ticks;
}

static void load(struct passo_ramp_unit *ramp, const struct passo_ramp *command)
{
	ramp->v_end = command->velocity_end;
	ramp->last = command->last;
	ramp->mirror = command->mirror;
	ramp->shape = command->shape;
	ramp->ticks = command->ticks;
	ramp->progress_step = command->progress_step;
	ramp->progress = command->mirror ? PROGRESS_MASK - command->progress_step : command->progress_step;
}

static void choose(struct passo_ramp_unit *ramp, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires)
{
	const struct passo_ramp front = passo_ramp_queue_front(&channel->ramp_queue, inputs->parameters);
	const uint32_t work = work_clocks(ramp, inputs->tables, inputs->parameters, channel->number);

	if (channel->ramp_queue.now_pending) {
		ramp->take_now = true;
		ramp->loaded = false;
		ramp->last = false;
		begin_step(ramp, PASSO_RAMP_COPY, COPY_CLOCKS);
	} else if (ramp->loaded) {
		begin_step(ramp, PASSO_RAMP_WORK, work);
	} else if (ramp->last) {
		ramp->ends_next = !wires->now_coming;
		ramp->ready = !wires->now_coming;
	} else if (wires->ramp_valid) {
		begin_step(ramp, PASSO_RAMP_FETCH, front.ticks == 0u ? FETCH_NO_TICKS_CLOCKS : FETCH_CLOCKS);
	} else {
		begin_step(ramp, PASSO_RAMP_WORK, work);
	}
}

/* Applies the effect of a completed step and chooses the next one. */
static void finish_step(struct passo_ramp_unit *ramp, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs)
{
	const enum passo_ramp_step step = ramp->step;

	ramp->step = PASSO_RAMP_CHOOSE;
	if (step == PASSO_RAMP_COPY) {
		ramp->v_start = ramp->velocity_next;
	} else if (step == PASSO_RAMP_FETCH) {
		const struct passo_ramp front =
		    passo_ramp_queue_front(&channel->ramp_queue, inputs->parameters);
		load(ramp, &front);
		ramp->loaded = ramp->ticks != 0u;
		if (!ramp->loaded)
			begin_step(ramp, PASSO_RAMP_TAKE, TAKE_CLOCKS);
	} else if (step == PASSO_RAMP_TAKE) {
		ramp->v_start = ramp->v_end;
		ramp->loaded = false;
	} else if (step == PASSO_RAMP_WORK && ramp->loaded) {
		passo_ramp_make_velocity(ramp, inputs->tables);
		if (ramp->ticks == 0u)
			begin_step(ramp, PASSO_RAMP_TAKE, TAKE_CLOCKS);
		else
			begin_step(ramp, PASSO_RAMP_STEP, STEP_CLOCKS);
	} else if (step == PASSO_RAMP_WORK) {
		ramp->velocity_next = ramp->v_start;
		ramp->dry = ramp->v_start != 0u;
		ramp->ready = true;
	}
}

void passo_ramp_clock(struct passo_ramp_unit *ramp, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires, bool *take,
    bool *take_now)
{
	*take = ramp->step == PASSO_RAMP_TAKE && ramp->wait == TAKE_WAIT;
	*take_now = ramp->take_now;
	ramp->take_now = false;
	ramp->dry = false;
	ramp->unready = !ramp->ready && !wires->drain;

	if (ramp->step != PASSO_RAMP_CHOOSE) {
		if (--ramp->wait == 0u)
			finish_step(ramp, channel, inputs);
	} else if (!ramp->ready && !ramp->ends_next) {
		choose(ramp, channel, inputs, wires);
	}

	if (wires->advance)
		ramp->tick_count = (ramp->tick_count + 1u) & ((1u << inputs->parameters->tick_log2) - 1u);
	if (wires->next)
		ramp->ready = false;
	if (wires->begin_profile)
		ramp->tick_count = 0;
	if (wires->prepare) {
		begin_step(ramp, PASSO_RAMP_COPY, COPY_CLOCKS);
		ramp->ready = false;
		ramp->ends_next = false;
		ramp->loaded = false;
		ramp->last = false;
		ramp->velocity_next = 0;
	}
	if (wires->stopped) {
		ramp->step = PASSO_RAMP_CHOOSE;
		ramp->ready = false;
		ramp->ends_next = true;
		ramp->take_now = false;
	}
}
