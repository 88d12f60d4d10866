/* SPDX-License-Identifier: MIT
 * Generated from spec/moves.toml by spec/generate_moves.py.
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

/* Shapes of the ramps of a move. */
enum passo_profile {
	PASSO_PROFILE_LINEAR,
	PASSO_PROFILE_COSINE,
	PASSO_PROFILE_SIGMOID,
	PASSO_PROFILE_JERK,
	PASSO_PROFILE_COUNT
};

/* Their names, for messages. */
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

/* A move in a given total time, from rest to rest. f_max = n / (total - ramp), both rounded to ticks. */
struct passo_move_in_time {
	int32_t            steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps; `shaped` with a shaper */
	uint64_t           total_clocks;          /* clocks: duration of the move */
	uint64_t           ramp_clocks;           /* clocks: duration of each ramp; 0 to half the total time */
};

/* A move by speeds of the dominant axis. The drive can start at the start speed and stop from the stop
 * speed; a move too short for them uses less. Phases are rounded up to ticks, so no limit is ever exceeded. */
struct passo_move_by_speed {
	int32_t            steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           start_speed;           /* UQ32.32 steps/s: the move starts at this speed, 0 .. speed */
	uint64_t           speed;                 /* UQ32.32 steps/s: never exceeded; not reached if the move is too short */
	uint64_t           stop_speed;            /* UQ32.32 steps/s: the move stops from this speed, 0 .. speed */
	uint64_t           acceleration;          /* UQ32.32 steps/s^2: mean over the ramp; never exceeded */
	uint64_t           deceleration;          /* UQ32.32 steps/s^2: mean over the ramp down; never exceeded; 0 in C: same as acceleration */
	uint64_t           ramp_clocks;           /* clocks: duration of each full ramp, instead of accelerations */
};

/* A move in a given time, never above a speed. Its ramps are the longest, so the gentlest, that allow it:
 * total - n / speed each, at most half the total time (then the speed is not reached). */
struct passo_move_below_speed {
	int32_t            steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           total_clocks;          /* clocks: duration of the move */
	uint64_t           speed;                 /* UQ32.32 steps/s: never exceeded */
};

/* A move with a given speed and ramp time. It takes n / speed + ramp, rounded up to ticks. The ramp time is
 * at most n / speed, half the total time. */
struct passo_move_at_speed {
	int32_t            steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	enum passo_profile profile;               /* shape of the ramps */
	uint64_t           speed;                 /* UQ32.32 steps/s: between the ramps */
	uint64_t           ramp_clocks;           /* clocks: duration of each ramp; 0 to steps / speed */
};

/* Trapezoid on several axes, from and to the start speed. A move too short for it is a triangle with the
 * same acceleration. The axis with the most steps is the dominant one. */
struct passo_move_axes {
	int32_t  steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	uint64_t start_speed;           /* UQ32.32 steps/s: speed at which the move starts and stops */
	uint64_t speed;                 /* UQ32.32 steps/s: never exceeded; not reached if the move is too short */
	uint64_t ramp_clocks;           /* clocks: duration of each full ramp */
};

/* Trapezoid on one axis by angle and rpm. The sign of the angle is the direction. Steps per turn are full
 * steps times microsteps. */
struct passo_move_turn {
	uint8_t  axis;           /* axis to rotate */
	uint32_t steps_per_turn; /* full steps times microsteps */
	int64_t  angle;          /* Q31.32 degrees: to the nearest step */
	uint64_t rpm;            /* UQ32.32 rpm: speed; not reached if the move is too short */
	uint64_t minimum_rpm;    /* UQ32.32 rpm: speed at which the move starts and stops */
	uint64_t acceleration;   /* UQ32.32 steps/s^2: never exceeded, accelerating or decelerating */
};

/* Sigmoid S-curve by three frequencies and two ramp times. A move too short for full ramps keeps their mean
 * accelerations. plan.steps_to_stop is where deceleration begins. */
struct passo_move_sigmoid {
	int32_t  steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	uint64_t start_speed;           /* UQ32.32 steps/s: the move starts at this speed, 0 .. speed */
	uint64_t speed;                 /* UQ32.32 steps/s: never exceeded; not reached if the move is too short */
	uint64_t stop_speed;            /* UQ32.32 steps/s: the move stops from this speed, 0 .. speed */
	uint64_t accelerate_clocks;     /* clocks: duration of a full ramp up */
	uint64_t decelerate_clocks;     /* clocks: duration of a full ramp down */
	uint32_t alpha;                 /* 1/4096: steepness: the logistic function over -alpha .. alpha */
};

/* Jerk-limited in up to seven phases. The acceleration rises, stays constant and falls, and so does the
 * deceleration; phases drop out where length, speed or acceleration do not reach them. */
struct passo_move_jerk {
	int32_t  steps[PASSO_AXES_MAX]; /* per axis; the sign is the direction */
	uint64_t start_speed;           /* UQ32.32 steps/s: the move starts at this speed, 0 .. speed */
	uint64_t speed;                 /* UQ32.32 steps/s: never exceeded; not reached if the move is too short */
	uint64_t stop_speed;            /* UQ32.32 steps/s: the move stops from this speed, 0 .. speed */
	uint64_t acceleration;          /* UQ32.32 steps/s^2: never exceeded, accelerating or decelerating */
	uint64_t jerk;                  /* UQ32.32 steps/s^3: never exceeded */
};

struct passo_axis_limits {
	uint64_t steps_per_mm; /* UQ32.32 steps/mm: scale of the axis */
	uint64_t speed;        /* UQ32.32 mm/s: limit of the axis */
	uint64_t acceleration; /* UQ32.32 mm/s^2: limit of the axis */
	uint64_t jerk;         /* UQ32.32 mm/s^3: limit of the axis; 0 in C: no limit */
};

/* Straight line through space, in millimeters or, for rotary axes, degrees. Each axis has its own limits;
 * the tightest one sets the speed of the path. */
struct passo_move_straight {
	int64_t  distance[PASSO_AXES_MAX]; /* Q31.32 mm: per axis, to the nearest step */
	uint64_t feed;                     /* UQ32.32 mm/s: along the path */
	struct passo_axis_limits limits[PASSO_AXES_MAX];
};

#endif
