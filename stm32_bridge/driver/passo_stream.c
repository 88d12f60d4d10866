/* SPDX-License-Identifier: MIT
 * Streams: a path of any length goes through queues of any length, without overfilling or starving them.
 *
 * The path is prepared behind a closed gate, which opens when the queues are full or all is sent.
 */
#include "passo_driver.h"

#define LOOK_MICROSECONDS 1000u
#define LOOK_MICROSECONDS_STREAMING 50u
/* A queue with fewer places may run dry in that time. */
#define PLACES_FEW 64u
#define STATUS_CHANNEL_LSB 24u

static uint32_t line_words(const struct passo *passo)
{
	return PASSO_LINE_WORDS((uint32_t)passo->machine.axes);
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

/* So many at a time are worth a frame: as many as fit, half a small queue; anything while nothing moves yet.
 */
static uint32_t worthwhile(const struct passo *passo, uint32_t words, uint32_t places)
{
	return passo->stream == PASSO_STREAM_FILLS ? 1u
	                                           : smaller(PASSO_FRAME_PAYLOAD_MAX / words, places / 2u);
}

static bool wants_lines(const struct passo *passo)
{
	return !passo->lines_done && !passo->lines_dry
	    && passo->snapshot.line_room >= worthwhile(passo, line_words(passo), passo->line_places);
}

static bool wants_ramps(const struct passo *passo)
{
	return !passo->ramps_done && !passo->ramps_dry
	    && passo->snapshot.ramp_room >= worthwhile(passo, PASSO_RAMP_WORDS, passo->ramp_places);
}

/* The stream can begin. */
static bool is_prepared(const struct passo *passo)
{
	return passo->stream == PASSO_STREAM_FILLS && (passo->lines_done || passo->snapshot.line_room == 0u)
	    && (passo->ramps_done || passo->snapshot.ramp_room == 0u);
}

uint32_t passo_driver_interval(const struct passo *passo)
{
	if (passo->stream == PASSO_STREAM_NONE)
		return LOOK_MICROSECONDS;
	return passo->line_places < PLACES_FEW ? 0u : LOOK_MICROSECONDS_STREAMING;
}

static bool is_line(const struct passo *passo, const struct passo_line *line)
{
	if (line->substeps == 0u || line->substeps > PASSO_SUBSTEPS_MAX
	    || line->directions >> passo->machine.axes != 0u)
		return false;
	for (unsigned i = 0; i < passo->machine.axes; i++) {
		if (line->steps[i] > line->substeps)
			return false;
	}
	return true;
}

static bool is_ramp(const struct passo_ramp *ramp)
{
	return !ramp->now && ramp->velocity_end <= PASSO_VELOCITY_MAX
	    && (unsigned)ramp->shape <= PASSO_SHAPE_EASE && ramp->progress_step <= PASSO_PROGRESS_STEP_MAX;
}

/* As many lines as there are, are wanted, and have room. */
static enum passo_error take_lines(struct passo *passo, size_t *length)
{
	const uint32_t most = smaller(passo->snapshot.line_room, PASSO_FRAME_PAYLOAD_MAX / line_words(passo));
	uint32_t *payload = passo_host_payload(passo->host);
	uint32_t count = 0;

	while (count < most && !passo->lines_done) {
		struct passo_line line = {0};
		if (!passo->source.line(passo->source.context, &line)) {
			passo->lines_dry = true;
			break;
		}
		if (!is_line(passo, &line))
			return PASSO_ERROR_SUPPLY;
		if (!passo_driver_pins_known(passo, &line))
			return PASSO_ERROR_NOT_CONFIGURED;
		*length += passo_line_words(payload + *length, &line, passo->machine.axes);
		passo->lines_done = line.last;
		passo->certain = passo->certain && !line.endless;
		passo_driver_expect(passo, &line);
		count++;
	}
	passo->snapshot.line_room = (uint16_t)(passo->snapshot.line_room - count);
	return PASSO_OK;
}

static enum passo_error take_ramps(struct passo *passo, size_t *length)
{
	const uint32_t most = smaller(passo->snapshot.ramp_room, PASSO_FRAME_PAYLOAD_MAX / PASSO_RAMP_WORDS);
	uint32_t *payload = passo_host_payload(passo->host);
	uint32_t count = 0;

	while (count < most && !passo->ramps_done) {
		struct passo_ramp ramp = {0};
		if (!passo->source.ramp(passo->source.context, &ramp)) {
			passo->ramps_dry = true;
			break;
		}
		if (!is_ramp(&ramp))
			return PASSO_ERROR_SUPPLY;
		*length += passo_ramp_words(payload + *length, &ramp);
		passo->ramps_done = ramp.last;
		count++;
	}
	passo->snapshot.ramp_room = (uint16_t)(passo->snapshot.ramp_room - count);
	return PASSO_OK;
}

void passo_driver_end_stream(struct passo *passo)
{
	passo->stream = PASSO_STREAM_NONE;
	if (passo->post == PASSO_POST_ITEMS || passo->post == PASSO_POST_START)
		passo_driver_drop(passo);
}

static enum passo_error fail(struct passo *passo, enum passo_error error)
{
	passo_driver_halt(passo, PASSO_DUE_STOP);
	passo->broken = true;
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
		passo_driver_end_stream(passo); /* it has stopped; the next look tells why */
		return PASSO_OK;
	}
	if (error != PASSO_OK)
		return fail(passo, error);
	if ((host->status >> STATUS_CHANNEL_LSB & 7u) != passo->channel)
		return PASSO_OK;
	/* both are never too much */
	if (snapshot->line_room < host->line_room)
		snapshot->line_room = host->line_room;
	if (snapshot->ramp_room < host->ramp_room)
		snapshot->ramp_room = host->ramp_room;
	return PASSO_OK;
}

enum passo_error passo_driver_feed(struct passo *passo, bool *sent)
{
	enum passo_error error = PASSO_OK;
	uint16_t address = PASSO_CHANNEL_RAMP;
	size_t length = 0;

	*sent = false;
	passo->lines_dry = passo->ramps_dry = false;
	if (passo->post == PASSO_POST_NONE) {
		if (wants_ramps(passo))
			error = take_ramps(passo, &length);
		if (error == PASSO_OK && length == 0u && wants_lines(passo)) {
			address = PASSO_CHANNEL_LINE;
			error = take_lines(passo, &length);
		}
		if (error != PASSO_OK)
			return fail(passo, error);
		if (length == 0u && is_prepared(passo)) {
			*passo_host_payload(passo->host) = passo_driver_run(passo, passo->gate);
			passo->post = PASSO_POST_START;
			error = passo_host_post_write(passo->host, PASSO_ADDRESS_RUN, 1, &passo->posted);
		} else if (length == 0u) {
			if (passo->stream == PASSO_STREAM_RUNS && passo->lines_done && passo->ramps_done)
				passo->stream = PASSO_STREAM_NONE;
			return PASSO_OK;
		} else {
			passo->post = PASSO_POST_ITEMS;
			error = passo_host_post_push(
			    passo->host, (uint16_t)(passo->base + address), length, &passo->posted);
		}
		if (error != PASSO_OK)
			return fail(passo, error);
	}
	*sent = true;
	passo_host_step(passo->host);
	return passo->posted == PASSO_PENDING ? PASSO_OK : passo_driver_settle_stream(passo);
}

enum passo_error passo_stream(struct passo *passo, const struct passo_source *source)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!source || !source->line || !source->ramp)
		return PASSO_ERROR_ARGUMENT;
	error = passo_driver_ready(passo, true);
	if (error == PASSO_OK)
		error = passo_driver_gate(passo, PASSO_GATE_CLOSED);
	if (error != PASSO_OK)
		return error;
	passo->source = *source;
	passo->stream = PASSO_STREAM_FILLS;
	passo->lines_done = passo->ramps_done = false;
	return PASSO_OK;
}

enum passo_error passo_stream_start(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (passo->stream != PASSO_STREAM_FILLS)
		return PASSO_ERROR_ARGUMENT;
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
	    && (passo->post != PASSO_POST_NONE || wants_lines(passo) || wants_ramps(passo)
	        || is_prepared(passo)))
		return 0;
	if (passo_driver_due(passo) != PASSO_OK || (passo->expecting && passo->idle_looks != 0u))
		return 0;
	const uint32_t since = passo_driver_now(passo) - passo->looked_at;
	const uint32_t interval = passo_driver_interval(passo);
	return since < interval ? interval - since : 0u;
}
