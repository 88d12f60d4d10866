/* SPDX-License-Identifier: MIT
 * The planner: turns what a user knows into one line and a few ramps, in integers.
 *
 * Every plan starts and ends at rest and is exact twice: the line's steps are the wanted steps, and the
 * distance under the ramps is the line's M substeps to a small part of a substep (passo_plan.c says how
 * small), so the time is the whole number of ticks that the ramps say.
 */
#ifndef PASSO_PLAN_H
#define PASSO_PLAN_H

#include "passo_command.h"

/* Speeds (steps/s) and accelerations (steps/s^2) are UQ32.32: an integer x stands for x / 2^32.
 * They belong to the longest axis; the other axes follow in proportion. */
#define PASSO_UNIT_Q32 (UINT64_C(1) << 32)

/* Jump to the start speed, two halves of a jerk-limited ramp, cruise, two halves, jump to 0. */
#define PASSO_PLAN_RAMPS_MAX 7u

enum passo_profile { PASSO_PROFILE_LINEAR, PASSO_PROFILE_COSINE, PASSO_PROFILE_SIGMOID, PASSO_PROFILE_JERK };

enum passo_plan_error {
	PASSO_PLAN_OK = 0,
	PASSO_PLAN_BAD_CLOCK,            /* clock_hz is 0 or tick_log2 is not 7 .. 16 */
	PASSO_PLAN_BAD_AXES,             /* not 1 .. 8 axes */
	PASSO_PLAN_BAD_PROFILE,          /* unknown profile */
	PASSO_PLAN_NO_STEPS,             /* all axes have 0 steps */
	PASSO_PLAN_TOO_MANY_STEPS,       /* an axis has -2^31 steps */
	PASSO_PLAN_NO_TIME,              /* total time is less than one tick */
	PASSO_PLAN_RAMP_TOO_LONG,        /* the ramp time is more than half the total time */
	PASSO_PLAN_TOO_LONG,             /* a phase has 2^32 ticks or more, or the move 2^44 clocks or more */
	PASSO_PLAN_TOO_FAST,             /* more steps than half the clock allows */
	PASSO_PLAN_NO_SPEED,             /* speed is 0 */
	PASSO_PLAN_NO_ACCELERATION,      /* acceleration is 0 and so is the ramp time, but the speed changes */
	PASSO_PLAN_START_ABOVE_SPEED,    /* start speed is above the speed */
	PASSO_PLAN_STOP_ABOVE_SPEED      /* stop speed is above the speed */
};

/* What the core is: what ticks mean. */
struct passo_machine {
	uint32_t clock_hz;
	uint8_t tick_log2; /* TICK_LOG2 of the core */
	uint8_t axes;      /* axes in the moves below, 1 .. 8 */
};

/* A move in a given total time: from rest to rest. f_max = n / (total - ramp), both rounded to ticks. */
struct passo_move_in_time {
	int32_t steps[PASSO_AXES_MAX];
	enum passo_profile profile;
	uint64_t total_clocks;
	uint64_t ramp_clocks; /* speeding up, and again slowing down; 0 .. total_clocks / 2 */
};

/* A move by speeds of the longest axis. Start and stop speed are what the drive can jump to from rest, and
 * from to rest; a move too short for them jumps to less. Phases are rounded up to ticks, so no limit is
 * ever exceeded. */
struct passo_move_by_speed {
	int32_t steps[PASSO_AXES_MAX];
	enum passo_profile profile;
	uint64_t start_speed;  /* 0 .. speed */
	uint64_t speed;        /* never exceeded; not reached when the move is too short */
	uint64_t stop_speed;   /* 0 .. speed */
	uint64_t acceleration; /* mean acceleration of the ramp; never exceeded */
	uint64_t deceleration; /* 0: the same as acceleration */
	uint64_t ramp_clocks;  /* instead of acceleration, when that is 0: duration of each full ramp */
};

/* A finished plan. Velocities in UQ0.48 substeps per clock. */
struct passo_plan {
	struct passo_line line;
	struct passo_ramp ramps[PASSO_PLAN_RAMPS_MAX];
	uint32_t ramp_count;
	uint32_t oversampling;     /* K = M / max(N): substeps per step of the longest axis; 1 or even */
	uint64_t velocity_start;   /* jumped to at the start; the peak when there is no accelerate phase */
	uint64_t velocity_peak;
	uint64_t velocity_stop;    /* jumped from at the end; the peak when there is no decelerate phase */
	uint32_t accelerate_ticks; /* length of the phases */
	uint32_t cruise_ticks;
	uint32_t decelerate_ticks;
};

/* Both leave *plan untouched unless they return PASSO_PLAN_OK. */
enum passo_plan_error passo_plan_in_time(
    const struct passo_machine *machine, const struct passo_move_in_time *move, struct passo_plan *plan);
enum passo_plan_error passo_plan_by_speed(
    const struct passo_machine *machine, const struct passo_move_by_speed *move, struct passo_plan *plan);

/* Name ("TOO_FAST") and sentence of an error. */
const char *passo_plan_error_name(enum passo_plan_error error);
const char *passo_plan_error_text(enum passo_plan_error error);

#endif
