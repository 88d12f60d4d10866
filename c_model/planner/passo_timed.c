/* SPDX-License-Identifier: MIT
 * Timed points. The substeps of a line are its time, so the line ends on its clock whatever its steps are.
 */
#include "passo_timed.h"

#include <string.h>

#include "passo_math.h"

#define ONE_Q32 (UINT64_C(1) << 32)

static uint64_t smaller(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static uint64_t larger(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

#ifdef PASSO_CARTESIAN
uint32_t passo_timed_motors(const struct passo_path_settings *settings)
{
	return settings->machine.axes;
}

static uint32_t axis_of(const struct passo_path_settings *settings, uint32_t motor)
{
	(void)settings;
	return motor;
}

static bool is_mixed(const struct passo_path_settings *settings, uint32_t motor)
{
	(void)settings, (void)motor;
	return false;
}

static bool has_motors(const struct passo_path_settings *settings)
{
	(void)settings;
	return true;
}

static int64_t motor_place(const struct passo_path_settings *settings, uint32_t motor, const int64_t *axes)
{
	(void)settings;
	return axes[motor];
}

static int64_t axis_place(
    const struct passo_path_settings *settings, uint32_t axis, const int32_t *places, uint32_t *parts)
{
	(void)settings, (void)parts;
	return places[axis];
}

static struct passo_path_axis limits_of(const struct passo_path_settings *settings, uint32_t motor)
{
	return settings->axis[motor];
}
#else
uint32_t passo_timed_motors(const struct passo_path_settings *settings)
{
	return settings->motors.count > 0 ? settings->motors.count : settings->machine.axes;
}

static uint32_t axis_of(const struct passo_path_settings *settings, uint32_t motor)
{
	return settings->motors.count > 0 ? passo_motor_axis(&settings->motors, motor) : motor;
}

static bool is_mixed(const struct passo_path_settings *settings, uint32_t motor)
{
	return settings->motors.count > 0 && passo_motor_is_mixed(&settings->motors, motor);
}

static bool has_motors(const struct passo_path_settings *settings)
{
	return passo_motors_fit(&settings->motors, settings->machine.axes);
}

static int64_t motor_place(const struct passo_path_settings *settings, uint32_t motor, const int64_t *axes)
{
	return passo_motor_place(&settings->motors, motor, axes);
}

static int64_t axis_place(
    const struct passo_path_settings *settings, uint32_t axis, const int32_t *places, uint32_t *parts)
{
	return passo_axis_place(&settings->motors, axis, places, parts);
}

/* Of a motor that moves two axes, in mm of the motor: given, or that of the larger one. */
static struct passo_path_axis limits_of(const struct passo_path_settings *settings, uint32_t motor)
{
	const struct passo_path_axis *given = &settings->mixed;
	struct passo_path_axis found = {0};

	for (uint32_t axis = 0; axis < settings->machine.axes; axis++) {
		const struct passo_path_axis *own = &settings->axis[axis];
		if (((settings->motors.plus[motor] | settings->motors.minus[motor]) >> axis & 1u) == 0u)
			continue;
		found.speed = larger(found.speed, own->speed);
		found.acceleration = larger(found.acceleration, own->acceleration);
		found.jump = larger(found.jump, own->jump);
	}
	found.speed = given->speed > 0 ? given->speed : found.speed;
	found.acceleration = given->acceleration > 0 ? given->acceleration : found.acceleration;
	found.jump = given->jump > 0 ? given->jump : found.jump;
	return found;
}
#endif

enum passo_timed_error passo_timed_open(
    struct passo_timed *timed, const struct passo_path_settings *settings, const int32_t *positions)
{
	const struct passo_machine *machine = &settings->machine;

	if (machine->clock_hz == 0 || machine->axes == 0 || machine->axes > PASSO_AXES_MAX
	    || !has_motors(settings))
		return PASSO_TIMED_SETTINGS;
	*timed = (struct passo_timed){.settings = settings};
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		uint32_t parts = 1;
		const int64_t steps = axis_place(settings, axis, positions, &parts);
		const uint64_t scale = settings->axis[axis].steps_per_mm;
		const uint64_t size =
		    passo_divide((struct passo_u128){passo_size64(steps), 0}, scale * parts, NULL);

		if (scale == 0)
			return PASSO_TIMED_SETTINGS;
		timed->target[axis] = steps < 0 ? -(int64_t)smaller(size, PASSO_PATH_TARGET_MAX)
		                                : (int64_t)smaller(size, PASSO_PATH_TARGET_MAX);
	}
	for (uint32_t motor = 0; motor < passo_timed_motors(settings); motor++)
		timed->steps[motor] = positions[motor];
	return PASSO_TIMED_OK;
}

/* mm/s, Q31.32, of a way in mm, Q31.32; saturates. */
static int64_t speed_of(const struct passo_timed *timed, int64_t way, uint64_t clocks)
{
	const uint64_t size =
	    smaller(passo_mul_div(passo_size64(way), timed->settings->machine.clock_hz, clocks), INT64_MAX);

	return way < 0 ? -(int64_t)size : (int64_t)size;
}

/* By how much a speed may be off because times and targets are rounded: a time by a clock at each end. */
static uint64_t rounding(const struct passo_timed *timed, int64_t speed, uint64_t clocks)
{
	return clocks == 0 ? 0 : (2u * passo_size64(speed) + timed->settings->machine.clock_hz) / clocks + 1u;
}

/* From one speed to another, with these intervals on both sides. */
static bool can_change(const struct passo_timed *timed, const struct passo_path_axis *limits, int64_t from,
    int64_t to, uint64_t before, uint64_t after)
{
	const bool same_way = (from < 0) == (to < 0);
	const uint64_t a = passo_size64(from), b = passo_size64(to);
	const uint64_t change = same_way ? larger(a, b) - smaller(a, b) : a + b;
	const uint64_t slack = rounding(timed, from, before) + rounding(timed, to, after);
	/* UQ32.32 mm/s; intervals are rounded */
	const uint64_t in_time = passo_mul_div(limits->acceleration, before + after + 2u * PASSO_TIMED_GRAIN,
	    (uint64_t)timed->settings->machine.clock_hz * 2u);
	const struct passo_u128 square =
	    passo_multiply(limits->acceleration, timed->settings->junction_deviation);
	const uint64_t at_corner = passo_isqrt128(passo_u128_shift_left(square, 3));

	return change <= larger(limits->jump, smaller(in_time, at_corner)) + slack;
}

static const struct passo_path_axis *row(
    const struct passo_timed *timed, uint32_t number, struct passo_path_axis *mixed)
{
	const struct passo_path_settings *settings = timed->settings;

	if (number < settings->machine.axes)
		return &settings->axis[number];
	if (!is_mixed(settings, number - settings->machine.axes))
		return NULL;
	*mixed = limits_of(settings, number - settings->machine.axes);
	return mixed;
}

static enum passo_timed_error check_speeds(struct passo_timed *timed, const int64_t *speed, uint64_t interval)
{
	for (uint32_t i = 0; i < timed->settings->machine.axes + passo_timed_motors(timed->settings); i++) {
		struct passo_path_axis mixed;
		const struct passo_path_axis *limits = row(timed, i, &mixed);

		timed->axis = (uint8_t)i;
		if (!limits)
			continue;
		if (passo_size64(speed[i]) > limits->speed + rounding(timed, speed[i], interval))
			return PASSO_TIMED_SPEED;
		if (!can_change(timed, limits, timed->speed[i], speed[i], timed->interval, interval))
			return PASSO_TIMED_ACCELERATION;
	}
	return PASSO_TIMED_OK;
}

/* Steps of a motor at a place, to nearest; false: out of range. */
static bool steps_at(const struct passo_timed *timed, uint32_t motor, const int64_t *target, int32_t *steps)
{
	const struct passo_path_settings *settings = timed->settings;
	const int64_t place = motor_place(settings, motor, target);
	const struct passo_u128 product = passo_u128_add(
	    passo_multiply(passo_size64(place), settings->axis[axis_of(settings, motor)].steps_per_mm),
	    (struct passo_u128){0, UINT64_C(1) << 63});

	if (product.high > INT32_MAX)
		return false;
	*steps = place < 0 ? -(int32_t)product.high : (int32_t)product.high;
	return true;
}

static enum passo_timed_error make_line(struct passo_timed *timed, const int64_t *target, uint64_t interval,
    int32_t *steps, struct passo_line *line)
{
	*line = (struct passo_line){.substeps = (uint32_t)(interval / PASSO_TIMED_GRAIN)};
	for (uint32_t motor = 0; motor < passo_timed_motors(timed->settings); motor++) {
		timed->axis = (uint8_t)(timed->settings->machine.axes + motor);
		if (!steps_at(timed, motor, target, &steps[motor]))
			return PASSO_TIMED_FAR;
		const int64_t way = (int64_t)steps[motor] - timed->steps[motor];
		if (passo_size64(way) > line->substeps)
			return PASSO_TIMED_STEPS;
		line->steps[motor] = (uint32_t)passo_size64(way);
		line->directions |= (uint8_t)((way < 0) << motor);
	}
	return PASSO_TIMED_OK;
}

enum passo_timed_error passo_timed_add(
    struct passo_timed *timed, const struct passo_timed_point *point, struct passo_line *line)
{
	const uint32_t axes = timed->settings->machine.axes;
	const uint64_t clocks = passo_timed_clocks(point);
	int64_t way[PASSO_AXES_MAX] = {0}, speed[PASSO_TIMED_ROWS] = {0};
	int32_t steps[PASSO_AXES_MAX] = {0};
	struct passo_line made;

	timed->axis = 0;
	if (point->clocks > INT64_MAX || clocks <= timed->clocks)
		return PASSO_TIMED_ORDER;
	const uint64_t interval = clocks - timed->clocks;
	if (interval / PASSO_TIMED_GRAIN > PASSO_SUBSTEPS_MAX)
		return PASSO_TIMED_LONG;
	for (uint32_t axis = 0; axis < axes; axis++) {
		timed->axis = (uint8_t)axis;
		if (passo_size64(point->target[axis]) > PASSO_PATH_TARGET_MAX >> 2) /* a motor moves two */
			return PASSO_TIMED_FAR;
		way[axis] = point->target[axis] - timed->target[axis];
	}
	for (uint32_t axis = 0; axis < axes; axis++)
		speed[axis] = speed_of(timed, way[axis], interval);
	for (uint32_t motor = 0; motor < passo_timed_motors(timed->settings); motor++)
		speed[axes + motor] = speed_of(timed, motor_place(timed->settings, motor, way), interval);
	enum passo_timed_error error = check_speeds(timed, speed, interval);
	if (error == PASSO_TIMED_OK)
		error = make_line(timed, point->target, interval, steps, &made);
	if (error != PASSO_TIMED_OK)
		return error;
	timed->clocks = clocks;
	timed->interval = interval;
	memcpy(timed->target, point->target, sizeof timed->target);
	memcpy(timed->steps, steps, sizeof timed->steps);
	memcpy(timed->speed, speed, sizeof timed->speed);
	*line = made;
	return PASSO_TIMED_OK;
}

enum passo_timed_error passo_timed_end(struct passo_timed *timed)
{
	static const int64_t REST[PASSO_TIMED_ROWS];

	return timed->clocks == 0 ? PASSO_TIMED_NO_POINTS : check_speeds(timed, REST, 0);
}

const char *passo_timed_error_text(enum passo_timed_error error)
{
	static const char *const TEXTS[] = {
	    [PASSO_TIMED_OK] = "no error",
	    [PASSO_TIMED_ORDER] = "its time must be above that of the point before",
	    [PASSO_TIMED_LONG] = "it must be less than 2^31 clocks after the point before",
	    [PASSO_TIMED_FAR] = "it is out of range",
	    [PASSO_TIMED_SPEED] = "the way to it is faster than the speed of the axis",
	    [PASSO_TIMED_ACCELERATION] =
		("the speed changes by more than the acceleration allows: give points "
		 "closer together, or more time"),
	    [PASSO_TIMED_STEPS] = "the way to it needs more than a step in two clocks",
	    [PASSO_TIMED_PINS] = "the way to it needs steps faster than the pin timing allows",
	    [PASSO_TIMED_SETTINGS] = "axes, clock or motors are not possible",
	    [PASSO_TIMED_NO_POINTS] = "there is no point",
	};

	return (unsigned)error < sizeof TEXTS / sizeof *TEXTS ? TEXTS[error] : "unknown error";
}
