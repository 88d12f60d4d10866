/* SPDX-License-Identifier: MIT
 * Continuous rotation: start, change of speed, stop.
 */
#include "passo_driver.h"

enum passo_error passo_turn_start(struct passo *passo, const struct passo_turning *turning, uint64_t rpm)
{
	struct passo_plan plan;
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!turning)
		return PASSO_ERROR_ARGUMENT_POINTER;
	enum passo_plan_error refused = passo_plan_turning_start(&passo->machine, turning, rpm, &plan);
	if (refused != PASSO_PLAN_OK)
		return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)refused);
	error = passo_move_plan(passo, &plan, NULL);
	if (error != PASSO_OK)
		return error;
	passo_driver_turns(passo, turning, turning->backward, &plan, NULL);
	return PASSO_OK;
}

/* The ramp from any possible velocity, so that none is too steep. */
static enum passo_plan_error plan_speed(
    const struct passo *passo, const struct passo_sight *sight, uint64_t rpm, struct passo_plan *plan)
{
	const struct passo_turning *turning = &passo->turning;
	enum passo_plan_error error =
	    passo_plan_turning_speed(&passo->machine, turning, sight->low, rpm, plan);

	if (error != PASSO_PLAN_OK)
		return error;
	const uint32_t ticks = plan->ramps[0].ticks;
	error = passo_plan_turning_speed(&passo->machine, turning, sight->high, rpm, plan);
	return error == PASSO_PLAN_OK && ticks > plan->ramps[0].ticks
	         ? passo_plan_turning_speed(&passo->machine, turning, sight->low, rpm, plan)
	         : error;
}

/* Queues a ramp to another speed, or to rest. */
static enum passo_error turn_on(struct passo *passo, bool stop, uint64_t rpm)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	struct passo_steering steering = {.stop = stop, .late = passo->late};
	error = PASSO_ERROR_LATE;
	while (error == PASSO_ERROR_LATE && passo_driver_steers(passo, &steering)) {
		enum passo_plan_error refused;
		struct passo_sight sight;
		struct passo_plan plan;

		error = passo_driver_sight(passo, &steering, passo->turning.acceleration, &sight);
		if (error == PASSO_OK && passo->has_aim)
			error = PASSO_ERROR_NOT_TURNING;
		if (error != PASSO_OK)
			break;
		if (stop)
			refused =
			    passo_plan_turning_stop(&passo->machine, &passo->turning, sight.high, &plan);
		else
			refused = plan_speed(passo, &sight, rpm, &plan);
		if (refused != PASSO_PLAN_OK)
			return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)refused);
		error = passo_driver_steer(passo, &steering, &plan);
	}
	return passo_driver_steered(passo, &steering, error);
}

enum passo_error passo_turn_speed(struct passo *passo, uint64_t rpm)
{
	return turn_on(passo, false, rpm);
}

enum passo_error passo_turn_stop(struct passo *passo)
{
	return turn_on(passo, true, 0);
}
