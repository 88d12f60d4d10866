/* SPDX-License-Identifier: MIT
 * The planner: turns what a user knows into one line and a few ramps, in integers.
 *
 * Every plan starts and ends at rest and is exact twice: the line's steps are the wanted steps, and the
 * distance under the ramps is the line's M substeps to a small part of a substep (passo_plan.c says how
 * small), so the time is the whole number of ticks that the ramps say.
 */
#ifndef PASSO_PLAN_H
#define PASSO_PLAN_H

#include "passo_moves.h"

/* What a move is asked for with stands in passo_moves.h, one struct for each form. Speeds and accelerations
 * belong to the longest axis; the other axes follow in proportion. */

/* Jump to the start speed, three parts of a jerk-limited ramp, cruise, three parts, jump to 0. */
#define PASSO_PLAN_RAMPS_MAX 9u

/* The core's table is made for this alpha after reset. */
#define PASSO_SIGMOID_ALPHA_RESET (PASSO_ALPHA_RESET * PASSO_ALPHA_ONE)

enum passo_plan_error {
	PASSO_PLAN_OK = 0,
	PASSO_PLAN_BAD_CLOCK,      /* clock_hz is 0 or tick_log2 is out of its limits */
	PASSO_PLAN_BAD_AXES,       /* not 1 .. PASSO_AXES_MAX axes */
	PASSO_PLAN_BAD_PROFILE,    /* unknown profile */
	PASSO_PLAN_NO_STEPS,       /* all axes have 0 steps */
	PASSO_PLAN_TOO_MANY_STEPS, /* an axis has more than PASSO_SUBSTEPS_MAX steps, forwards or backwards */
	PASSO_PLAN_NO_TIME,        /* total time is less than one tick */
	PASSO_PLAN_RAMP_TOO_LONG,  /* the ramp time is more than half the total time */
	PASSO_PLAN_TOO_LONG,       /* a phase has 2^32 ticks or more, or the move is too long in clocks */
	PASSO_PLAN_TOO_FAST,       /* more steps than half the clock allows */
	PASSO_PLAN_NO_SPEED,       /* speed is 0 */
	PASSO_PLAN_NO_ACCELERATION,   /* acceleration is 0 and so is the ramp time, but the speed changes */
	PASSO_PLAN_START_ABOVE_SPEED, /* start speed is above the speed */
	PASSO_PLAN_STOP_ABOVE_SPEED,  /* stop speed is above the speed */
	/* of the further methods */
	PASSO_PLAN_SPEED_TOO_LOW,        /* so many steps need more than the highest speed in that time */
	PASSO_PLAN_BAD_AXIS,             /* the axis is not one of the machine's */
	PASSO_PLAN_NO_STEPS_PER_TURN,    /* steps per turn is 0 */
	PASSO_PLAN_MINIMUM_ABOVE_SPEED,  /* the minimum rpm is above the rpm */
	PASSO_PLAN_BELOW_MINIMUM,        /* turning: the rpm is below the minimum rpm */
	PASSO_PLAN_ABOVE_TOP,            /* turning: the rpm, or the present velocity, is above the top rpm */
	PASSO_PLAN_BAD_ALPHA,            /* alpha is out of its limits */
	PASSO_PLAN_NO_JERK,              /* jerk is 0 */
	PASSO_PLAN_NO_FEED,              /* feed is 0 */
	PASSO_PLAN_NO_SCALE,             /* an axis that moves has 0 steps per millimetre */
	PASSO_PLAN_NO_AXIS_SPEED,        /* an axis that moves has a largest speed of 0 */
	PASSO_PLAN_NO_AXIS_ACCELERATION, /* an axis that moves has a largest acceleration of 0 */
	PASSO_PLAN_BAD_BANK,             /* not one of the banks of tables */
	PASSO_PLAN_TABLE_START,          /* point 0 of a table is not 0 */
	PASSO_PLAN_TABLE_FALLS           /* a point of a table is lower than the one before */
};

/* What the core is: what ticks mean. */
struct passo_machine {
	uint32_t clock_hz;
	uint8_t tick_log2; /* TICK_LOG2 of the core */
	uint8_t axes;      /* axes in the moves below, 1 .. PASSO_AXES_MAX */
};

/* A finished plan. Velocities in UQ0.48 substeps per clock. */
struct passo_plan {
	struct passo_line line;
	struct passo_ramp ramps[PASSO_PLAN_RAMPS_MAX];
	uint32_t ramp_count;
	uint32_t oversampling;   /* K = M / max(N): substeps per step of the longest axis; 1 or even */
	uint64_t velocity_start; /* jumped to at the start; the peak when there is no accelerate phase */
	uint64_t velocity_peak;
	uint64_t velocity_stop;    /* jumped from at the end; the peak when there is no decelerate phase */
	uint32_t accelerate_ticks; /* length of the phases */
	uint32_t cruise_ticks;
	uint32_t decelerate_ticks;
	uint32_t steps_to_stop; /* steps of the longest axis while it slows down: where that begins */
	uint32_t sigmoid_alpha; /* what the core's sigmoid table must be made for; 0: it is not used */
};

/* Both leave *plan untouched unless they return PASSO_PLAN_OK. */
enum passo_plan_error passo_plan_in_time(
    const struct passo_machine *machine, const struct passo_move_in_time *move, struct passo_plan *plan);
enum passo_plan_error passo_plan_by_speed(
    const struct passo_machine *machine, const struct passo_move_by_speed *move, struct passo_plan *plan);

/* Name ("TOO_FAST") and sentence of an error. */
const char *passo_plan_error_name(enum passo_plan_error error);
const char *passo_plan_error_text(enum passo_plan_error error);

/* ------------------------------------------------------------------------------------ further methods ----
 *
 * Each takes what a user knows about one kind of move, and becomes one of the two forms above. A refused
 * *plan stays untouched. */

enum passo_plan_error passo_plan_below_speed(
    const struct passo_machine *machine, const struct passo_move_below_speed *move, struct passo_plan *plan);

/* total - n / speed in clocks, rounded down; 0 if there is no time for ramps, or none at all. */
uint64_t passo_longest_ramp(uint32_t clock_hz, uint32_t steps, uint64_t total_clocks, uint64_t speed);

enum passo_plan_error passo_plan_at_speed(
    const struct passo_machine *machine, const struct passo_move_at_speed *move, struct passo_plan *plan);

enum passo_plan_error passo_plan_axes(
    const struct passo_machine *machine, const struct passo_move_axes *move, struct passo_plan *plan);

enum passo_plan_error passo_plan_turn(
    const struct passo_machine *machine, const struct passo_move_turn *move, struct passo_plan *plan);

/* Turning without end. The three plans of it: start with a line without end and a ramp that does not end the
 * profile; another speed, and stop, with ramps only, the first of them NOW. `velocity` is the present one,
 * which the ramp starts from: the plan's velocity_peak when it is reached, before that the VELOCITY register
 * times 2^16. The direction is changed by a stop and a new start. */
struct passo_turning {
	uint8_t axis;
	uint32_t steps_per_turn;
	bool backwards;
	uint64_t top_rpm; /* no higher rpm will be asked for */
	uint64_t minimum_rpm;
	uint64_t acceleration; /* UQ32.32 steps/s^2 */
};
enum passo_plan_error passo_plan_turning_start(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t rpm, struct passo_plan *plan);
enum passo_plan_error passo_plan_turning_speed(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t velocity, uint64_t rpm, struct passo_plan *plan);
enum passo_plan_error passo_plan_turning_stop(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t velocity, struct passo_plan *plan);

/* Reading back: degrees (Q31.32, saturating) of a position; rpm (UQ32.32) of a velocity of the longest axis
 * in a plan with so much oversampling. 0 if steps per turn is 0. */
int64_t passo_angle_of(int32_t position, uint32_t steps_per_turn);
uint64_t passo_rpm_of(uint64_t velocity, uint32_t oversampling, uint32_t clock_hz, uint32_t steps_per_turn);

enum passo_plan_error passo_plan_sigmoid(
    const struct passo_machine *machine, const struct passo_move_sigmoid *move, struct passo_plan *plan);

/* The points of the sigmoid's bank for an alpha; table[k] + table[256 - k] is 65536. For alpha = 5 they are
 * those after reset. */
#define PASSO_TABLE_SIZE PASSO_ADDRESS_SIGMOID_COUNT
enum passo_plan_error passo_sigmoid_table(uint32_t alpha, uint16_t table[PASSO_TABLE_SIZE]);

enum passo_plan_error passo_plan_jerk(
    const struct passo_machine *machine, const struct passo_move_jerk *move, struct passo_plan *plan);

enum passo_plan_error passo_plan_straight(
    const struct passo_machine *machine, const struct passo_move_straight *move, struct passo_plan *plan);

/* The user's own shape: a table that is loaded into one of the banks. Speeding up follows it, slowing down is
 * its mirror image in time. `profile` in the moves is not looked at. */
struct passo_user_shape {
	enum passo_shape bank; /* PASSO_SHAPE_COSINE, SIGMOID or EASE */
	const uint16_t *table; /* PASSO_TABLE_SIZE points; point 256 is 65536 */
};
enum passo_plan_error passo_plan_user_in_time(const struct passo_machine *machine,
    const struct passo_move_in_time *move, const struct passo_user_shape *shape, struct passo_plan *plan);
enum passo_plan_error passo_plan_user_by_speed(const struct passo_machine *machine,
    const struct passo_move_by_speed *move, const struct passo_user_shape *shape, struct passo_plan *plan);

/* Is a table fit to be a shape: it starts at 0 and never falls. */
struct passo_table_facts {
	uint32_t mean;  /* with linear interpolation, in units of 2^-24; exact */
	bool symmetric; /* table[k] + table[256 - k] is 65536: the mean is 2^23 */
	uint16_t worst; /* the point that is wrong, if one is */
};
enum passo_plan_error passo_table_check(
    const uint16_t table[PASSO_TABLE_SIZE], struct passo_table_facts *facts);

#endif
