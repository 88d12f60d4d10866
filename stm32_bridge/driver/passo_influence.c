/* SPDX-License-Identifier: MIT
 * What is commanded while a channel moves, and after: hold, override, stop, clear.
 */
#include "passo_driver.h"

#define PERCENT 100u

static enum passo_error set_rate(struct passo *passo, bool held, uint32_t target)
{
	enum passo_error error = passo_driver_check(passo);
	const uint32_t rate = held ? 0u : target;

	if (error != PASSO_OK)
		return error;
	if (!passo->held || !held)
		error = passo_driver_write(passo, PASSO_CHANNEL_RATE_TARGET, &rate, 1);
	if (error != PASSO_OK)
		return error;
	passo->held = held;
	passo->rate_target = target;
	return PASSO_OK;
}

enum passo_error passo_hold(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	passo->held = false; /* written even if it was held before */
	return set_rate(passo, true, passo->rate_target);
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
	return rate == 0u || rate > PASSO_RATE_FULL ? PASSO_ERROR_ARGUMENT
	                                            : set_rate(passo, passo->held, rate);
}

enum passo_error passo_override(struct passo *passo, uint32_t percent)
{
	if (percent == 0u || percent > PERCENT)
		return PASSO_ERROR_ARGUMENT;
	return passo_override_q16(passo, (percent * PASSO_RATE_FULL + PERCENT / 2u) / PERCENT);
}

static enum passo_error halt(struct passo *passo, unsigned bit)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	passo_driver_end_stream(passo);
	passo->certain = false;
	passo->halted = true;
	return passo_driver_command(passo, UINT32_C(1) << bit);
}

enum passo_error passo_stop(struct passo *passo)
{
	return halt(passo, PASSO_CHANNEL_COMMAND_STOP_LSB);
}

enum passo_error passo_abort(struct passo *passo)
{
	return halt(passo, PASSO_CHANNEL_COMMAND_ABORT_LSB);
}

enum passo_error passo_clear(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	error = passo_driver_look(passo, false);
	if (error != PASSO_OK)
		return error;
	if (passo_driver_occupied(passo))
		return PASSO_ERROR_MOVING;
	passo_driver_end_stream(passo);
	/* what still waits must not start in the meantime */
	if (!passo_driver_at_rest(passo))
		error = passo_driver_gate(passo, PASSO_GATE_CLOSED);
	if (error == PASSO_OK)
		error = passo_driver_look(passo, false);
	if (error == PASSO_OK && passo_driver_occupied(passo))
		error = PASSO_ERROR_MOVING;
	if (error == PASSO_OK)
		error = passo_driver_take_over(passo);
	return error != PASSO_OK ? error : passo_driver_gate(passo, passo->gate);
}

enum passo_error passo_zero(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_OK)
		error = passo_driver_ready(passo, true);
	if (error == PASSO_OK)
		error = passo_driver_command(passo, UINT32_C(1) << PASSO_CHANNEL_COMMAND_ZERO_LSB);
	if (error != PASSO_OK)
		return error;
	const int32_t zeros[PASSO_AXES_MAX] = {0};
	passo_driver_ended(passo, zeros);
	return PASSO_OK;
}

enum passo_error passo_wait_for_sync(struct passo *passo, bool on)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	const enum passo_gate gate = on ? PASSO_GATE_SYNC : PASSO_GATE_OPEN;
	if (!passo->starting)
		error = passo_driver_gate(passo, gate);
	if (error == PASSO_OK)
		passo->gate = gate;
	return error;
}
