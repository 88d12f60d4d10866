/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the protocol.
 */
#ifndef PASSO_GRBL_PRIVATE_H
#define PASSO_GRBL_PRIVATE_H

#include "passo_grbl.h"
#ifndef PASSO_WITHOUT_TRACKERS
#include "passo_track.h"
#endif

void passo_grbl_say(struct passo_grbl *grbl, const char *text);
void passo_grbl_say_number(struct passo_grbl *grbl, uint64_t number);
/* Millionths, with three decimals. */
void passo_grbl_say_thousandths(struct passo_grbl *grbl, int64_t millionths);
/* In report units: lengths in nanometers. */
void passo_grbl_say_length(struct passo_grbl *grbl, int64_t nanometres);
/* After `head`: X, Y and Z on every machine, 0 for an axis that it lacks, then its other axes. */
void passo_grbl_say_position(struct passo_grbl *grbl, const char *head, const int64_t *position);
void passo_grbl_say_rate(struct passo_grbl *grbl, uint64_t rate); /* mm/min, UQ48.16 */
void passo_grbl_report(struct passo_grbl *grbl);
void passo_grbl_report_modes(struct passo_grbl *grbl);
void passo_grbl_report_offsets(struct passo_grbl *grbl);
void passo_grbl_report_probe(struct passo_grbl *grbl);
void passo_grbl_report_tools(struct passo_grbl *grbl);
void passo_grbl_report_settings(struct passo_grbl *grbl);
void passo_grbl_report_starts(struct passo_grbl *grbl);
void passo_grbl_report_build(struct passo_grbl *grbl);
void passo_grbl_answer(struct passo_grbl *grbl, enum passo_gcode_error error);
void passo_grbl_greet(struct passo_grbl *grbl);

enum passo_grbl_state passo_grbl_state(const struct passo_grbl *grbl);

/* Overrides are 100 % from here on. */
void passo_grbl_end_overrides(struct passo_grbl *grbl);
/* A reset, after the requests are processed. Ends the overrides. */
void passo_grbl_ask_reset(struct passo_grbl *grbl);
/* Processes the real-time requests. */
void passo_grbl_obey(struct passo_grbl *grbl);
/* Bytes that the ring can take. */
uint8_t passo_grbl_room(const struct passo_grbl *grbl);
/* The next byte of the lines; false: none. */
bool passo_grbl_next(struct passo_grbl *grbl, char *byte);
/* When the buffer is empty: number of lines lost with their ends. */
unsigned passo_grbl_lost(struct passo_grbl *grbl);
/* All that has come in. */
void passo_grbl_drop_input(struct passo_grbl *grbl);
/* Jogs received before a jog cancel are dropped. */
void passo_grbl_drop_jogs(struct passo_grbl *grbl);

/* Its motors, and the bits of those that are named after an axis. */
static inline unsigned passo_grbl_motors(const struct passo_grbl *grbl)
{
#ifndef PASSO_CARTESIAN
	if (grbl->path.motors.count > 0)
		return grbl->path.motors.count;
#endif
	return grbl->path.machine.axes;
}

static inline struct passo_grbl_counts passo_grbl_counts(const struct passo_grbl *grbl)
{
	return (struct passo_grbl_counts){.axes = grbl->setup->path.machine.axes,
#ifndef PASSO_CARTESIAN
	    .offsets = grbl->setup->squared != 0 ? grbl->setup->path.motors.count : 0
#endif
	};
}

#ifndef PASSO_CARTESIAN
static inline bool passo_grbl_has_encoder(const struct passo_grbl *grbl, unsigned motor)
{
	return grbl->setup->encoders && grbl->setup->encoders[2u * motor] > 0;
}

/* At rest: following errors are 0. Error: RATIO. */
enum passo_error passo_grbl_apply_encoders(struct passo_grbl *grbl);
#endif

/* The axis that a motor is named after. */
static inline unsigned passo_grbl_axis_of(const struct passo_grbl *grbl, unsigned motor)
{
#ifndef PASSO_CARTESIAN
	if (motor >= grbl->path.machine.axes)
		return passo_motor_axis(&grbl->path.motors, motor);
#endif
	(void)grbl;
	return motor;
}

static inline unsigned passo_grbl_motors_of(const struct passo_grbl *grbl, unsigned axis)
{
#ifdef PASSO_CARTESIAN
	(void)grbl;
	return 1u << axis;
#else
	return passo_motors_of(&grbl->path.motors, grbl->path.machine.axes, axis);
#endif
}

/* Reports an alarm, answers the current line, and stops. */
void passo_grbl_fail(struct passo_grbl *grbl, enum passo_grbl_alarm alarm);
/* The same with the alarm of an error of the driver. */
void passo_grbl_fault(struct passo_grbl *grbl, enum passo_error error);
void passo_grbl_begin_stop(struct passo_grbl *grbl);
/* At rest: the program continues from the current position. Returns whether something was printed. */
bool passo_grbl_end_stop(struct passo_grbl *grbl);
/* It comes to rest. */
bool passo_grbl_slows(const struct passo_grbl *grbl);
/* Applies the overrides of feed, rapids and spindle. */
void passo_grbl_override(struct passo_grbl *grbl);
/* Applies the rate of the core. */
void passo_grbl_mind_rate(struct passo_grbl *grbl);
/* Enables or disables the drives; at rest. */
enum passo_error passo_grbl_drive(struct passo_grbl *grbl, bool on);
/* Disables idle drives after the time in the settings. */
void passo_grbl_mind_drives(struct passo_grbl *grbl);

#ifndef PASSO_WITHOUT_TRACKERS
/* What the tracker of an axis, and of all its motors, takes up. */
struct passo_track passo_grbl_track(const struct passo_grbl *grbl, uint8_t axis);
/* The highest speed of that, steps/s, UQ32.32: a way of its backlash takes at most twice the time at it. */
uint64_t passo_grbl_take_up_speed(const struct passo_track *track);
#endif

/* Applies the settings to path, interpreter, pins and inputs. At rest; the path restarts, and `stopping` is
 * set while trackers take up another backlash. Errors: TOO_FAST, PULSE_TOO_SHORT, STATEMENT, NOT_IDLE
 * (rejected by the core); the previous settings must then be applied again. */
enum passo_gcode_error passo_grbl_apply(struct passo_grbl *grbl);
/* Loads the stored settings, or the defaults. Error: STORAGE. */
enum passo_gcode_error passo_grbl_load(struct passo_grbl *grbl);
/* Error: STORAGE. */
enum passo_gcode_error passo_grbl_save(struct passo_grbl *grbl);
/* `$n=` and `$Nx=`: the text after the `$`. */
enum passo_gcode_error passo_grbl_change(struct passo_grbl *grbl, const char *text);
/* `$RST=`: the letter. */
enum passo_gcode_error passo_grbl_restore(struct passo_grbl *grbl, const char *text);

/* `$H`; passo_grbl_poll_home() answers it at its end. */
enum passo_gcode_error passo_grbl_home(struct passo_grbl *grbl);
void passo_grbl_poll_home(struct passo_grbl *grbl);

#ifndef PASSO_PLAIN_GCODE
/* Keeps the message of the line, until the motion before it has ended. */
void passo_grbl_take_message(struct passo_grbl *grbl);
/* Says them then. */
void passo_grbl_poll_message(struct passo_grbl *grbl);
/* What M66 has read. */
void passo_grbl_report_input(struct passo_grbl *grbl);
/* M6, at rest. */
void passo_grbl_begin_change(struct passo_grbl *grbl);
/* Lines that are received from now on are taken before those of the program. */
void passo_grbl_admit(struct passo_grbl *grbl);
/* The lines of the program follow; or a reset drops all. */
void passo_grbl_end_change(struct passo_grbl *grbl);
/* `$TLR`: lengths are relative to the last probed position. Error: TOOL_LENGTH_UNKNOWN, there is none. */
enum passo_gcode_error passo_grbl_set_reference(struct passo_grbl *grbl);
/* `$TPW`: probes the tool at the present position; passo_grbl_poll_touch() answers it at its end. */
enum passo_gcode_error passo_grbl_touch(struct passo_grbl *grbl);
void passo_grbl_poll_touch(struct passo_grbl *grbl);
#else
static inline void passo_grbl_take_message(struct passo_grbl *grbl)
{
	(void)grbl;
}

static inline void passo_grbl_poll_message(struct passo_grbl *grbl)
{
	(void)grbl;
}

static inline void passo_grbl_poll_touch(struct passo_grbl *grbl)
{
	(void)grbl;
}
#endif

/* A line that begins with `$`. */
enum passo_gcode_error passo_grbl_system(
    struct passo_grbl *grbl, enum passo_grbl_kind kind, const char *text);

#endif
