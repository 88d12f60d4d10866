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
	passo->turning = *turning;
	passo->expects = PASSO_EXPECT_TURNING;
	return PASSO_OK;
}

/* A stop by ramp that is not acknowledged becomes a soft stop. */
static enum passo_error fail(struct passo *passo, enum passo_error error, bool stop)
{
	if (stop && passo_driver_is_wire(error))
		passo_driver_halt(passo, PASSO_DUE_STOP);
	return error;
}

enum passo_error passo_driver_turning_velocity(struct passo *passo, bool stop, uint64_t *velocity)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	error = passo_driver_restrain(passo, PASSO_POST_RUN);
	if (error != PASSO_OK)
		return error;
	if (passo_driver_is_broken(passo))
		return PASSO_ERROR_BROKEN;
	if (passo->expects != PASSO_EXPECT_TURNING)
		return PASSO_ERROR_NOT_TURNING;
	error = passo_driver_look(passo, false);
	if (error != PASSO_OK)
		return fail(passo, error, stop);
	if (passo->snapshot.state == PASSO_STATE_STOPPED || passo->snapshot.stopping)
		return PASSO_ERROR_STOPPED;

	/* the register has only the upper 32 bits; at the peak all bits are known from the plan */
	*velocity = (uint64_t)passo->snapshot.velocity << 16;
	if (passo->velocity_peak >> 16 == passo->snapshot.velocity)
		*velocity = passo->velocity_peak;
	return PASSO_OK;
}

enum passo_error passo_driver_turning_ramps(struct passo *passo, bool stop, const struct passo_plan *plan)
{
	if (passo->snapshot.ramp_room < plan->ramp_count)
		return PASSO_ERROR_FULL;
	enum passo_error error = passo_driver_push_ramps(passo, plan);
	if (error == PASSO_ERROR_STOPPED && passo_driver_look(passo, false) == PASSO_OK
	    && passo->snapshot.state != PASSO_STATE_STOPPED)
		error = PASSO_ERROR_NOT_TURNING; /* its end is already in progress */
	if (error != PASSO_OK)
		return fail(passo, error, stop);
	passo->velocity_peak = plan->velocity_peak;
	if (stop)
		passo->expects = PASSO_EXPECT_TURN_END;
	return PASSO_OK;
}

/* Queues a ramp to another speed, or to rest. */
static enum passo_error turn_on(struct passo *passo, bool stop, uint64_t rpm)
{
	struct passo_plan plan;
	enum passo_plan_error refused;
	uint64_t velocity;
	enum passo_error error = passo_driver_turning_velocity(passo, stop, &velocity);

	if (error != PASSO_OK)
		return error;
	if (stop)
		refused = passo_plan_turning_stop(&passo->machine, &passo->turning, velocity, &plan);
	else
		refused = passo_plan_turning_speed(&passo->machine, &passo->turning, velocity, rpm, &plan);
	if (refused != PASSO_PLAN_OK)
		return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)refused);
	return passo_driver_turning_ramps(passo, stop, &plan);
}

enum passo_error passo_turn_speed(struct passo *passo, uint64_t rpm)
{
	return turn_on(passo, false, rpm);
}

enum passo_error passo_turn_stop(struct passo *passo)
{
	return turn_on(passo, true, 0);
}
