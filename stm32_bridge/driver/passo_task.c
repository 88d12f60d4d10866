/* SPDX-License-Identifier: MIT
 * Common to homing, probing and goto: motions one after the other, advanced by passo_poll(). Those of homing
 * and probing can end at a trigger.
 */
#include "passo_driver.h"

/* Ends the task. A trigger that may still be armed must not stop a later motion: passo_clear() disarms it. */
static enum passo_error settle(struct passo *passo, enum passo_error error)
{
	passo->task.inside = false;
	if (error == PASSO_PENDING)
		return PASSO_OK;
	passo->task.kind = PASSO_TASK_NONE;
	if (passo->task.armed
	    && (passo_driver_is_link_error(error) || passo_driver_disarm(passo) != PASSO_OK))
		passo_driver_assume_worse(passo, PASSO_ASSUMED_BROKEN);
	return error;
}

/* The path makes the move, or the tracker of the axis that is homed. */
static enum passo_error set_off(struct passo *passo, const struct passo_move_by_speed *move)
{
#ifndef PASSO_WITHOUT_TRACKERS
	const struct passo_home *home = passo->task.home;

	if (passo->task.kind == PASSO_TASK_HOME && home->track)
		return passo_driver_track_by(
		    passo, home->axis, move->steps[home->axis], move->speed, move->acceleration);
#endif
	return passo_move_by_speed(passo, move);
}

enum passo_error passo_driver_seek(
    struct passo *passo, const struct passo_trigger_config *trigger, const struct passo_move_by_speed *move)
{
	enum passo_error error = PASSO_OK;
	bool active = false;

	/* armed first: an edge between the two is not missed */
	if (trigger) {
		passo->task.armed = true;
		error = passo_driver_arm(passo, trigger);
		if (error == PASSO_OK)
			error = passo_driver_armed(passo, &active);
		if (error == PASSO_OK && active != trigger->falling)
			error = PASSO_ERROR_SWITCH_LEVEL;
	}
	if (error == PASSO_OK)
		error = set_off(passo, move);
	return error == PASSO_OK ? PASSO_PENDING : error;
}

enum passo_error passo_driver_begin(struct passo *passo, struct passo_task task,
    const struct passo_trigger_config *trigger, const struct passo_move_by_speed *move)
{
	enum passo_error error = passo_driver_ready(passo, true);

	if (error == PASSO_OK && trigger)
		error = passo_driver_check_source(passo, trigger->source, trigger->axis);
	if (error == PASSO_OK && !task.go_on && !passo->stop_time_known)
		error = PASSO_ERROR_NO_STOP_TIME; /* after a reset the core stops within 0.1 ms */
#ifndef PASSO_WITHOUT_TRACKERS
	if (error == PASSO_OK && !task.go_on)
		error = passo_driver_note_trackers(passo);
#endif
	if (error != PASSO_OK)
		return error;
	passo->task = task;
	passo->task.inside = true;
	if (task.go_on)
		return settle(passo, task.go_on(passo));
	error = trigger ? passo_driver_seek(passo, trigger, move) : passo_driver_home_first(passo);
	return settle(passo, error);
}

#ifdef PASSO_WITHOUT_TRACKERS
static bool has_settled(const struct passo *passo)
{
	(void)passo;
	return false;
}

static enum passo_error settle_trackers(const struct passo *passo)
{
	(void)passo;
	return PASSO_OK;
}
#else
/* The trackers that the trigger has stopped are at their targets again: positions are exact. */
static bool has_settled(struct passo *passo)
{
	const bool settled = passo->task.settles;

	passo->task.settles = false;
	return settled;
}

/* PENDING: they are on their way. */
static enum passo_error settle_trackers(struct passo *passo)
{
	if (passo->task.kind == PASSO_TASK_HOME && passo->task.home->track)
		passo->tracked =
		    (uint8_t)(passo->tracked & ~(1u << passo->task.home->axis)); /* it is there */
	const enum passo_error error = passo_track_again(passo);

	if (error != PASSO_OK || passo->expects == PASSO_EXPECT_NOTHING)
		return error;
	passo->task.settles = true;
	return PASSO_PENDING;
}
#endif

/* A motion of the task has ended. */
static enum passo_error next(struct passo *passo)
{
	struct passo_trigger_report report = {.fired = false};
	enum passo_error error = PASSO_OK;
	const bool settled = has_settled(passo);

	if (passo->task.armed || settled)
		error = passo_read_trigger(passo, &report);
#ifndef PASSO_CARTESIAN
	if (!settled)
		passo->square.stopped = 0;
#endif
	if (error == PASSO_OK && !settled && (report.fired || passo_driver_is_stopped(passo))) {
		passo->task.armed &= !report.fired; /* its latch stays */
		error = passo_clear(passo);
		if (error == PASSO_OK)
			error = settle_trackers(passo);
	}
	if (error != PASSO_OK)
		return error;
	if (passo->task.go_on)
		return passo->task.go_on(passo);
	if (passo->task.kind == PASSO_TASK_HOME)
		return passo_driver_home_next(passo, &report);
	return report.fired || passo->task.optional ? PASSO_OK : PASSO_ERROR_SWITCH_MISSED;
}

/* Why the channel stopped. */
static enum passo_error cause(const struct passo *passo)
{
	const enum passo_error error = passo_driver_fault_of(passo->snapshot.cause);

	return error != PASSO_OK ? error : PASSO_ERROR_STOPPED;
}

enum passo_error passo_driver_task(struct passo *passo, enum passo_error error)
{
	if (error == PASSO_ERROR_NOT_STOPPED || error == PASSO_ERROR_NOT_HELD)
		return error;
	/* expected stops: by the trigger, or by the switch itself */
	const bool is_sought =
	    (error == PASSO_ERROR_TRIGGER || error == PASSO_ERROR_LIMIT) && passo->task.armed;
	if (is_sought)
		passo->fault = PASSO_OK;
	else if (error != PASSO_OK)
		return settle(passo, error);
	if (passo_driver_in_motion(passo))
		return PASSO_OK;
	passo->task.inside = true;
	error = next(passo);
	if (error == PASSO_ERROR_STOPPED && passo_driver_look(passo, false) == PASSO_OK)
		error = cause(passo); /* between two motions */
	error = settle(passo, error);
	if (error != PASSO_OK)
		passo->fault = error;
	return error;
}
