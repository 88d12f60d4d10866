/* SPDX-License-Identifier: MIT
 * Internal: slopes of ramps, in moves by speed.
 */
#ifndef PASSO_PLAN_SLOPE_H
#define PASSO_PLAN_SLOPE_H

#include <stdbool.h>
#include "passo_math.h"
#include "passo_plan_draft.h"

/* Longest ramp from rest to the full speed. Keeps the sums in passo_plan_slope.c below 2^128. */
#define PASSO_SLOPE_CLOCKS_MAX (UINT64_C(1) << 62)

/* The speed changes by `speed` (UQ32.32 steps/s) in `clocks`. With a jerk limit, the acceleration takes up to
 * `ease` clocks to build up, and again to fall, which makes the ramp longer. */
struct passo_slope {
	uint64_t clocks, speed, ease, jerk;
};

/* Whether its acceleration has to build up: never in an image whose moves are linear, for the flash of a
 * small controller. */
static inline bool passo_slope_is_eased(const struct passo_slope *slope)
{
#ifdef PASSO_LINEAR_MOVES
	(void)slope;
	return false;
#else
	return slope->ease != 0u;
#endif
}

/* An instantaneous change of speed. */
static const struct passo_slope PASSO_VERTICAL = {0, 1, 0, 0};

/* Clocks of a change of speed without a jerk limit, rounded down or up. */
static inline uint64_t passo_slope_clocks(struct passo_slope slope, uint64_t change)
{
	return passo_mul_div(change, slope.clocks, slope.speed);
}

static inline uint64_t passo_slope_clocks_ceil(struct passo_slope slope, uint64_t change)
{
	return passo_mul_div_ceil(change, slope.clocks, slope.speed);
}

/* Clocks of each curve in a change of speed that takes `clocks` without a jerk limit. */
uint64_t passo_slope_curve(struct passo_slope slope, uint64_t change, uint64_t clocks);

/* The highest speed, up to a limit, that a move with these slopes and end speeds reaches. */
uint64_t passo_slope_reach(const struct passo_draft *draft, uint64_t limit, const struct passo_slope *up,
    uint64_t start, const struct passo_slope *down, uint64_t stop);

#endif
