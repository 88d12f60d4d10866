/* SPDX-License-Identifier: MIT
 * Commands that are resent until they are acknowledged: abort, stop, rate (hold and override), gate.
 *
 * They are idempotent, so repeating one that was already executed is harmless.
 */
#include "passo_driver.h"

/* The due command of highest priority. */
static enum passo_post urgent(const struct passo *passo)
{
	if (passo->stop_due != PASSO_DUE_NOTHING)
		return passo->stop_due == PASSO_DUE_ABORT ? PASSO_POST_ABORT : PASSO_POST_STOP;
	if (passo->rate_due)
		return PASSO_POST_RATE;
	return passo->host->run_due ? PASSO_POST_RUN : PASSO_POST_NONE;
}

enum passo_error passo_driver_due(const struct passo *passo)
{
	const enum passo_post most = urgent(passo);

	if (most == PASSO_POST_NONE)
		return PASSO_OK;
	return most >= PASSO_POST_STOP ? PASSO_ERROR_NOT_STOPPED : PASSO_ERROR_NOT_HELD;
}

void passo_driver_drop(struct passo *passo)
{
	if (passo->host->posted == &passo->posted)
		passo_host_drop(passo->host);
	passo->post = PASSO_POST_NONE;
}

static enum passo_error post(struct passo *passo, enum passo_post most)
{
	uint32_t word = passo->host->run;
	uint16_t address = PASSO_ADDRESS_RUN;

	if (most == PASSO_POST_RATE) {
		word = passo_driver_rate(passo);
		address = (uint16_t)(passo->base + PASSO_CHANNEL_RATE_TARGET);
	} else if (most != PASSO_POST_RUN) {
		word = passo_pack_channel_command(&(struct passo_channel_command){
		    .abort = most == PASSO_POST_ABORT, .stop = most == PASSO_POST_STOP});
		address = (uint16_t)(passo->base + PASSO_CHANNEL_COMMAND);
	}
	enum passo_error error = passo_host_post_write(passo->host, address, word, &passo->posted);
	if (error == PASSO_OK)
		passo->post = most;
	return error;
}

/* The command was executed. A posted stop is dropped when an abort becomes due, so `done` is the due one. */
static void acknowledge(struct passo *passo, enum passo_post done)
{
	if (done == PASSO_POST_RATE)
		passo->rate_due = false;
	else if (done >= PASSO_POST_STOP)
		passo->stop_due = PASSO_DUE_NOTHING;
}

/* Handles the result of the posted frame. */
static enum passo_error settle(struct passo *passo)
{
	const enum passo_post done = passo->post;
	enum passo_error error = passo->posted;

	if (done == PASSO_POST_ITEMS || done == PASSO_POST_START) {
		error = passo_driver_settle_stream(passo);
	} else {
		passo->post = PASSO_POST_NONE;
		if (error == PASSO_OK)
			acknowledge(passo, done);
	}
	if (error != PASSO_OK)
		return error;
	return urgent(passo) == PASSO_POST_NONE ? PASSO_OK : PASSO_PENDING;
}

enum passo_error passo_driver_send_due(struct passo *passo)
{
	struct passo_host *host = passo->host;
	const enum passo_post most = urgent(passo);
	enum passo_error error = PASSO_OK;

	/* a stop preempts a frame that is being retried; lines or ramps that it holds may be lost */
	if (most >= PASSO_POST_STOP && passo->post < most && !host->in_flight) {
		if (passo->post == PASSO_POST_ITEMS)
			passo_driver_end_stream(passo);
		passo_driver_drop(passo);
	}
	if (passo->post == PASSO_POST_NONE) {
		if (most == PASSO_POST_NONE)
			return PASSO_OK;
		if (host->posted) { /* another channel's */
			passo_host_step(host);
			return PASSO_PENDING;
		}
		if (passo_host_is_unsure(host)) {
			error = passo_driver_look(passo, true);
			return error == PASSO_OK ? PASSO_PENDING : error;
		}
		error = post(passo, most);
		if (error != PASSO_OK)
			return error;
	}
	passo_host_step(host);
	/* else it is gone if the host was opened again */
	return host->posted == &passo->posted ? PASSO_PENDING : settle(passo);
}

enum passo_error passo_driver_send_due_until(struct passo *passo, enum passo_post least)
{
	enum passo_error error = PASSO_PENDING;

	while (error == PASSO_PENDING && urgent(passo) >= least)
		error = passo_driver_send_due(passo);
	return error == PASSO_PENDING ? PASSO_OK : error;
}

enum passo_error passo_driver_require_sent(struct passo *passo, enum passo_post least)
{
	passo_driver_send_due_until(passo, least);
	if (passo->host->lost)
		return PASSO_ERROR_CORE_RESET;
	return urgent(passo) >= least ? passo_driver_due(passo) : PASSO_OK;
}

void passo_driver_halt(struct passo *passo, enum passo_due due)
{
	/* in a soft stop the path continues, and needs its lines */
	if (due == PASSO_DUE_ABORT || passo->stream != PASSO_STREAM_RUNS)
		passo_driver_end_stream(passo);
	passo->task.kind = PASSO_TASK_NONE;
	if (passo->expects == PASSO_EXPECT_POSITIONS)
		passo->expects = PASSO_EXPECT_END;
	passo_driver_assume_worse(passo, PASSO_ASSUMED_STOPPED);
	if (passo->stop_due < due)
		passo->stop_due = due;
}
