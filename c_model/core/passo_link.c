/* SPDX-License-Identifier: MIT
 * Link: words to frames to bus accesses, and the replies. See rtl/passo_link.v, rtl/passo_payload.v and
 * rtl/passo_reply.v. The 32 shifts of a word are done together, in the last of their clocks. The reject
 * counters are in passo_registers.c, the states of a frame in passo_link_states.c.
 */
#include "passo_crc.h"
#include "passo_link_schedule.h"
#include "passo_model.h"
#include "passo_words.h"

/* Sequence and response code, and their complement. */
static uint32_t acknowledge(uint8_t sequence, uint8_t verdict)
{
	return passo_pack_ack(&(struct passo_ack){
	    .sequence = sequence,
	    .verdict = (enum passo_verdict)verdict,
	    .not_sequence = (uint8_t)~sequence,
	    .not_verdict = (uint8_t)~verdict,
	});
}

void passo_link_reset(struct passo_link *link)
{
	*link = (struct passo_link){.step = PASSO_LINK_IDLE, .count = COUNT_REST};
}

uint64_t passo_link_quiet(const struct passo_link *link)
{
	const struct passo_bus *bus = &link->bus;

	if (link->answer_due || link->answer_came || link->refused || bus->frame || bus->check || bus->write
	    || bus->read)
		return 0;
	if (link->count == COUNT_REST)
		return bus->commit ? 0u : UINT64_MAX;
	/* the RTL rotates a word */
	if (link->count > COUNT_LOADED && link->count < COUNT_ROTATED)
		return (uint64_t)COUNT_ROTATED - link->count;
	/* a read waits for its strobe; `all_words` has followed the index */
	if (link->step == PASSO_LINK_READ && link->count > COUNT_READ + 1 && link->count < COUNT_STROBE)
		return (uint64_t)COUNT_STROBE - link->count;
	return 0;
}

void passo_link_skip(struct passo_link *link, uint64_t clocks)
{
	if (link->count != COUNT_REST)
		link->count = (uint8_t)(link->count + clocks);
}

static unsigned place(const struct passo_link *link, bool in_payload, unsigned otherwise)
{
	return in_payload ? link->index & 63u : otherwise;
}

static void store(struct passo_link *link, const struct passo_link_wires *wires)
{
	const bool is_header = link->step == PASSO_LINK_HEADER || link->step == PASSO_LINK_REPLAY;
	const unsigned otherwise = is_header ? PASSO_BUFFER_HEADER : PASSO_BUFFER_OTHER;

	link->buffer[place(link, link->step == PASSO_LINK_PAYLOAD, otherwise)][wires->half_low ? 1 : 0] =
	    wires->half;
}

static uint32_t loaded(const struct passo_link *link)
{
	const bool in_payload = link->step == PASSO_LINK_PAYLOAD || link->step == PASSO_LINK_REPLAY;
	const unsigned otherwise = link->step == PASSO_LINK_CRC ? PASSO_BUFFER_OTHER : PASSO_BUFFER_HEADER;
	const uint16_t *word = link->buffer[place(link, in_payload, otherwise)];

	return (uint32_t)word[0] << 16 | word[1];
}

/* The 32 clocks of a bus word, CRC or reply word have passed: apply their result. */
static void rotated(struct passo_link *link)
{
	switch (link->step) {
	case PASSO_LINK_HEADER:
		link->crc = passo_crc(PASSO_CRC_START, &link->bus.data, 1);
		break;
	case PASSO_LINK_PAYLOAD:
		link->crc = passo_crc(link->crc, &link->bus.data, 1);
		break;
	case PASSO_LINK_CRC:
		link->crc_wrong = link->crc != link->bus.data;
		break;
	case PASSO_LINK_ACK:
		link->reply_word = acknowledge(passo_unpack_header(link->bus.data).sequence, link->verdict);
		break;
	case PASSO_LINK_READ:
		link->crc = passo_crc(link->crc, &link->reply_word, 1);
		break;
	case PASSO_LINK_SUM:
		link->reply_word = link->crc;
		break;
	case PASSO_LINK_IDLE:
	case PASSO_LINK_REPLAY:
	case PASSO_LINK_COUNT:
		break;
	}
}

void passo_link_clock(struct passo_link *link, const struct passo_link_wires *wires)
{
	/* without the buffer */
	const struct passo_link was = {
	    .step = link->step,
	    .count = link->count,
	    .length = link->length,
	    .index = link->index,
	    .all_words = link->all_words,
	    .frame_waits = link->frame_waits,
	    .answer_due = link->answer_due,
	    .answer_came = link->answer_came,
	    .answer = link->answer,
	    .bus = link->bus,
	};
	const bool act = was.count == COUNT_ACT;
	const bool word_valid = wires->spi.half_valid && wires->half_low;
	const bool frame_goes_on =
	    (was.frame_waits || wires->spi.frame_start) && !wires->spi.frame_end && !word_valid;

	if (was.count == COUNT_LOADED - 1)
		link->bus.data = loaded(link);
	if (was.count == COUNT_ROTATED)
		rotated(link);
	if (wires->spi.half_valid)
		store(link, wires);
	if (was.count != COUNT_REST)
		link->count = was.count + 1u;
	link->bus.frame = link->bus.check = link->bus.write = link->bus.read = false;
	link->all_words = was.index == was.length && !act;
	link->answer_due = was.bus.check;
	link->answer_came = was.answer_due;
	link->answer = wires->response.claim ? wires->response.refusal : PASSO_VERDICT_UNKNOWN_ADDRESS;
	link->refused = false;
	link->bus.commit = (was.step == PASSO_LINK_CRC && was.count > COUNT_LOAD && was.count != COUNT_REST)
	                || was.step == PASSO_LINK_ACK || was.step == PASSO_LINK_REPLAY;

	if (was.answer_came && link->verdict == PASSO_VERDICT_OK)
		link->verdict = was.answer;
	if ((was.bus.check || was.bus.write) && !was.bus.push)
		link->bus.address = (was.bus.address + 1u) & 0xFFFu;

	passo_link_states_clock(link, wires, &was, word_valid, frame_goes_on);

	if (wires->spi.frame_start)
		link->reply_word = link->status;
	link->status = wires->status;
	const bool goes_through = was.step == PASSO_LINK_REPLAY || was.step == PASSO_LINK_COUNT;
	link->frame_waits = goes_through && frame_goes_on;
	if (!goes_through && !(was.step == PASSO_LINK_ACK && act)) {
		if (wires->spi.frame_end)
			link->step = PASSO_LINK_IDLE;
		if (wires->spi.frame_start)
			link->step = PASSO_LINK_HEADER;
		if (wires->spi.frame_end || wires->spi.frame_start)
			link->count = COUNT_REST;
	}
}
