/* SPDX-License-Identifier: MIT
 * The commands a channel consumes: lines (where) and ramps (when).
 *
 * Both meet in the substep, a tiny unit of path: ramps produce substeps, lines consume them.
 * The planner makes these structs, the frame codec sends them, the core model executes them.
 */
#ifndef PASSO_COMMAND_H
#define PASSO_COMMAND_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_limits.h"
#include "passo_registers.h"

#define PASSO_CHANNELS_MAX PASSO_ADDRESS_CHANNEL_COUNT
#define PASSO_AXES_MAX PASSO_CHANNEL_AXIS_COUNT

/* Of the trackers of a core: a turn of an axis, and a tick, in which it has one; clocks. */
#define PASSO_TRACKER_TURN 32u
#define PASSO_TRACKER_TICK(axes) (PASSO_TRACKER_TURN * ((axes) > 4u ? 8u : 4u))

/* Velocities and progress are UQ0.48: an integer v stands for v / 2^48. */
#define PASSO_ONE_Q48 (UINT64_C(1) << 48)
/* Highest velocity: half a substep per clock, because the DDA takes two clocks per substep. */
#define PASSO_VELOCITY_MAX (UINT64_C(1) << 47)
/* Largest progress step: that of a ramp of one tick. */
#define PASSO_PROGRESS_STEP_MAX (PASSO_ONE_Q48 - 1u)

/* A line moves axis i by exactly steps[i] steps over `substeps` substeps of path. */
struct passo_line {
	bool last;                      /* the path may end here */
	bool endless;                   /* repeat until stopped */
	uint8_t directions;             /* bit i set: axis i counts down */
	uint32_t substeps;              /* M, 1 .. PASSO_SUBSTEPS_MAX */
	uint32_t steps[PASSO_AXES_MAX]; /* N_i, 0 .. M */
	uint32_t output;                /* of a core with OUTPUTS: its output word */
};

/* A ramp takes the velocity from its present value to velocity_end. */
struct passo_ramp {
	bool last;   /* the profile ends with this ramp */
	bool now;    /* drop the ramps queued before it and start from the present velocity */
	bool mirror; /* 1 - shape(1 - u) instead of shape(u) */
	enum passo_shape shape;
	uint64_t velocity_end;  /* UQ0.48 substeps per clock, 0 .. 2^47 */
	uint32_t ticks;         /* T; 0 sets the velocity immediately */
	uint64_t progress_step; /* du = round(2^48 / T), at most 2^48-1; for T > 2^24: floor */
};

#endif
