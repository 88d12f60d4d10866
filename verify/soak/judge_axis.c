/* SPDX-License-Identifier: MIT
 * Settings of an axis: polarities and timings that change while it moves.
 */
#include "judge_state.h"

/* Latency of a polarity change to STEP. */
#define POLARITY_CLOCKS 4u

static void write_step_timing(struct axis *axis, uint64_t now, uint32_t value)
{
	const struct passo_axis_step_timing timing = passo_unpack_axis_step_timing(value);
	const uint64_t was = judge_level_time(axis);

	axis->written_at = now;
	axis->step_high = judge_later(timing.step_high, 1);
	axis->step_low = judge_later(timing.step_low, 1);
	if (axis->level_over + SLACK < now)
		return;
	axis->exact = false;
	if (now + SLACK < axis->level_over)
		axis->level_over = now - SLACK + TIMING_CLOCKS + judge_level_time(axis);
	else if (judge_level_time(axis) < was)
		axis->level_over -= was - judge_level_time(axis);
	if (axis->hold_over != UINT64_MAX)
		axis->hold_over = axis->level_over + axis->dir_hold;
}

static void write_dir_timing(struct axis *axis, uint64_t now, uint32_t value)
{
	const struct passo_axis_dir_timing timing = passo_unpack_axis_dir_timing(value);
	const uint64_t was_setup = axis->dir_setup, was_hold = axis->dir_hold;

	axis->written_at = now;
	axis->dir_setup = judge_later(timing.dir_setup, 1);
	axis->dir_hold = judge_later(timing.dir_hold, 1);
	if (now <= axis->level_over + SLACK) /* the write restarts this time as well */
		axis->exact = false;
	if (now + SLACK < axis->setup_over)
		axis->setup_over = now - SLACK + TIMING_CLOCKS + axis->dir_setup;
	else if (axis->setup_over + SLACK >= now && axis->dir_setup < was_setup)
		axis->setup_over -= was_setup - axis->dir_setup;
	if (axis->hold_over == UINT64_MAX)
		return;
	if (now + SLACK < axis->level_over)
		axis->hold_over = axis->level_over + axis->dir_hold;
	else if (now + SLACK < axis->hold_over)
		axis->hold_over = now - SLACK + TIMING_CLOCKS + axis->dir_hold;
	else if (axis->hold_over + SLACK >= now && axis->dir_hold < was_hold)
		axis->hold_over -= was_hold - axis->dir_hold;
}

/* The level of STEP a few clocks later, and its edges until then. */
static bool follow_step(const struct judge *judge, unsigned bit, unsigned *edges)
{
	const struct world *world = judge->world;
	bool level = (judge->pins.step >> bit & 1u) != 0u;

	for (size_t row = judge->row; row < world->row_count; row++) {
		const bool next = (world->rows[row].pins.step >> bit & 1u) != 0u;

		if (world->rows[row].clock > judge->now + POLARITY_CLOCKS)
			break;
		*edges += next != level ? 1u : 0u;
		level = next;
	}
	return level;
}

/* A polarity change inverts the levels, which is not an edge; the next step waits as after a pulse. */
static void write_pins(
    struct judge *judge, unsigned c, unsigned a, uint32_t value, const struct passo_outputs *pins)
{
	const struct passo_axis_pins written = passo_unpack_axis_pins(value);
	unsigned edges = 0;
	struct axis *axis = &judge->channel[c].axis[a];
	const unsigned bit = c * judge_axes(judge) + a;

	axis->step_inverted = written.step_inverted;
	axis->direction_inverted = written.direction_inverted;
	axis->enable_inverted = written.enable_inverted;
	axis->both_edges = written.both_edges;
	if (!axis->both_edges)
		axis->active = false;
	const bool step = follow_step(judge, bit, &edges);
	if (step != (axis->active != axis->step_inverted) || edges > 1u)
		FAIL(judge, "channel %u axis %u: STEP is %d after %u edges with a change of its polarity", c,
		    a, step, edges);
	if (((pins->dir >> bit & 1u) != 0u) != (axis->down != axis->direction_inverted))
		FAIL(judge, "channel %u axis %u: DIR does not follow its polarity", c, a);
	axis->exact = false;
	axis->settled_at = judge->now + POLARITY_CLOCKS;
	axis->level_over = judge->now - SLACK + judge_level_time(axis);
	axis->hold_over = axis->level_over + axis->dir_hold;
	axis->setup_over = judge->now - SLACK + axis->dir_setup;
	judge_enable(judge, c, a, (pins->enable >> bit & 1u) != 0u);
}

void judge_write_axis(
    struct judge *judge, unsigned c, unsigned place, uint32_t value, const struct passo_outputs *pins)
{
	const unsigned a = place / PASSO_CHANNEL_AXIS_STRIDE;
	struct axis *axis = &judge->channel[c].axis[a];

	switch (place % PASSO_CHANNEL_AXIS_STRIDE) {
	case PASSO_AXIS_PINS:
		judge_gate(judge, c, true);
		write_pins(judge, c, a, value, pins);
		break;
	case PASSO_AXIS_STEP_TIMING:
		write_step_timing(axis, judge->now, value);
		break;
	case PASSO_AXIS_DIR_TIMING:
		write_dir_timing(axis, judge->now, value);
		break;
	case PASSO_AXIS_INPUTS:
		break;
	default:
		axis->enabled = (value & 1u) != 0u;
		if (judge->world->machine)
			judge_machine_enable(judge, a);
		judge_enable(judge, c, a, (pins->enable >> (c * judge_axes(judge) + a) & 1u) != 0u);
		break;
	}
}
