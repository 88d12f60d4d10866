/* SPDX-License-Identifier: MIT
 * The columns of a map are orthogonal, so that its inverse is its transpose, divided by the motors of an
 * axis.
 */
#include "passo_motors.h"

#ifndef PASSO_CARTESIAN

/* -1, 0, 1 */
static int32_t entry(const struct passo_motors *motors, uint32_t motor, uint32_t axis)
{
	return (int32_t)(motors->plus[motor] >> axis & 1u) - (int32_t)(motors->minus[motor] >> axis & 1u);
}

static uint32_t count_bits(uint32_t bits)
{
	uint32_t count = 0;

	for (; bits > 0; bits &= bits - 1)
		count++;
	return count;
}

bool passo_motors_fit(const struct passo_motors *motors, uint32_t axes)
{
	if (motors->count == 0)
		return true;
	if (motors->count < axes || motors->count > PASSO_AXES_MAX)
		return false;
	for (uint32_t motor = 0; motor < motors->count; motor++) {
		const uint32_t both = motors->plus[motor] | motors->minus[motor];
		const uint32_t moved = count_bits(motors->plus[motor]) + count_bits(motors->minus[motor]);

		if (both >> axes != 0 || moved < 1 || moved > 2 || moved != count_bits(both)
		    || (motor < axes && (both >> motor & 1u) == 0))
			return false;
	}
	for (uint32_t axis = 0; axis < axes; axis++) {
		for (uint32_t other = 0; other <= axis; other++) {
			int32_t product = 0;

			for (uint32_t motor = 0; motor < motors->count; motor++)
				product += entry(motors, motor, axis) * entry(motors, motor, other);
			if ((product != 0) != (axis == other))
				return false;
		}
	}
	return true;
}

int64_t passo_motor_place(const struct passo_motors *motors, uint32_t motor, const int64_t *axes)
{
	int64_t sum = 0;

	if (motors->count == 0)
		return axes[motor];
	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		const int32_t sign = entry(motors, motor, axis);

		if (sign != 0)
			sum += sign * axes[axis];
	}
	return sum;
}

int64_t passo_axis_place(
    const struct passo_motors *motors, uint32_t axis, const int32_t *places, uint32_t *parts)
{
	int64_t sum = 0;

	*parts = 1;
	if (motors->count == 0)
		return places[axis];
	*parts = 0;
	for (uint32_t motor = 0; motor < motors->count; motor++) {
		const int32_t sign = entry(motors, motor, axis);

		sum += (int64_t)sign * places[motor];
		*parts += sign != 0;
	}
	return sum;
}

uint32_t passo_motor_axis(const struct passo_motors *motors, uint32_t motor)
{
	uint32_t axis = 0;

	while (entry(motors, motor, axis) == 0)
		axis++;
	return axis;
}

bool passo_motor_is_mixed(const struct passo_motors *motors, uint32_t motor)
{
	return motors->count > 0 && count_bits(motors->plus[motor] | motors->minus[motor]) > 1;
}

uint8_t passo_motors_of(const struct passo_motors *motors, uint32_t axes, uint32_t axis)
{
	uint8_t own = (uint8_t)(1u << axis);

	for (uint32_t motor = axes; motor < motors->count; motor++) {
		if (entry(motors, motor, axis) != 0)
			own |= (uint8_t)(1u << motor);
	}
	return own;
}

#endif
