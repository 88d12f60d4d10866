/* SPDX-License-Identifier: MIT
 * An arc or helix as arc segments: each deviates from the arc by at most the tolerance, each corner is within
 * 1 nm of it, and the last one is the target exactly.
 */
#ifndef PASSO_GCODE_ARC_H
#define PASSO_GCODE_ARC_H

#include "passo_gcode_angle.h"
#include "passo_gcode_block.h"

/* Largest magnitude of a coordinate, in nanometers. */
#define PASSO_GCODE_COORDINATE_MAX (INT64_C(1000000000) * PASSO_GCODE_MILLION)

/* Plane of an arc: counterclockwise is from `first` to `second`, seen from the third axis. */
struct passo_gcode_plane {
	uint8_t first, second;
};

struct passo_gcode_arc {
	struct passo_gcode_plane plane;
	bool clockwise;
	uint8_t axes;
	uint32_t chords, done;
	uint64_t sweep;  /* fraction of a turn, UQ1.63: up to 1 */
	uint64_t length; /* nm, with the motion of the other axes */
	uint64_t radius;
	struct passo_gcode_vector radial, center; /* radial: from the center to the start; nm */
	int64_t start[PASSO_GCODE_AXES_MAX], target[PASSO_GCODE_AXES_MAX];
};

/* Converts a radius (negative: the longer arc) to the offset of the center from the start. Errors: TARGET
 * (the same point), RADIUS. */
enum passo_gcode_error passo_gcode_arc_center(
    struct passo_gcode_vector chord, int64_t radius, bool clockwise, struct passo_gcode_vector *offset);

/* Prepares the segments of an arc whose plane, clockwise, axes, start and target are set. Start and end in
 * the same direction give a full circle. `tolerance` is in nm, at least 1. Error: TARGET if the target and
 * the start differ in their distance from the center (0.5 mm or 0.1 %, but 0.005 mm are always allowed). */
enum passo_gcode_error passo_gcode_arc_begin(
    struct passo_gcode_arc *arc, struct passo_gcode_vector offset, uint64_t tolerance);

/* The next corner; false after the target. */
bool passo_gcode_arc_next(struct passo_gcode_arc *arc, int64_t *corner);

#endif
