/* SPDX-License-Identifier: MIT
 * Homing of axes, one after the other, and probing.
 */
#include "passo_driver.h"

static enum passo_error of_plan(enum passo_plan_error error)
{
	return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)error);
}

static enum passo_error check_home(const struct passo *passo, const struct passo_home *home)
{
	const int32_t most = (int32_t)PASSO_SUBSTEPS_MAX;
	const enum passo_trigger_source source = home->source;
	enum passo_error error = passo_driver_check_source(passo, source, home->axis);

	if (error != PASSO_OK)
		return error;
	if (source > PASSO_TRIGGER_SOURCE_HOME
	    || (source == PASSO_TRIGGER_SOURCE_LIMIT_LOW && home->distance > 0)
	    || (source == PASSO_TRIGGER_SOURCE_LIMIT_HIGH && home->distance < 0))
		return PASSO_ERROR_ARGUMENT;
	if (home->distance == 0 || home->back_off == 0u)
		return PASSO_ERROR_NO_DISTANCE;
	if (home->distance < -most || home->distance > most || home->back_off > PASSO_SUBSTEPS_MAX / 4u
	    || home->pull_off > PASSO_SUBSTEPS_MAX / 4u)
		return of_plan(PASSO_PLAN_TOO_MANY_STEPS);
	if (home->speed == 0u || home->slow_speed == 0u)
		return of_plan(PASSO_PLAN_NO_SPEED);
	if (home->acceleration == 0u)
		return of_plan(PASSO_PLAN_NO_ACCELERATION);
#ifndef PASSO_WITHOUT_TRACKERS
	if (home->track && !passo->has_trackers)
		return PASSO_ERROR_NO_TRACKERS;
	if (home->track ? home->track->axis != home->axis || home->racking != 0u
	                : home->axis >= passo->machine.axes)
		return PASSO_ERROR_ARGUMENT;
#endif
#ifndef PASSO_CARTESIAN
	if (passo_driver_squares(home))
		return passo_driver_check_square(passo, home);
#endif
	return PASSO_OK;
}

enum passo_error passo_home(struct passo *passo, const struct passo_home *homes, uint8_t count)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK && (!homes || count == 0u))
		error = PASSO_ERROR_ARGUMENT;
	for (unsigned i = 0; error == PASSO_OK && i < count; i++)
		error = check_home(passo, &homes[i]);
	if (error != PASSO_OK)
		return error;
	return passo_driver_begin(
	    passo, (struct passo_task){.kind = PASSO_TASK_HOME, .left = count, .home = homes}, NULL, NULL);
}

/* Motors that move with the axis being homed. An image without room has none: PASSO_CARTESIAN. */
static int32_t sign_of(const struct passo_home *home, uint32_t motor)
{
#ifndef PASSO_CARTESIAN
	if ((home->forward | home->backward) != 0u)
		return (int32_t)((unsigned)home->forward >> motor & 1u)
		     - (int32_t)((unsigned)home->backward >> motor & 1u);
#endif
	return motor == home->axis;
}

static void set_homed(struct passo *passo, const struct passo_home *home, bool homed)
{
#ifdef PASSO_CARTESIAN
	passo->axis[home->axis].homed = homed;
#else
	for (uint32_t motor = 0; motor < passo->axes; motor++) {
		if (sign_of(home, motor) != 0)
			passo->axis[motor].homed = homed;
	}
#endif
}

/* Moves the axis being homed, for a phase. With an edge: until it occurs. */
enum edge { NO_EDGE, RISING, FALLING };
static enum passo_error go(
    struct passo *passo, enum passo_home_phase phase, enum edge edge, int32_t steps, uint64_t speed)
{
	const struct passo_home *home = passo->task.home;
	const struct passo_trigger_config trigger = {.source = home->source,
	    .action = PASSO_TRIGGER_ACTION_SOFT_STOP,
	    .axis = home->axis,
	    .falling = edge == FALLING};
	struct passo_move_by_speed move = {.speed = speed, .acceleration = home->acceleration};

#ifdef PASSO_CARTESIAN
	move.steps[home->axis] = steps;
#else
	for (uint32_t motor = 0; motor < passo->axes; motor++)
		move.steps[motor] = sign_of(home, motor) * steps;
#endif
	passo->task.phase = phase;
	return passo_driver_seek(passo, edge != NO_EDGE ? &trigger : NULL, &move);
}

enum passo_error passo_driver_home_first(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;

#ifndef PASSO_CARTESIAN
	if (passo_driver_squares(home)) {
		set_homed(passo, home, false);
		return passo_driver_square_first(passo);
	}
#endif
	enum passo_error error = go(passo, PASSO_HOME_APPROACH, RISING, home->distance, home->speed);

	set_homed(passo, home, false);
	if (error != PASSO_ERROR_SWITCH_LEVEL)
		return error;
	return go(passo, PASSO_HOME_RELEASE, FALLING, -home->distance, home->speed);
}

/* Moves slowly from the back-off to the edge, which must be near. */
static enum passo_error approach_slowly(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	const int32_t most = (int32_t)(2u * home->back_off + 1u);

	return go(passo, PASSO_HOME_SLOW, RISING, home->distance < 0 ? -most : most, home->slow_speed);
}

static enum passo_error back_off(struct passo *passo, int32_t past)
{
	const struct passo_home *home = passo->task.home;
	const int32_t away = (int32_t)home->back_off;
	const int32_t steps = (home->distance < 0 ? away : -away) - past;

	if (steps == 0)
		return approach_slowly(passo);
	return go(passo, PASSO_HOME_BACK_OFF, NO_EDGE, steps, home->speed);
}

/* The next axis, if there is one. */
static enum passo_error end_axis(struct passo *passo)
{
	passo->task.left--;
	if (passo->task.left == 0u)
		return PASSO_OK;
	passo->task.home++;
	return passo_driver_home_first(passo);
}

/* The axis is there: its motors are shifted, so that another axis that they move stays where it is, within
 * half a step. */
static enum passo_error set_position(struct passo *passo, int32_t position)
{
	const struct passo_home *home = passo->task.home;
#ifdef PASSO_CARTESIAN
	return passo_set_position(passo, home->axis, position);
#else
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = passo_positions(passo, now);
	int64_t sum = 0, motors = 0;

	for (uint32_t motor = 0; motor < passo->machine.axes; motor++) {
		sum += (int64_t)sign_of(home, motor) * now[motor];
		motors += sign_of(home, motor) != 0;
	}
	const int64_t shift = (position * motors - sum) / motors;
	for (uint8_t motor = 0; error == PASSO_OK && motor < passo->machine.axes; motor++) {
		if (sign_of(home, motor) != 0)
			error = passo_set_position(
			    passo, motor, (int32_t)(now[motor] + sign_of(home, motor) * shift));
	}
	return error;
#endif
}

#ifndef PASSO_WITHOUT_TRACKERS
/* The tracker is at its target after the pull-off: its place from the latched edge is exact. */
static enum passo_error set_track(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	struct passo_trigger_report report;
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = passo_read_trigger(passo, &report);

	if (error == PASSO_OK)
		error = passo_positions(passo, now);
	if (error == PASSO_OK)
		error = passo_driver_track_is_at(passo, home->axis,
		    (int32_t)((uint32_t)home->position + (uint32_t)now[home->axis]
		              - (uint32_t)report.positions[home->axis]));
	if (error == PASSO_OK)
		error = passo_configure_tracker(passo, home->track);
	if (error == PASSO_OK)
		set_homed(passo, home, true);
	return error;
}
#endif

/* The edge was `past` steps ago: it is at home->position. */
static enum passo_error set_home(struct passo *passo, int32_t past)
{
	const struct passo_home *home = passo->task.home;
	const int32_t away = (int32_t)home->pull_off;
#ifndef PASSO_WITHOUT_TRACKERS
	if (home->track) {
		const int32_t way = away == 0 ? 0 : (home->distance < 0 ? away : -away) - past;

		return go(passo, PASSO_HOME_PULL_OFF, NO_EDGE, way, home->speed);
	}
#endif
	const enum passo_error error =
	    set_position(passo, (int32_t)((uint32_t)home->position + (uint32_t)past));

	if (error != PASSO_OK)
		return error;
	set_homed(passo, home, true);
	if (away == 0)
		return end_axis(passo);
	return go(
	    passo, PASSO_HOME_PULL_OFF, NO_EDGE, (home->distance < 0 ? away : -away) - past, home->speed);
}

enum passo_error passo_driver_home_next(struct passo *passo, const struct passo_trigger_report *report)
{
	const uint8_t axis = passo->task.home->axis;
	int32_t now[PASSO_AXES_MAX];

#ifndef PASSO_CARTESIAN
	if (passo_driver_squares(passo->task.home)) {
		const enum passo_error error = passo_driver_square_next(passo, report);

		return error == PASSO_OK ? end_axis(passo) : error;
	}
#endif
	if (passo->task.phase == PASSO_HOME_BACK_OFF)
		return approach_slowly(passo);
#ifndef PASSO_WITHOUT_TRACKERS
	if (passo->task.phase == PASSO_HOME_PULL_OFF && passo->task.home->track) {
		const enum passo_error error = set_track(passo);

		return error == PASSO_OK ? end_axis(passo) : error;
	}
#endif
	if (passo->task.phase == PASSO_HOME_PULL_OFF)
		return end_axis(passo);
	if (!report->fired)
		return PASSO_ERROR_SWITCH_MISSED;
	enum passo_error error = passo_positions(passo, now);
	if (error != PASSO_OK)
		return error;
	const int32_t moved = (int32_t)((uint32_t)now[axis] - (uint32_t)report->positions[axis]);
	const int32_t past = sign_of(passo->task.home, axis) < 0 ? -moved : moved;
	return passo->task.phase == PASSO_HOME_SLOW ? set_home(passo, past) : back_off(passo, past);
}

enum passo_error passo_probe(struct passo *passo, const struct passo_probe *probe)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error != PASSO_OK)
		return error;
	if (!probe)
		return PASSO_ERROR_ARGUMENT;
	const struct passo_trigger_config trigger = {.source = PASSO_TRIGGER_SOURCE_PROBE,
	    .action = PASSO_TRIGGER_ACTION_SOFT_STOP,
	    .falling = probe->away};
	struct passo_move_by_speed move = {.speed = probe->speed, .acceleration = probe->acceleration};
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		move.steps[i] = probe->steps[i];
	return passo_driver_begin(passo,
	    (struct passo_task){.kind = PASSO_TASK_PROBE, .optional = probe->optional}, &trigger, &move);
}
