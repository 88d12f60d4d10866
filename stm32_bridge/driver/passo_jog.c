/* SPDX-License-Identifier: MIT
 * Jogging: continuous rotation in steps per second, or a line of known length that can be left at any time.
 */
#include "passo_driver.h"
#include "passo_math.h"
#include "passo_plan_draft.h"

/* A ramp reaches the core within a millisecond of the look that it was planned by. */
#define FRAMES_PER_S 1000u

/* With so many steps per turn, rpm are steps per second. */
#define STEPS_PER_TURN 60u

/* An endless line does not make substeps that rounding left over; with two substeps per step or more the last
 * step comes before these. So the jog is exact, and a ramp to 0 ends it where it is. */
static enum passo_error jog_by_distance(struct passo *passo, const struct passo_jog *jog)
{
	struct passo_move_by_speed move = {.speed = jog->speed, .acceleration = jog->acceleration};
	struct passo_plan plan;

	move.steps[jog->axis] = jog->steps;
	enum passo_plan_error refused = passo_plan_by_speed(&passo->machine, &move, &plan);
	if (refused == PASSO_PLAN_OK && plan.oversampling < 2u)
		refused = PASSO_PLAN_TOO_FAST;
	if (refused != PASSO_PLAN_OK)
		return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)refused);
	plan.line.last = false;
	plan.line.endless = true;
	enum passo_error error = passo_move_plan(passo, &plan, NULL);
	if (error == PASSO_OK)
		passo->expects = PASSO_EXPECT_TURNING;
	return error;
}

enum passo_error passo_jog(struct passo *passo, const struct passo_jog *jog)
{
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_OK && (!jog || jog->axis >= passo->machine.axes))
		error = PASSO_ERROR_ARGUMENT;
	if (error != PASSO_OK)
		return error;
	const struct passo_turning turning = {.axis = jog->axis,
	    .steps_per_turn = STEPS_PER_TURN,
	    .backwards = jog->backwards,
	    .top_rpm = jog->top_speed != 0u ? jog->top_speed : jog->speed,
	    .acceleration = jog->acceleration};
	if (jog->steps == 0)
		return passo_turn_start(passo, &turning, jog->speed);
	error = jog_by_distance(passo, jog);
	if (error == PASSO_OK)
		passo->turning = (struct passo_turning){.axis = jog->axis, .acceleration = jog->acceleration};
	return error;
}

enum passo_error passo_jog_speed(struct passo *passo, uint64_t speed)
{
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_OK && passo->turning.steps_per_turn != STEPS_PER_TURN)
		error = PASSO_ERROR_NOT_TURNING;
	return error != PASSO_OK ? error : passo_turn_speed(passo, speed);
}

enum passo_error passo_jog_cancel(struct passo *passo)
{
	struct passo_plan plan = {.ramp_count = 0};
	uint64_t velocity;
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (passo->task.kind == PASSO_TASK_GOTO)
		passo->task.kind = PASSO_TASK_NONE;
	if (passo->expects == PASSO_EXPECT_NOTHING || passo->expects == PASSO_EXPECT_TURN_END)
		return PASSO_OK;
	error = passo_driver_turning_velocity(passo, true, &velocity);
	if (error != PASSO_OK)
		return error;
	const struct passo_machine *machine = &passo->machine;
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	const uint64_t peak = velocity > passo->velocity_peak ? velocity : passo->velocity_peak;
	const uint64_t most = passo_mul_div_ceil(peak, machine->clock_hz, units * passo->oversampling);
	/* while it speeds up, what is added until the core has the ramp */
	const uint64_t speed =
	    passo_smaller(passo_mul_div_ceil(velocity, machine->clock_hz, units * passo->oversampling)
	                      + passo->turning.acceleration / FRAMES_PER_S,
		most);
	const uint64_t clocks = passo_mul_div_ceil(speed, machine->clock_hz, passo->turning.acceleration);
	const uint64_t ticks = passo_ticks_ceil(machine, clocks);
	passo_plan_add_ramp(&plan, PASSO_SHAPE_LINEAR, false, 0, passo_smaller(ticks, UINT32_MAX));
	plan.ramps[0].now = plan.ramps[0].last = true;
	error = passo_driver_turning_ramps(passo, true, &plan);
	return error == PASSO_ERROR_NOT_TURNING ? PASSO_OK : error; /* it ends already */
}
