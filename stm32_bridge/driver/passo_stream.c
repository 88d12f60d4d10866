/* SPDX-License-Identifier: MIT
 * Streams: feed a path of any length through the queues without overflow or underrun.
 *
 * The queues are filled behind a closed gate, which opens when they are full or everything is sent.
 */
#include "passo_driver.h"

#define LOOK_MICROSECONDS 1000u
#define LOOK_MICROSECONDS_STREAMING 50u
/* A shorter queue can underrun in that time. */
#define PLACES_FEW 64u

/* The queues are filled: the stream can start. */
static bool is_filled(const struct passo *passo)
{
	return passo->stream == PASSO_STREAM_FILLS
	    && (passo->lines == PASSO_SUPPLY_DONE || passo->snapshot.line_room == 0u)
	    && (passo->ramps == PASSO_SUPPLY_DONE || passo->snapshot.ramp_room == 0u);
}

uint32_t passo_driver_interval(const struct passo *passo)
{
	if (passo->stream == PASSO_STREAM_NONE)
		return LOOK_MICROSECONDS;
	return passo->line_places < PLACES_FEW ? 0u : LOOK_MICROSECONDS_STREAMING;
}

void passo_driver_end_stream(struct passo *passo)
{
	passo->stream = PASSO_STREAM_NONE;
	passo->packed_lines = passo->packed_ramps = 0;
	passo->host->prepared = 0;
	if (passo->post == PASSO_POST_ITEMS || passo->post == PASSO_POST_START)
		passo_driver_drop(passo);
}

static enum passo_error fail(struct passo *passo, enum passo_error error)
{
	passo_driver_end_stream(passo);
	passo_driver_halt(passo, PASSO_DUE_STOP);
	passo_driver_assume_worse(passo, PASSO_ASSUMED_BROKEN);
	passo->fault = error;
	return error;
}

enum passo_error passo_driver_settle_stream(struct passo *passo)
{
	const struct passo_host *host = passo->host;
	struct passo_snapshot *snapshot = &passo->snapshot;
	const enum passo_post done = passo->post;
	const enum passo_error error = passo->posted;

	passo->post = PASSO_POST_NONE;
	if (done == PASSO_POST_START && error == PASSO_OK) {
		passo->stream = PASSO_STREAM_RUNS;
		return PASSO_OK;
	}
	if ((unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_BUSY) {
		passo_driver_end_stream(passo); /* it has stopped; the next status read shows the cause */
		return PASSO_OK;
	}
	if (error != PASSO_OK)
		return fail(passo, error);
	if (passo_unpack_status(host->status).channel != passo->channel)
		return PASSO_OK;
	/* both are lower bounds */
	if (snapshot->line_room < host->line_room)
		snapshot->line_room = host->line_room;
	if (snapshot->ramp_room < host->ramp_room)
		snapshot->ramp_room = host->ramp_room;
	return PASSO_OK;
}

static bool is_packed(const struct passo *passo)
{
	return passo->packed_lines != 0u || passo->packed_ramps != 0u;
}

bool passo_driver_is_sending(const struct passo *passo)
{
	return passo->post != PASSO_POST_NONE || is_packed(passo);
}

/* Prepares a frame of lines or of ramps, if there are any. */
static enum passo_error pack_items(struct passo *passo, bool lines, size_t *length)
{
	const uint16_t address = lines ? PASSO_CHANNEL_LINE : PASSO_CHANNEL_RAMP;

	if (!(lines ? passo_driver_wants_lines(passo) : passo_driver_wants_ramps(passo)))
		return PASSO_OK;
	const enum passo_error error =
	    lines ? passo_driver_take_lines(passo, length) : passo_driver_take_ramps(passo, length);
	if (error == PASSO_OK && *length != 0u)
		passo_host_prepare_push(passo->host, (uint16_t)(passo->base + address), *length);
	return error;
}

/* First what the core needs first. */
static enum passo_error pack(struct passo *passo)
{
	const bool lines = passo_driver_lines_are_urgent(passo);
	size_t length = 0;

	passo_driver_ask_again(passo);
	const enum passo_error error = pack_items(passo, lines, &length);
	return error == PASSO_OK && length == 0u ? pack_items(passo, !lines, &length) : error;
}

static enum passo_error step(struct passo *passo)
{
	passo_host_step(passo->host);
	return passo->posted == PASSO_PENDING ? PASSO_OK : passo_driver_settle_stream(passo);
}

static enum passo_error send_packed(struct passo *passo)
{
	struct passo_snapshot *snapshot = &passo->snapshot;

	snapshot->line_room = (uint16_t)(snapshot->line_room - passo->packed_lines);
	snapshot->ramp_room = (uint16_t)(snapshot->ramp_room - passo->packed_ramps);
	passo->packed_lines = passo->packed_ramps = 0;
	passo->post = PASSO_POST_ITEMS;
	return passo_host_post_push(passo->host, &passo->posted);
}

static enum passo_error send_start(struct passo *passo)
{
	passo->post = PASSO_POST_START;
	return passo_host_post_write(
	    passo->host, PASSO_ADDRESS_RUN, passo_driver_run(passo, passo->gate), &passo->posted);
}

enum passo_error passo_driver_feed(struct passo *passo, bool *sent)
{
	const struct passo_host *host = passo->host;
	const bool flew = host->in_flight;
	enum passo_error error = PASSO_OK;

	*sent = passo->post != PASSO_POST_NONE;
	if (*sent) {
		error = step(passo);
		if (error != PASSO_OK || passo->stream == PASSO_STREAM_NONE || !flew)
			return error;
	}
	if (!is_packed(passo)
	    && (passo->post == PASSO_POST_NONE || (host->in_flight && host->ahead != host->send)))
		error = pack(passo);
	if (error != PASSO_OK)
		return fail(passo, error);
	if (passo->post != PASSO_POST_NONE)
		return PASSO_OK;
	if (is_packed(passo)) {
		error = send_packed(passo);
	} else if (is_filled(passo)) {
		error = send_start(passo);
	} else {
		if (passo->stream == PASSO_STREAM_RUNS && passo->lines == PASSO_SUPPLY_DONE
		    && passo->ramps == PASSO_SUPPLY_DONE)
			passo->stream = PASSO_STREAM_NONE;
		return PASSO_OK;
	}
	if (error != PASSO_OK)
		return fail(passo, error);
	*sent = true;
	return step(passo);
}

enum passo_error passo_stream(struct passo *passo, const struct passo_source *source)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!source || !source->line || !source->ramp)
		return PASSO_ERROR_ARGUMENT_POINTER;
	error = passo_driver_ready(passo, true);
	if (error == PASSO_OK)
		error = passo_driver_unfollow(passo);
	if (error == PASSO_OK)
		error = passo_driver_gate(passo, PASSO_GATE_CLOSED);
	if (error != PASSO_OK)
		return error;
	passo->source = *source;
	passo->stream = PASSO_STREAM_FILLS;
	passo->lines = passo->ramps = PASSO_SUPPLY_MORE;
	return PASSO_OK;
}

enum passo_error passo_stream_start(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (passo->stream != PASSO_STREAM_FILLS)
		return PASSO_ERROR_NOT_PREPARED;
	if (passo->post == PASSO_POST_START)
		passo_driver_drop(passo);
	error = passo_driver_gate(passo, passo->gate);
	if (error != PASSO_OK)
		return fail(passo, error);
	passo->stream = PASSO_STREAM_RUNS;
	return PASSO_OK;
}

bool passo_is_streaming(const struct passo *passo)
{
	return passo && passo->stream != PASSO_STREAM_NONE;
}

uint32_t passo_idle_time(const struct passo *passo)
{
	if (passo_driver_check(passo) != PASSO_OK)
		return 0;
	if (passo->stream != PASSO_STREAM_NONE
	    && (passo_driver_is_sending(passo) || passo_driver_wants_lines(passo)
	        || passo_driver_wants_ramps(passo) || is_filled(passo)))
		return 0;
	if (passo_driver_due(passo) != PASSO_OK
	    || (passo->expects != PASSO_EXPECT_NOTHING && passo->idle_looks != 0u))
		return 0;
	const uint32_t since = passo_driver_now(passo) - passo->looked_at;
	const uint32_t interval = passo_driver_interval(passo);
	return since < interval ? interval - since : 0u;
}
