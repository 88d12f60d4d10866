/* SPDX-License-Identifier: MIT
 * Timed points: where all axes are at given times. Each interval between two points becomes one line at
 * constant speed, which begins and ends on its clock, so that nothing adds up over any number of points.
 *
 *     passo_timed_open(&timed, &settings, positions);
 *     while (passo_timed_add(&timed, &points[i], &line) == PASSO_TIMED_OK) // for the core, i = 0, 1, ...
 *             ...
 *     passo_timed_end(&timed); // the last point is at rest
 * All lines run under one velocity, PASSO_TIMED_VELOCITY: a substep takes two clocks. See passo_follow.h of
 * the driver, which checks all points before anything moves.
 *
 * No heap, no floating point. Pointers must not be null.
 */
#ifndef PASSO_TIMED_H
#define PASSO_TIMED_H

#include "passo_path.h"

/* Of the ramps, UQ0.48 substeps per clock, and its clocks per substep. */
#define PASSO_TIMED_VELOCITY PASSO_VELOCITY_MAX
#define PASSO_TIMED_GRAIN 2u

/* Speeds of a point: of each axis, then of each motor that moves two. */
#define PASSO_TIMED_ROWS (2u * PASSO_AXES_MAX)

enum passo_timed_error {
	PASSO_TIMED_OK = 0,
	PASSO_TIMED_ORDER, /* its time is not above that of the point before, from which 0 is the start */
	PASSO_TIMED_LONG,  /* 2^31 clocks or more after the point before */
	PASSO_TIMED_FAR,   /* out of range, or more than 2^31 steps from position 0 */
	PASSO_TIMED_SPEED, /* an axis would be faster than its speed */
	PASSO_TIMED_ACCELERATION, /* the speed of an axis would change by more than it can at this point */
	PASSO_TIMED_STEPS,        /* a motor would step more than once in two clocks */
	PASSO_TIMED_PINS,         /* a motor would step faster than its pin timing allows */
	PASSO_TIMED_SETTINGS,     /* axes, clock or motors are none that a path can have */
	PASSO_TIMED_NO_POINTS     /* there is none */
};

struct passo_timed_point {
	uint64_t clocks;                /* from the start of the motion; rounded up to an even number */
	int64_t target[PASSO_AXES_MAX]; /* Q31.32 mm, absolute; steps are rounded from it */
};

/* Members are private, except `axis`. */
struct passo_timed {
	const struct passo_path_settings *settings;
	uint64_t clocks;                 /* of the last point */
	uint64_t interval;               /* before it, clocks */
	int64_t target[PASSO_AXES_MAX];  /* of the last point */
	int32_t steps[PASSO_AXES_MAX];   /* of the motors */
	int64_t speed[PASSO_TIMED_ROWS]; /* before it, Q31.32 mm/s */
	uint8_t axis;                    /* after an error: the axis, or the motor, behind the axes */
};

/* Begins at rest, at these positions of the motors, in steps. The speeds, accelerations, jumps and scales of
 * the axes, the motors, the clock and the junction deviation are those of a path, and must stay valid. Error:
 * SETTINGS. */
enum passo_timed_error passo_timed_open(
    struct passo_timed *timed, const struct passo_path_settings *settings, const int32_t *positions);

/* The line to the next point. An error leaves all as it was.
 *
 * The speed of an axis changes at a point from that of one interval to that of the next. The change must not
 * exceed `jump`, or else neither what its acceleration makes in half the time of both intervals, nor the
 * speed sqrt(8 a d) at which rounding the corner within the junction deviation d takes no more than that
 * acceleration a: points of a smooth curve pass if they are close enough. */
enum passo_timed_error passo_timed_add(
    struct passo_timed *timed, const struct passo_timed_point *point, struct passo_line *line);

/* Whether the axes can come to rest at the last point. Errors: ACCELERATION; NO_POINTS. */
enum passo_timed_error passo_timed_end(struct passo_timed *timed);

/* The time of a point, rounded. */
static inline uint64_t passo_timed_clocks(const struct passo_timed_point *point)
{
	return point->clocks + point->clocks % PASSO_TIMED_GRAIN;
}

/* Motors of these settings: one for each axis, or more. */
uint32_t passo_timed_motors(const struct passo_path_settings *settings);

/* Description of an error, for any value. Never null. */
const char *passo_timed_error_text(enum passo_timed_error error);

#endif
