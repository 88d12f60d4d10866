/* SPDX-License-Identifier: MIT
 * Moves of several axes: a trapezoid of the axis with the most steps, and straight lines within the limits of
 * each axis.
 */
#include "passo_math.h"
#include "passo_plan_draft.h"

enum passo_plan_error passo_plan_axes(
    const struct passo_machine *machine, const struct passo_move_axes *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, PASSO_PROFILE_LINEAR);
	if (error != PASSO_PLAN_OK)
		return error;
	const struct passo_limits limits = {
	    .start_speed = move->start_speed,
	    .speed = move->speed,
	    .stop_speed = move->start_speed,
	    .up = {.ramp_clocks = move->ramp_clocks},
	    .down = {.ramp_clocks = move->ramp_clocks},
	};
	return passo_draft_by_speed(&draft, &limits, plan);
}

/* ------------------------------------------------------------------------------------ straight lines ---- */

static uint64_t absolute(int64_t value)
{
	return value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
}

int64_t passo_steps_of_length(int64_t length, uint64_t steps_per_mm)
{
	struct passo_u128 exact = passo_multiply(absolute(length), steps_per_mm); /* UQ64.64, below 2^63 */
	int64_t steps = (int64_t)passo_smaller(exact.high + (exact.low >> 63), UINT32_MAX);
	return length < 0 ? -steps : steps;
}

/* Length of the path in millimeters, UQ32.32, rounded up to a few units; saturates. */
static uint64_t length_of(const struct passo_machine *machine, const int64_t *distance)
{
	/* Two bits fewer, so that the sum of eight squares does not overflow. */
	struct passo_u128 sum = {0, 0};
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		uint64_t quarter = (absolute(distance[axis]) + 3) / 4;
		sum = passo_u128_add(sum, passo_multiply(quarter, quarter));
	}
	uint64_t root = passo_isqrt128(sum) + 1;
	return root < UINT64_MAX / 4 ? root * 4 : UINT64_MAX;
}

/* Converts the limit of an axis into a limit of the axis with the most steps. */
static uint64_t limit_of_lead(uint64_t limit, uint64_t steps_per_mm, uint32_t lead, uint32_t steps)
{
	return passo_mul_div(passo_mul_div(limit, steps_per_mm, PASSO_UNIT_Q32), lead, steps);
}

static uint32_t check_axes(const struct passo_machine *machine, const struct passo_move_straight *move)
{
	if (machine->axes < 1 || machine->axes > PASSO_AXES_MAX)
		return PASSO_PLAN_BAD_AXES;
	if (move->feed == 0)
		return PASSO_PLAN_NO_FEED;
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		if (move->distance[axis] == 0)
			continue;
		if (move->limits[axis].steps_per_mm == 0)
			return PASSO_PLAN_NO_SCALE;
		if (move->limits[axis].speed == 0)
			return PASSO_PLAN_NO_AXIS_SPEED;
		if (move->limits[axis].acceleration == 0)
			return PASSO_PLAN_NO_AXIS_ACCELERATION;
		int64_t steps = passo_steps_of_length(move->distance[axis], move->limits[axis].steps_per_mm);
		if (steps < -(int64_t)PASSO_SUBSTEPS_MAX || steps > (int64_t)PASSO_SUBSTEPS_MAX)
			return PASSO_PLAN_TOO_MANY_STEPS;
	}
	return PASSO_PLAN_OK;
}

enum passo_plan_error passo_plan_straight(
    const struct passo_machine *machine, const struct passo_move_straight *move, struct passo_plan *plan)
{
	uint32_t refused = check_axes(machine, move);
	if (refused != PASSO_PLAN_OK)
		return refused;
	int32_t steps[PASSO_AXES_MAX] = {0};
	for (uint32_t axis = 0; axis < machine->axes; axis++)
		steps[axis] =
		    (int32_t)passo_steps_of_length(move->distance[axis], move->limits[axis].steps_per_mm);

	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, steps, PASSO_PROFILE_LINEAR);
	if (error != PASSO_PLAN_OK)
		return error;

	uint64_t length = length_of(machine, move->distance);
	uint64_t speed = passo_mul_div(move->feed, draft.longest * PASSO_UNIT_Q32, length);
	struct passo_rise rise = {.acceleration = UINT64_MAX};
	uint64_t jerk = UINT64_MAX;
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		const struct passo_axis_limits *own = &move->limits[axis];
		uint32_t count = steps[axis] < 0 ? 0u - (uint32_t)steps[axis] : (uint32_t)steps[axis];
		if (count == 0)
			continue;
		speed =
		    passo_smaller(speed, limit_of_lead(own->speed, own->steps_per_mm, draft.longest, count));
		rise.acceleration = passo_smaller(rise.acceleration,
		    limit_of_lead(own->acceleration, own->steps_per_mm, draft.longest, count));
		if (own->jerk == 0)
			continue;
		draft.profile = PASSO_PROFILE_JERK;
		jerk = passo_smaller(jerk, limit_of_lead(own->jerk, own->steps_per_mm, draft.longest, count));
	}
	if (draft.profile == PASSO_PROFILE_JERK) {
		if (jerk == 0)
			return PASSO_PLAN_NO_JERK;
		rise.jerk = jerk;
		draft.shape = PASSO_SHAPE_EASE;
	}
	const struct passo_limits limits = {.speed = speed, .up = rise, .down = rise};
	return passo_draft_by_speed(&draft, &limits, plan);
}
