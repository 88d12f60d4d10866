/* SPDX-License-Identifier: MIT
 * What the pins of a motion promise (docs/architecture.md), checked on the recorded pins without knowledge of
 * the core: pulse timing, directions, and the curve of the plan.
 */
#ifndef PASSO_PULSES_H
#define PASSO_PULSES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_command.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of a row, one for each clock in which a pin changes: its number (64 bits, little-endian), STEP and
 * DIR with a bit per axis, and `running`. All pins are low before the first row. */
enum { PASSO_PULSES_ROW = 11 };

/* Clocks of a pulse that does not end. */
#define PASSO_PULSE_ENDLESS INT64_MAX

/* Kinds of faults; `step` and `value` of each. */
enum passo_pulse_kind {
	PASSO_PULSE_HIGH,  /* not step_high clocks: the step; the clocks, PASSO_PULSE_ENDLESS of the last one
	                    */
	PASSO_PULSE_LOW,   /* below step_low: the step after; the clocks */
	PASSO_PULSE_SETUP, /* DIR changes too late: the step; clocks before it */
	PASSO_PULSE_HOLD,  /* DIR changes too early: clock since the start; clocks after the low time */
	PASSO_PULSE_DIRECTION, /* wrong: the step; the direction it has */
	PASSO_PULSE_TURNS,     /* of DIR: before which step; how many, and in `off` how many it needs */
	PASSO_PULSE_EARLY, /* these of each plan: the step; clock since the start; substeps off the curve */
	PASSO_PULSE_LATE,
	PASSO_PULSE_KINDS
};

struct passo_pulse_fault {
	bool found;
	int64_t step, value;
	double off; /* substeps from the curve */
};

/* Clocks; see struct passo_axis_config. */
struct passo_pulse_pins {
	int64_t step_high, step_low, dir_setup, dir_hold;
};

struct passo_pulse_plan {
	int64_t clocks; /* of its profile */
	int64_t substeps;
	int32_t steps[PASSO_AXES_MAX];
	bool oversampled;             /* each step of the leading axis takes several substeps */
	double tolerance;             /* substeps by which rounding may move a step */
	size_t points;                /* of the curve: clocks since the start of the plan, rising, ... */
	const double *times, *places; /* ... and substeps due by then */
};

/* The steps of an axis: clock since the start and direction of each, for which there is room for half of the
 * rows, rounded up. Returns their number. */
size_t passo_pulses_steps(
    const uint8_t *rows, size_t count, uint64_t start, unsigned axis, int64_t *clocks, int8_t *directions);

/* Checks `axes` axes; `faults` has room for the first fault of each kind, those of the curve for each plan:
 * PASSO_PULSE_EARLY + 2 * `plans` for each axis. `start`: clock at which the motion started. Returns whether
 * there is a fault. */
bool passo_pulses_judge(const uint8_t *rows, size_t count, uint64_t start,
    const struct passo_pulse_pins *pins, const struct passo_pulse_plan *plan, size_t plans, unsigned axes,
    struct passo_pulse_fault *faults);

#ifdef __cplusplus
}
#endif

#endif
