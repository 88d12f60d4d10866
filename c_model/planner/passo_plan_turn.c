/* SPDX-License-Identifier: MIT
 * Rotation of one axis by angle and rpm, and continuous rotation.
 */
#include <stddef.h>

#include "passo_math.h"
#include "passo_plan_draft.h"

#define DEGREES_PER_TURN 360u
#define SECONDS_PER_MINUTE 60u

/* Steps per second, rounded down so that the rpm is not exceeded. */
static uint64_t speed_of(uint64_t rpm, uint32_t steps_per_turn)
{
	return passo_mul_div(rpm, steps_per_turn, SECONDS_PER_MINUTE);
}

enum passo_plan_error passo_plan_turn(
    const struct passo_machine *machine, const struct passo_move_turn *move, struct passo_plan *plan)
{
	if (move->axis >= machine->axes || move->axis >= PASSO_AXES_MAX)
		return PASSO_PLAN_BAD_AXIS;
	if (move->steps_per_turn == 0)
		return PASSO_PLAN_NO_STEPS_PER_TURN;
	if (move->minimum_rpm > move->rpm)
		return PASSO_PLAN_MINIMUM_ABOVE_SPEED;

	int64_t count = passo_steps_of_angle(move->angle, move->steps_per_turn);
	if (count < -(int64_t)PASSO_SUBSTEPS_MAX || count > (int64_t)PASSO_SUBSTEPS_MAX)
		return PASSO_PLAN_TOO_MANY_STEPS;
	int32_t steps[PASSO_AXES_MAX] = {0};
	steps[move->axis] = (int32_t)count;

	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, steps, PASSO_PROFILE_LINEAR);
	if (error != PASSO_PLAN_OK)
		return error;
	const struct passo_rise rise = {.acceleration = move->acceleration};
	uint64_t minimum = speed_of(move->minimum_rpm, move->steps_per_turn);
	const struct passo_limits limits = {
	    .start_speed = minimum,
	    .speed = speed_of(move->rpm, move->steps_per_turn),
	    .stop_speed = minimum,
	    .up = rise,
	    .down = rise,
	};
	return passo_draft_by_speed(&draft, &limits, plan);
}

/* ------------------------------------------------------------------------------- continuous rotation ---- */

/* Checks common to the three plans. The draft has a single step, which defines its oversampling. */
static uint32_t start_turning(struct passo_draft *draft, int32_t steps[PASSO_AXES_MAX],
    const struct passo_machine *machine, const struct passo_turning *turning)
{
	if (turning->axis >= machine->axes || turning->axis >= PASSO_AXES_MAX)
		return PASSO_PLAN_BAD_AXIS;
	if (turning->steps_per_turn == 0)
		return PASSO_PLAN_NO_STEPS_PER_TURN;
	steps[turning->axis] = turning->backward ? -1 : 1;
	enum passo_plan_error error = passo_draft_start(draft, machine, steps, PASSO_PROFILE_LINEAR);
	if (error != PASSO_PLAN_OK)
		return error;
	uint64_t top = speed_of(turning->top_rpm, turning->steps_per_turn);
	if (top == 0)
		return PASSO_PLAN_NO_SPEED;
	if (passo_draft_oversample(draft, top) == 0)
		return PASSO_PLAN_TOO_FAST;
	return turning->acceleration > 0 ? PASSO_PLAN_OK : PASSO_PLAN_NO_ACCELERATION;
}

static uint64_t velocity_of(
    const struct passo_draft *draft, const struct passo_turning *turning, uint64_t rpm)
{
	return passo_draft_velocity(draft, speed_of(rpm, turning->steps_per_turn));
}

/* Adds the ramp between two velocities; its time is rounded up to ticks. */
static uint32_t add_change(struct passo_plan *plan, const struct passo_draft *draft,
    const struct passo_turning *turning, uint64_t from, uint64_t to)
{
	const struct passo_machine *machine = draft->machine;
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	uint64_t change = from < to ? to - from : from - to;
	uint64_t speed = passo_mul_div_ceil(change, machine->clock_hz, units * draft->oversampling);
	uint64_t clocks = passo_mul_div_ceil(speed, machine->clock_hz, turning->acceleration);
	uint64_t ticks = passo_ticks_ceil(machine, clocks);
	if (ticks > UINT32_MAX)
		return PASSO_PLAN_TOO_LONG;
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, to, ticks);
	if (from < to)
		plan->accelerate_ticks = (uint32_t)ticks;
	else
		plan->decelerate_ticks = (uint32_t)ticks;
	return PASSO_PLAN_OK;
}

/* The same for a plan that leads to an rpm. */
static uint32_t start_turning_at(struct passo_draft *draft, int32_t steps[PASSO_AXES_MAX],
    const struct passo_machine *machine, const struct passo_turning *turning, uint64_t rpm)
{
	const uint32_t refused = start_turning(draft, steps, machine, turning);
	if (refused != PASSO_PLAN_OK)
		return refused;
	if (speed_of(rpm, turning->steps_per_turn) == 0)
		return PASSO_PLAN_NO_SPEED;
	if (rpm < turning->minimum_rpm)
		return PASSO_PLAN_BELOW_MINIMUM;
	return rpm > turning->top_rpm ? PASSO_PLAN_ABOVE_TOP : PASSO_PLAN_OK;
}

enum passo_plan_error passo_plan_turning_start(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t rpm, struct passo_plan *plan)
{
	struct passo_draft draft;
	int32_t steps[PASSO_AXES_MAX] = {0};
	uint32_t refused = start_turning_at(&draft, steps, machine, turning, rpm);
	if (refused != PASSO_PLAN_OK)
		return refused;

	/* the longest line possible, so that it seldom repeats */
	uint32_t count = PASSO_SUBSTEPS_MAX / draft.oversampling;
	struct passo_plan made = {
	    .line = {.endless = true, .substeps = count * draft.oversampling},
	    .oversampling = draft.oversampling,
	    .velocity_start = velocity_of(&draft, turning, turning->minimum_rpm),
	    .velocity_peak = velocity_of(&draft, turning, rpm),
	};
	made.line.steps[turning->axis] = count;
	made.line.directions = (uint8_t)(turning->backward ? 1u << turning->axis : 0u);
	if (made.velocity_start > 0)
		passo_plan_add_ramp(&made, PASSO_SHAPE_LINEAR, false, made.velocity_start, 0);
	refused = add_change(&made, &draft, turning, made.velocity_start, made.velocity_peak);
	if (refused == PASSO_PLAN_OK)
		*plan = made;
	return refused;
}

enum passo_plan_error passo_plan_turning_speed(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t velocity, uint64_t rpm, struct passo_plan *plan)
{
	struct passo_draft draft;
	int32_t steps[PASSO_AXES_MAX] = {0};
	uint32_t refused = start_turning_at(&draft, steps, machine, turning, rpm);
	if (refused != PASSO_PLAN_OK)
		return refused;
	if (velocity > velocity_of(&draft, turning, turning->top_rpm))
		return PASSO_PLAN_ABOVE_TOP;

	struct passo_plan made = {
	    .oversampling = draft.oversampling,
	    .velocity_start = velocity,
	    .velocity_peak = velocity_of(&draft, turning, rpm),
	};
	refused = add_change(&made, &draft, turning, velocity, made.velocity_peak);
	made.ramps[0].now = true;
	if (refused == PASSO_PLAN_OK)
		*plan = made;
	return refused;
}

enum passo_plan_error passo_plan_turning_stop(const struct passo_machine *machine,
    const struct passo_turning *turning, uint64_t velocity, struct passo_plan *plan)
{
	struct passo_draft draft;
	int32_t steps[PASSO_AXES_MAX] = {0};
	uint32_t refused = start_turning(&draft, steps, machine, turning);
	if (refused != PASSO_PLAN_OK)
		return refused;
	if (velocity > velocity_of(&draft, turning, turning->top_rpm))
		return PASSO_PLAN_ABOVE_TOP;

	struct passo_plan made = {
	    .oversampling = draft.oversampling,
	    .velocity_start = velocity,
	    .velocity_peak = velocity,
	    .velocity_stop = passo_smaller(velocity, velocity_of(&draft, turning, turning->minimum_rpm)),
	};
	if (velocity > made.velocity_stop)
		refused = add_change(&made, &draft, turning, velocity, made.velocity_stop);
	if (made.ramp_count == 0 || made.velocity_stop > 0)
		passo_plan_add_ramp(&made, PASSO_SHAPE_LINEAR, false, 0, 0);
	made.ramps[0].now = true;
	made.ramps[made.ramp_count - 1].last = true;
	if (refused == PASSO_PLAN_OK)
		*plan = made;
	return refused;
}

/* -------------------------------------------------------------------------------------- conversion ---- */

int64_t passo_steps_of_angle(int64_t angle, uint32_t steps_per_turn)
{
	const uint64_t turn = DEGREES_PER_TURN * PASSO_UNIT_Q32;
	struct passo_u128 product =
	    passo_multiply(angle < 0 ? 0 - (uint64_t)angle : (uint64_t)angle, steps_per_turn);
	uint64_t count = passo_divide(passo_u128_add(product, (struct passo_u128){0, turn / 2}), turn, NULL);
	int64_t steps = (int64_t)passo_smaller(count, UINT32_MAX);
	return angle < 0 ? -steps : steps;
}

int64_t passo_angle_of(int32_t position, uint32_t steps_per_turn)
{
	uint64_t count = position < 0 ? 0 - (uint64_t)position : (uint64_t)position;
	uint64_t degrees = count * DEGREES_PER_TURN;
	if (steps_per_turn == 0)
		return 0;
	uint64_t angle = passo_smaller(passo_mul_div(degrees, PASSO_UNIT_Q32, steps_per_turn), INT64_MAX);
	return position < 0 ? -(int64_t)angle : (int64_t)angle;
}

uint64_t passo_rpm_of(uint64_t velocity, uint32_t oversampling, uint32_t clock_hz, uint32_t steps_per_turn)
{
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	if (oversampling == 0 || steps_per_turn == 0)
		return 0;
	uint64_t speed = passo_mul_div(velocity, clock_hz, units * oversampling);
	return passo_mul_div(speed, SECONDS_PER_MINUTE, steps_per_turn);
}
