/* SPDX-License-Identifier: MIT
 * One axis to a target that can change during the motion.
 *
 * Each motion is an endless line, whose ramps end it. From rest they end exactly at the target. A change
 * replaces them all in one frame, so there is no moment without an end. The position at which the core
 * receives that frame is known only within bounds, so the change ends short of the target; another motion,
 * from rest, completes the distance. A frame that is never sent, or rejected, leaves the end unchanged.
 */
#include "passo_goto.h"

#include "passo_driver.h"
#include "passo_math.h"

#define LATE_MICROSECONDS 1000u
#define LATE_MAX (UINT32_C(1) << 30)
#define MICROSECONDS_PER_SECOND 1000000u

static enum passo_error of_plan(enum passo_plan_error error)
{
	return error == PASSO_PLAN_OK ? PASSO_OK
	                              : (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)error);
}

static struct passo_course course_of(const struct passo_goto *go, bool backward)
{
	return (struct passo_course){.axis = go->axis,
	    .backward = backward,
	    .top_speed = go->top_speed,
	    .speed = go->speed,
	    .acceleration = go->acceleration};
}

/* Time limit of a change, microseconds. */
static uint32_t late_of(const struct passo *passo, const struct passo_goto *go)
{
	const uint64_t late =
	    passo_mul_div_ceil(go->late_clocks, MICROSECONDS_PER_SECOND, passo->machine.clock_hz);

	if (go->late_clocks == 0u)
		return LATE_MICROSECONDS;
	return late < LATE_MAX ? (uint32_t)late : LATE_MAX;
}

/* The target in core positions. */
static int32_t aim_of(const struct passo *passo, const struct passo_goto *go)
{
	return (int32_t)((uint32_t)go->target - passo->axis[go->axis].offset);
}

/* The next motion, from rest. */
static enum passo_error go_on(struct passo *passo)
{
	const struct passo_goto *go = &passo->go;
	int32_t positions[PASSO_AXES_MAX];
	struct passo_plan plan;
	enum passo_error error = passo_driver_positions(passo, positions, false);

	if (error != PASSO_OK)
		return error;
	const int32_t aim = aim_of(passo, go);
	const int32_t far = (int32_t)((uint32_t)aim - (uint32_t)positions[go->axis]);
	if (far == 0)
		return PASSO_OK;
	const struct passo_course course = course_of(go, far < 0);
	const uint32_t steps = far < 0 ? 0u - (uint32_t)far : (uint32_t)far;
	error = of_plan(passo_plan_course(&passo->machine, &course, steps, &plan));
	if (error != PASSO_OK)
		return error;
	const uint64_t peak = plan.velocity_peak, units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	/* the pins have to suffice for all changes */
	plan.velocity_peak = passo_mul_div(go->top_speed, units * plan.oversampling, passo->machine.clock_hz);
	error = passo_move_plan(passo, &plan, NULL);
	if (error != PASSO_OK)
		return error;
	plan.velocity_peak = peak;
	const struct passo_turning turning = {.axis = go->axis, .acceleration = go->acceleration};
	passo_driver_turns(passo, &turning, course.backward, &plan, &aim);
	passo->late = late_of(passo, go);
	return PASSO_PENDING;
}

/* Plans the change; no ramps: the motion already ends as it should. *aimed: it then ends at or before the
 * target. */
static enum passo_error plan_change(const struct passo *passo, const struct passo_goto *to,
    const struct passo_sight *sight, struct passo_plan *plan, bool *aimed)
{
	const struct passo_machine *machine = &passo->machine;
	const struct passo_course course = course_of(to, passo->backward);
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	const uint64_t low = passo_mul_div(sight->low, machine->clock_hz, units * passo->oversampling);
	const uint64_t high = passo_driver_speed_of(passo, sight->high);
	enum passo_plan_error refused = PASSO_PLAN_TOO_NEAR;

	plan->ramp_count = 0;
	if (sight->way != 0u)
		refused = passo_plan_course_change(machine, &course, low, high, sight->way, plan);
	*aimed = refused == PASSO_PLAN_OK;
	const uint32_t further = (uint32_t)to->target - (uint32_t)passo->go.target;
	/* what the core has ends there or before it */
	if (refused == PASSO_PLAN_TOO_NEAR && passo->aimed
	    && (int32_t)(passo->backward ? 0u - further : further) >= 0)
		return PASSO_OK;
	if (refused == PASSO_PLAN_TOO_NEAR)
		refused = passo_plan_course_change(machine, &course, low, high, 0, plan);
	return of_plan(refused);
}

/* Replaces the ramps in the core. */
static enum passo_error steer(struct passo *passo, const struct passo_goto *to)
{
	struct passo_steering steering = {.late = late_of(passo, to)};
	const uint64_t steepest =
	    to->acceleration > passo->go.acceleration ? to->acceleration : passo->go.acceleration;
	const int32_t before = passo->aim;
	enum passo_error error = PASSO_ERROR_LATE;

	passo->aim = aim_of(passo, to);
	while ((error == PASSO_ERROR_LATE || error == PASSO_ERROR_FULL)
	       && passo_driver_steers(passo, &steering)) {
		struct passo_sight sight;
		struct passo_plan plan;
		bool aimed = false;

		error = passo_driver_sight(passo, &steering, steepest, &sight);
		if (error == PASSO_OK)
			error = plan_change(passo, to, &sight, &plan, &aimed);
		if (error != PASSO_OK || plan.ramp_count == 0u)
			break;
		error = passo_driver_steer(passo, &steering, &plan);
		if (error == PASSO_OK || steering.overdue)
			passo->aimed = aimed && !steering.overdue;
		if (passo_driver_is_link_error(error))
			passo_driver_halt(passo, PASSO_DUE_STOP);
	}
	if (error == PASSO_ERROR_NOT_TURNING)
		return PASSO_OK; /* it is ending; the next motion has the new target */
	if (steering.overdue)
		passo_driver_halt(passo, PASSO_DUE_STOP);
	if (error != PASSO_OK)
		passo->aim = before;
	return error;
}

/* A goto is in progress. */
static enum passo_error change(struct passo *passo, const struct passo_goto *to)
{
	const struct passo_goto *go = &passo->go;

	if (to->axis != go->axis)
		return PASSO_ERROR_UNDER_WAY;
	const bool is_new =
	    to->target != go->target || to->speed != go->speed || to->acceleration != go->acceleration;
	enum passo_error error = is_new || !passo->aimed ? steer(passo, to) : PASSO_OK;
	if (error != PASSO_OK)
		return error;
	passo->go = *to;
	passo->turning.acceleration = to->acceleration;
	passo->late = late_of(passo, to);
	return PASSO_OK;
}

/* Test plan of a single step: reports errors of the planner before anything moves. */
static enum passo_error check_plan(const struct passo *passo, const struct passo_goto *wanted)
{
	const struct passo_course course = course_of(wanted, false);
	struct passo_plan plan;

	return of_plan(passo_plan_course(&passo->machine, &course, 1, &plan));
}

enum passo_error passo_goto(struct passo *passo, const struct passo_goto *go)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!go)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (go->axis >= passo->machine.axes)
		return PASSO_ERROR_ARGUMENT_AXIS;
	if (!passo->host->hardware.microseconds)
		return PASSO_ERROR_NO_CLOCK;
	const bool is_under_way = passo->task.kind == PASSO_TASK_GOTO;
	struct passo_goto wanted = *go;
	if (is_under_way)
		wanted.top_speed = passo->go.top_speed;
	else if (wanted.top_speed == 0u)
		wanted.top_speed = wanted.speed;
	error = check_plan(passo, &wanted);
	if (error != PASSO_OK)
		return error;
	if (is_under_way)
		return change(passo, &wanted);
	error = passo_driver_ready(passo, true);
	if (error != PASSO_OK)
		return error;
	passo->go = wanted;
	return passo_driver_begin(
	    passo, (struct passo_task){.kind = PASSO_TASK_GOTO, .go_on = go_on}, NULL, NULL);
}
