/* SPDX-License-Identifier: MIT
 * Jogging: continuous rotation in steps per second, or a line of known length that can be ended at any time.
 */
#include "passo_driver.h"
#include "passo_math.h"
#include "passo_plan_draft.h"

#define VELOCITY_BITS 48u
#define WAY_BITS 16u
/* With this many steps per turn, rpm equals steps per second. */
#define STEPS_PER_TURN 60u

/* An endless line does not drain substeps left over by rounding; with two or more substeps per step the last
 * step comes before these. So the jog is exact, and a ramp to 0 ends it in place. */
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
	if (error != PASSO_OK)
		return error;
	const struct passo_turning turning = {.axis = jog->axis, .acceleration = jog->acceleration};
	passo_driver_turns(passo, &turning, jog->steps < 0, &plan, &passo->axis[jog->axis].expected);
	return PASSO_OK;
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
	    .backward = jog->backward,
	    .top_rpm = jog->top_speed != 0u ? jog->top_speed : jog->speed,
	    .acceleration = jog->acceleration};
	if (jog->steps == 0)
		return passo_turn_start(passo, &turning, jog->speed);
	return jog_by_distance(passo, jog);
}

enum passo_error passo_jog_speed(struct passo *passo, uint64_t speed)
{
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_OK && passo->turning.steps_per_turn != STEPS_PER_TURN)
		error = PASSO_ERROR_NOT_TURNING;
	return error != PASSO_OK ? error : passo_turn_speed(passo, speed);
}

/* One ramp to rest. False if a motion with a target that ends there anyway is too near for it; otherwise the
 * ramp is shortened to end at the target. */
static bool plan_rest(
    const struct passo *passo, const struct passo_sight *sight, bool ends_there, struct passo_plan *plan)
{
	const struct passo_machine *machine = &passo->machine;
	const uint64_t speed = passo_driver_speed_of(passo, sight->high);
	const uint64_t clocks = passo_mul_div_ceil(speed, machine->clock_hz, passo->turning.acceleration);
	uint64_t ticks = passo_smaller(passo_ticks_ceil(machine, clocks), UINT32_MAX);

	if (passo->has_aim) {
		/* in half ticks of velocity, as ticks * velocity is */
		const struct passo_u128 way =
		    passo_u128_shift_left(passo_multiply(sight->way, passo->oversampling),
			VELOCITY_BITS - WAY_BITS + 1u - machine->tick_log2);
		if (passo_u128_less(way, passo_multiply(ticks, sight->high))) {
			ticks = passo_divide(way, sight->high, NULL);
			if (ends_there || ticks == 0u)
				return false;
		}
	}
	*plan = (struct passo_plan){.ramp_count = 0};
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, 0, ticks);
	plan->ramps[0].now = plan->ramps[0].last = true;
	return true;
}

/* Sends the ramp to rest, unless the motion ends as early without it. */
static enum passo_error come_to_rest(struct passo *passo)
{
	struct passo_steering steering = {.stop = true, .late = passo->late};
	enum passo_error error = PASSO_ERROR_LATE;

	while (error == PASSO_ERROR_LATE && passo_driver_steers(passo, &steering)) {
		struct passo_sight sight;
		struct passo_plan plan;

		error = passo_driver_sight(passo, &steering, passo->turning.acceleration, &sight);
		if (error != PASSO_OK)
			break;
		if (plan_rest(passo, &sight, !steering.overdue, &plan))
			error = passo_driver_steer(passo, &steering, &plan);
		else if (steering.overdue) {
			error = PASSO_ERROR_LATE;
			break;
		}
	}
	return passo_driver_steered(passo, &steering, error);
}

enum passo_error passo_jog_cancel(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (passo->stream != PASSO_STREAM_NONE)
		return PASSO_ERROR_NOT_TURNING;
	const bool is_goto = passo->task.kind == PASSO_TASK_GOTO;
	if (is_goto)
		passo->task.kind = PASSO_TASK_NONE;
	if (passo->expects == PASSO_EXPECT_NOTHING || passo->expects == PASSO_EXPECT_TURN_END)
		return PASSO_OK;
	if (is_goto && !passo->aimed) { /* it is already coming to rest, to return */
		passo->expects = PASSO_EXPECT_TURN_END;
		return PASSO_OK;
	}
	const bool was_turning = passo->expects == PASSO_EXPECT_TURNING;
	error = come_to_rest(passo);
	return error == PASSO_ERROR_NOT_TURNING && was_turning ? PASSO_OK : error; /* it is already ending */
}
