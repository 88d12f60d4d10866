/* SPDX-License-Identifier: MIT
 * Internal: state of the judge.
 */
#ifndef SOAK_JUDGE_STATE_H
#define SOAK_JUDGE_STATE_H

#include "address.h"
#include "judge_machine.h"

/* Uncertainty in clocks of the time at which a write takes effect. */
#define SLACK 3u
/* Clocks by which a timing takes effect later than other settings; no running time ends meanwhile. */
#define TIMING_CLOCKS 2u
/* Shortest time from the start of a motion to `running` and to its first step: nothing may run within it
 * after a frame that requires rest. DIR may change a few clocks earlier, with the first line. */
#define GATE_CLOCKS 32u
/* Steps that may still leave an axis after its channel has stopped: four queued, two in flight. */
#define STEPS_AFTER_STOP 6u
/* The shortest of the last GAPS gaps gives the rate: one can be longer, between two lines or motions. */
#define GAPS 3u

struct axis {
	bool step_inverted, direction_inverted, enable_inverted, both_edges, enabled;
	uint64_t step_high, step_low, dir_setup, dir_hold;
	bool active, down;
	bool exact;          /* the present pulse must have exactly its minimum length */
	uint64_t written_at; /* when a timing was written */
	uint64_t settled_at; /* when the pins have followed a change of polarity */
	uint64_t level_over; /* when STEP may change */
	uint64_t setup_over, hold_over;
	int64_t position, lowest, highest; /* extremes since the start of a read */
	int64_t owed, owed_from;           /* steps of the accepted lines, and the position they start from */
	unsigned budget;                   /* steps that may still come */
	uint64_t steps[GAPS + 1u];         /* clocks of the last steps, latest first; 0: none */
	uint64_t gap_least;
};

struct channel {
	struct axis axis[PASSO_AXES_MAX];
	uint64_t silent_from; /* no step after this clock, if `silent` */
	const char *silent;   /* the reason, or NULL */
	bool still;           /* no change of DIR either */
	uint64_t gated_until; /* nothing may run or move before this clock */
	bool gated_pins;
	bool exact; /* every accepted line must be executed */
	bool stopped, stops;
	uint32_t rate_slew;
	/* RATE read during a stop; UINT32_MAX: none. Valid when the next state still shows `stopping`. */
	uint32_t slowed, last_rate;
	uint16_t plain_ramps;
	bool ramps_known;
	bool fresh; /* nothing has left the queues */
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
	size_t row; /* first row not processed yet */
	size_t fact;
	struct machine machine;
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

/* Minimum time of the present STEP level. */
static inline uint64_t judge_level_time(const struct axis *axis)
{
	return axis->active ? axis->step_high : axis->step_low;
}

/* Checks new pin levels, and the level of one EN pin. */
void judge_pins(struct judge *judge, const struct passo_outputs *pins);
void judge_enable(struct judge *judge, unsigned c, unsigned a, bool level);

/* Notes that something was accepted that may lead to steps. */
void judge_may_move(struct channel *channel, const struct judge *judge, bool new_motion);
/* Lifts the limit on gaps after a stop. */
void judge_forget_stop(struct channel *channel, const struct judge *judge);

/* Notes that the channel must not run, or with `pins` not even move a pin, while a word is executed and
 * shortly after. */
void judge_gate(struct judge *judge, unsigned c, bool pins);
/* A write to a register of an axis; `place` is its offset in the axis. */
void judge_write_axis(
    struct judge *judge, unsigned c, unsigned place, uint32_t value, const struct passo_outputs *pins);

/* Facts: accepted words ... */
void judge_write(struct judge *judge, const struct world_fact *fact, const struct passo_outputs *pins);
void judge_line(struct judge *judge, const struct world_fact *fact);
void judge_ramp(struct judge *judge, const struct world_fact *fact);
/* ... and replies. */
void judge_state(struct judge *judge, const struct world_fact *fact);
void judge_reads(struct judge *judge, const struct world_fact *fact);
void judge_position(struct judge *judge, const struct world_fact *fact);
void judge_busy(struct judge *judge, const struct world_fact *fact);
void judge_status(struct judge *judge, const struct world_fact *fact);

/* A machine: settings ... */
void judge_machine_power_up(struct judge *judge);
void judge_machine_reset(struct judge *judge, bool done);
void judge_machine_line(struct judge *judge, const struct world_fact *fact);
void judge_machine_write(struct judge *judge, uint32_t address, uint32_t value);
void judge_machine_command(struct judge *judge, struct passo_channel_command command);
void judge_machine_enable(struct judge *judge, unsigned a);
/* ... its inputs; the pin `input` of an axis has changed, or its polarity ... */
void judge_pin(struct judge *judge, const struct world_fact *fact);
void judge_see_levels(struct judge *judge, unsigned input, unsigned a, bool inverted);
bool judge_may(const struct level *level, uint64_t from, uint64_t until);
bool judge_must(const struct level *level, uint64_t clock);
uint64_t judge_next_change(const struct judge *judge, unsigned input, unsigned a);
/* ... whether they are known: not after a reset, a change of polarity or filter, until they have been stable
 * ... */
void judge_forget(struct judge *judge);
void judge_changes(struct judge *judge, unsigned input, unsigned a);
void judge_begins(struct judge *judge);
void judge_reset_inputs(struct judge *judge, bool done);
void judge_flags(struct judge *judge, const struct world_fact *fact);
/* ... its stops; before and after the pins of a row are judged ... */
void judge_add_event(
    struct judge *judge, enum passo_cause cause, bool hard, uint64_t earliest, uint64_t latest);
void judge_clear_events(struct judge *judge);
void judge_machine_before(struct judge *judge, const struct passo_outputs *pins);
void judge_machine_after(struct judge *judge, const struct passo_outputs *pins);
void judge_machine_step(struct judge *judge, unsigned a);
void judge_machine_state(struct judge *judge, struct passo_channel_state now, uint32_t rate);
bool judge_enabled(struct judge *judge, unsigned a, bool *unsure);
void judge_feed(struct judge *judge, const struct world_fact *fact);
void judge_silence(struct judge *judge);
/* ... its trigger ... */
void judge_arm(struct judge *judge, uint32_t value);
void judge_rearm(struct judge *judge);
void judge_latch(struct judge *judge);
void judge_trigger_state(struct judge *judge, const struct world_fact *fact);
void judge_latched(struct judge *judge, const struct world_fact *fact);
/* ... and its encoders. */
void judge_turn(struct judge *judge, unsigned input, unsigned a);
void judge_turns(struct judge *judge);
void judge_counts_read(struct judge *judge, const struct world_fact *fact);
void judge_follow(struct judge *judge, unsigned a);
void judge_exceeding(struct judge *judge);
void judge_write_encoder(struct judge *judge, unsigned a, unsigned place, uint32_t value);
void judge_zero_encoders(struct judge *judge);

#endif
