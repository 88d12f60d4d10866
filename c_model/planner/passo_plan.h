/* SPDX-License-Identifier: MIT
 * The planner: converts a move into one line and a few ramps, in integer arithmetic.
 *
 * Every plan except those of continuous rotation starts and ends at rest and is exact in two respects: the
 * line has exactly the requested steps, and the area under the ramps equals the line's M substeps to a small
 * fraction of a substep (see passo_plan.c). The move therefore takes exactly the ticks of its ramps.
 *
 * All functions are reentrant, use no heap and no floating point, and accept any argument values; pointers
 * must not be null. A function that returns an error leaves *plan unchanged.
 */
#ifndef PASSO_PLAN_H
#define PASSO_PLAN_H

#include "passo_moves.h"

/* passo_moves.h has a struct with the parameters of each form of move. Speeds and accelerations are those of
 * the dominant axis, the one with the most steps; the other axes move in proportion. */

/* Largest number of ramps in a plan: a jump to the start speed, three of a jerk-limited ramp, cruise, three
 * more, a jump to 0. */
#define PASSO_PLAN_RAMPS_MAX 9u

/* Alpha of the core's sigmoid table after reset, in units of 1 / PASSO_ALPHA_ONE. */
#define PASSO_SIGMOID_ALPHA_RESET (PASSO_ALPHA_RESET * PASSO_ALPHA_ONE)

enum passo_plan_error {
	PASSO_PLAN_OK = 0,
	PASSO_PLAN_BAD_CLOCK,       /* clock_hz is 0 or tick_log2 is out of range */
	PASSO_PLAN_BAD_AXES,        /* not 1 .. PASSO_AXES_MAX axes */
	PASSO_PLAN_BAD_PROFILE,     /* unknown profile */
	PASSO_PLAN_NO_STEPS,        /* all axes have 0 steps */
	PASSO_PLAN_TOO_MANY_STEPS,  /* an axis has more than PASSO_SUBSTEPS_MAX steps, in either direction */
	PASSO_PLAN_NO_TIME,         /* total time is less than one tick */
	PASSO_PLAN_RAMP_TOO_LONG,   /* the ramp time exceeds half the total time */
	PASSO_PLAN_TOO_LONG,        /* a phase has 2^32 ticks or more, or the move is too long in clocks */
	PASSO_PLAN_TOO_FAST,        /* the speed exceeds one step every two clocks */
	PASSO_PLAN_NO_SPEED,        /* speed is 0 */
	PASSO_PLAN_NO_ACCELERATION, /* the speed changes, but acceleration and ramp time are both 0 */
	PASSO_PLAN_START_ABOVE_SPEED, /* start speed is above the speed */
	PASSO_PLAN_STOP_ABOVE_SPEED,  /* stop speed is above the speed */
	/* further methods */
	PASSO_PLAN_SPEED_TOO_LOW,        /* the steps take longer than the total time at this speed */
	PASSO_PLAN_BAD_AXIS,             /* the machine does not have this axis */
	PASSO_PLAN_NO_STEPS_PER_TURN,    /* steps per revolution is 0 */
	PASSO_PLAN_MINIMUM_ABOVE_SPEED,  /* the minimum rpm is above the rpm */
	PASSO_PLAN_BELOW_MINIMUM,        /* continuous rotation: rpm is below minimum rpm */
	PASSO_PLAN_ABOVE_TOP,            /* continuous rotation: rpm or current velocity is above top rpm */
	PASSO_PLAN_BAD_ALPHA,            /* alpha is out of range */
	PASSO_PLAN_NO_JERK,              /* jerk is 0 */
	PASSO_PLAN_NO_FEED,              /* feed is 0 */
	PASSO_PLAN_NO_SCALE,             /* a moving axis has 0 steps per millimeter */
	PASSO_PLAN_NO_AXIS_SPEED,        /* the speed limit of a moving axis is 0 */
	PASSO_PLAN_NO_AXIS_ACCELERATION, /* the acceleration limit of a moving axis is 0 */
	PASSO_PLAN_BAD_BANK,             /* not one of the three table banks */
	PASSO_PLAN_TABLE_START,          /* point 0 of the table is not 0 */
	PASSO_PLAN_TABLE_FALLS,          /* a point of the table is lower than the previous one */
	/* paths of many lines: passo_path.h */
	PASSO_PLAN_PATH_FULL, /* no free entry for another line yet */
	PASSO_PLAN_TOO_FAR,   /* a target is out of range */
	/* targets that change during the motion */
	PASSO_PLAN_TOO_NEAR /* the axis cannot come to rest before the target */
};

/* The machine that a plan is made for. */
struct passo_machine {
	uint32_t clock_hz; /* clock of the core */
	uint8_t tick_log2; /* TICK_LOG2 of the core: a tick has 2^tick_log2 clocks */
	uint8_t axes;      /* axes that a move uses, 1 .. PASSO_AXES_MAX */
};

/* A complete plan. Velocities are UQ0.48 substeps per clock; phase lengths are in ticks. */
struct passo_plan {
	struct passo_line line;
	uint32_t ramp_count; /* ramps in use, 1 .. PASSO_PLAN_RAMPS_MAX */
	struct passo_ramp ramps[PASSO_PLAN_RAMPS_MAX];
	uint64_t velocity_start; /* initial jump; velocity_peak if there is no acceleration */
	uint64_t velocity_peak;
	uint64_t velocity_stop; /* final jump; velocity_peak if there is no deceleration */
	uint32_t oversampling;  /* K = M / max(N): substeps per step of the dominant axis; 1 or even */
	uint32_t accelerate_ticks;
	uint32_t cruise_ticks;
	uint32_t decelerate_ticks;
	uint32_t steps_to_stop; /* steps of the dominant axis during deceleration, rounded to nearest */
	uint32_t sigmoid_alpha; /* alpha of the sigmoid table that the plan needs; 0: none */
};

/* The two basic forms: a move in a given time, and a move by speed and acceleration. Errors of all forms:
 * BAD_CLOCK, BAD_AXES, BAD_PROFILE, NO_STEPS, TOO_MANY_STEPS, TOO_LONG, TOO_FAST. In time also: NO_TIME,
 * RAMP_TOO_LONG. By speed also: NO_SPEED, NO_ACCELERATION, START_ABOVE_SPEED, STOP_ABOVE_SPEED. */
enum passo_plan_error passo_plan_in_time(
    const struct passo_machine *machine, const struct passo_move_in_time *move, struct passo_plan *plan);
enum passo_plan_error passo_plan_by_speed(
    const struct passo_machine *machine, const struct passo_move_by_speed *move, struct passo_plan *plan);

/* Name ("TOO_FAST") and description of an error, for any value; never null. */
const char *passo_plan_error_name(enum passo_plan_error error);
const char *passo_plan_error_text(enum passo_plan_error error);

/* ------------------------------------------------------------------------------------ further methods ----
 *
 * Each converts the parameters of one kind of move into one of the two basic forms. */

/* A move in a given time that stays below a speed. Errors: those of all forms, NO_SPEED, NO_TIME,
 * SPEED_TOO_LOW. */

enum passo_plan_error passo_plan_below_speed(
    const struct passo_machine *machine, const struct passo_move_below_speed *move, struct passo_plan *plan);

/* The ramp time of passo_plan_below_speed(): total_clocks - steps / speed, in clocks, rounded down; 0 if the
 * time is too short for ramps. `speed` is UQ32.32 steps/s. */
uint64_t passo_longest_ramp(uint32_t clock_hz, uint32_t steps, uint64_t total_clocks, uint64_t speed);

/* A move with a given speed and ramp time. Errors: those of all forms, NO_SPEED, RAMP_TOO_LONG. */
enum passo_plan_error passo_plan_at_speed(
    const struct passo_machine *machine, const struct passo_move_at_speed *move, struct passo_plan *plan);

/* A trapezoid on several axes. Errors: those of all forms, NO_SPEED, NO_ACCELERATION, START_ABOVE_SPEED. */
enum passo_plan_error passo_plan_axes(
    const struct passo_machine *machine, const struct passo_move_axes *move, struct passo_plan *plan);

/* Rotation of one axis by an angle. Errors: those of all forms, NO_SPEED, NO_ACCELERATION, BAD_AXIS,
 * NO_STEPS_PER_TURN, MINIMUM_ABOVE_SPEED. */
enum passo_plan_error passo_plan_turn(
    const struct passo_machine *machine, const struct passo_move_turn *move, struct passo_plan *plan);

/* Continuous rotation takes three kinds of plans. Start: an endless line and a ramp that does not end the
 * profile. New speed, and stop: ramps only, the first of them with NOW. To reverse, stop and start again. */
struct passo_turning {
	uint8_t axis;
	uint32_t steps_per_turn; /* steps per revolution: full steps times microsteps */
	bool backward;           /* negative direction */
	uint64_t top_rpm;        /* UQ32.32: upper limit of all speeds of this rotation */
	uint64_t minimum_rpm;    /* UQ32.32: initial and final speed */
	uint64_t acceleration;   /* UQ32.32 steps/s^2, for deceleration as well */
};
/* `rpm` is UQ32.32, minimum_rpm .. top_rpm. `velocity` (UQ0.48 substeps per clock) is the current velocity,
 * from which the ramp starts: velocity_peak of the previous plan once it is reached, until then the VELOCITY
 * register times 2^16. Errors: BAD_CLOCK, BAD_AXES, BAD_AXIS, NO_STEPS_PER_TURN, NO_SPEED, TOO_FAST,
 * NO_ACCELERATION, TOO_LONG, BELOW_MINIMUM, ABOVE_TOP. */
enum passo_plan_error passo_plan_turning_start(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t rpm, struct passo_plan *plan);
enum passo_plan_error passo_plan_turning_speed(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t velocity, uint64_t rpm, struct passo_plan *plan);
enum passo_plan_error passo_plan_turning_stop(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t velocity, struct passo_plan *plan);

/* A course moves one axis to a target that can change during the motion. Like continuous rotation it has an
 * endless line, but its ramps always end at rest at or before the target. */
struct passo_course {
	uint8_t axis;
	bool backward;         /* negative direction */
	uint64_t top_speed;    /* UQ32.32 steps/s: upper limit of all speeds of this line */
	uint64_t speed;        /* UQ32.32 steps/s, at most top_speed */
	uint64_t acceleration; /* UQ32.32 steps/s^2, for deceleration as well */
};
/* Longest ramp in ticks, so that rounding stays below a step. */
#define PASSO_COURSE_RAMP_TICKS_MAX (UINT32_C(1) << 22)

/* From rest: exactly `steps` of them, at least 1. Errors: BAD_CLOCK, BAD_AXES, BAD_AXIS, NO_STEPS, NO_SPEED,
 * ABOVE_TOP, TOO_FAST above a quarter of the clock, NO_ACCELERATION, TOO_LONG. */
enum passo_plan_error passo_plan_course(const struct passo_machine *machine,
    const struct passo_course *course, uint32_t steps, struct passo_plan *plan);
/* While it moves: ramps only, the first of them with NOW. The current speed, UQ32.32 steps/s, is between
 * `low` and `high`. From the NOW on the axis moves by at most `way` (UQ48.16 steps), needs at most the given
 * acceleration for any speed within the bounds, and uses the distance as far as these allow. `way` 0: to rest
 * immediately. Errors: the same, TOO_NEAR if the axis cannot come to rest within the distance. */
enum passo_plan_error passo_plan_course_change(const struct passo_machine *machine,
    const struct passo_course *course, uint64_t low, uint64_t high, uint64_t way, struct passo_plan *plan);

/* Nearest whole steps to an angle (Q31.32 degrees) and to a length (Q31.32 mm, scale UQ32.32), with its sign;
 * at most 2^32 - 1 either way. 0 if the scale is 0. */
int64_t passo_steps_of_angle(int64_t angle, uint32_t steps_per_turn);
int64_t passo_steps_of_length(int64_t length, uint64_t steps_per_mm);

/* Conversion of readings: the angle of a position in degrees (Q31.32, saturating), and the speed of the
 * dominant axis in rpm (UQ32.32) from a velocity (UQ0.48 substeps per clock) and the oversampling of its
 * plan. 0 if steps_per_turn is 0. */
int64_t passo_angle_of(int32_t position, uint32_t steps_per_turn);
uint64_t passo_rpm_of(uint64_t velocity, uint32_t oversampling, uint32_t clock_hz, uint32_t steps_per_turn);

/* A sigmoid S-curve. Errors: those of passo_plan_by_speed(), BAD_ALPHA. */
enum passo_plan_error passo_plan_sigmoid(
    const struct passo_machine *machine, const struct passo_move_sigmoid *move, struct passo_plan *plan);

/* Computes the points (UQ0.16) of a sigmoid table; `alpha` is in units of 1 / PASSO_ALPHA_ONE. table[k] +
 * table[256 - k] is 65536. For alpha = 5 this is the table after reset. Error: BAD_ALPHA. */
#define PASSO_TABLE_SIZE PASSO_ADDRESS_SIGMOID_COUNT
enum passo_plan_error passo_sigmoid_table(uint32_t alpha, uint16_t table[PASSO_TABLE_SIZE]);

/* A jerk-limited move in up to seven phases. Errors: those of passo_plan_by_speed(), NO_JERK. */
enum passo_plan_error passo_plan_jerk(
    const struct passo_machine *machine, const struct passo_move_jerk *move, struct passo_plan *plan);

/* A straight line in millimeters within the limits of each axis. Errors: those of all forms, NO_SPEED,
 * NO_FEED, NO_SCALE, NO_AXIS_SPEED, NO_AXIS_ACCELERATION, NO_JERK. */
enum passo_plan_error passo_plan_straight(
    const struct passo_machine *machine, const struct passo_move_straight *move, struct passo_plan *plan);

/* User-defined shape: a table that is loaded into one of the banks. Acceleration follows the table,
 * deceleration its mirror image in time, or with `forward` the table as well: the speed falls as it rose,
 * which an input shaper needs. `profile` of the move is ignored. Errors: those of the basic forms, BAD_BANK,
 * TABLE_START, TABLE_FALLS. */
struct passo_user_shape {
	enum passo_shape bank; /* PASSO_SHAPE_COSINE, SIGMOID or EASE */
	const uint16_t *table; /* PASSO_TABLE_SIZE points, UQ0.16; point 256 is 65536 and not stored */
	bool forward;          /* deceleration is not mirrored */
};
enum passo_plan_error passo_plan_user_in_time(const struct passo_machine *machine,
    const struct passo_move_in_time *move, const struct passo_user_shape *shape, struct passo_plan *plan);
enum passo_plan_error passo_plan_user_by_speed(const struct passo_machine *machine,
    const struct passo_move_by_speed *move, const struct passo_user_shape *shape, struct passo_plan *plan);

/* Properties of a table. */
struct passo_table_facts {
	uint32_t mean;  /* mean of the interpolated shape in units of 2^-24, exact */
	bool symmetric; /* table[k] + table[256 - k] is 65536: the mean is 2^23 */
	uint16_t worst; /* index of the first invalid point, if there is one */
};
/* Checks that a table starts at 0 and never decreases, and fills in *facts in any case. Errors: TABLE_START,
 * TABLE_FALLS. */
enum passo_plan_error passo_table_check(
    const uint16_t table[PASSO_TABLE_SIZE], struct passo_table_facts *facts);

#endif
