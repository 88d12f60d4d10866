/* SPDX-License-Identifier: MIT
 * Commands to a moving or stopped channel: hold, override, stop, clear.
 */
#include "passo_driver.h"

#define PERCENT 100u

uint32_t passo_driver_rate(const struct passo *passo)
{
	return passo->held ? 0u : passo->rate_target;
}

/* Without acknowledgement, the slower of the old and the new rate becomes due. */
static enum passo_error set_rate(struct passo *passo, bool held, uint32_t target)
{
	const bool was_held = passo->held;
	const uint32_t was_target = passo->rate_target, was = passo_driver_rate(passo);
	enum passo_error error = passo_driver_require_sent(passo, PASSO_POST_STOP);

	if (passo->post == PASSO_POST_RATE)
		passo_driver_drop(passo);
	passo->held = held;
	passo->rate_target = target;
	const bool is_slower = passo_driver_rate(passo) <= was;
	if (error == PASSO_OK || is_slower)
		passo->rate_due = true;
	if (error == PASSO_OK)
		error = passo_driver_send_due_until(passo, PASSO_POST_RATE);
	if (error != PASSO_OK && !is_slower) {
		passo->held = was_held;
		passo->rate_target = was_target;
	}
	return error;
}

enum passo_error passo_hold(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	return error != PASSO_OK ? error : set_rate(passo, true, passo->rate_target);
}

enum passo_error passo_resume(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	return error != PASSO_OK ? error : set_rate(passo, false, passo->rate_target);
}

enum passo_error passo_override_q16(struct passo *passo, uint32_t rate)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (rate == 0u || rate > PASSO_RATE_FULL)
		return PASSO_ERROR_ARGUMENT_RATE;
	if (!passo->held)
		return set_rate(passo, false, rate);
	passo->rate_target = rate;
	return PASSO_OK;
}

enum passo_error passo_override(struct passo *passo, uint32_t percent)
{
	if (percent == 0u || percent > PERCENT)
		return PASSO_ERROR_ARGUMENT_RATE;
	return passo_override_q16(passo, (percent * PASSO_RATE_FULL + PERCENT / 2u) / PERCENT);
}

static enum passo_error halt(struct passo *passo, enum passo_due due)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	passo->aborts |= due == PASSO_DUE_ABORT;
	passo_driver_halt(passo, due);
	return passo_driver_send_due_until(passo, PASSO_POST_STOP);
}

enum passo_error passo_stop(struct passo *passo)
{
	return halt(passo, PASSO_DUE_STOP);
}

enum passo_error passo_abort(struct passo *passo)
{
	return halt(passo, PASSO_DUE_ABORT);
}

enum passo_error passo_clear(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	error = passo_driver_require_sent(passo, PASSO_POST_RUN);
	if (error == PASSO_OK)
		error = passo_driver_look_at_rest(passo);
	if (error != PASSO_OK)
		return error;
	/* between two motions none is running, but one is queued */
	const bool goes_on = passo->snapshot.state == PASSO_STATE_IDLE && !passo_driver_at_rest(passo)
	                  && passo->assumed == PASSO_ASSUMED_READY && passo->stream != PASSO_STREAM_FILLS;
	if (goes_on || !passo->snapshot.quiet)
		return PASSO_ERROR_MOVING;
	passo_driver_end_stream(passo);
	if (!passo->task.inside)
		passo->task.kind = PASSO_TASK_NONE;
	error = passo_driver_check_home(passo);
	if (error == PASSO_OK && passo->task.armed)
		error = passo_driver_disarm(passo);
	if (error != PASSO_OK)
		return error;
	passo_driver_assume_worse(passo, PASSO_ASSUMED_BROKEN); /* until clear has succeeded */
	/* queued motions must not start in the meantime */
	if (!passo_driver_at_rest(passo))
		error = passo_driver_gate(passo, PASSO_GATE_CLOSED);
	if (error == PASSO_OK)
		error = passo_driver_look(passo, false);
	if (error == PASSO_OK && !passo->snapshot.quiet)
		error = PASSO_ERROR_MOVING;
	if (error == PASSO_OK)
		error = passo_driver_take_over(passo);
	return error != PASSO_OK ? error : passo_driver_gate(passo, passo->gate);
}

enum passo_error passo_wait_for_sync(struct passo *passo, bool on)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	const enum passo_gate gate = on ? PASSO_GATE_SYNC : PASSO_GATE_OPEN;
	error = passo_driver_require_sent(passo, PASSO_POST_STOP);
	if (passo->post == PASSO_POST_START)
		passo_driver_drop(passo); /* it would open the gate as it was before */
	if (error == PASSO_OK && passo->stream != PASSO_STREAM_FILLS)
		error = passo_driver_gate(passo, gate);
	if (error == PASSO_OK || (on && passo_driver_is_link_error(error)))
		passo->gate = gate;
	return error;
}
