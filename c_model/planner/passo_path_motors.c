/* SPDX-License-Identifier: MIT
 * What the settings of a path say of the motors.
 */
#include "passo_path_private.h"

#ifndef PASSO_CARTESIAN
static uint32_t last_axis_of(const struct passo_motors *motors, uint32_t motor)
{
	return passo_bits((struct passo_u128){0, motors->plus[motor] | motors->minus[motor]}) - 1;
}

/* What two axes allow of a motor, or its own limit, along the direction between them. */
static uint64_t along(uint64_t given, uint64_t one, uint64_t other)
{
	const uint64_t limit = given > 0 ? given : passo_path_larger(one, other);

	return passo_mul_shift(limit, PASSO_PATH_HALF_ROOT, PASSO_PATH_UNIT_BITS);
}

const struct passo_path_axis *passo_path_motor_limits(
    const struct passo_path_settings *settings, uint32_t motor, struct passo_path_axis *mixed)
{
	const struct passo_motors *motors = &settings->motors;
	const struct passo_path_axis *given = &settings->mixed;

	if (motors->count == 0)
		return &settings->axis[motor];
	const struct passo_path_axis *one = &settings->axis[passo_motor_axis(motors, motor)];
	const struct passo_path_axis *other = &settings->axis[last_axis_of(motors, motor)];
	if (one == other)
		return one;
	*mixed = (struct passo_path_axis){
	    .speed = along(given->speed, one->speed, other->speed),
	    .acceleration = along(given->acceleration, one->acceleration, other->acceleration),
	    .jerk = along(given->jerk, one->jerk, other->jerk),
	    .jump = along(given->jump, one->jump, other->jump),
	};
	return mixed;
}

bool passo_path_has_motors(const struct passo_path_settings *settings)
{
	const struct passo_motors *motors = &settings->motors;
	uint32_t rows = settings->machine.axes;

	if (!passo_motors_fit(motors, rows) || motors->count > PASSO_PATH_AXES_MAX)
		return false;
	for (uint32_t motor = 0; motor < motors->count; motor++) {
		rows += passo_motor_is_mixed(motors, motor);
		if (settings->axis[passo_motor_axis(motors, motor)].steps_per_mm
		    != settings->axis[last_axis_of(motors, motor)].steps_per_mm)
			return false;
	}
	return rows <= PASSO_PATH_AXES_MAX;
}

uint64_t passo_path_mixed_acceleration(const struct passo_path_planner *path, uint64_t acceleration)
{
	const uint32_t hz = path->machine.clock_hz;

	for (uint32_t row = path->machine.axes; row < path->rows; row++) {
		const uint64_t clocks =
		    passo_mul_div(path->axis[row].acceleration, hz, path->substeps_per_mm);

		acceleration = passo_path_smaller(acceleration, passo_mul_div(clocks, hz, PASSO_UNIT_Q32));
	}
	return acceleration;
}
#endif
