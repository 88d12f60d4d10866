/* SPDX-License-Identifier: MIT
 * Which axes are homed. A position is a number of pulses; a drive that is stopped at speed may not have
 * followed them all. A soft stop decelerates on the path, as the motion would.
 */
#include "passo_driver.h"

bool passo_is_homed(const struct passo *passo, uint8_t axis)
{
	return passo_driver_check_axis(passo, axis) == PASSO_OK && passo->axis[axis].homed
	    && !passo->host->lost;
}

static void forget(struct passo *passo, unsigned axes)
{
	for (unsigned i = 0; i < passo->axes; i++)
		passo->axis[i].homed = passo->axis[i].homed && (axes >> i & 1u) == 0u;
}

void passo_driver_forget_all(struct passo *passo)
{
	forget(passo, UINT8_MAX);
}

/* Whether the stop by a limit was on the path. A soft-stop limit that is active when a motion starts blocks
 * the first step toward it: a hard stop for the other axes. */
static bool is_soft_limit(const struct passo *passo)
{
	for (unsigned i = 0; i < passo->axes; i++)
		if ((passo->movers >> i & 1u) != 0u && !passo->axis[i].limit_soft)
			return false;
	return (passo->movers & (passo->movers - 1u)) == 0u;
}

void passo_driver_forget_home(struct passo *passo)
{
	bool is_soft = false;

	switch (passo->snapshot.cause) {
	case PASSO_CAUSE_STOP:
	case PASSO_CAUSE_RAMP_UNDERRUN:
		is_soft = true;
		break;
	case PASSO_CAUSE_TRIGGER:
		is_soft = !passo->hard_trigger;
		break;
	case PASSO_CAUSE_LIMIT:
		is_soft = is_soft_limit(passo);
		break;
	case PASSO_CAUSE_ALARM: /* the drive itself, or its power, or the way to it */
	case PASSO_CAUSE_ESTOP:
	case PASSO_CAUSE_WATCHDOG:
	case PASSO_CAUSE_FOLLOWING_ERROR:
		passo_driver_forget_all(passo);
		break;
	default:
		break;
	}
	if (!is_soft || passo->aborts)
		forget(passo, passo->movers);
}

/* Axes whose limits may stop a motion of the task that ends: the switches that are sought, and those right
 * behind the home switch. */
static uint8_t sought(const struct passo *passo)
{
	const struct passo_home *home = passo->task.home;

	if (passo->task.kind != PASSO_TASK_HOME || passo->task.phase == PASSO_HOME_RELEASE)
		return 0;
#ifdef PASSO_CARTESIAN
	return (uint8_t)(!passo->task.armed << home->axis);
#else
	if (passo->task.armed && (home->source == PASSO_TRIGGER_SOURCE_HOME || !passo_driver_squares(home)))
		return 0;
	return (uint8_t)(home->forward | 1u << home->axis);
#endif
}

/* A hard stop during a soft stop keeps the cause of the soft stop. */
enum passo_error passo_driver_check_home(struct passo *passo)
{
	const bool inside = passo->task.inside;
	struct passo_readings now;
	bool any = inside;

	for (unsigned i = 0; i < passo->axes; i++)
		any |= passo->axis[i].homed;
	if (!any || !passo->has_inputs || passo->snapshot.state != PASSO_STATE_STOPPED
	    || (passo->snapshot.cause == PASSO_CAUSE_LIMIT && !inside))
		return PASSO_OK;
	enum passo_error error = passo_read_inputs(passo, &now);
	if (error != PASSO_OK)
		return error;
	/* its flag may be older, but a limit that stopped the axis is still active */
	const bool alarm = (now.axes & now.was_alarm & ~(unsigned)(now.limit_low | now.limit_high)) != 0u;
	if (now.estop || alarm)
		passo_driver_forget_all(passo);
	else if (now.axes != 0u && !is_soft_limit(passo))
		forget(passo, passo->movers);
	if (!inside || now.estop)
		return PASSO_OK;
#ifndef PASSO_CARTESIAN
	passo->square.stopped = now.axes;
#endif
	if ((now.axes & (unsigned)~sought(passo)) == 0u)
		return PASSO_OK;
	return alarm ? PASSO_ERROR_ALARM : PASSO_ERROR_LIMIT;
}
