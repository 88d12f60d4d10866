/* SPDX-License-Identifier: MIT
 * Checks of the pins: every edge, and its distance from the previous one.
 */
#include <string.h>

#include "judge_state.h"

static void see_gap(struct judge *judge, unsigned c, unsigned a)
{
	struct axis *axis = &judge->channel[c].axis[a];
	const uint64_t gap = judge->now - axis->steps[0];

	if (axis->gap_least != 0u && gap < axis->gap_least)
		FAIL(judge, "channel %u axis %u: %llu clocks between steps, the rate at the stop allows %llu",
		    c, a, (unsigned long long)gap, (unsigned long long)axis->gap_least);
	judge->counts->gaps += axis->gap_least != 0u ? 1u : 0u;
	memmove(&axis->steps[1], &axis->steps[0], GAPS * sizeof axis->steps[0]);
	axis->steps[0] = judge->now;
}

static void see_step(struct judge *judge, unsigned c, unsigned a)
{
	struct channel *channel = &judge->channel[c];
	struct axis *axis = &channel->axis[a];

	axis->position += axis->down ? -1 : 1;
	if (axis->position < axis->lowest)
		axis->lowest = axis->position;
	if (axis->position > axis->highest)
		axis->highest = axis->position;
	judge->counts->steps++;
	if (judge->now < axis->setup_over)
		FAIL(judge, "channel %u axis %u: DIR setup is %llu clocks short", c, a,
		    (unsigned long long)(axis->setup_over - judge->now));
	if (channel->silent && judge->now > channel->silent_from)
		FAIL(judge, "channel %u axis %u: a step after %s", c, a, channel->silent);
	if (axis->budget == 0u)
		FAIL(judge, "channel %u axis %u: more steps after the stop than can have waited", c, a);
	axis->budget -= axis->budget != UINT32_MAX && axis->budget != 0u ? 1u : 0u;
	see_gap(judge, c, a);
	if (judge->world->machine)
		judge_machine_step(judge, a);
}

static void see_level(struct judge *judge, unsigned c, unsigned a)
{
	struct axis *axis = &judge->channel[c].axis[a];

	if (judge->now < axis->level_over)
		FAIL(judge, "channel %u axis %u: STEP was %s %llu clocks too short", c, a,
		    axis->active ? "active" : "inactive",
		    (unsigned long long)(axis->level_over - judge->now));
	if (axis->active && !axis->both_edges && axis->exact && judge->now > axis->level_over)
		FAIL(judge, "channel %u axis %u: STEP was active %llu clocks too long", c, a,
		    (unsigned long long)(judge->now - axis->level_over));
	axis->active = !axis->active;
	axis->exact = judge->now > axis->written_at + TIMING_CLOCKS + SLACK;
	axis->level_over = judge->now + judge_level_time(axis);
	axis->hold_over = axis->level_over + axis->dir_hold;
	if (axis->active && !axis->both_edges)
		axis->hold_over = UINT64_MAX;
	if (axis->active || axis->both_edges)
		see_step(judge, c, a);
}

static void see_turn(struct judge *judge, unsigned c, unsigned a)
{
	struct channel *channel = &judge->channel[c];
	struct axis *axis = &channel->axis[a];

	judge->counts->turns++;
	if (judge->now < axis->hold_over)
		FAIL(judge, "channel %u axis %u: DIR changes %lld clocks before its hold time is over", c, a,
		    axis->hold_over == UINT64_MAX ? -1LL : (long long)(axis->hold_over - judge->now));
	if (channel->still && judge->now > channel->silent_from)
		FAIL(judge, "channel %u axis %u: DIR changes after %s", c, a, channel->silent);
	axis->down = !axis->down;
	axis->setup_over = judge->now + axis->dir_setup;
}

void judge_enable(struct judge *judge, unsigned c, unsigned a, bool level)
{
	const struct axis *axis = &judge->channel[c].axis[a];
	bool unsure = false;
	const bool enabled = judge->world->machine ? judge_enabled(judge, a, &unsure) : axis->enabled;

	if (!unsure && judge->now >= judge->enable_unknown_until
	    && level != (enabled != axis->enable_inverted))
		FAIL(judge, "channel %u axis %u: EN is %d", c, a, level);
}

void judge_pins(struct judge *judge, const struct passo_outputs *pins)
{
	const unsigned axes = judge_axes(judge);

	if (judge->world->machine)
		judge_machine_before(judge, pins);
	for (unsigned c = 0; c < judge_channels(judge); c++) {
		struct channel *channel = &judge->channel[c];
		bool moves = (pins->running & ~judge->pins.running & 1u << c) != 0u;

		/* a motion starts at the target rate */
		for (unsigned a = 0; moves && a < axes; a++) {
			memset(channel->axis[a].steps, 0, sizeof channel->axis[a].steps);
			channel->axis[a].gap_least = 0;
		}
		for (unsigned a = 0; a < axes; a++) {
			struct axis *axis = &channel->axis[a];
			const unsigned bit = c * axes + a;
			const bool step = (pins->step >> bit & 1u) != 0u;
			const bool dir = (pins->dir >> bit & 1u) != 0u;
			const bool turns = (dir != axis->direction_inverted) != axis->down;
			const bool steps = (step != axis->step_inverted) != axis->active;

			const bool settles = judge->now <= axis->settled_at;

			if (turns)
				see_turn(judge, c, a);
			if (steps && !settles)
				see_level(judge, c, a);
			moves = moves || (channel->gated_pins && steps && !settles)
			     || (channel->gated_pins && turns
			         && judge->now + GATE_CLOCKS <= channel->gated_until + SLACK);
			judge_enable(judge, c, a, (pins->enable >> bit & 1u) != 0u);
		}
		if (moves && judge->now <= channel->gated_until)
			FAIL(judge, "channel %u: moves while a frame is executed that needs rest", c);
	}
	if (pins->irq && !judge->pins.irq && judge_channels(judge) == 1u) {
		struct channel *channel = &judge->channel[0];

		for (unsigned a = 0; a < axes && !channel->stopped; a++)
			if (channel->axis[a].budget == UINT32_MAX)
				channel->axis[a].budget = STEPS_AFTER_STOP;
		channel->stopped = true;
		channel->exact = false;
	}
	if (judge->world->machine)
		judge_machine_after(judge, pins);
	judge->pins = *pins;
}
