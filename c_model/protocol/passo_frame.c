/* SPDX-License-Identifier: MIT */
#include "passo_frame.h"

#include <string.h>

#include "passo_words.h"

static uint32_t header(enum passo_operation operation, uint8_t sequence, uint16_t address, size_t length)
{
	return passo_pack_header(&(struct passo_header){
	    .operation = operation, .sequence = sequence, .length = (uint8_t)length, .address = address});
}

static size_t build(uint32_t *frame, uint32_t head, const uint32_t *payload, size_t length)
{
	frame[0] = head;
	if (length && payload != frame + 1)
		memcpy(frame + 1, payload, length * sizeof *payload);
	frame[length + 1] = passo_crc(PASSO_CRC_START, frame, length + 1);
	frame[length + 2] = 0;
	frame[length + 3] = 0;
	return length + PASSO_FRAME_OVERHEAD;
}

size_t passo_frame_write(
    uint32_t *frame, uint8_t sequence, uint16_t address, const uint32_t *payload, size_t length)
{
	return build(frame, header(PASSO_OPERATION_WRITE, sequence, address, length), payload, length);
}

size_t passo_frame_push(
    uint32_t *frame, uint8_t sequence, uint16_t address, const uint32_t *payload, size_t length)
{
	return build(frame, header(PASSO_OPERATION_PUSH, sequence, address, length), payload, length);
}

size_t passo_frame_read(uint32_t *frame, uint8_t sequence, uint16_t address, size_t length)
{
	frame[0] = header(PASSO_OPERATION_READ, sequence, address, length);
	frame[1] = passo_crc(PASSO_CRC_START, frame, 1);
	memset(frame + 2, 0, (length + 2) * sizeof *frame);
	return length + PASSO_FRAME_OVERHEAD;
}

static bool is_stuck(const uint32_t *miso, size_t count)
{
	if (miso[0] != 0 && miso[0] != UINT32_C(0xFFFFFFFF))
		return false;
	for (size_t i = 1; i < count; i++) {
		if (miso[i] != miso[0])
			return false;
	}
	return true;
}

bool passo_frame_is_status(uint32_t word)
{
	const struct passo_status status = passo_unpack_status(word);

	return status.marker == PASSO_STATUS_MARKER_RESET && !status.zero;
}

/* The ack of a write or of a refused read: always the last word. The status word before it exposes a reply
 * that is shifted by a bit, in which the ack of one verdict can look like that of another. If it equals the
 * ack, the core decoded the request as a read. */
static enum passo_reply read_ack(const uint32_t *mosi, const uint32_t *miso, size_t count,
    uint32_t last_status, enum passo_verdict *verdict)
{
	const uint32_t word = miso[count - 1];
	const struct passo_ack ack = passo_unpack_ack(word);

	if (is_stuck(miso, count))
		return PASSO_REPLY_STUCK;
	if (word >> 16 != (~word & 0xFFFFu))
		return word == miso[0] ? PASSO_REPLY_NO_ACK : PASSO_REPLY_DAMAGED;
	if (ack.sequence != passo_unpack_header(mosi[0]).sequence)
		return PASSO_REPLY_SEQUENCE;
	if (ack.verdict > PASSO_VERDICT_BAD_VALUE || !passo_frame_is_status(last_status)
	    || last_status == word)
		return PASSO_REPLY_DAMAGED;
	*verdict = ack.verdict;
	return *verdict <= PASSO_VERDICT_DUPLICATE ? PASSO_REPLY_OK : PASSO_REPLY_REFUSED;
}

enum passo_reply passo_frame_write_reply(
    const uint32_t *mosi, const uint32_t *miso, size_t count, enum passo_verdict *verdict)
{
	return read_ack(mosi, miso, count, miso[count - 2], verdict);
}

enum passo_reply passo_frame_read_reply(
    const uint32_t *mosi, const uint32_t *miso, size_t count, enum passo_verdict *verdict)
{
	uint32_t crc = passo_crc(PASSO_CRC_START, mosi, 1);

	crc = passo_crc(crc, miso + PASSO_FRAME_DATA, count - PASSO_FRAME_OVERHEAD);
	if (crc == miso[count - 1] && !is_stuck(miso, count)) {
		*verdict = PASSO_VERDICT_OK;
		return PASSO_REPLY_OK;
	}
	/* A read is never answered with an ack that says OK. */
	enum passo_reply reply = read_ack(mosi, miso, count, miso[PASSO_FRAME_DATA - 1], verdict);
	return reply == PASSO_REPLY_OK ? PASSO_REPLY_DAMAGED : reply;
}

size_t passo_line_words(uint32_t *words, const struct passo_line *line, uint8_t axes)
{
	words[0] = passo_pack_line_control(&(struct passo_line_control){
	    .last = line->last, .endless = line->endless, .directions = line->directions});
	words[1] = line->substeps;
	for (unsigned i = 0; i < axes; i++)
		words[2 + i] = line->steps[i];
	return PASSO_LINE_WORDS(axes);
}

size_t passo_ramp_words(uint32_t *words, const struct passo_ramp *ramp)
{
	words[0] = passo_pack_ramp_control(
	    &(struct passo_ramp_control){.velocity_high = (uint16_t)(ramp->velocity_end >> 32),
		.last = ramp->last,
		.now = ramp->now,
		.mirror = ramp->mirror,
		.shape = ramp->shape});
	words[1] = (uint32_t)ramp->velocity_end;
	words[2] = ramp->ticks;
	words[3] = (uint32_t)(ramp->progress_step >> 32);
	words[4] = (uint32_t)ramp->progress_step;
	return PASSO_RAMP_WORDS;
}
