/* SPDX-License-Identifier: MIT
 * The path planner: converts a path of many lines into lines and ramps, in integer arithmetic. See
 * docs/path.md.
 *
 *     static struct passo_path_item items[48];
 *     static struct passo_path_planner path;
 *
 *     passo_path_open(&path, &settings, items, 48);
 *     passo_path_add(&path, &move);            // again with the same move after PATH_FULL
 *     passo_path_end(&path);                   // no further lines for now
 *     passo_path_next_line(&path, &line);      // for the core's queues, whenever they have free entries
 *     passo_path_next_ramp(&path, held, &ramp);
 *
 * At every moment the ramps handed out, and those still available, bring the path to rest within the known
 * lines. A path that is not continued ends there as a motion, and the next motion starts there.
 *
 * No heap, no floating point; the same results on every machine. The work of a call is bounded by the number
 * of items. Pointers must not be null.
 */
#ifndef PASSO_PATH_H
#define PASSO_PATH_H

#include "passo_motors.h"
#include "passo_path_state.h"
#include "passo_plan.h"

/* Minimum look-ahead, in lines. */
#define PASSO_PATH_ITEMS_MIN 4u

/* Feed of a line that is limited only by its axes. */
#define PASSO_PATH_RAPID UINT64_MAX

/* Largest magnitude of a target, Q31.32 mm. */
#define PASSO_PATH_TARGET_MAX (INT64_C(1) << 62)

/* Limits of an axis, UQ32.32. Rotary axes: degrees instead of millimeters. */
struct passo_path_axis {
	uint64_t steps_per_mm;
	uint64_t speed;        /* mm/s */
	uint64_t acceleration; /* mm/s^2 */
	uint64_t jerk;         /* mm/s^3, for profile jerk */
	uint64_t jump; /* start-stop speed, mm/s, and largest instantaneous change; 0: the axis starts and
	                  stops at rest, and corners are limited only by the other rules */
};

struct passo_path_settings {
	struct passo_machine machine;
	struct passo_path_axis axis[PASSO_AXES_MAX];
#ifndef PASSO_CARTESIAN
	struct passo_motors motors;   /* machine.axes counts the axes, not the motors */
	struct passo_path_axis mixed; /* limits of each motor that moves two axes, 0: the larger one of these;
	                                 steps_per_mm is not used: both have that of the motor */
#endif
	uint64_t acceleration;       /* UQ32.32 mm/s^2 along the path; 0: only those of the axes */
	uint64_t junction_deviation; /* UQ32.32 mm; 0: rest at every corner */
	uint64_t tolerance;          /* UQ32.32 mm, see passo_path_tolerance(); 0: a twentieth of the junction
	                                deviation */
	enum passo_profile profile;  /* linear, cosine, sigmoid or jerk */
	uint32_t reserve_clocks;     /* minimum time buffered in the core until the path ends; 0: 20 ms */
	uint32_t polls; /* minimum polls of the feed per second: the path is never faster than they can send
	                   its lines and ramps; 200 or more, 0: 500 */
	bool unrounded; /* no constant speed around single corners, as in an image without that code */
};

/* A straight line from the end of the previous one. */
struct passo_path_move {
	int64_t target[PASSO_AXES_MAX]; /* Q31.32 mm, absolute; steps are rounded from it */
	uint64_t feed;                  /* UQ32.32 mm/s along the path, or PASSO_PATH_RAPID */
	uint32_t output;                /* of the line; see passo_output_word() of the driver */
};

/* Starts a path at position 0 of all axes. `items` holds `capacity` lines, at least
 * PASSO_PATH_ITEMS_MIN: the look-ahead. Errors: BAD_CLOCK, BAD_AXES (also too many motors, or a map of them
 * that has no inverse), BAD_PROFILE, NO_SCALE, NO_AXIS_SPEED,
 * NO_AXIS_ACCELERATION, NO_JERK, TOO_FAST, PATH_FULL (capacity too small). */
enum passo_plan_error passo_path_open(struct passo_path_planner *path,
    const struct passo_path_settings *settings, struct passo_path_item *items, uint32_t capacity);

/* Drops all known lines and starts a new path at these positions of the motors, in steps: after a stop, or
 * homing. */
void passo_path_restart(struct passo_path_planner *path, const int32_t *positions);

/* After a stop: continues the rest of the path from these positions of the motors, in steps, which must be on
 * one of the lines still in memory, those added last; the first match from number `done` on (counted from 0)
 * is used. Each motor makes its missing steps. False: the positions are on none of them, and nothing has
 * changed. */
bool passo_path_recover(struct passo_path_planner *path, const int32_t *positions, uint32_t done);

/* Ramps of a frame, or in the core's queue while it is prepared, if that is fewer; lines in the queue then,
 * and lines per frame: so that the path is not faster than it can be sent. passo_path_feed_open() sets it;
 * the default is that of a core with default parameters. */
void passo_path_pace(
    struct passo_path_planner *path, uint32_t queued, uint32_t lines_queued, uint32_t lines_sent);

/* Largest deviation of a line from the ends of the short, nearly collinear lines that it replaces: lines with
 * the same feed and output that take less time than sending them. The ends of the line itself are exact.
 * Applies to lines added from now on; 0: that of the settings. */
#define PASSO_PATH_UNMERGED UINT64_MAX /* lines are never merged */
void passo_path_tolerance(struct passo_path_planner *path, uint64_t tolerance);

/* Adds a line. A line shorter than half a substep is added to the next one. Errors: PATH_FULL (take ramps
 * and lines, then add it again), NO_FEED, TOO_FAR (target out of range), TOO_LONG (2^30 substeps or more). */
enum passo_plan_error passo_path_add(struct passo_path_planner *path, const struct passo_path_move *move);

/* The path comes to rest at the end of the last line and stays there for `clocks` clocks, in whole ticks,
 * before the next line starts; 0: an exact stop. */
void passo_path_dwell(struct passo_path_planner *path, uint64_t clocks);

/* No line follows for now: the motion ends with the last line. Lines added later belong to the next one. */
void passo_path_end(struct passo_path_planner *path);

/* Feed override, UQ16.16, 100 % or more, of all lines that no ramp has passed yet. The limits of axes and
 * corners still apply. Lower overrides are those of the core. */
#define PASSO_PATH_OVERRIDE_MIN UINT32_C(0x10000)
#define PASSO_PATH_OVERRIDE_MAX UINT32_C(0xA0000)
void passo_path_override(struct passo_path_planner *path, uint32_t override);

/* Override of lines with PASSO_PATH_RAPID, which passo_path_override() does not change: UQ16.16, 1 .. 100 %,
 * of the speed that the axes allow. */
#define PASSO_PATH_RAPID_FULL UINT32_C(0x10000)
void passo_path_rapid(struct passo_path_planner *path, uint32_t rapid);

/* The next line and ramp of the motion; false: none available. The last ones have `last`; then
 * passo_path_next_motion() continues with the next motion, if more lines are known. `held` is a lower bound
 * of the ticks that the core holds in ramps handed out before, or UINT32_MAX before the motion has started:
 * while it is above the reserve, the planner waits for more lines instead of decelerating for the last known
 * one. */
bool passo_path_next_line(struct passo_path_planner *path, struct passo_line *line);
bool passo_path_next_ramp(struct passo_path_planner *path, uint32_t held, struct passo_ramp *ramp);

/* After the last line and ramp of a motion: continues with the next one. False: they have not been handed out
 * yet. */
bool passo_path_next_motion(struct passo_path_planner *path);

/* True if every known line has been handed out and passed by the ramps: nothing is left of the path. */
bool passo_path_is_empty(const struct passo_path_planner *path);

/* Conversions for the settings of the outputs (passo_outputs.h): a speed, UQ32.32 mm/s, in UQ0.32 substeps
 * per clock, rounded down, and a length, UQ32.32 mm, in substeps, to nearest; both saturate. */
uint32_t passo_path_velocity(const struct passo_path_planner *path, uint64_t speed);
uint32_t passo_path_substeps(const struct passo_path_planner *path, uint64_t length);

/* Its motors, and the places of a motor and of an axis (the sum of its motors, to be divided by *parts): see
 * passo_motors.h. An image without room has a motor for each axis, PASSO_CARTESIAN. */
static inline uint32_t passo_path_motors(const struct passo_path_planner *path)
{
#ifndef PASSO_CARTESIAN
	if (path->motors.count > 0)
		return path->motors.count;
#endif
	return path->machine.axes;
}

/* See passo_path_motors(). */
static inline int64_t passo_path_motor_place(
    const struct passo_path_planner *path, uint32_t motor, const int64_t *axes)
{
#ifdef PASSO_CARTESIAN
	(void)path;
	return axes[motor];
#else
	return passo_motor_place(&path->motors, motor, axes);
#endif
}

/* See passo_path_motors(). */
static inline int64_t passo_path_axis_place(
    const struct passo_path_planner *path, uint32_t axis, const int32_t *places, uint32_t *parts)
{
#ifdef PASSO_CARTESIAN
	(void)path, (void)parts;
	return places[axis];
#else
	return passo_axis_place(&path->motors, axis, places, parts);
#endif
}

/* An acceleration, UQ32.32 mm/s^2, or the lowest one of the motors that move two axes, along the direction
 * between them. */
#ifdef PASSO_CARTESIAN
#define passo_path_mixed_acceleration(path, acceleration) (acceleration)
#else
uint64_t passo_path_mixed_acceleration(const struct passo_path_planner *path, uint64_t acceleration);
#endif

/* The limits of a motor: those of its axis; or, in *mixed, of one that moves two of them: along the direction
 * between them, 1 mm of which is sqrt(2) mm of the motor. */
#ifdef PASSO_CARTESIAN
static inline const struct passo_path_axis *passo_path_motor_limits(
    const struct passo_path_settings *settings, uint32_t motor, struct passo_path_axis *mixed)
{
	(void)mixed;
	return &settings->axis[motor];
}
#else
const struct passo_path_axis *passo_path_motor_limits(
    const struct passo_path_settings *settings, uint32_t motor, struct passo_path_axis *mixed);
#endif

/* Free entries: lines that can be added. */
uint32_t passo_path_room(const struct passo_path_planner *path);

#endif
