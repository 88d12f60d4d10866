/* SPDX-License-Identifier: MIT
 * Trackers of a core that was built with them: a second hand on every axis, beside the path or without one.
 *
 * The steps of a tracker add to those of the path: the axis is at the sum. Positions of the driver are those
 * of the path alone. A stop of any cause, passo_zero() and passo_open() end all trackers; each continues with
 * its next target. See docs/machine.md. Every call can also return NO_TRACKERS and the errors common to the
 * calls of passo.h.
 */
#ifndef PASSO_DRIVER_TRACK_H
#define PASSO_DRIVER_TRACK_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

struct passo_track {
	uint8_t axis;
	uint16_t backlash;     /* steps that the axis goes back further where its path turns down; else 0 */
	uint64_t top_speed;    /* UQ32.32 steps/s, below a step per PASSO_TRACKER_TICK(axes) clocks */
	uint64_t acceleration; /* UQ32.32 steps/s^2, at most top_speed in a tick */
};

/* Sets the limits of a tracker, rounded down to 2^-32 steps per tick (per tick). At rest or stopped. A frame.
 * Errors: TRACKER_LIMITS, MOVING. */
enum passo_error passo_configure_tracker(struct passo *passo, const struct passo_track *track);
/* Sends it to a target, in steps of its own since passo_zero(), or from its home, at any time. Four frames.
 */
enum passo_error passo_track_to(struct passo *passo, const struct passo_track *track, int32_t target);
/* Slows it down; it rests until its next target. Two frames. */
enum passo_error passo_untrack(struct passo *passo, uint8_t axis);
/* At rest, as after passo_clear(): trackers that a stop has ended follow their targets again. Until all are
 * there, passo_is_moving(); then passo_poll() has read the exact positions, so call this before the next
 * motion. A tracker that would step toward an active limit goes to the target of the other direction, and
 * keeps that until a motion that moves the axis has ended. Homing and probing do the same after each of their
 * stops. A frame if there is nothing to do; else at most six, and two for each axis at a limit. */
enum passo_error passo_track_again(struct passo *passo);

struct passo_track_reading {
	int32_t position; /* steps of the tracker; after a hard stop up to 7 of them were not made */
	bool enabled;     /* it follows its target */
	bool moves;
	bool at_target; /* since the last tick: ask 256 clocks after passo_track_to() */
};
/* Two frames. */
enum passo_error passo_read_tracker(struct passo *passo, uint8_t axis, struct passo_track_reading *reading);

/* Targets along an axis, as of a leadscrew whose errors are known. */
struct passo_track_table {
	const int16_t *targets; /* steps, at points that are `pitch` steps apart */
	uint16_t points;
	int32_t begin;  /* position of the first one */
	uint32_t pitch; /* steps, above 0 */
};
/* The target where the path is at `position`: on the straight line between two points, to the nearest step,
 * halves up; before the first and behind the last point that of the point; without points 0. No frame. */
int32_t passo_track_at(const struct passo_track_table *table, int32_t position);

#ifdef __cplusplus
}
#endif

#endif
