/* SPDX-License-Identifier: MIT
 * Executing a running profile with what it moves: ramp, path, line, DDAs and axes. See passo_advance.c.
 *
 * Most clocks are skipped. Those around a substep, a tick or an edge are executed in these units alone, while
 * they only act on each other.
 */
#include "passo_advance.h"

/* An axis without a step is left behind, and caught up with when it has one. */
struct run {
	struct passo_channel *channel;
	const struct passo_channel_inputs *inputs;
	uint64_t clocks;               /* so far */
	uint32_t tick_last;            /* clock of a tick */
	uint64_t then[PASSO_AXES_MAX]; /* clocks that an axis has executed */
	bool idle[PASSO_AXES_MAX];     /* nothing changes in it until its next step */
	bool due;                      /* a pin changes in the next clock */
	bool overrun;                  /* an axis stops the channel */
};

static bool is_due(const struct passo_axis *axis)
{
	const struct passo_axis_settings *settings = &axis->settings;

	return axis->step_pin != (axis->step != settings->step_inverted)
	    || axis->dir_pin != (axis->dir != settings->direction_inverted)
	    || axis->enable_pin != (settings->enable != settings->enable_inverted);
}

/* Other parts see the steps: encoders, outputs, and limits. */
static bool is_watched(const struct passo_channel *channel)
{
	const struct passo_inputs_unit *inputs = &channel->inputs;

	return channel->has_outputs || channel->encoders.present || channel->trackers.present
	    || (inputs->input[PASSO_KIND_LIMIT_LOW].level | inputs->input[PASSO_KIND_LIMIT_HIGH].level
	           | inputs->limits.closed_low | inputs->limits.closed_high)
	           != 0u;
}

/* Whether the units only act on each other in the next clock. */
static bool is_alone(const struct run *run)
{
	const struct passo_channel *channel = run->channel;
	const struct passo_ramp_unit *ramp = &channel->ramp;
	const struct passo_line_unit *line = &channel->line;

	if (run->overrun || !ramp->loaded || ramp->take_now || ramp->dry || ramp->ends_next
	    || channel->ramp_queue.now_pending)
		return false;
	/* the tables serve a shape in its turn, and the queue gives the next ramp */
	if (ramp->step == PASSO_RAMP_CHOOSE ? !ramp->ready && ramp->shape != PASSO_SHAPE_LINEAR
	                                    : ramp->step != PASSO_RAMP_WORK && ramp->step != PASSO_RAMP_STEP)
		return false;
	if (ramp->unready && ramp->tick_count == run->tick_last)
		return false;
	return !(channel->path.substep && line->active && line->on_last);
}

static void catch_up(struct run *run, unsigned i)
{
	passo_axis_skip(&run->channel->axis[i], run->clocks - run->then[i]);
	run->then[i] = run->clocks;
}

static void clock_axis(struct run *run, unsigned i)
{
	struct passo_channel *channel = run->channel;
	struct passo_axis *axis = &channel->axis[i];
	const struct passo_axis_wires wires = {
	    .step_request = passo_dda_step_request(&channel->dda[i], &channel->line),
	    .direction = ((uint32_t)channel->line.directions >> i & 1u) != 0u,
	    .closed = axis->closed,
	};

	if (run->idle[i] && !wires.step_request)
		return;
	if (run->idle[i])
		catch_up(run, i);
	passo_axis_clock(axis, &wires);
	run->then[i]++;
	run->idle[i] = axis->state == PASSO_AXIS_READY && passo_advance_axis_quiet(channel, i) == UINT64_MAX;
	run->due = run->due || is_due(axis);
	run->overrun = run->overrun || axis->overrun;
}

static void clock_units(struct run *run)
{
	struct passo_channel *channel = run->channel;
	const bool tick = channel->ramp.tick_count == run->tick_last;
	const struct passo_channel_wires wires = {
	    .counting = true,
	    .moving = true,
	    .occupied = true,
	    .advance = true,
	    .tick = tick,
	    .next = tick,
	    .substep_taken = channel->path.substep && channel->line.active,
	};
	bool take, take_now;

	for (unsigned i = 0; i < channel->axes; i++) {
		clock_axis(run, i);
		passo_dda_clock(&channel->dda[i], &channel->line, &channel->line_queue, i);
	}
	passo_line_clock(&channel->line, &channel->line_queue, &wires);
	passo_path_clock(&channel->path, &channel->ramp, &wires, 0);
	passo_ramp_clock(&channel->ramp, channel, run->inputs, &wires, &take, &take_now);
	run->clocks++;
}

/* Skips clocks, if the axes allow that many. */
static bool skip(struct run *run, uint64_t limit)
{
	struct passo_channel *channel = run->channel;
	uint64_t clocks = limit - run->clocks;

	for (unsigned i = 0; i < channel->axes; i++)
		if (!run->idle[i])
			clocks = passo_least(clocks, passo_advance_axis_quiet(channel, i));
	if (clocks < PASSO_ADVANCE_PIPELINE)
		return false;
	/* outputs see the velocity of each tick */
	uint64_t skipped = channel->has_outputs ? 0u : passo_advance_skip_ticks(channel, run->inputs, clocks);
	if (skipped == 0u) {
		clocks = passo_least(clocks, passo_advance_ramp_quiet(&channel->ramp));
		skipped = passo_advance_profile_quiet(channel, run->inputs->parameters, clocks);
		if (skipped == 0u)
			return false;
		passo_advance_profile_skip(channel, skipped);
	}
	run->clocks += skipped;
	for (unsigned i = 0; i < channel->axes; i++)
		if (!run->idle[i])
			catch_up(run, i);
	return true;
}

uint64_t passo_advance_run(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit, bool *changed)
{
	struct run run = {
	    .channel = channel, .inputs = inputs, .tick_last = (1u << inputs->parameters->tick_log2) - 1u};
	const bool watched = is_watched(channel);
	const uint32_t before = channel->line.substep_number;

	for (unsigned i = 0; i < channel->axes; i++) {
		run.idle[i] = passo_advance_axis_quiet(channel, i) == UINT64_MAX;
		run.due = run.due || is_due(&channel->axis[i]);
		run.overrun = run.overrun || channel->axis[i].overrun;
	}
	while (run.clocks < limit && !run.due) {
		if (skip(&run, limit))
			continue;
		if (watched || !is_alone(&run))
			break;
		clock_units(&run);
	}
	if (changed) {
		*changed = run.due && run.clocks < limit && !watched && is_alone(&run);
		if (*changed)
			clock_units(&run);
	}
	for (unsigned i = 0; i < channel->axes; i++)
		catch_up(&run, i);
	passo_advance_surroundings_skip(channel, run.clocks, channel->line.substep_number - before);
	return run.clocks;
}
