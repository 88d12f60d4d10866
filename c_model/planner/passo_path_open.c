/* SPDX-License-Identifier: MIT
 * Opening a path: the scale of the substeps, and the limits of the axes in substeps and clocks.
 *
 * A substep is the same length everywhere on the path: as short as half, or better a quarter, of a substep
 * per clock allows at the highest speed that all axes together can reach, but not shorter than 2^-18 mm.
 */
#include <stddef.h>

#include "passo_path_private.h"
#include "passo_shapes.h"

/* Most substeps per mm, so that lines of four meters have less than 2^30. */
#define SUBSTEPS_PER_MM_MAX (UINT64_C(1) << 18)
/* Fewest substeps per step. */
#define OVERSAMPLING_MIN 2u
#define STEPS_PER_MM_MAX (UINT64_C(1) << (20 + 32))
/* Of the reserve, unless it is given. */
#define RESERVES_PER_SECOND 50u
/* Of the junction deviation is the tolerance, unless it is given. */
#define TOLERANCE_PART 20u
/* Of the feed, unless they are given. */
#define POLLS_PER_SECOND 500u
/* Of a core with 16 places for ramps, of which a frame takes half, and of 4 axes. */
#define PACED_RAMPS 8u
#define PACED_LINES 10u

/* Highest speed of a line on any axes, UQ32.32 mm/s; saturates. */
static uint64_t top_speed(const struct passo_path_settings *settings)
{
	struct passo_u128 sum = {0, 0};

	for (uint32_t axis = 0; axis < settings->machine.axes; axis++) {
		const uint64_t quarter =
		    settings->axis[axis].speed / 4 + 1; /* eight squares do not overflow */

		sum = passo_u128_add(sum, passo_multiply(quarter, quarter));
	}
	const uint64_t root = passo_isqrt128(sum) + 1;
	return root < UINT64_MAX / 4 ? root * 4 : UINT64_MAX;
}

/* Substeps per mm; 0: too fast for the clock. */
static uint32_t substeps_per_mm(const struct passo_path_settings *settings)
{
	const uint64_t speed = top_speed(settings);
	const uint64_t fastest = passo_mul_div(settings->machine.clock_hz, PASSO_UNIT_Q32 / 2, speed);
	uint64_t steps = 0;

	for (uint32_t axis = 0; axis < settings->machine.axes; axis++)
		steps = passo_path_larger(steps, settings->axis[axis].steps_per_mm);
#ifndef PASSO_CARTESIAN
	if (settings->motors.count > 0) /* a motor that moves two axes moves by up to sqrt(2) mm per mm */
		steps += steps / 2;
#endif
	const uint64_t least = (steps >> 32) * OVERSAMPLING_MIN + OVERSAMPLING_MIN;
	const uint64_t wanted = passo_path_smaller(fastest / 2, SUBSTEPS_PER_MM_MAX);
	return least > fastest ? 0 : (uint32_t)passo_path_larger(least, wanted);
}

static bool has_profile(enum passo_profile profile)
{
#ifdef PASSO_LINEAR_PATHS
	if (profile != PASSO_PROFILE_LINEAR)
		return false;
#endif
#ifdef PASSO_WITHOUT_JERK_PATHS
	if (profile == PASSO_PROFILE_JERK)
		return false;
#endif
	return (unsigned)profile < PASSO_PROFILE_COUNT;
}

static enum passo_plan_error check(const struct passo_path_settings *settings)
{
	const struct passo_machine *machine = &settings->machine;

	if (machine->clock_hz == 0 || machine->tick_log2 < PASSO_TICK_LOG2_MIN
	    || machine->tick_log2 > PASSO_TICK_LOG2_MAX)
		return PASSO_PLAN_BAD_CLOCK;
	if (machine->axes < 1 || machine->axes > PASSO_PATH_AXES_MAX)
		return PASSO_PLAN_BAD_AXES;
	if (!has_profile(settings->profile))
		return PASSO_PLAN_BAD_PROFILE;
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		const struct passo_path_axis *own = &settings->axis[axis];

		if (own->steps_per_mm == 0)
			return PASSO_PLAN_NO_SCALE;
		if (own->speed == 0)
			return PASSO_PLAN_NO_AXIS_SPEED;
		if (own->acceleration == 0)
			return PASSO_PLAN_NO_AXIS_ACCELERATION;
		if (own->jerk == 0 && settings->profile == PASSO_PROFILE_JERK)
			return PASSO_PLAN_NO_JERK;
		if (own->steps_per_mm > STEPS_PER_MM_MAX)
			return PASSO_PLAN_TOO_FAST;
	}
#ifndef PASSO_CARTESIAN
	if (!passo_path_has_motors(settings))
		return PASSO_PLAN_BAD_AXES;
#endif
	return PASSO_PLAN_OK;
}

/* Mean slope of a shape divided by its steepest, UQ0.16, rounded down: 2 / pi for a cosine. */
static uint32_t gentleness(enum passo_shape shape)
{
	uint32_t steepest = 1;

	if (shape == PASSO_SHAPE_LINEAR)
		return UINT32_C(1) << 16;
	for (uint32_t k = 1; k < PASSO_BANK_POINTS; k++) {
		const uint32_t rise =
		    passo_shape_point((unsigned)shape, k) - passo_shape_point((unsigned)shape, k - 1);
		steepest = rise > steepest ? rise : steepest;
	}
	return (UINT32_C(1) << 24) / (steepest + 1);
}

/* UQ0.64 substeps per clock^2, at least 1. */
static uint64_t acceleration_of(const struct passo_path_planner *path, uint64_t acceleration)
{
	const uint32_t hz = path->machine.clock_hz;
	const uint64_t gain = passo_mul_div(acceleration, path->substeps_per_mm, hz); /* UQ.32 per second */
	const uint64_t scaled = passo_mul_div(gain, PASSO_UNIT_Q32, hz);

	return passo_path_larger(1, passo_path_smaller(scaled, PASSO_PATH_SQUARE_MAX >> 2));
}

/* UQ0.80 substeps per clock^3, at least 1. */
static uint64_t jerk_of(const struct passo_path_planner *path, uint64_t jerk)
{
	const uint32_t hz = path->machine.clock_hz;
	uint64_t scaled = passo_mul_div(jerk, path->substeps_per_mm, hz); /* UQ.32 per second^2 */

	for (unsigned i = 0; i < 2; i++)
		scaled = passo_mul_div(scaled, UINT32_C(1) << 24, hz);
	return passo_path_larger(1, passo_path_smaller(scaled, PASSO_PATH_SQUARE_MAX));
}

static struct passo_path_scale scale_of(
    const struct passo_path_planner *path, const struct passo_path_axis *own)
{
	const uint32_t hz = path->machine.clock_hz;
	const uint64_t jump = passo_mul_div(own->jump, path->substeps_per_mm, hz);

	return (struct passo_path_scale){
	    .acceleration = acceleration_of(path, own->acceleration),
	    .jerk = jerk_of(path, own->jerk),
	    .speed = (uint32_t)passo_path_larger(1, passo_mul_div(own->speed, path->substeps_per_mm, hz)),
	    .jump = (uint32_t)passo_path_smaller(jump, UINT32_C(1) << 31),
	};
}

#ifndef PASSO_CARTESIAN
/* The motors: `steps_per_mm` of those behind the axes, and the rows of those that move two. */
static void set_motors(struct passo_path_planner *path, const struct passo_path_settings *settings)
{
	path->motors = settings->motors;
	path->rows = settings->machine.axes;
	for (uint32_t motor = 0; motor < settings->motors.count; motor++) {
		struct passo_path_axis mixed;

		path->steps_per_mm[motor] =
		    settings->axis[passo_motor_axis(&settings->motors, motor)].steps_per_mm;
		if (passo_path_motor_limits(settings, motor, &mixed) == &mixed)
			path->axis[path->rows++] = scale_of(path, &mixed);
	}
}
#endif

enum passo_plan_error passo_path_open(struct passo_path_planner *path,
    const struct passo_path_settings *settings, struct passo_path_item *items, uint32_t capacity)
{
	static const int32_t ORIGIN[PASSO_AXES_MAX];
	static const enum passo_shape SHAPES[] = {
	    [PASSO_PROFILE_LINEAR] = PASSO_SHAPE_LINEAR,
	    [PASSO_PROFILE_COSINE] = PASSO_SHAPE_COSINE,
	    [PASSO_PROFILE_SIGMOID] = PASSO_SHAPE_SIGMOID,
	    [PASSO_PROFILE_JERK] = PASSO_SHAPE_COSINE,
	};
	const enum passo_plan_error error = check(settings);

	if (error != PASSO_PLAN_OK)
		return error;
	if (capacity < PASSO_PATH_ITEMS_MIN)
		return PASSO_PLAN_PATH_FULL;
	const uint32_t scale = substeps_per_mm(settings);
	if (scale == 0)
		return PASSO_PLAN_TOO_FAST;
	const struct passo_machine *machine = &settings->machine;
	const uint32_t reserve =
	    settings->reserve_clocks > 0 ? settings->reserve_clocks : machine->clock_hz / RESERVES_PER_SECOND;
	*path = (struct passo_path_planner){
	    .machine = *machine,
	    .items = items,
	    .capacity = capacity,
	    .substeps_per_mm = scale,
	    .override = PASSO_PATH_OVERRIDE_MIN,
	    .rapid = PASSO_PATH_RAPID_FULL,
	    .deviation = passo_mul_div(settings->junction_deviation, scale, UINT32_C(1) << 16),
	    .reserve = (reserve >> machine->tick_log2) + 1,
	    .polls = settings->polls > 0 ? settings->polls : POLLS_PER_SECOND,
	    .unrounded = settings->unrounded,
	    .shape = SHAPES[settings->profile],
	    .soft = settings->profile == PASSO_PROFILE_JERK, /* see passo_path_is_soft() */
	};
	passo_path_tolerance(path,
	    settings->tolerance > 0 ? settings->tolerance : settings->junction_deviation / TOLERANCE_PART);
	path->own_tolerance = path->tolerance;
	path->gentleness = gentleness(passo_path_shape(path));
	path->acceleration = settings->acceleration > 0 ? acceleration_of(path, settings->acceleration)
	                                                : PASSO_PATH_SQUARE_MAX >> 2;
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		path->axis[axis] = scale_of(path, &settings->axis[axis]);
		path->steps_per_mm[axis] = settings->axis[axis].steps_per_mm;
	}
#ifndef PASSO_CARTESIAN
	set_motors(path, settings);
#endif
	passo_path_pace(path, PACED_RAMPS, UINT32_MAX, PACED_LINES);
	passo_path_restart(path, ORIGIN);
	return PASSO_PLAN_OK;
}

void passo_path_restart(struct passo_path_planner *path, const int32_t *positions)
{
	for (uint32_t motor = path->machine.axes; motor < passo_path_motors(path); motor++)
		path->at.steps[motor] = positions[motor];
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		uint32_t parts = 1;
		const int64_t steps = passo_path_axis_place(path, axis, positions, &parts);
		const uint64_t target =
		    passo_path_smaller(passo_divide((struct passo_u128){passo_size64(steps), 0},
					   path->steps_per_mm[axis] * parts, NULL),
			PASSO_PATH_TARGET_MAX);

		path->at.steps[axis] = positions[axis];
		path->at.target[axis] = steps < 0 ? -(int64_t)target : (int64_t)target;
	}
	path->sent = path->planned = path->added = path->final = 0;
	path->at.carry = 0;
	path->dwell = 0;
	path->rest = true;
	path->offset = 0;
	path->velocity = 0;
	path->at_rest = true;
	path->started = path->jump = path->last = path->lines_end = path->ramps_end = path->open = false;
	path->at.line_credit = 0;
	passo_path_pace_begin(path);
}
