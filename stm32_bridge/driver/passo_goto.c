/* SPDX-License-Identifier: MIT
 * One axis to a target that may change on the way.
 *
 * Each motion is an endless line, whose ramps end it. From rest they end exactly at the target. A change
 * replaces them all in one frame, so there is no moment without an end. Where on the way the core receives
 * that frame is known only within bounds, so it plans to end short of the target; another motion, from rest,
 * makes what is left. A frame that is never sent, or refused, leaves the end as it was.
 */
#include "passo_goto.h"

#include "passo_driver.h"
#include "passo_math.h"

#define LATE_MICROSECONDS 1000u
#define MICROSECONDS_PER_SECOND 1000000u
#define TRIES 3u
/* Steps that the ramps are ahead of the position: four wait for the pins, and parts of one. */
#define STEPS_AHEAD 5
/* Ticks until a ramp that was received changes the speed. */
#define TICKS_AHEAD 4u
#define WAY_BITS 16u

/* What a change is based on. */
struct sight {
	uint64_t low, high; /* bounds of the speed, UQ32.32 steps/s */
	uint64_t way;       /* to the target, UQ48.16 steps; 0: none */
};

static enum passo_error of_plan(enum passo_plan_error error)
{
	return error == PASSO_PLAN_OK ? PASSO_OK
	                              : (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)error);
}

static struct passo_course course_of(const struct passo_goto *go, bool backwards)
{
	return (struct passo_course){.axis = go->axis,
	    .backwards = backwards,
	    .top_speed = go->top_speed,
	    .speed = go->speed,
	    .acceleration = go->acceleration};
}

static uint64_t larger(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

/* Steps from a position to the target. */
static int32_t distance(const struct passo *passo, const struct passo_goto *go, const int32_t *positions)
{
	const int32_t now = passo_driver_offset(passo, go->axis, positions[go->axis]);

	return (int32_t)((uint32_t)go->target - (uint32_t)now);
}

static uint32_t late_microseconds(const struct passo *passo, const struct passo_goto *go)
{
	const uint64_t late =
	    passo_mul_div(go->late_clocks, MICROSECONDS_PER_SECOND, passo->machine.clock_hz);

	if (go->late_clocks == 0u)
		return LATE_MICROSECONDS;
	return late < INT32_MAX ? (uint32_t)late : INT32_MAX;
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
	const int32_t far = distance(passo, go, positions);
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
	passo->velocity_peak = peak;
	passo->expects = PASSO_EXPECT_TURNING;
	passo->turning = (struct passo_turning){.axis = go->axis, .acceleration = go->acceleration};
	passo->backwards = course.backwards;
	passo->aimed = true;
	return PASSO_PENDING;
}

/* Reads where the axis is, and bounds its speed and its way for as long as a change may take. */
static enum passo_error look(struct passo *passo, const struct passo_goto *to, struct sight *sight)
{
	const struct passo_machine *machine = &passo->machine;
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	const uint64_t time =
	    passo_mul_div_ceil(late_microseconds(passo, to), machine->clock_hz, MICROSECONDS_PER_SECOND)
	    + ((uint64_t)TICKS_AHEAD << machine->tick_log2);
	int32_t positions[PASSO_AXES_MAX];
	uint64_t velocity;
	enum passo_error error = passo_driver_turning_velocity(passo, false, &velocity);

	if (error == PASSO_OK)
		error = passo_driver_positions(passo, positions, false);
	if (error != PASSO_OK)
		return error;
	const uint64_t steepest = larger(to->acceleration, passo->go.acceleration);
	const uint64_t change = passo_mul_div_ceil(steepest, time, machine->clock_hz);
	const uint64_t speed = passo_mul_div(velocity, machine->clock_hz, units * passo->oversampling);
	const uint64_t peak = passo_mul_div_ceil(
	    larger(velocity + units, passo->velocity_peak), machine->clock_hz, units * passo->oversampling);
	sight->low = speed > change ? speed - change : 0u;
	sight->high = speed + change < peak && speed + change > speed ? speed + change : peak;
	const uint64_t passed =
	    (passo_mul_div_ceil(sight->high, time, machine->clock_hz) >> (32u - WAY_BITS)) + 1u;
	const int32_t far = distance(passo, to, positions);
	const int64_t ahead = (passo->backwards ? -(int64_t)far : far) - STEPS_AHEAD;
	sight->way =
	    ahead > 0 && (uint64_t)ahead << WAY_BITS > passed ? ((uint64_t)ahead << WAY_BITS) - passed : 0u;
	return PASSO_OK;
}

/* Plans the change; no ramps: the motion ends as it should already. *aimed: it then ends at or before the
 * target. */
static enum passo_error plan_change(
    struct passo *passo, const struct passo_goto *to, struct passo_plan *plan, bool *aimed)
{
	const struct passo_course course = course_of(to, passo->backwards);
	enum passo_plan_error refused = PASSO_PLAN_TOO_NEAR;
	struct sight sight;
	enum passo_error error = look(passo, to, &sight);

	if (error != PASSO_OK)
		return error;
	plan->ramp_count = 0;
	if (sight.way != 0u)
		refused = passo_plan_course_change(
		    &passo->machine, &course, sight.low, sight.high, sight.way, plan);
	*aimed = refused == PASSO_PLAN_OK;
	if (refused == PASSO_PLAN_TOO_NEAR && passo->aimed && to->target == passo->go.target)
		return PASSO_OK;
	if (refused == PASSO_PLAN_TOO_NEAR)
		refused = passo_plan_course_change(&passo->machine, &course, sight.low, sight.high, 0, plan);
	return of_plan(refused);
}

/* Replaces the ramps in the core. */
static enum passo_error steer(struct passo *passo, const struct passo_goto *to)
{
	const uint32_t late = late_microseconds(passo, to);
	enum passo_error error = PASSO_ERROR_LATE;
	bool overdue = false;

	for (unsigned tries = 0; tries < TRIES; tries++) {
		const uint32_t since = passo_driver_now(passo);
		struct passo_plan plan;
		bool aimed = false;

		error = plan_change(passo, to, &plan, &aimed);
		if (error == PASSO_ERROR_NOT_TURNING || (error == PASSO_OK && plan.ramp_count == 0u))
			return PASSO_OK;
		if (error != PASSO_OK)
			return error;
		error = PASSO_ERROR_LATE;
		if (passo_driver_now(passo) - since > late)
			continue;
		error = passo_driver_turning_ramps(passo, false, &plan);
		if (error == PASSO_ERROR_NOT_TURNING)
			return PASSO_OK; /* it ends; the next motion has the new target */
		if (error == PASSO_ERROR_FULL)
			continue;
		if (error != PASSO_OK) {
			if (passo_driver_is_wire(error))
				passo_driver_halt(passo, PASSO_DUE_STOP);
			return error;
		}
		overdue = passo_driver_now(passo) - since > late;
		passo->aimed = !overdue && aimed;
		if (!overdue)
			return PASSO_OK;
		error = PASSO_ERROR_LATE;
	}
	if (overdue)
		passo_driver_halt(passo, PASSO_DUE_STOP);
	return error;
}

/* A goto is under way. */
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
	return PASSO_OK;
}

/* Whether a step can be planned so: errors of the planner before anything moves. */
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
