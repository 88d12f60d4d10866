/* SPDX-License-Identifier: MIT
 * What the path planner remembers: of each line and of the whole path. Included by passo_path.h; all members
 * are private.
 */
#ifndef PASSO_PATH_STATE_H
#define PASSO_PATH_STATE_H

#include "passo_motors.h"
#include "passo_plan.h"

/* An image without room has linear ramps only. */
#ifdef PASSO_LINEAR_PATHS
#define PASSO_WITHOUT_JERK_PATHS
#endif

/* The halves of a line, each with the curvature of the corner at its end. */
#ifdef PASSO_WITHOUT_ROUNDING
#define PASSO_PATH_HALVES 1u
#else
#define PASSO_PATH_HALVES 2u
#endif

/* Motors of a path, or axes and motors that move two of them, at most; an image for fewer saves RAM. */
#ifndef PASSO_PATH_AXES_MAX
#define PASSO_PATH_AXES_MAX PASSO_AXES_MAX
#endif

/* Ramps in a row that are limited together, at most. */
#define PASSO_PATH_PACED 8u

/* Profile jerk: how the path comes down from the start of a line to that of a later one, private. */
struct passo_path_descent {
	uint64_t slope, jerk; /* lowest of the lines between */
	uint64_t length;      /* UQ32.32 substeps */
	uint64_t lowest;      /* UQ0.48 substeps per clock: what the corners from here on allow */
	uint32_t anchor;      /* number of the later line */
};

/* What limits the slope in a curve, private; see passo_path_curve.c. 26 bits and an exponent of 6. */
struct passo_path_curve {
	uint32_t slope[PASSO_PATH_AXES_MAX]; /* of the square, where it is 0 */
	/* of each half, or of the whole line: */
	uint32_t bend[PASSO_PATH_HALVES]
		     [PASSO_PATH_AXES_MAX]; /* UQ16.48 per substep: the square takes of it */
	uint8_t helps[PASSO_PATH_HALVES];   /* bit i set: on the way up */
	uint8_t hinders[PASSO_PATH_HALVES]; /* on the way down */
	bool halved;                        /* each half has its own */
	bool strong;                        /* and is passed in steps, as it leaves less and less */
	uint32_t
	    fall; /* of a line that is not: change of the square from its start down to 0, by its curve */
	uint32_t loss; /* UQ0.32: what a square at its end takes of that; no packed number */
};

#ifndef PASSO_WITHOUT_ROUNDING
/* Of the acceleration of an axis at a lone corner, UQ1.7. */
struct passo_path_share {
	uint8_t lost;   /* what it has before and behind the corner, in all, the way that it turns */
	uint8_t needed; /* what the rounding needs at the square `bend` */
};

#define PASSO_PATH_SHARES 2u

/* The start of a line is a corner; or it goes straight on, and a corner behind it, or before it, is rounded
 * to beyond it: it has `bend` and `turn` of that. */
enum passo_path_point { PASSO_PATH_CORNER, PASSO_PATH_BEFORE, PASSO_PATH_BEHIND };
#endif

/* A line of the path, private. Squares are those of velocities, UQ0.64 (substeps per clock)^2. */
struct passo_path_item {
	uint32_t feed;   /* velocity, UQ0.32 */
	uint32_t limit;  /* highest velocity within the line, by its axes */
	uint64_t bend;   /* highest square at the corner at its start, by its geometry */
	uint64_t top;    /* highest square within the line */
	uint64_t corner; /* highest square at its start */
	uint64_t reach;  /* highest square at its start from which the path can come to rest */
	uint64_t slope;  /* change of the square per substep at full acceleration */
	uint32_t halt;   /* highest velocity at its end, if the path rests there */
	uint32_t substeps;
	uint32_t dwell; /* ticks of rest before the line */
	uint32_t output;
	uint32_t steps[PASSO_PATH_AXES_MAX]; /* of the motors */
	struct passo_path_curve curve;
	uint8_t directions; /* bit i set: motor i counts down */
	bool rest;          /* the path rests before the line */
	bool last;          /* the motion ends with the line */
	uint8_t arc;        /* the corner at its start is a part of an arc with half the line before (bit 0),
	                       and with half of this one (bit 1) */
	bool rapid;         /* its feed is PASSO_PATH_RAPID */
#ifndef PASSO_WITHOUT_ROUNDING
	uint8_t begun
	    : 2; /* halves, bit by bit, with the curvature of the corner at the start of their straight */
	uint8_t point : 2; /* enum passo_path_point */
	bool whole : 1;    /* the corner is lone, and its rounding may span several lines */
	uint16_t away;     /* of a point: 65,536ths of `turn` that are between it and the corner */
	uint32_t turn;     /* substeps on either side over which a lone corner at its start may be rounded */
	/* of a path that falls, or rises: of the axis with most of both there, and of that which lost most */
	struct passo_path_share lone[2][PASSO_PATH_SHARES];
	bool valley; /* it has that where the path comes down to the corner and speeds up behind it */
#endif
#ifndef PASSO_LINEAR_PATHS
	uint8_t eased; /* in a curve: quarters of the slope that are for the way across */
#endif
#ifndef PASSO_WITHOUT_JERK_PATHS
	uint8_t over;  /* profile jerk: 256ths of the slope that a ramp over the corner at its start lacks */
	uint64_t jerk; /* profile jerk: change of the velocity by the square of the time that it takes at
	                  least, UQ0.80 substeps per clock^3 */
	struct passo_path_descent descent;
#endif
};

/* The limits of an axis in substeps and clocks. */
struct passo_path_scale {
	uint64_t acceleration; /* UQ0.64 substeps per clock^2 */
	uint64_t jerk;         /* UQ0.80 substeps per clock^3 */
	uint32_t speed;        /* UQ0.32 substeps per clock */
	uint32_t jump;         /* the same */
};

/* Where a line begins, private: what the next one is measured from. */
struct passo_path_place {
	int64_t target[PASSO_PATH_AXES_MAX];    /* Q31.32 mm */
	int64_t steps[PASSO_PATH_AXES_MAX];     /* of the motors */
	int32_t direction[PASSO_PATH_AXES_MAX]; /* unit vector of the last line, in rows, Q1.30 */
	struct passo_path_curve curve;          /* of the last line, by the corner at its start */
	uint64_t length;                        /* of the last line, UQ32.16 substeps */
#ifndef PASSO_LINEAR_PATHS
	uint64_t slope, jerk; /* of the last line, by the corner at its start */
	uint8_t eased;        /* the same */
#endif
#ifndef PASSO_WITHOUT_JERK_PATHS
	int32_t half_turn[PASSO_PATH_AXES_MAX]; /* of the change of direction at that corner, Q1.30 */
	uint64_t turn, over;                    /* its size, and in which length it turns, UQ.30 substeps */
	bool bends;                             /* the last line is part of the curve */
#endif
#ifndef PASSO_WITHOUT_ROUNDING
	uint64_t bend;  /* the highest square at that corner */
	uint64_t ahead; /* how far before it the rounding begins, UQ32.16 substeps */
	bool lone;      /* no line beside it is part of a curve */
	/* The straight that the last line ends, of lines of several feeds, and the corner that it begins
	 * with. */
	uint64_t straight;                 /* its length, UQ32.16 substeps */
	uint32_t first;                    /* the item that it begins with */
	bool cornered;                     /* it begins with a corner, before which there is: */
	int32_t came[PASSO_PATH_AXES_MAX]; /* this unit vector */
	uint64_t came_straight, came_last; /* a straight, and the line at its end */
	uint64_t arc;                      /* what the corner can have of either */
#endif
	int32_t carry;        /* Q16: substeps that rounding has withheld from the lines so far */
	uint32_t line_credit; /* clocks that the last lines have left, see passo_path_pace.c */
};

/* By how much a line is off those that it replaces, at most, of which both bounds hold. */
struct passo_path_merged {
	uint64_t off;    /* UQ32.16 substeps */
	uint64_t bulge;  /* UQ.46 per substep: this times the distances to both of its ends */
	uint64_t longer; /* than the last of them, UQ32.16 substeps */
#ifndef PASSO_WITHOUT_ROUNDING
	/* Unit vectors of lines from its start that pass all omitted ends within the tolerance, by axes,
	 * Q1.30; unless none is omitted. */
	int32_t low[PASSO_PATH_AXES_MAX], high[PASSO_PATH_AXES_MAX];
	bool narrowed;
#endif
};

/* All members are private. Items are counted from 0 and never wrap within a motion. */
struct passo_path_planner {
	struct passo_machine machine;
	struct passo_path_item *items;
	uint32_t capacity;
	uint32_t sent, planned, added; /* items handed out as lines; passed by the ramps; known */
	uint32_t final;                /* what is before the start of this item cannot become faster */
				       /* geometry of the last line */
#ifndef PASSO_CARTESIAN
	struct passo_motors motors;
	uint8_t rows; /* axes, and motors that move two */
#endif
	uint64_t steps_per_mm[PASSO_PATH_AXES_MAX];        /* of the motors */
	struct passo_path_scale axis[PASSO_PATH_AXES_MAX]; /* of the rows */
	uint64_t acceleration;                             /* UQ0.64 substeps per clock^2, along the path */
	struct passo_path_place at, before;                /* its end and its start */
	uint64_t deviation, tolerance;                     /* UQ32.16 substeps */
	uint64_t own_tolerance;                            /* the same: that of the settings */
	struct passo_path_merged merged; /* by how much the last line is off those that it replaces */
	uint64_t feed;                   /* of the last line, as it was given */
	uint32_t wanted;                 /* the same, UQ0.32 */
	bool begins;                     /* the path rested before the last line */
	bool open; /* the last line may still become a longer one: no ramp relies on it */
	uint32_t substeps_per_mm;
	uint32_t dwell; /* ticks before the next line */
	bool rest;      /* before the next line */
	/* where the ramps end */
	int64_t offset;    /* Q31.32 substeps into item `planned` */
	uint64_t velocity; /* UQ0.48 substeps per clock */
#ifndef PASSO_WITHOUT_ROUNDING
	uint64_t passing;    /* the square at which they pass the start of item `planned` */
	uint64_t rounded;    /* the corner before a straight is rounded for this length of it; */
	uint32_t rounded_at; /* this item begins it */
	uint32_t point[2];   /* of the items within the rounding of a corner the first and the last one; */
	uint32_t pointed;    /* it is that at the start of this item */
	uint32_t bent;       /* what is before this item is as it was when `reach` was found */
#endif
	bool at_rest;
	bool started;    /* the dwell before the item is over */
	bool jump, last; /* a ramp to 0 in no time is due; it ends the motion */
	bool lines_end, ramps_end;
	bool anew;           /* the limits of all items have changed */
	bool waits;          /* for a further line, to make the next ramp */
	uint32_t unsettled;  /* it waits until this item is settled */
	uint32_t override;   /* UQ16.16 */
	uint32_t rapid;      /* the same, of rapids */
	uint32_t reserve;    /* ticks */
	uint32_t gentleness; /* UQ0.16: what a shape leaves of the acceleration */
	/* the pace */
	uint32_t polls;
	bool unrounded;
	uint32_t pace, paced;                  /* least ticks of a number of ramps */
	uint32_t recent[PASSO_PATH_PACED - 1]; /* ticks of the last ramps */
	uint32_t line_clocks, line_burst;      /* of a line, at least; how many may be in advance */
	enum passo_shape shape;
	bool soft; /* profile jerk */
};

#endif
