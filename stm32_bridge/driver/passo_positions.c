/* SPDX-License-Identifier: MIT
 * Positions: read and set, in steps and units, and where the queued motions end.
 */
#include "passo_driver.h"
#include "passo_math.h"

#define LOOKS_AT_REST 2u /* consecutive */

enum passo_error passo_positions(struct passo *passo, int32_t *steps)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!steps)
		return PASSO_ERROR_ARGUMENT_POINTER;
	error = passo_driver_positions(passo, steps, false);
	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++)
		steps[i] = passo_driver_offset(passo, i, steps[i]);
	return error;
}

int64_t passo_driver_units(int32_t steps, uint64_t scale)
{
	const uint64_t size = steps < 0 ? 0u - (uint64_t)steps : (uint64_t)steps;
	const struct passo_u128 half = {0, scale / 2u};
	uint64_t units = passo_divide(passo_u128_add((struct passo_u128){size, 0}, half), scale, NULL);

	if (scale == 0u || units > INT64_MAX)
		return PASSO_NO_UNITS;
	return steps < 0 ? -(int64_t)units : (int64_t)units;
}

enum passo_error passo_positions_units(struct passo *passo, int32_t *steps, int64_t *units)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_OK && !units)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_positions(passo, positions);
	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++) {
		units[i] = passo_driver_units(positions[i], passo->axis[i].steps_per_unit);
		if (steps)
			steps[i] = positions[i];
	}
	return error;
}

enum passo_error passo_to_units(const struct passo *passo, uint8_t axis, int32_t steps, int64_t *units)
{
	enum passo_error error = passo_driver_check_axis(passo, axis);

	if (error != PASSO_OK)
		return error;
	if (!units)
		return PASSO_ERROR_ARGUMENT_POINTER;
	const int64_t found = passo_driver_units(steps, passo->axis[axis].steps_per_unit);
	if (found == PASSO_NO_UNITS)
		return PASSO_ERROR_UNITS;
	*units = found;
	return PASSO_OK;
}

enum passo_error passo_position_units(struct passo *passo, uint8_t axis, int64_t *units)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_check_axis(passo, axis);

	if (error == PASSO_OK && !units)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_positions(passo, positions);
	return error != PASSO_OK ? error : passo_to_units(passo, axis, positions[axis], units);
}

enum passo_error passo_target(const struct passo *passo, int32_t *steps)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!steps)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (passo_driver_is_broken(passo))
		return PASSO_ERROR_BROKEN;
	if (passo_driver_is_stopped(passo))
		return PASSO_ERROR_STOPPED;
	if (passo->expects > PASSO_EXPECT_POSITIONS)
		return PASSO_ERROR_MOVING;
	for (unsigned i = 0; i < passo->axes; i++)
		steps[i] = passo_driver_offset(passo, i, passo->axis[i].expected);
	return PASSO_OK;
}

enum passo_error passo_distance_to_go(struct passo *passo, int32_t *steps)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_target(passo, steps);

	if (error == PASSO_OK)
		error = passo_positions(passo, positions);
	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++)
		steps[i] = (int32_t)((uint32_t)steps[i] - (uint32_t)positions[i]);
	return error;
}

enum passo_error passo_set_position(struct passo *passo, uint8_t axis, int32_t steps)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_check_axis(passo, axis);

	for (unsigned looks = 0; error == PASSO_OK && looks < LOOKS_AT_REST; looks++)
		error = passo_driver_ready(passo, true);
	if (error == PASSO_OK)
		error = passo_driver_positions(passo, positions, false);
	if (error == PASSO_OK)
		passo->axis[axis].offset = (uint32_t)steps - (uint32_t)positions[axis];
	return error;
}

enum passo_error passo_zero(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_OK)
		error = passo_driver_ready(passo, true);
	if (error != PASSO_OK)
		return error;
	error = passo_driver_command(passo, (struct passo_channel_command){.zero = true});
	if (passo_driver_is_link_error(error)) {
		passo->expects = PASSO_EXPECT_END; /* the next polls read the positions */
		passo->zero_due = true;
	}
#ifndef PASSO_WITHOUT_TRACKERS
	if (error == PASSO_OK || passo->zero_due)
		passo->tracked = passo->parked = 0;
	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++)
		passo->axis[i].tracked_from = 0;
#endif
	if (error != PASSO_OK)
		return passo_driver_moving(error);
	const int32_t zeros[PASSO_AXES_MAX] = {0};
	for (unsigned i = 0; i < passo->axes; i++)
		passo->axis[i].offset = 0;
	passo_driver_ended(passo, zeros);
	return PASSO_OK;
}
