/* SPDX-License-Identifier: MIT
 * Link: words to frames to bus accesses, and the replies. See rtl/passo_link.v.
 */
#include "passo_model.h"

static uint8_t operation_of(uint32_t header)
{
	return (uint8_t)(header >> 28);
}
static uint8_t sequence_of(uint32_t header)
{
	return (uint8_t)(header >> 20 & 0xFFu);
}
static uint8_t length_of(uint32_t header)
{
	return (uint8_t)(header >> 12 & 0xFFu);
}
static uint16_t address_of(uint32_t header)
{
	return (uint16_t)(header & 0xFFFu);
}

/* Sequence and verdict, and their complement. */
static uint32_t acknowledge(uint8_t sequence, uint8_t verdict)
{
	const uint32_t half = (uint32_t)sequence << 8 | verdict;
	return half << 16 | (~half & 0xFFFFu);
}

void passo_link_reset(struct passo_link *link)
{
	*link = (struct passo_link){.step = PASSO_LINK_IDLE};
}

bool passo_link_quiet(const struct passo_link *link)
{
	const struct passo_bus *bus = &link->bus;
	const bool waits = link->step != PASSO_LINK_VERDICT && link->step != PASSO_LINK_REPLAY
	                && link->step != PASSO_LINK_READ;
	return waits && link->crc.busy == 0u && !link->crc_start && link->crc_idle_q && !link->crc_restart
	    && !link->answer_due && !link->stage_high && !link->stage_low && !link->refused && !bus->frame
	    && !bus->check && !bus->write && !bus->read;
}

static void take_header(struct passo_link *link, uint32_t word)
{
	const uint8_t operation = operation_of(word);
	const bool is_read = operation == PASSO_OPERATION_READ;
	const bool is_known =
	    is_read || operation == PASSO_OPERATION_WRITE || operation == PASSO_OPERATION_PUSH;
	const bool fits = length_of(word) != 0u && length_of(word) <= PASSO_PAYLOAD_MAX;
	const bool repeated = link->sequence_known && !is_read && sequence_of(word) == link->last_sequence;

	link->header = word;
	link->bus.address = address_of(word);
	link->bus.frame = true;
	link->index = 0;
	link->crc_word = word;
	link->crc_start = true;
	link->verdict = !is_known ? PASSO_VERDICT_BAD_OPERATION
	              : !fits     ? PASSO_VERDICT_BAD_LENGTH
	              : repeated  ? PASSO_VERDICT_DUPLICATE
	                          : PASSO_VERDICT_OK;
	link->step = is_read || length_of(word) == 0u ? PASSO_LINK_CRC : PASSO_LINK_PAYLOAD;
}

static void give_verdict(struct passo_link *link, bool incomplete)
{
	const uint8_t verdict = link->crc.crc != 0u               ? PASSO_VERDICT_BAD_CRC
	                      : link->verdict != PASSO_VERDICT_OK ? link->verdict
	                      : incomplete                        ? PASSO_VERDICT_BAD_LENGTH
	                                                          : PASSO_VERDICT_OK;

	link->reply_word = acknowledge(sequence_of(link->header), verdict);
	link->refused = verdict != PASSO_VERDICT_OK && verdict != PASSO_VERDICT_DUPLICATE;
	link->refused_verdict = verdict;
	link->index = 0;
	link->phase = 0;
	link->bus.address = address_of(link->header);
	link->bus.frame = true;
	if (verdict != PASSO_VERDICT_OK) {
		link->step = PASSO_LINK_DONE;
	} else if (operation_of(link->header) == PASSO_OPERATION_READ) {
		link->crc_word = link->header;
		link->crc_restart = true;
		link->crc_start = true;
		link->step = PASSO_LINK_READ;
	} else {
		link->last_sequence = sequence_of(link->header);
		link->sequence_known = true;
		link->step = PASSO_LINK_REPLAY;
	}
}

static void next_word(struct passo_link *link, enum passo_link_step step_after_last)
{
	link->index++;
	if (link->index == length_of(link->header))
		link->step = step_after_last;
}

void passo_link_clock(struct passo_link *link, const struct passo_link_wires *wires)
{
	const struct passo_link was = {
	    .step = link->step,
	    .phase = link->phase,
	    .frame_waits = link->frame_waits,
	    .answer_due = link->answer_due,
	    .crc_restart = link->crc_restart,
	    .crc_start = link->crc_start,
	    .crc_word = link->crc_word,
	    .crc = link->crc,
	    .stage_high = link->stage_high,
	    .stage_low = link->stage_low,
	    .bus = link->bus,
	};
	const bool crc_idle = was.crc.busy == 0u && !was.crc_start;
	const bool verdict_due = crc_idle && link->crc_idle_q;
	const bool frame_goes_on =
	    (was.frame_waits || wires->spi.frame_start) && !wires->spi.frame_end && !wires->spi.word_valid;
	const uint8_t answer =
	    wires->response.claim ? wires->response.refusal : PASSO_VERDICT_UNKNOWN_ADDRESS;

	if (was.stage_low)
		link->payload[link->index & 63u] = was.bus.data;

	link->bus.frame = link->bus.write = link->bus.read = false;
	link->bus.check = was.stage_high;
	link->answer_due = was.bus.check;
	link->crc_restart = link->crc_start = false;
	link->stage_high = false;
	link->stage_low = was.stage_high;
	link->refused = false;
	link->crc_idle_q = crc_idle;

	if (was.answer_due && link->verdict == PASSO_VERDICT_OK)
		link->verdict = answer;
	if ((was.bus.check || was.bus.write) && !was.bus.push)
		link->bus.address = (was.bus.address + 1u) & 0xFFFu;

	switch (was.step) {
	case PASSO_LINK_HEADER:
		if (wires->spi.word_valid)
			take_header(link, wires->word);
		break;
	case PASSO_LINK_PAYLOAD:
		if (was.stage_low)
			next_word(link, PASSO_LINK_CRC);
		if (wires->spi.word_valid) {
			link->bus.data = wires->word;
			link->stage_high = true;
			link->crc_word = wires->word;
			link->crc_start = true;
		}
		break;
	case PASSO_LINK_CRC:
		if (wires->spi.word_valid) {
			link->crc_word = wires->word;
			link->crc_start = true;
			link->step = PASSO_LINK_VERDICT;
		}
		break;
	case PASSO_LINK_VERDICT:
		if (verdict_due)
			give_verdict(link, wires->incomplete);
		break;
	case PASSO_LINK_REPLAY:
		link->phase = (was.phase + 1u) & 3u;
		if (was.phase == 2u)
			link->bus.data = link->payload[link->index];
		if (was.phase == 3u) {
			link->bus.write = true;
			next_word(link, frame_goes_on ? PASSO_LINK_HEADER : PASSO_LINK_DONE);
			link->crc_restart = link->step != PASSO_LINK_REPLAY;
		}
		break;
	case PASSO_LINK_READ:
		if (was.phase != 3u)
			link->phase++;
		if (was.phase == 0u)
			link->bus.read = true;
		if (was.phase == 2u) {
			link->crc_word = wires->response.read_data;
			if (link->index == 0u && answer != PASSO_VERDICT_OK) {
				link->reply_word = acknowledge(sequence_of(link->header), answer);
				link->refused = true;
				link->refused_verdict = answer;
				link->step = PASSO_LINK_DONE;
			}
		}
		if (was.phase == 3u && crc_idle) {
			link->reply_word = was.crc_word;
			link->crc_start = true;
			link->phase = 0;
			link->index++;
			link->bus.address = (was.bus.address + 1u) & 0xFFFu;
			link->step = PASSO_LINK_SEND;
		}
		break;
	case PASSO_LINK_SEND:
		if (wires->spi.word_valid) {
			if (link->index != length_of(link->header)) {
				link->step = PASSO_LINK_READ;
			} else {
				link->reply_word = was.crc.crc;
				link->step = PASSO_LINK_DONE;
			}
		}
		break;
	case PASSO_LINK_IDLE:
	case PASSO_LINK_DONE:
		break;
	}

	if (wires->spi.frame_start)
		link->reply_word = wires->status;
	link->frame_waits = was.step == PASSO_LINK_REPLAY && frame_goes_on;
	if (was.step != PASSO_LINK_REPLAY && !(was.step == PASSO_LINK_VERDICT && verdict_due)) {
		if (wires->spi.frame_end)
			link->step = PASSO_LINK_IDLE;
		if (wires->spi.frame_start) {
			link->step = PASSO_LINK_HEADER;
			link->crc_restart = true;
		}
	}
	link->bus.push = operation_of(link->header) == PASSO_OPERATION_PUSH;
	passo_crc_clock(&link->crc, was.crc_restart, was.crc_start, was.crc_word);
}
