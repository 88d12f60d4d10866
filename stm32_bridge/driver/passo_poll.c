/* SPDX-License-Identifier: MIT
 * The poll of the main loop: feeds streams, reads the state and detects the end of motions.
 */
#include "passo_driver.h"

/* Consecutive reads of an idle state that prove that all motions have ended. */
#define IDLE_LOOKS 2u

static enum passo_error tell(struct passo *passo, enum passo_error error)
{
	passo->fault = error;
	return error;
}

/* A frame of the main loop failed; reported only after several consecutive failures. */
static enum passo_error miss(struct passo *passo, enum passo_error error)
{
	if (error == PASSO_ERROR_CORE_RESET) {
		passo_driver_end_stream(passo);
		return tell(passo, error);
	}
	if (passo_driver_is_link_error(error) && ++passo->misses < passo->host->hardware.tries)
		return PASSO_OK;
	passo->misses = 0;
	return tell(passo, error);
}

static enum passo_error see_stop(struct passo *passo)
{
	const enum passo_error fault = passo_driver_fault_of(passo->snapshot.cause);
	const bool is_news = !passo_driver_is_stopped(passo) || passo->expects != PASSO_EXPECT_NOTHING;

	passo_driver_end_stream(passo);
	/* the last steps may still be at the pins */
	passo->expects = passo->snapshot.quiet ? PASSO_EXPECT_NOTHING : PASSO_EXPECT_END;
	passo_driver_assume_worse(passo, PASSO_ASSUMED_STOPPED);
	passo->idle_looks = 0;
	return is_news && fault != PASSO_OK && fault != passo->fault ? tell(passo, fault) : PASSO_OK;
}

/* Nothing moves or is queued; items queued by a previous connection wait at the closed gate. Ramps left over
 * from an interrupted command do not move without a line. */
static bool has_ended(const struct passo *passo)
{
	if (passo_driver_is_broken(passo))
		return passo->snapshot.state == PASSO_STATE_IDLE && passo->snapshot.quiet
		    && (passo->inherits || passo->snapshot.line_room == passo->line_places);
	return passo->stream == PASSO_STREAM_NONE && passo_driver_at_rest(passo);
}

/* A motion that does not start is waiting for its inputs to be known. After the timeout it is flushed, since
 * it could start at any time. */
static enum passo_error see_wait(struct passo *passo)
{
	const uint32_t now = passo_driver_now(passo);
	const bool waits = passo->has_inputs && passo->snapshot.state == PASSO_STATE_IDLE
	                && passo->expects != PASSO_EXPECT_NOTHING && passo->stream != PASSO_STREAM_FILLS
	                && passo->gate != PASSO_GATE_CLOSED && passo->snapshot.quiet
	                && passo->snapshot.line_room != passo->line_places;
	bool blind = false;

	if (!waits || !passo->unbegun)
		passo->unbegun_since = now;
	passo->unbegun = waits;
	if (!waits || now - passo->unbegun_since < PASSO_INPUTS_MICROSECONDS)
		return PASSO_OK;
	enum passo_error error = passo_driver_is_blind(passo, &blind);
	if (error != PASSO_OK || !blind)
		return error != PASSO_OK ? miss(passo, error) : PASSO_OK;
	passo->unbegun = false;
	passo_driver_halt(passo, PASSO_DUE_STOP);
	return tell(passo, PASSO_ERROR_INPUTS_UNKNOWN);
}

static enum passo_error look(struct passo *passo)
{
	enum passo_error error = passo_driver_look(passo, true);

	if (error != PASSO_OK)
		return miss(passo, error);
	passo->misses = 0;
	if (passo->snapshot.state == PASSO_STATE_STOPPED)
		return see_stop(passo);
	if (!has_ended(passo))
		passo->idle_looks = 0;
	else if (passo->idle_looks < IDLE_LOOKS)
		passo->idle_looks++;
	return see_wait(passo);
}

/* Resends due commands; a failure is reported after as many attempts as other link errors. */
static enum passo_error resend_due(struct passo *passo)
{
	enum passo_error error = passo_driver_send_due(passo);

	if (error == PASSO_OK || error == PASSO_PENDING)
		return PASSO_OK;
	return error == PASSO_ERROR_CORE_RESET ? miss(passo, error) : passo_driver_due(passo);
}

static bool is_at(const struct passo *passo, const int32_t *positions)
{
	for (unsigned i = 0; i < passo->axes; i++) {
		if (positions[i] != passo->axis[i].expected)
			return false;
	}
	return true;
}

/* The channel is at rest: compares its positions with the expected ones. */
static enum passo_error see_end(struct passo *passo)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_positions(passo, positions, true);

	if (error != PASSO_OK)
		return miss(passo, error);
	passo->misses = 0;
	const bool is_wrong = passo->expects == PASSO_EXPECT_POSITIONS && !is_at(passo, positions);
#ifndef PASSO_WITHOUT_TRACKERS
	const uint8_t moved = passo->movers;
#endif
	passo_driver_ended(passo, positions);
#ifndef PASSO_WITHOUT_TRACKERS
	passo_driver_unpark(passo, moved);
#endif
	return is_wrong ? tell(passo, PASSO_ERROR_POSITION) : PASSO_OK;
}

static bool is_due(const struct passo *passo)
{
	const struct passo_hardware *hardware = &passo->host->hardware;

	if (hardware->irq && passo->snapshot.state != PASSO_STATE_STOPPED && hardware->irq(hardware->context))
		return true;
	return !hardware->microseconds
	    || passo_driver_now(passo) - passo->looked_at >= passo_driver_interval(passo);
}

static enum passo_error poll(struct passo *passo)
{
	enum passo_error error = PASSO_OK;
	bool sent = false;

	if (passo->host->lost) {
		passo_driver_end_stream(passo);
		return tell(passo, PASSO_ERROR_CORE_RESET);
	}
	if (passo->host->posted && passo->host->posted != &passo->posted) {
		passo_host_step(passo->host); /* another channel's frame has priority */
		return PASSO_OK;
	}
	if (passo_driver_due(passo) != PASSO_OK || passo->post > PASSO_POST_START)
		return resend_due(passo);
	if (passo->post == PASSO_POST_NONE && passo_host_is_unsure(passo->host))
		return look(passo);
	if (passo->stream != PASSO_STREAM_NONE) {
		error = passo_driver_feed(passo, &sent);
		if (error != PASSO_OK || sent)
			return error;
	}
	const bool expects = passo->expects != PASSO_EXPECT_NOTHING;
	if (expects && passo->idle_looks == IDLE_LOOKS)
		return see_end(passo);
	return is_due(passo) || (expects && passo->idle_looks != 0u) ? look(passo) : PASSO_OK;
}

enum passo_error passo_poll(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	error = poll(passo);
	return passo->task.kind != PASSO_TASK_NONE ? passo_driver_task(passo, error) : error;
}

bool passo_driver_in_motion(const struct passo *passo)
{
	return passo->expects != PASSO_EXPECT_NOTHING || passo->stream != PASSO_STREAM_NONE
	    || passo_driver_due(passo) == PASSO_ERROR_NOT_STOPPED;
}

bool passo_is_moving(const struct passo *passo)
{
	return passo && passo->assumed != PASSO_ASSUMED_NOT_OPEN
	    && (passo->task.kind != PASSO_TASK_NONE || passo_driver_in_motion(passo));
}

const struct passo_snapshot *passo_snapshot(const struct passo *passo)
{
	return &passo->snapshot;
}

enum passo_error passo_fault(const struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error == PASSO_ERROR_NOT_OPEN && passo->fault != PASSO_OK)
		return passo->fault;
	if (error != PASSO_OK)
		return error;
	error = passo->host->lost ? PASSO_OK : passo_driver_due(passo);
	return error != PASSO_OK ? error : passo->fault;
}

enum passo_error passo_wait(struct passo *passo, uint64_t timeout_clocks)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	const struct passo_hardware *hardware = &passo->host->hardware;
	struct passo_deadline deadline = passo_driver_deadline(passo, timeout_clocks);
	for (;;) {
		error = passo_poll(passo);
		if (error != PASSO_OK || !passo_is_moving(passo))
			return error;
		uint32_t idle = passo_idle_time(passo);
		const uint64_t left = passo_driver_left(passo, &deadline);
		if (left == 0u)
			return PASSO_ERROR_TIMEOUT;
		if (idle > left)
			idle = (uint32_t)left;
		if (hardware->wait && idle != 0u)
			hardware->wait(hardware->context, idle);
	}
}
