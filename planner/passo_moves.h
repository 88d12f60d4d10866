/* SPDX-License-Identifier: MIT
 * Generated from schema/moves.toml by tools/generate_moves.py.
 *
 * Parameters of moves: the profiles, and a struct for each form.
 */
#ifndef PASSO_MOVES_H
#define PASSO_MOVES_H

#include "passo_command.h"

/* X macro of the profiles: EACH(NAME, shape of the core, name). */
#define PASSO_PROFILES(EACH) \
	EACH(LINEAR, PASSO_SHAPE_LINEAR, "linear") \
	EACH(COSINE, PASSO_SHAPE_COSINE, "cosine") \
	EACH(SIGMOID, PASSO_SHAPE_SIGMOID, "sigmoid") \
	EACH(JERK, PASSO_SHAPE_EASE, "jerk")

enum passo_profile {
	PASSO_PROFILE_LINEAR,
	PASSO_PROFILE_COSINE,
	PASSO_PROFILE_SIGMOID,
	PASSO_PROFILE_JERK,
	PASSO_PROFILE_COUNT
};

#define PASSO_PROFILES_WORDS "linear, cosine, sigmoid or jerk"
#define PASSO_PROFILES_CHOICE "linear|cosine|sigmoid|jerk"

/* User-defined shape: the name that replaces a profile, and the bank of its table. */
#define PASSO_USER_PROFILE "user"
#define PASSO_USER_BANK    PASSO_SHAPE_SIGMOID

/* X macros: EACH(name, NAME) for each form ... */
#define PASSO_MOVES(EACH) \
	EACH(in_time, IN_TIME) \
	EACH(by_speed, BY_SPEED) \
	EACH(below_speed, BELOW_SPEED) \
	EACH(at_speed, AT_SPEED) \
	EACH(axes, AXES) \
	EACH(turn, TURN) \
	EACH(sigmoid, SIGMOID) \
	EACH(jerk, JERK) \
	EACH(straight, STRAIGHT)

/* ... for those with a member `steps` ... */
#define PASSO_MOVES_BY_STEPS(EACH) \
	EACH(in_time, IN_TIME) \
	EACH(by_speed, BY_SPEED) \
	EACH(below_speed, BELOW_SPEED) \
	EACH(at_speed, AT_SPEED) \
	EACH(axes, AXES) \
	EACH(sigmoid, SIGMOID) \
	EACH(jerk, JERK)

/* ... and for those that accept a user-defined shape. */
#define PASSO_MOVES_BY_SHAPE(EACH) \
	EACH(in_time, IN_TIME) \
	EACH(by_speed, BY_SPEED)

/* A move from rest to rest in a given total time. f_max = n / (total - ramp), both rounded to ticks. */
struct passo_move_in_time {
	int32_t            steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           total_clocks;          /* clocks: of the whole move */
	uint64_t           ramp_clocks;           /* clocks: of acceleration, and of deceleration; 0 .. half the total time */
};

/* A move by speeds of the longest axis. Start and stop speed are the largest jumps from and to rest that
 * the drive can follow; a short move may use smaller ones. Phases are rounded up to ticks, so no limit is
 * ever exceeded. */
struct passo_move_by_speed {
	int32_t            steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           start_speed;           /* UQ32.32 steps/s: initial speed, set at once from rest; 0 .. speed */
	uint64_t           speed;                 /* UQ32.32 steps/s: upper limit; not reached if the move is too short */
	uint64_t           stop_speed;            /* UQ32.32 steps/s: final speed, dropped to rest at once; 0 .. speed */
	uint64_t           acceleration;          /* UQ32.32 steps/s^2: mean over the ramp; upper limit */
	uint64_t           deceleration;          /* UQ32.32 steps/s^2: the same for deceleration; 0 in C: as acceleration */
	uint64_t           ramp_clocks;           /* clocks: of each full ramp, instead of accelerations */
};

/* A move in a given time that stays below a speed. It takes the longest and therefore gentlest ramps that
 * fit: total - n / speed each, at most half the total time (then the speed is not reached). */
struct passo_move_below_speed {
	int32_t            steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           total_clocks;          /* clocks: of the whole move */
	uint64_t           speed;                 /* UQ32.32 steps/s: upper limit */
};

/* A move with a given speed and ramp time. It takes n / speed + ramp, rounded up to ticks. The ramp time is
 * at most n / speed, which is half the total time. */
struct passo_move_at_speed {
	int32_t            steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           speed;                 /* UQ32.32 steps/s: cruise speed */
	uint64_t           ramp_clocks;           /* clocks: of acceleration, and of deceleration; 0 .. steps / speed */
};

/* Trapezoid on several axes, from and to the start speed. A move that is too short is a triangle with the
 * same acceleration. Speeds are those of the axis with the most steps. */
struct passo_move_axes {
	int32_t  steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	uint64_t start_speed;           /* UQ32.32 steps/s: initial and final speed */
	uint64_t speed;                 /* UQ32.32 steps/s: upper limit; not reached if the move is too short */
	uint64_t ramp_clocks;           /* clocks: of each full ramp */
};

/* Rotates one axis by an angle, with a trapezoid. The sign of the angle is the direction. */
struct passo_move_turn {
	uint8_t  axis;           /* to rotate */
	uint32_t steps_per_turn; /* steps per revolution: full steps times microsteps */
	int64_t  angle;          /* Q31.32 degrees: rounded to the nearest step */
	uint64_t rpm;            /* UQ32.32 rpm: speed; not reached if the move is too short */
	uint64_t minimum_rpm;    /* UQ32.32 rpm: initial and final speed */
	uint64_t acceleration;   /* UQ32.32 steps/s^2: upper limit, for acceleration and deceleration */
};

/* Sigmoid S-curve by three frequencies and two ramp times. A move too short for full ramps keeps their mean
 * accelerations. plan.steps_to_stop tells where deceleration begins. */
struct passo_move_sigmoid {
	int32_t  steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	uint64_t start_speed;           /* UQ32.32 steps/s: initial speed, set at once from rest; 0 .. speed */
	uint64_t speed;                 /* UQ32.32 steps/s: upper limit; not reached if the move is too short */
	uint64_t stop_speed;            /* UQ32.32 steps/s: final speed, dropped to rest at once; 0 .. speed */
	uint64_t accelerate_clocks;     /* clocks: of a full acceleration ramp */
	uint64_t decelerate_clocks;     /* clocks: of a full deceleration ramp */
	uint32_t alpha;                 /* 1/4096: steepness: the logistic function over -alpha .. alpha */
};

/* Jerk-limited move in up to seven phases. Acceleration rises, stays constant and falls, and so does
 * deceleration; phases are omitted where length, speed or acceleration leave no room for them. */
struct passo_move_jerk {
	int32_t  steps[PASSO_AXES_MAX]; /* of each axis; the sign is the direction */
	uint64_t start_speed;           /* UQ32.32 steps/s: initial speed, set at once from rest; 0 .. speed */
	uint64_t speed;                 /* UQ32.32 steps/s: upper limit; not reached if the move is too short */
	uint64_t stop_speed;            /* UQ32.32 steps/s: final speed, dropped to rest at once; 0 .. speed */
	uint64_t acceleration;          /* UQ32.32 steps/s^2: upper limit, for acceleration and deceleration */
	uint64_t jerk;                  /* UQ32.32 steps/s^3: upper limit */
};

struct passo_axis_limits {
	uint64_t steps_per_mm; /* UQ32.32 steps/mm: scale of each axis */
	uint64_t speed;        /* UQ32.32 mm/s: upper limit of each axis */
	uint64_t acceleration; /* UQ32.32 mm/s^2: upper limit of each axis */
	uint64_t jerk;         /* UQ32.32 mm/s^3: upper limit of each axis; 0 in C: no limit */
};

/* Straight line in space, in millimetres (degrees for a rotary axis). Each axis has its own limits; the
 * path is as fast as the tightest of them allows. */
struct passo_move_straight {
	int64_t  distance[PASSO_AXES_MAX]; /* Q31.32 mm: of each axis, rounded to the nearest step */
	uint64_t feed;                     /* UQ32.32 mm/s: along the path */
	struct passo_axis_limits limits[PASSO_AXES_MAX];
};

#endif
