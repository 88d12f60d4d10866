/* SPDX-License-Identifier: MIT */
#include "judge.h"

#include <string.h>

/* Clocks by which what the host knows of the time of a write may be wrong. */
#define SLACK 3u
/* Shortest time from the beginning of a motion to `running` and to its first step: nothing may run so soon
 * after a frame that is only executed while nothing does. DIR follows the motion's first line a few clocks
 * earlier. */
#define GATE_CLOCKS 32u
/* Steps that may still leave an axis after its channel has stopped: four wait, two are on their way. */
#define STEPS_AFTER_STOP 6u
/* Enabled clocks from step to step, from which on a gap tells the rate. */
#define GAP_MIN 8u
/* STEP has followed its polarity. */
#define POLARITY_CLOCKS 4u
/* A reset is over at the pins. */
#define RESET_CLOCKS 4u

/* The shortest of the last ones tells the rate: one may be longer, between two lines or motions. */
#define GAPS 3u

struct axis {
	bool step_inverted, direction_inverted, enable_inverted, both_edges, enabled;
	uint64_t step_high, step_low, dir_setup, dir_hold;
	bool active, down;
	bool exact;          /* the present pulse must be as long as it may be short */
	uint64_t written_at; /* a timing was written */
	uint64_t settled_at; /* the pins have followed a change of their polarity */
	uint64_t level_over; /* STEP may change */
	uint64_t setup_over, hold_over;
	int64_t position, lowest, highest; /* the latter since a read began */
	int64_t owed, owed_from;           /* steps of the accepted lines, from this position on */
	unsigned budget;                   /* steps that may still come */
	uint64_t steps[GAPS + 1u];         /* clocks of the last ones, the latest first; 0: none */
	uint64_t gap_least;
};

struct channel {
	struct axis axis[PASSO_AXES_MAX];
	uint64_t silent_from; /* no step after this clock, if `silent` */
	const char *silent;   /* why */
	bool still;           /* nor a change of DIR */
	uint64_t gated_until; /* nothing may run or move */
	bool gated_pins;
	bool exact; /* every accepted line must be made */
	bool stopped, stops;
	uint32_t rate_slew;
	/* RATE while stopping; UINT32_MAX: none. The last one counts when the next state still says stopping.
	 */
	uint32_t slowed, last_rate;
	uint16_t plain_ramps;
	bool ramps_known;
	bool fresh; /* nothing can have left the queues */
	uint32_t lines, ramps;
};

struct judge {
	struct world *world;
	struct judge_counts *counts;
	struct channel channel[PASSO_CHANNELS_MAX];
	struct passo_outputs pins;
	uint64_t now;
	uint64_t enable_unknown_until;
	uint8_t run;
	size_t row; /* the first one that has not been seen */
};

static uint64_t later(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

static unsigned axes_of(const struct judge *judge)
{
	return judge->world->model.parameters.axes;
}

static unsigned channels_of(const struct judge *judge)
{
	return judge->world->model.parameters.channels;
}

#define FAIL(judge, ...) world_fail((judge)->world, (judge)->now, __VA_ARGS__)

static uint64_t level_time(const struct axis *axis)
{
	return axis->active ? axis->step_high : axis->step_low;
}

/* ---- pins ---- */

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
		FAIL(judge, "channel %u axis %u: DIR set-up is %llu clocks short", c, a,
		    (unsigned long long)(axis->setup_over - judge->now));
	if (channel->silent && judge->now > channel->silent_from)
		FAIL(judge, "channel %u axis %u: a step after %s", c, a, channel->silent);
	if (axis->budget == 0u)
		FAIL(judge, "channel %u axis %u: more steps after the stop than can have waited", c, a);
	axis->budget -= axis->budget != UINT32_MAX && axis->budget != 0u ? 1u : 0u;
	see_gap(judge, c, a);
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
	axis->exact = judge->now > axis->written_at + SLACK;
	axis->level_over = judge->now + level_time(axis);
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

static void see_enable(struct judge *judge, unsigned c, unsigned a, bool level)
{
	const struct axis *axis = &judge->channel[c].axis[a];

	if (judge->now >= judge->enable_unknown_until && level != (axis->enabled != axis->enable_inverted))
		FAIL(judge, "channel %u axis %u: EN is %d", c, a, level);
}

static void see_pins(struct judge *judge, const struct passo_outputs *pins)
{
	const unsigned axes = axes_of(judge);

	for (unsigned c = 0; c < channels_of(judge); c++) {
		struct channel *channel = &judge->channel[c];
		bool moves = (pins->running & ~judge->pins.running & 1u << c) != 0u;

		/* a motion begins at the rate that is its target */
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
			see_enable(judge, c, a, (pins->enable >> bit & 1u) != 0u);
		}
		if (moves && judge->now <= channel->gated_until)
			FAIL(judge, "channel %u: moves while a frame is executed that needs rest", c);
	}
	if (pins->irq && !judge->pins.irq && channels_of(judge) == 1u) {
		struct channel *channel = &judge->channel[0];

		for (unsigned a = 0; a < axes && !channel->stopped; a++)
			if (channel->axis[a].budget == UINT32_MAX)
				channel->axis[a].budget = STEPS_AFTER_STOP;
		channel->stopped = true;
		channel->exact = false;
	}
	judge->pins = *pins;
}

/* ---- what the host knows ---- */

/* Something was accepted that may lead to steps. */
static void may_move(struct channel *channel, const struct judge *judge, bool new_motion)
{
	channel->silent = NULL;
	channel->still = false;
	for (unsigned a = 0; new_motion && a < axes_of(judge); a++)
		channel->axis[a].budget = UINT32_MAX;
}

static void forget_stop(struct channel *channel, const struct judge *judge)
{
	channel->stops = false;
	for (unsigned a = 0; a < axes_of(judge); a++)
		channel->axis[a].gap_least = 0;
}

/* From here on the gaps must not shrink: how short they may become at the rate that may be in force now. */
static void expect_slowing(struct judge *judge, unsigned c)
{
	struct channel *channel = &judge->channel[c];
	const uint64_t tick = UINT64_C(1) << judge->world->model.parameters.tick_log2;

	for (unsigned a = 0; a < axes_of(judge) && !channel->stops; a++) {
		struct axis *axis = &channel->axis[a];
		const uint64_t enabled = judge->world->gap_enabled[c][a];

		if (enabled < GAP_MIN || axis->steps[GAPS] == 0u)
			continue;
		uint64_t gap = axis->steps[0] - axis->steps[1];
		for (unsigned i = 1; i < GAPS; i++)
			if (axis->steps[i] - axis->steps[i + 1u] < gap)
				gap = axis->steps[i] - axis->steps[i + 1u];
		/* the rate that this gap stands for, UQ48.16, and what the slew can have added since */
		const uint64_t ticks = (judge->now - axis->steps[GAPS]) / tick + 2u;
		const uint64_t rate = ((enabled + 2u) << 16) / gap + ticks * channel->rate_slew;
		const uint64_t most = rate < PASSO_RATE_ONE ? rate : PASSO_RATE_ONE;
		const uint64_t least = ((enabled - 2u) << 16) / most;

		axis->gap_least = least > 4u ? least - 4u : 0u;
	}
}

static void do_command(struct judge *judge, unsigned c, uint32_t value)
{
	struct channel *channel = &judge->channel[c];
	const bool stop = (value >> PASSO_CHANNEL_COMMAND_STOP_LSB & 1u) != 0u;
	const bool abort = (value >> PASSO_CHANNEL_COMMAND_ABORT_LSB & 1u) != 0u;

	if (abort) {
		channel->silent = "an abort";
		channel->silent_from =
		    judge->now + (uint64_t)(judge->world->latency->command - judge->world->latency->pins);
		channel->exact = false;
		channel->stopped = true;
		channel->ramps_known = false;
		channel->fresh = false;
		judge->counts->aborts++;
		return;
	}
	if (stop) {
		expect_slowing(judge, c);
		channel->stops = true;
		channel->exact = false;
		channel->ramps_known = false;
		channel->fresh = false;
		judge->counts->stops++;
		return;
	}
	if ((value >> PASSO_CHANNEL_COMMAND_CLEAR_LSB & 1u) != 0u) {
		channel->stopped = false;
		channel->exact = false;
		channel->slowed = channel->last_rate = UINT32_MAX;
		forget_stop(channel, judge);
	}
	if ((value >> PASSO_CHANNEL_COMMAND_ZERO_LSB & 1u) != 0u)
		for (unsigned a = 0; a < axes_of(judge); a++) {
			struct axis *axis = &channel->axis[a];

			axis->owed_from -= axis->position;
			axis->position = axis->lowest = axis->highest = 0;
		}
}

/* Nothing of this channel may run, or even move, while the word is executed and a little later. */
static void gate(struct judge *judge, unsigned c, bool pins)
{
	struct channel *channel = &judge->channel[c];

	judge->counts->gates++;
	if ((judge->pins.running >> c & 1u) != 0u)
		FAIL(judge, "channel %u runs while a frame is executed that needs rest", c);
	channel->gated_until = judge->now + GATE_CLOCKS;
	channel->gated_pins = pins;
}

static void write_step_timing(struct axis *axis, uint64_t now, uint32_t value)
{
	const uint64_t was = level_time(axis);

	axis->written_at = now;
	axis->step_high = later(value >> 16, 1);
	axis->step_low = later(value & 0xFFFFu, 1);
	if (axis->level_over + SLACK < now)
		return;
	axis->exact = false;
	if (now + SLACK < axis->level_over)
		axis->level_over = now - SLACK + level_time(axis);
	else if (level_time(axis) < was)
		axis->level_over -= was - level_time(axis);
	if (axis->hold_over != UINT64_MAX)
		axis->hold_over = axis->level_over + axis->dir_hold;
}

static void write_dir_timing(struct axis *axis, uint64_t now, uint32_t value)
{
	const uint64_t was_setup = axis->dir_setup, was_hold = axis->dir_hold;

	axis->written_at = now;
	axis->dir_setup = later(value >> 16, 1);
	axis->dir_hold = later(value & 0xFFFFu, 1);
	if (now <= axis->level_over + SLACK) /* the write restarts this time, too */
		axis->exact = false;
	if (now + SLACK < axis->setup_over)
		axis->setup_over = now - SLACK + axis->dir_setup;
	else if (axis->setup_over + SLACK >= now && axis->dir_setup < was_setup)
		axis->setup_over -= was_setup - axis->dir_setup;
	if (axis->hold_over == UINT64_MAX)
		return;
	if (now + SLACK < axis->level_over)
		axis->hold_over = axis->level_over + axis->dir_hold;
	else if (now + SLACK < axis->hold_over)
		axis->hold_over = now - SLACK + axis->dir_hold;
	else if (axis->hold_over + SLACK >= now && axis->dir_hold < was_hold)
		axis->hold_over -= was_hold - axis->dir_hold;
}

/* The level of STEP a few clocks from now, and its edges until then. */
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

/* The levels change with the polarity, which is no edge; the next step waits as after one. */
static void write_pins(
    struct judge *judge, unsigned c, unsigned a, uint32_t value, const struct passo_outputs *pins)
{
	unsigned edges = 0;
	struct axis *axis = &judge->channel[c].axis[a];
	const unsigned bit = c * axes_of(judge) + a;

	axis->step_inverted = (value >> PASSO_AXIS_PINS_STEP_INVERTED_LSB & 1u) != 0u;
	axis->direction_inverted = (value >> PASSO_AXIS_PINS_DIRECTION_INVERTED_LSB & 1u) != 0u;
	axis->enable_inverted = (value >> PASSO_AXIS_PINS_ENABLE_INVERTED_LSB & 1u) != 0u;
	axis->both_edges = (value >> PASSO_AXIS_PINS_BOTH_EDGES_LSB & 1u) != 0u;
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
	axis->level_over = judge->now - SLACK + level_time(axis);
	axis->hold_over = axis->level_over + axis->dir_hold;
	axis->setup_over = judge->now - SLACK + axis->dir_setup;
	see_enable(judge, c, a, (pins->enable >> bit & 1u) != 0u);
}

static void do_axis(
    struct judge *judge, unsigned c, unsigned place, uint32_t value, const struct passo_outputs *pins)
{
	const unsigned a = place / PASSO_CHANNEL_AXIS_STRIDE;
	struct axis *axis = &judge->channel[c].axis[a];

	switch (place % PASSO_CHANNEL_AXIS_STRIDE) {
	case PASSO_AXIS_PINS:
		gate(judge, c, true);
		write_pins(judge, c, a, value, pins);
		break;
	case PASSO_AXIS_STEP_TIMING:
		write_step_timing(axis, judge->now, value);
		break;
	case PASSO_AXIS_DIR_TIMING:
		write_dir_timing(axis, judge->now, value);
		break;
	default:
		axis->enabled = (value & 1u) != 0u;
		see_enable(judge, c, a, (pins->enable >> (c * axes_of(judge) + a) & 1u) != 0u);
		break;
	}
}

static void do_run(struct judge *judge, uint32_t value)
{
	judge->run = (uint8_t)value;
	for (unsigned c = 0; c < channels_of(judge); c++)
		if ((value >> c & 1u) != 0u) {
			may_move(&judge->channel[c], judge, false);
			judge->channel[c].fresh = false;
		}
}

static void do_write(struct judge *judge, const struct world_fact *fact, const struct passo_outputs *pins)
{
	const uint32_t address = fact->words[0], value = fact->words[1];
	const unsigned c = fact->channel, place = address & 0xFFu;

	if (address == PASSO_ADDRESS_RUN)
		do_run(judge, value);
	if (address >= PASSO_ADDRESS_COSINE_BASE)
		for (unsigned i = 0; i < channels_of(judge); i++)
			gate(judge, i, false);
	if (address < PASSO_ADDRESS_CHANNEL_BASE || address >= PASSO_ADDRESS_COSINE_BASE)
		return;
	if (place >= PASSO_CHANNEL_AXIS_BASE)
		do_axis(judge, c, place - PASSO_CHANNEL_AXIS_BASE, value, pins);
	else if (place == PASSO_CHANNEL_RATE_SLEW)
		judge->channel[c].rate_slew = value == 0u ? 1u : value;
	else if (place == PASSO_CHANNEL_COMMAND) {
		if ((value & 3u) == 0u && (value & 12u) != 0u)
			gate(judge, c, (value >> PASSO_CHANNEL_COMMAND_ZERO_LSB & 1u) != 0u);
		do_command(judge, c, value);
	}
}

static void do_line(struct judge *judge, const struct world_fact *fact)
{
	struct channel *channel = &judge->channel[fact->channel];

	may_move(channel, judge, true);
	channel->lines++;
	if ((fact->words[0] & 2u) != 0u)
		channel->exact = false;
	for (unsigned a = 0; a < axes_of(judge); a++) {
		const int64_t steps = fact->words[1u + a];

		channel->axis[a].owed += (fact->words[0] >> (8u + a) & 1u) != 0u ? -steps : steps;
	}
}

static void do_ramp(struct judge *judge, const struct world_fact *fact)
{
	struct channel *channel = &judge->channel[fact->channel];

	may_move(channel, judge, false);
	channel->ramps++;
	if ((fact->words[0] & 2u) == 0u) {
		channel->plain_ramps++;
		return;
	}
	if (channel->fresh)
		FAIL(
		    judge, "channel %u: a NOW ramp was accepted although there was no motion", fact->channel);
	channel->plain_ramps = 0;
}

static void see_quiet(struct judge *judge, unsigned c, uint32_t state, uint32_t room)
{
	const struct passo_parameters *parameters = &judge->world->model.parameters;
	struct channel *channel = &judge->channel[c];
	const uint32_t line_places = 1u << parameters->line_queue_log2;
	const uint32_t ramp_places = 1u << parameters->ramp_queue_log2;
	const bool no_lines = room >> 16 == line_places;
	const bool no_ramps = (room & 0xFFFFu) == ramp_places;

	judge->counts->quiets++;
	if ((no_lines || no_ramps || (judge->run >> c & 1u) == 0u) && !channel->silent) {
		channel->silent = "a state that said quiet";
		channel->silent_from = judge->now;
		channel->still = true;
	}
	if (no_ramps && no_lines) {
		channel->plain_ramps = 0;
		channel->ramps_known = true;
	} else if (channel->ramps_known && ramp_places - (room & 0xFFFFu) > channel->plain_ramps) {
		FAIL(judge, "channel %u: a NOW ramp stayed behind", c);
	}
	if ((state & 7u) != PASSO_STATE_IDLE || !no_lines)
		return;
	for (unsigned a = 0; a < axes_of(judge); a++) {
		struct axis *axis = &channel->axis[a];

		if (channel->exact && axis->position != axis->owed_from + axis->owed)
			FAIL(judge, "channel %u axis %u: %lld steps of lines were accepted, %lld were made",
			    c, a, (long long)axis->owed, (long long)(axis->position - axis->owed_from));
		axis->owed_from = axis->position;
		axis->owed = 0;
	}
	judge->counts->paths += channel->exact ? 1u : 0u;
	channel->exact = true;
	forget_stop(channel, judge);
}

static void do_state(struct judge *judge, const struct world_fact *fact)
{
	const uint32_t state = fact->words[0];
	const bool stopping = (state >> PASSO_CHANNEL_STATE_STOPPING_LSB & 1u) != 0u;
	struct channel *channel = &judge->channel[fact->channel];

	if ((state & 7u) == PASSO_STATE_STOPPED) {
		for (unsigned a = 0; a < axes_of(judge) && !channel->stopped; a++)
			channel->axis[a].budget = STEPS_AFTER_STOP;
		channel->stopped = true;
		channel->exact = false;
	}
	if (stopping && channel->last_rate != UINT32_MAX) {
		if (channel->last_rate > channel->slowed)
			FAIL(judge, "channel %u: RATE was %u and is %u after a stop was commanded",
			    fact->channel, channel->slowed, channel->last_rate);
		channel->slowed = channel->last_rate;
	} else {
		channel->slowed = UINT32_MAX;
	}
	channel->last_rate = stopping ? fact->words[1] : UINT32_MAX;
	if ((state >> PASSO_CHANNEL_STATE_QUIET_LSB & 1u) != 0u)
		see_quiet(judge, fact->channel, state, fact->words[2]);
}

static void do_position(struct judge *judge, const struct world_fact *fact)
{
	for (unsigned a = 0; a < axes_of(judge); a++) {
		const struct axis *axis = &judge->channel[fact->channel].axis[a];
		const int64_t position = (int32_t)fact->words[a];

		judge->counts->positions++;
		if (position < axis->lowest || position > axis->highest)
			FAIL(judge, "channel %u axis %u: position %lld after %lld steps", fact->channel, a,
			    (long long)position, (long long)axis->position);
	}
}

/* Refused, although the channel had said that it was quiet and nothing had been accepted since. */
static void do_busy(struct judge *judge, const struct world_fact *fact)
{
	const struct channel *channel = &judge->channel[fact->channel];

	if (channel->still && !channel->stopped && judge->now > channel->silent_from
	    && channels_of(judge) == 1u)
		FAIL(judge, "channel %u: %03x was refused as BUSY although it was quiet", fact->channel,
		    fact->words[0]);
}

/* While nothing can have left the queues their room is known. */
static void do_status(struct judge *judge, const struct world_fact *fact)
{
	const struct passo_parameters *parameters = &judge->world->model.parameters;
	const struct channel *channel = &judge->channel[fact->channel];
	const uint32_t lines = (1u << parameters->line_queue_log2) - channel->lines;
	const uint32_t ramps = (1u << parameters->ramp_queue_log2) - channel->ramps;

	if (channel->fresh && ((fact->words[0] >> 8 & 0xFFu) > lines || (fact->words[0] & 0xFFu) > ramps))
		FAIL(judge,
		    "channel %u: status says room for %u lines and %u ramps, there is room for %u and %u",
		    fact->channel, fact->words[0] >> 8 & 0xFFu, fact->words[0] & 0xFFu, lines, ramps);
}

static void do_reset(struct judge *judge)
{
	judge->counts->resets++;
	judge->run = 0;
	for (unsigned c = 0; c < channels_of(judge); c++) {
		struct channel *channel = &judge->channel[c];

		channel->silent = "a reset";
		channel->silent_from = judge->now + 1u;
		channel->still = false;
		channel->stopped = channel->exact = channel->ramps_known = false;
		channel->fresh = true;
		channel->lines = channel->ramps = 0;
		channel->plain_ramps = 0;
		channel->gated_until = 0;
		channel->rate_slew = PASSO_CHANNEL_RATE_SLEW_RESET;
		channel->slowed = channel->last_rate = UINT32_MAX;
		forget_stop(channel, judge);
		for (unsigned a = 0; a < axes_of(judge); a++) {
			struct axis *axis = &channel->axis[a];

			axis->enabled = false;
			axis->position = axis->lowest = axis->highest = 0;
			axis->owed = axis->owed_from = 0;
			axis->exact = false;
		}
	}
	judge->enable_unknown_until = judge->now + RESET_CLOCKS;
}

static void do_fact(struct judge *judge, const struct world_fact *fact, const struct passo_outputs *pins)
{
	switch (fact->kind) {
	case FACT_WRITE:
		do_write(judge, fact, pins);
		break;
	case FACT_LINE:
		do_line(judge, fact);
		break;
	case FACT_RAMP:
		do_ramp(judge, fact);
		break;
	case FACT_BUSY:
		do_busy(judge, fact);
		break;
	case FACT_STATE:
		do_state(judge, fact);
		break;
	case FACT_READS:
		for (unsigned a = 0; a < axes_of(judge); a++) {
			struct axis *axis = &judge->channel[fact->channel].axis[a];
			axis->lowest = axis->highest = axis->position;
		}
		break;
	case FACT_POSITION:
		do_position(judge, fact);
		break;
	case FACT_STATUS:
		do_status(judge, fact);
		break;
	case FACT_RESET:
		do_reset(judge);
		break;
	case FACT_RESET_DONE:
		break;
	}
}

static void power_up(struct judge *judge)
{
	const struct passo_parameters *parameters = &judge->world->model.parameters;

	for (unsigned c = 0; c < channels_of(judge); c++) {
		struct channel *channel = &judge->channel[c];

		for (unsigned a = 0; a < axes_of(judge); a++) {
			const unsigned bit = c * axes_of(judge) + a;

			channel->axis[a] = (struct axis){
			    .step_inverted = (parameters->step_reset >> bit & 1u) != 0u,
			    .direction_inverted = (parameters->dir_reset >> bit & 1u) != 0u,
			    .enable_inverted = (parameters->enable_reset >> bit & 1u) != 0u,
			    .step_high = PASSO_AXIS_STEP_TIMING_STEP_HIGH_RESET,
			    .step_low = PASSO_AXIS_STEP_TIMING_STEP_LOW_RESET,
			    .dir_setup = PASSO_AXIS_DIR_TIMING_DIR_SETUP_RESET,
			    .dir_hold = PASSO_AXIS_DIR_TIMING_DIR_HOLD_RESET,
			    .budget = UINT32_MAX,
			};
		}
	}
	do_reset(judge);
	judge->counts->resets--;
	judge->enable_unknown_until = 0;
}

/* Nearly sorted already; those of one clock keep their order. */
static void sort_facts(struct world *world)
{
	for (size_t i = 1; i < world->fact_count; i++) {
		const struct world_fact fact = world->facts[i];
		size_t at = i;

		for (; at != 0u && world->facts[at - 1u].clock > fact.clock; at--)
			world->facts[at] = world->facts[at - 1u];
		world->facts[at] = fact;
	}
}

/* What the pins did before a clock. */
static void see_rows(struct judge *judge, uint64_t clock)
{
	struct world *world = judge->world;

	while (judge->row < world->row_count && world->rows[judge->row].clock < clock && !world->failed_at) {
		judge->now = world->rows[judge->row].clock;
		see_pins(judge, &world->rows[judge->row++].pins);
	}
}

void judge_history(struct world *world, struct judge_counts *counts)
{
	struct judge judge = {.world = world, .counts = counts};

	sort_facts(world);
	power_up(&judge);
	for (size_t i = 0; i < world->fact_count && !world->failed_at; i++) {
		const struct world_fact *fact = &world->facts[i];

		see_rows(&judge, fact->clock);
		const bool same = judge.row < world->row_count && world->rows[judge.row].clock == fact->clock;
		judge.now = fact->clock;
		if (!world->failed_at)
			do_fact(&judge, fact, same ? &world->rows[judge.row].pins : &judge.pins);
	}
	see_rows(&judge, UINT64_MAX);
}
