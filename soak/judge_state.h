/* SPDX-License-Identifier: MIT
 * What the judge keeps in mind, for its sources.
 */
#ifndef SOAK_JUDGE_STATE_H
#define SOAK_JUDGE_STATE_H

#include "address.h"
#include "judge.h"
#include "passo_words.h"

/* Clocks by which what the host knows of the time of a write may be wrong. */
#define SLACK 3u
/* Shortest time from the beginning of a motion to `running` and to its first step: nothing may run so soon
 * after a frame that is only executed while nothing does. DIR follows the motion's first line a few clocks
 * earlier. */
#define GATE_CLOCKS 32u
/* Steps that may still leave an axis after its channel has stopped: four wait, two are on their way. */
#define STEPS_AFTER_STOP 6u
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

#define FAIL(judge, ...) world_fail((judge)->world, (judge)->now, __VA_ARGS__)

static inline uint64_t judge_later(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

static inline unsigned judge_axes(const struct judge *judge)
{
	return judge->world->model.parameters.axes;
}

static inline unsigned judge_channels(const struct judge *judge)
{
	return judge->world->model.parameters.channels;
}

/* Shortest time at the present level of STEP. */
static inline uint64_t judge_level_time(const struct axis *axis)
{
	return axis->active ? axis->step_high : axis->step_low;
}

/* The pins from now on, and one of EN. */
void judge_pins(struct judge *judge, const struct passo_outputs *pins);
void judge_enable(struct judge *judge, unsigned c, unsigned a, bool level);

/* Something was accepted that may lead to steps. */
void judge_may_move(struct channel *channel, const struct judge *judge, bool new_motion);
/* Gaps may be as short again as they like. */
void judge_forget_stop(struct channel *channel, const struct judge *judge);

/* Nothing of this channel may run, or even move, while the word is executed and a little later. */
void judge_gate(struct judge *judge, unsigned c, bool pins);
/* A word of an axis, whose registers begin at place 0. */
void judge_write_axis(
    struct judge *judge, unsigned c, unsigned place, uint32_t value, const struct passo_outputs *pins);

/* Facts: what was accepted ... */
void judge_write(struct judge *judge, const struct world_fact *fact, const struct passo_outputs *pins);
void judge_line(struct judge *judge, const struct world_fact *fact);
void judge_ramp(struct judge *judge, const struct world_fact *fact);
/* ... and what was replied. */
void judge_state(struct judge *judge, const struct world_fact *fact);
void judge_reads(struct judge *judge, const struct world_fact *fact);
void judge_position(struct judge *judge, const struct world_fact *fact);
void judge_busy(struct judge *judge, const struct world_fact *fact);
void judge_status(struct judge *judge, const struct world_fact *fact);

#endif
