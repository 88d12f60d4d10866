/* SPDX-License-Identifier: MIT
 * States of a frame on the link. See rtl/passo_link_states.v, rtl/passo_header.v and rtl/passo_verdict.v.
 */
#include "passo_link_schedule.h"
#include "passo_model.h"
#include "passo_words.h"

static void begin_pass(struct passo_link *link)
{
	link->bus.address = passo_unpack_header(link->bus.data).address;
	link->index = 0;
}

static void take_header(struct passo_link *link)
{
	const struct passo_header header = passo_unpack_header(link->bus.data);
	const bool is_read = header.operation == PASSO_OPERATION_READ;
	const bool is_push = header.operation == PASSO_OPERATION_PUSH;
	const bool is_known = is_read || is_push || header.operation == PASSO_OPERATION_WRITE;
	const bool fits = header.length != 0u && header.length <= PASSO_PAYLOAD_MAX;
	const bool repeated = link->sequence_known && !is_read && header.sequence == link->last_sequence;

	link->is_read = is_read;
	link->bus.push = is_push;
	link->length = header.length;
	link->verdict = !is_known ? PASSO_VERDICT_BAD_OPERATION
	              : !fits     ? PASSO_VERDICT_BAD_LENGTH
	              : repeated  ? PASSO_VERDICT_DUPLICATE
	                          : PASSO_VERDICT_OK;
	link->step = is_read || link->length == 0u ? PASSO_LINK_CRC : PASSO_LINK_PAYLOAD;
	link->bus.frame = true;
	begin_pass(link);
}

static void give_verdict(struct passo_link *link, const struct passo_link_wires *wires)
{
	if (link->crc_wrong)
		link->verdict = PASSO_VERDICT_BAD_CRC;
	else if (link->verdict == PASSO_VERDICT_OK && wires->incomplete)
		link->verdict = PASSO_VERDICT_BAD_LENGTH;
	else if (link->verdict == PASSO_VERDICT_OK && wires->busy)
		link->verdict = PASSO_VERDICT_BUSY;
	link->index = 0;
	if (link->is_read && link->verdict == PASSO_VERDICT_OK) {
		link->count = COUNT_READ;
		link->step = PASSO_LINK_READ;
	} else {
		link->count = COUNT_LOAD;
		link->step = PASSO_LINK_ACK;
	}
}

static void end_acknowledge(struct passo_link *link)
{
	link->refused = link->verdict != PASSO_VERDICT_OK && link->verdict != PASSO_VERDICT_DUPLICATE;
	link->step = PASSO_LINK_IDLE;
	if (link->verdict == PASSO_VERDICT_OK) {
		link->last_sequence = passo_unpack_header(link->bus.data).sequence;
		link->sequence_known = true;
		link->count = COUNT_LOAD;
		link->step = PASSO_LINK_REPLAY;
		link->bus.frame = true;
	}
	if (link->refused) {
		link->count = COUNT_LOAD;
		link->step = PASSO_LINK_COUNT;
	}
	begin_pass(link);
}

void passo_link_states_clock(struct passo_link *link, const struct passo_link_wires *wires,
    const struct passo_link *was, bool word_valid, bool frame_goes_on)
{
	const bool act = was->count == COUNT_ACT;

	switch (was->step) {
	case PASSO_LINK_HEADER:
		if (word_valid)
			link->count = COUNT_LOAD;
		if (act)
			take_header(link);
		break;
	case PASSO_LINK_PAYLOAD:
		if (word_valid)
			link->count = COUNT_LOAD;
		link->bus.check = act;
		if (act)
			link->index++;
		if (was->all_words)
			link->step = PASSO_LINK_CRC;
		break;
	case PASSO_LINK_CRC:
		if (word_valid)
			link->count = COUNT_LOAD;
		if (act)
			give_verdict(link, wires);
		break;
	case PASSO_LINK_ACK:
		if (act)
			end_acknowledge(link);
		break;
	case PASSO_LINK_REPLAY:
		/* a word is complete when loading of the next one starts */
		link->bus.write = was->count == COUNT_LOAD && was->index != 0u;
		if (was->count == COUNT_LOADED - 1) {
			link->index++;
			link->count = COUNT_LOAD;
		}
		if (was->all_words) {
			link->count = COUNT_REST;
			link->step = frame_goes_on ? PASSO_LINK_HEADER : PASSO_LINK_IDLE;
		}
		break;
	case PASSO_LINK_READ:
		link->bus.read = was->count == COUNT_STROBE && !wires->spi.frame_end;
		if (was->count == COUNT_ANSWER)
			link->reply_word = wires->response.read_data;
		if (was->count == COUNT_LOADED && was->index == 0u && was->answer != PASSO_VERDICT_OK) {
			link->verdict = was->answer;
			link->count = COUNT_LOAD;
			link->step = PASSO_LINK_ACK;
		}
		if (act) {
			link->index++;
			link->bus.address = (was->bus.address + 1u) & 0xFFFu;
		}
		if (word_valid) {
			link->count = was->all_words ? COUNT_ROTATE : COUNT_READ;
			if (was->all_words)
				link->step = PASSO_LINK_SUM;
		}
		break;
	case PASSO_LINK_SUM:
		if (act)
			link->step = PASSO_LINK_IDLE;
		break;
	case PASSO_LINK_COUNT:
		if (act)
			link->step = frame_goes_on ? PASSO_LINK_HEADER : PASSO_LINK_IDLE;
		break;
	case PASSO_LINK_IDLE:
		break;
	}
}
