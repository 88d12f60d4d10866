/* SPDX-License-Identifier: MIT
 * The source of a stream: when to call it, and how many items to take.
 */
#include "passo_driver.h"

static uint32_t smaller(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

/* Items of a frame: as many as fit, or a quarter of a short queue. */
static uint32_t frame(uint32_t words, uint32_t places)
{
	return smaller(PASSO_FRAME_PAYLOAD_MAX / words, (places + 3u) / 4u);
}

/* Number of items that justifies a frame; any before the motion starts. */
static uint32_t worthwhile(const struct passo *passo, uint32_t words, uint32_t places)
{
	return passo->stream == PASSO_STREAM_FILLS ? 1u : frame(words, places);
}

bool passo_driver_lines_are_urgent(const struct passo *passo)
{
	const uint32_t lines = (uint32_t)(passo->line_places - passo->snapshot.line_room);
	const uint32_t ramps = (uint32_t)(passo->ramp_places - passo->snapshot.ramp_room);

	return lines * frame(PASSO_RAMP_WORDS, passo->ramp_places)
	     < ramps * frame(passo->host->line_words, passo->line_places);
}

bool passo_driver_wants_lines(const struct passo *passo)
{
	return passo->lines == PASSO_SUPPLY_MORE
	    && passo->snapshot.line_room >= worthwhile(passo, passo->host->line_words, passo->line_places);
}

bool passo_driver_wants_ramps(const struct passo *passo)
{
	return passo->ramps == PASSO_SUPPLY_MORE
	    && passo->snapshot.ramp_room >= worthwhile(passo, PASSO_RAMP_WORDS, passo->ramp_places);
}

/* A source that had no items may have some now. */
static enum passo_supply ask_again(enum passo_supply supply)
{
	return supply == PASSO_SUPPLY_DRY ? PASSO_SUPPLY_MORE : supply;
}

void passo_driver_ask_again(struct passo *passo)
{
	passo->lines = ask_again(passo->lines);
	passo->ramps = ask_again(passo->ramps);
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

/* NOW needs a motion. */
static bool is_ramp(const struct passo *passo, const struct passo_ramp *ramp)
{
	return (!ramp->now || passo->stream == PASSO_STREAM_RUNS) && ramp->velocity_end <= PASSO_VELOCITY_MAX
	    && (unsigned)ramp->shape <= PASSO_BANKS && ramp->progress_step <= PASSO_PROGRESS_STEP_MAX;
}

enum passo_error passo_driver_take_lines(struct passo *passo, size_t *length)
{
	const uint32_t most =
	    smaller(passo->snapshot.line_room, PASSO_FRAME_PAYLOAD_MAX / passo->host->line_words);
	uint32_t *payload = passo_host_payload(passo->host);
	uint32_t count = 0;

	while (count < most && passo->lines != PASSO_SUPPLY_DONE) {
		struct passo_line line = {0};
		if (!passo->source.line(passo->source.context, &line)) {
			passo->lines = PASSO_SUPPLY_DRY;
			break;
		}
		if (!is_line(passo, &line))
			return PASSO_ERROR_SUPPLY;
		if (!passo_driver_pins_known(passo, &line))
			return PASSO_ERROR_NOT_CONFIGURED;
		const enum passo_error error = passo_driver_check_output(passo, line.output);
		if (error != PASSO_OK)
			return error;
		*length += passo_driver_line_words(passo, payload + *length, &line);
		if (line.last)
			passo->lines = PASSO_SUPPLY_DONE;
		passo_driver_expect(passo, &line);
		count++;
	}
	passo->packed_lines = (uint8_t)count;
	return PASSO_OK;
}

enum passo_error passo_driver_take_ramps(struct passo *passo, size_t *length)
{
	const uint32_t most = smaller(passo->snapshot.ramp_room, PASSO_FRAME_PAYLOAD_MAX / PASSO_RAMP_WORDS);
	uint32_t *payload = passo_host_payload(passo->host);
	uint32_t count = 0;

	while (count < most && passo->ramps != PASSO_SUPPLY_DONE) {
		struct passo_ramp ramp = {0};
		if (!passo->source.ramp(passo->source.context, &ramp)) {
			passo->ramps = PASSO_SUPPLY_DRY;
			break;
		}
		if (!is_ramp(passo, &ramp))
			return PASSO_ERROR_SUPPLY;
		*length += passo_ramp_words(payload + *length, &ramp);
		if (ramp.last)
			passo->ramps = PASSO_SUPPLY_DONE;
		count++;
	}
	passo->packed_ramps = (uint8_t)count;
	return PASSO_OK;
}
