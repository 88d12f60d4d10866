/* SPDX-License-Identifier: MIT
 * What a command of the console is given, for the sources that have one.
 *
 * It says "ok" with what it has to tell, or complains, and returns whether the end of the line is still to be
 * said.
 */
#ifndef PASSO_CALL_H
#define PASSO_CALL_H

#include "passo_console.h"

#define PASSO_COUNT(table) (sizeof(table) / sizeof(table)[0])

/* The values of all commands but `move`. */
struct passo_values {
	uint8_t axis;
	uint32_t number; /* percent, row */
	uint16_t points[PASSO_POINTS_PER_LINE];
	bool on;
	uint32_t steps_per_turn;
	uint64_t rpm, top_rpm, minimum_rpm, acceleration;
	uint32_t clock_hz, baud, hold_microseconds, stop_microseconds;
	struct passo_axis_config config;
};

/* What a command works with. */
struct passo_call {
	struct passo_console *console;
	struct passo_reading *reading;
	struct passo_words *words;
	struct passo_values *values;
};

/* Rows of a table of keys, for a value and for a whole number. */
#define PASSO_VALUE(text, member, read, default_text)                                                        \
	{.name = (text),                                                                                     \
	    .reader = PASSO_READ_##read,                                                                     \
	    .otherwise = (default_text),                                                                     \
	    .offset = offsetof(struct passo_values, member)}
#define PASSO_WHOLE(text, member, lowest, highest, default_text)                                             \
	{.name = (text),                                                                                     \
	    .reader = PASSO_READ_WHOLE,                                                                      \
	    .otherwise = (default_text),                                                                     \
	    .low = (lowest),                                                                                 \
	    .high = (highest),                                                                               \
	    .offset = offsetof(struct passo_values, member)}

/* "ok", or the complaint. */
bool passo_answer(const struct passo_call *call, enum passo_error error);
/* In thousandths, to the nearest; `value` has 32 binary places. */
int64_t passo_thousandths(int64_t value);

/* Motion and reading: passo_motion_commands.c. Settings, and the clear that may have to give them to the
 * core: passo_settings_commands.c. */
bool passo_run_move(const struct passo_call *call);
bool passo_run_turn(const struct passo_call *call);
bool passo_run_rpm(const struct passo_call *call);
bool passo_run_hold(const struct passo_call *call);
bool passo_run_resume(const struct passo_call *call);
bool passo_run_override(const struct passo_call *call);
bool passo_run_stop(const struct passo_call *call);
bool passo_run_abort(const struct passo_call *call);
bool passo_run_clear(const struct passo_call *call);
bool passo_run_status(const struct passo_call *call);
bool passo_run_position(const struct passo_call *call);
bool passo_run_angle(const struct passo_call *call);
bool passo_run_enable(const struct passo_call *call);
bool passo_run_disable(const struct passo_call *call);
bool passo_run_zero(const struct passo_call *call);
bool passo_run_sync(const struct passo_call *call);
bool passo_run_config(const struct passo_call *call);
bool passo_run_table(const struct passo_call *call);
bool passo_run_open(const struct passo_call *call);
bool passo_run_version(const struct passo_call *call);
/* Print the keys of `config`. */
void passo_config_help(const struct passo_sink *sink);

#endif
