/* SPDX-License-Identifier: MIT
 * Drilling cycles, G73 G81 G82 G83 G85 G86 G89: each hole is a few strokes.
 */
#ifndef PASSO_GCODE_CYCLE_H
#define PASSO_GCODE_CYCLE_H

#include "passo_gcode_arc.h"

/* The words that a cycle keeps while it is in force. */
struct passo_gcode_drill {
	int64_t bottom, level, peck; /* Z, R and Q as given, nm; in G91 from R, and from `initial` */
	int64_t initial;             /* before the first of a row of cycles, machine coordinate */
	uint64_t microseconds;       /* P: dwell at the bottom */
};

struct passo_gcode_cycle {
	passo_gcode_command kind; /* G73 .. G89 */
	uint8_t step;             /* of the hole, 0: begins */
	uint8_t axis;             /* that drills */
	struct passo_gcode_plane plane;
	uint32_t holes;                      /* left, this one included */
	int64_t bottom, level, clear;        /* of the drilling axis, machine coordinates, nm */
	int64_t peck, depth;                 /* depth: reached, or to be reached next */
	struct passo_gcode_vector hole;      /* its place in the plane */
	struct passo_gcode_vector increment; /* to the next hole */
	uint64_t microseconds;               /* at the bottom */
	int64_t at[PASSO_GCODE_AXES_MAX];    /* end of the last stroke */
};

enum passo_gcode_stroke {
	PASSO_GCODE_STROKE_NONE, /* the last hole is done */
	PASSO_GCODE_STROKE_RAPID,
	PASSO_GCODE_STROKE_RAPID_STOPPED, /* with the spindle stopped */
	PASSO_GCODE_STROKE_FEED,
	PASSO_GCODE_STROKE_DWELL
};

/* The next stroke, to `at`; those that would not move are left out. */
enum passo_gcode_stroke passo_gcode_cycle_next(struct passo_gcode_cycle *cycle);

#endif
