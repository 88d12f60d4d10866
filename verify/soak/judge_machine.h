/* SPDX-License-Identifier: MIT
 * Internal: what the judge knows of a machine: its inputs, trigger, encoders, outputs, and the events that
 * must stop the channel. One channel.
 */
#ifndef SOAK_JUDGE_MACHINE_H
#define SOAK_JUDGE_MACHINE_H

#include "judge.h"
#include "passo_words.h"

#define NEVER UINT64_MAX
#define KINDS ((unsigned)PASSO_INPUT_COUNT)
#define EVENTS_MAX 64u
#define TURNS_MAX 64u
#define LEVELS_MAX 64u

/* A filtered level: from when and until when it may, and must, be active. */
struct level {
	uint64_t may_from, may_until, must_from, must_until;
	bool was, may_have_been; /* for the flags */
};

/* Something that stops the channel, between two clocks; `latest` NEVER: perhaps. */
struct stop_event {
	enum passo_cause cause;
	bool hard;
	uint64_t earliest, latest;
};

/* A line of an encoder that changes at a clock, behind the filter. */
struct turn {
	uint64_t clock;
	bool is_b;
};

struct shaft {
	bool a, b, unsure;
	struct turn turns[TURNS_MAX];
	unsigned turn_count;
	int64_t count, lowest, highest;
	bool judged; /* its following error is */
	bool near;   /* the error is about at its limit */
	int64_t offset;
	uint64_t exceeded_from;
};

/* Whether a level has lasted for a period of the filter, and since when it lasts. */
struct calm {
	bool known;
	uint64_t from;
};

struct trigger {
	bool armed, unsure, latched;
	uint64_t armed_at, fires_at;
	struct calm calm; /* its source, since it was written */
	unsigned input, axis;
	enum passo_trigger_action action;
	int64_t position[PASSO_AXES_MAX];
};

struct machine {
	uint8_t pins[KINDS], inverted[KINDS];
	struct level levels[KINDS][PASSO_AXES_MAX];
	uint8_t limit_soft, alarm_soft, alarm_disables, enable_unsure;
	uint8_t closed_low, closed_high; /* limits that are active as the motion begins */
	struct calm calm;                /* all inputs, since polarity or filter changed */
	uint64_t forgot_at;
	uint64_t changed_at[KINDS][PASSO_AXES_MAX];
	uint8_t line_low, line_high; /* ways of the last line */
	uint32_t filter, encoder_filter, stop_slew;
	bool pressed, unsettled;
	uint64_t released_at;
	uint32_t watchdog;
	uint64_t fed_from, fed_until;
	bool starved, starved_moving; /* the watchdog may have bitten; the channel moved then */
	bool silent;                  /* it has */
	struct stop_event events[EVENTS_MAX];
	unsigned event_count;
	uint64_t stopped_at, ran_from, rested_at;
	bool full_rate, held;
	uint64_t held_from;
	struct trigger trigger;
	struct shaft shafts[PASSO_AXES_MAX];
	bool compares;
	unsigned compare_axis;
	uint32_t compare_width;
	int64_t compare_distance, compare_interval;
	uint64_t compare_until, compare_unsure;
	uint8_t words[LEVELS_MAX];
	unsigned word_count, word;
};

#endif
