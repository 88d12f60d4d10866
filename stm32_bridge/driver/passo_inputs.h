/* SPDX-License-Identifier: MIT
 * Inputs of a core that was built with them: limits, home switches, alarms, probe, triggers, e-stop,
 * watchdog.
 *
 * See docs/machine.md, also for recovery after each stop. Every call can also return NO_INPUTS and the errors
 * common to the calls of passo.h.
 */
#ifndef PASSO_INPUTS_H
#define PASSO_INPUTS_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------- settings ---- */

/* The inputs of an axis. Inputs that are not fitted must be tied to their inactive level. */
struct passo_input_config {
	/* fitted switches: homing and triggers on others return NO_SWITCH */
	bool limit_low, limit_high, home;
	/* active low */
	bool limit_low_inverted, limit_high_inverted, home_inverted, alarm_inverted;
	bool limit_soft;     /* limits soft-stop, in the time of passo_configure_motion(); else hard stop */
	bool alarm_soft;     /* the same for the alarm */
	bool alarm_disables; /* the alarm also disables the drive of this axis */
};

/* Sets the inputs of an axis, after passo_open(). One frame, two more to check for rest. Error:
 * MOVING. */
enum passo_error passo_configure_inputs(
    struct passo *passo, uint8_t axis, const struct passo_input_config *config);
/* Sets the probe of the channel. The same frames and error. */
enum passo_error passo_configure_probe(struct passo *passo, bool inverted);
/* Sets the glitch filter of all inputs of the core except e-stop, in clocks, PASSO_US(20). Shorter changes
 * are ignored. Error: FILTER_TOO_LONG above 65535. */
enum passo_error passo_configure_filter(struct passo *passo, uint64_t clocks);
/* Longest time of the watchdog. */
#define PASSO_WATCHDOG_CLOCKS_MAX (UINT64_C(1023) << 16)
/* Sets the watchdog of the core: a running motion is soft-stopped, cause WATCHDOG, if no frame arrives for
 * stop_clocks; all drives are disabled disable_clocks later, 0: never. 0 and 0: off. Both are
 * rounded up to 65536 clocks. Errors: WATCHDOG_TOO_LONG above 1023 of these; ARGUMENT for a disable time
 * alone. */
enum passo_error passo_configure_watchdog(struct passo *passo, uint64_t stop_clocks, uint64_t disable_clocks);

/* ---------------------------------------------------------------------------------------- readings ---- */

/* Levels, 1 = active, bit i is axis i, and sticky flags (was_...) since passo_clear_flags(). */
struct passo_readings {
	uint8_t limit_low, limit_high, home, alarm;
	uint8_t was_limit_low, was_limit_high, was_home, was_alarm;
	bool probe, was_probe;
	bool estop;   /* pressed, or not cleared since */
	uint8_t axes; /* those of the first limit or alarm since passo_clear() */
	bool unknown; /* the levels are not known yet; no motion starts */
};
/* Three frames. */
enum passo_error passo_read_inputs(struct passo *passo, struct passo_readings *readings);
/* Two frames. */
enum passo_error passo_clear_flags(struct passo *passo);
/* Clears the e-stop of the core after it is released; the channels stay stopped until passo_clear(), the
 * drives off until passo_enable(). Two frames. Error: ESTOP while it is pressed. */
enum passo_error passo_clear_estop(struct passo *passo);

/* ---------------------------------------------------------------------------------------- triggers ---- */

struct passo_trigger_config {
	enum passo_trigger_source source;
	enum passo_trigger_action action;
	uint8_t axis; /* of the source; not of a probe */
	bool falling; /* fires when the source becomes inactive instead of active */
};
struct passo_trigger_report {
	bool arming; /* waits until its source is stable for longer than the filter */
	bool armed, fired;
	/* of all axes at the edge, as passo_positions() counts them, if no tracker has moved since */
	int32_t positions[PASSO_AXES_MAX];
};

/* Longest wait of a motion or trigger for stable inputs; then INPUTS_UNKNOWN. */
#define PASSO_INPUTS_MICROSECONDS 100000u

/* Arms the trigger of the channel, one-shot; it replaces an earlier one. It is armed when its source has been
 * stable for longer than the filter; until then no motion starts. If the source already has the level, it
 * waits for the next edge. Its stops are reported as TRIGGER by passo_poll(). Errors: NO_SOURCE,
 * NO_SWITCH, UNDER_WAY. */
enum passo_error passo_arm_trigger(struct passo *passo, const struct passo_trigger_config *config);
/* Error: UNDER_WAY. */
enum passo_error passo_disarm_trigger(struct passo *passo);
/* One frame, two if it has fired, three with trackers. */
enum passo_error passo_read_trigger(struct passo *passo, struct passo_trigger_report *report);
/* Polls until the trigger has fired, at most for a time in clocks; 0: no timeout. Errors: TIMEOUT; NO_SOURCE
 * if none is armed; those of passo_poll(), but not TRIGGER. */
enum passo_error passo_wait_for_trigger(
    struct passo *passo, uint64_t timeout_clocks, struct passo_trigger_report *report);

#ifdef __cplusplus
}
#endif

#endif
