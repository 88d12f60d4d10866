/* SPDX-License-Identifier: MIT
 * Internal: arguments of the console commands.
 *
 * A command prints "ok" with its output, or an error. It returns true if the end of line is still to be
 * printed.
 */
#ifndef PASSO_CALL_H
#define PASSO_CALL_H

#include "passo_console.h"

#define PASSO_COUNT(table) (sizeof(table) / sizeof(table)[0])

/* Values of all commands except `move`. */
struct passo_values {
	uint8_t axis;
	uint32_t number; /* percent, row */
	uint16_t points[PASSO_POINTS_PER_LINE];
	bool on;
	uint32_t steps_per_turn;
	uint64_t rpm, top_rpm, minimum_rpm, acceleration;
	uint32_t clock_hz, baud, hold_microseconds, stop_microseconds;
	bool flow_waits, need_enable;
	struct passo_axis_config config;
	/* inputs, home, probe, jog */
	struct passo_console_inputs inputs;
	uint8_t probe, source, edge, action; /* PASSO_READ_LEVEL, _SOURCE, ... */
	bool clear, backward, away, optional;
	uint32_t filter_microseconds, watchdog_microseconds, disable_microseconds, timeout_microseconds;
	int32_t steps[PASSO_AXES_MAX];
	int32_t distance, position;
	uint32_t back_off, pull_off;
	uint64_t speed, slow_speed, top_speed;
#ifndef PASSO_WITHOUT_PARTS
	/* outputs */
	bool output_given;              /* of a move */
	uint32_t levels, pitch;         /* steps, then substeps */
	uint64_t power, pwm, reference; /* UQ32.32 %, Hz, substeps per clock */
	uint64_t lag, width;            /* clocks */
	int32_t interval;
	struct passo_raster_values raster;
	/* encoders */
	struct passo_console_encoder encoder;
	uint32_t filter, counts_per_turn;
	uint64_t turns; /* UQ32.32 */
	bool wait_index, endless;
#endif
#ifndef PASSO_WITHOUT_TRACKERS
	struct passo_console_tracker tracker;
#endif
};

/* Arguments of a command. */
struct passo_call {
	struct passo_console *console;
	struct passo_console_channel *channel; /* which the line names */
	struct passo_reading *reading;
	struct passo_words *words;
	struct passo_values *values;
};

/* Rows of a key table, for a value and for an integer. */
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

/* Prints "ok", or the error. Returns whether there was none. */
bool passo_answer(const struct passo_call *call, enum passo_error error);
/* Finds axes that are not enabled. If enabled drives are required, prints an error and returns false. */
bool passo_check_enabled(const struct passo_call *call, uint8_t axes, uint8_t *off);
/* Notes once for each axis that it moves without its drive. */
void passo_note_disabled(const struct passo_call *call, uint8_t off);
/* Prints the axes of a mask after a text, or none. */
void passo_say_axes(const struct passo_sink *sink, const char *text, uint8_t axes);
/* Prints input levels, the stop cause, and the homed axes. */
void passo_say_inputs(const struct passo_call *call, const struct passo_readings *now);
/* Prints the positions latched by a trigger. */
void passo_say_trigger(
    const struct passo_sink *sink, const struct passo *passo, const struct passo_trigger_report *report);
/* Converts Q31.32 to thousandths, rounded to nearest. */
int64_t passo_thousandths(int64_t value);

/* Moves and rotation: passo_move_commands.c. Control and readings: passo_motion_commands.c. Settings:
 * passo_settings_commands.c. `open`, and `clear`, which can apply deferred ones: passo_opening.c. Inputs:
 * passo_input_commands.c. Homing, probing, jogging: passo_task_commands.c. Outputs: passo_output_commands.c,
 * those of a move: passo_move_outputs.c. Encoders and threads: passo_encoder_commands.c. Trackers:
 * passo_track_commands.c. */
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
bool passo_run_start(const struct passo_call *call);
bool passo_run_sync(const struct passo_call *call);
bool passo_run_config(const struct passo_call *call);
bool passo_run_table(const struct passo_call *call);
bool passo_run_open(const struct passo_call *call);
bool passo_run_input(const struct passo_call *call);
bool passo_run_inputs(const struct passo_call *call);
bool passo_run_trigger(const struct passo_call *call);
bool passo_run_wait_trigger(const struct passo_call *call);
bool passo_run_home(const struct passo_call *call);
bool passo_run_probe(const struct passo_call *call);
bool passo_run_jog(const struct passo_call *call);
bool passo_run_goto(const struct passo_call *call);
bool passo_run_jog_speed(const struct passo_call *call);
bool passo_run_jog_cancel(const struct passo_call *call);
#ifndef PASSO_WITHOUT_PARTS
bool passo_run_output(const struct passo_call *call);
bool passo_run_outputs(const struct passo_call *call);
bool passo_run_compare(const struct passo_call *call);
bool passo_run_encoder(const struct passo_call *call);
bool passo_run_encoders(const struct passo_call *call);
bool passo_run_adopt(const struct passo_call *call);
bool passo_run_thread(const struct passo_call *call);
#endif
#ifndef PASSO_WITHOUT_TRACKERS
bool passo_run_tracker(const struct passo_call *call);
bool passo_run_track(const struct passo_call *call);
bool passo_run_untrack(const struct passo_call *call);
#endif
#ifdef PASSO_BOTH
bool passo_run_grbl(const struct passo_call *call);
#endif
bool passo_run_version(const struct passo_call *call);
bool passo_run_help(const struct passo_call *call);
#ifndef PASSO_WITHOUT_PARTS
/* Takes the keys of outputs from the words of a move. */
bool passo_output_read(const struct passo_call *call);
/* Prints an error and returns false if the raster has more values than the move takes. */
bool passo_output_fits(const struct passo_call *call, const struct passo_form_move *move);
/* Queues a move with its outputs. */
enum passo_error passo_output_queue(const struct passo_call *call, const struct passo_form_move *move);
/* Prints these keys. */
void passo_output_help(const struct passo_sink *sink);
#else
static inline bool passo_output_read(const struct passo_call *call)
{
	(void)call;
	return true;
}
static inline bool passo_output_fits(const struct passo_call *call, const struct passo_form_move *move)
{
	(void)call;
	(void)move;
	return true;
}
static inline enum passo_error passo_output_queue(
    const struct passo_call *call, const struct passo_form_move *move)
{
	return passo_forms_queue(&call->channel->passo, move);
}
static inline void passo_output_help(const struct passo_sink *sink)
{
	(void)sink;
}
#endif
/* Prints the keys of `config`. */
void passo_config_help(const struct passo_sink *sink);

#endif
