/* SPDX-License-Identifier: MIT
 * One chip select: transfer, decoding of the reply, and the queue room in its status word.
 */
#include "passo_link_frame.h"

#include "passo_words.h"

/* Mask of an address: the register within its channel. */
#define PLACE (PASSO_ADDRESS_CHANNEL_STRIDE - 1u)

/* Minimum number of equal words in a reply for a valid status: two could share a bit error. */
#define STATUS_WORDS 3u

bool passo_host_status_of(const uint32_t *miso, size_t count, uint32_t *status)
{
	size_t lead = 0, same = 0;
	uint32_t word = 0;

	/* majority vote (Boyer-Moore): the only candidate for more than half of the words */
	for (size_t i = 0; i < count; i++) {
		if (lead == 0u)
			word = miso[i];
		lead = miso[i] == word ? lead + 1u : lead - 1u;
	}
	for (size_t i = 0; i < count; i++)
		same += miso[i] == word ? 1u : 0u;
	if (same < STATUS_WORDS || 2u * same <= count || !passo_frame_is_status(word))
		return false;
	*status = word;
	return true;
}

static enum passo_error fault_of(struct passo_host *host, enum passo_reply reply, enum passo_verdict verdict)
{
	struct passo_counters *counters = &host->counters;

	switch (reply) {
	case PASSO_REPLY_OK:
		return PASSO_OK;
	case PASSO_REPLY_REFUSED:
		return verdict == PASSO_VERDICT_BAD_CRC
		         ? PASSO_ERROR_BAD_CRC
		         : (enum passo_error)((unsigned)PASSO_ERROR_REFUSED + (unsigned)verdict);
	case PASSO_REPLY_STUCK:
		counters->stuck++;
		return host->receive[host->words - 1u] ? PASSO_ERROR_STUCK_HIGH : PASSO_ERROR_STUCK_LOW;
	case PASSO_REPLY_NO_ACK:
		counters->no_ack++;
		return PASSO_ERROR_NO_ACK;
	case PASSO_REPLY_SEQUENCE:
		counters->sequence++;
		return PASSO_ERROR_SEQUENCE;
	case PASSO_REPLY_DAMAGED:
		break;
	}
	counters->damaged++;
	return PASSO_ERROR_DAMAGED;
}

static bool is_read(const struct passo_host *host)
{
	return passo_unpack_header(host->send[0]).operation == PASSO_OPERATION_READ;
}

/* Starts a chip select: PENDING. That of a read, whose words the caller needs, is complete on return. */
static enum passo_error launch(struct passo_host *host)
{
	const struct passo_hardware *hardware = &host->hardware;
	const bool stays = hardware->start && !is_read(host);

	host->counters.frames++;
	host->counters.retries += host->attempt != 0u;
	host->attempt++;
	if (!(stays ? hardware->start : hardware->transfer)(
		hardware->context, host->send, host->receive, host->words))
		return PASSO_ERROR_TRANSFER;
	host->in_flight = stays;
	return stays ? PASSO_PENDING : PASSO_OK;
}

static enum passo_error land(struct passo_host *host)
{
	enum passo_error error = host->hardware.finish(host->hardware.context);

	host->in_flight = error == PASSO_PENDING;
	return error;
}

enum passo_error passo_host_exchange(struct passo_host *host, bool *known)
{
	enum passo_verdict verdict = PASSO_VERDICT_OK;
	enum passo_error error = host->in_flight ? land(host) : launch(host);

	*known = false;
	if (error != PASSO_OK)
		return error;
	const bool read = is_read(host);
	const size_t count = read ? host->words : PASSO_REPLY_WORDS;
	const uint32_t *words = host->receive + host->words - count;
	enum passo_reply reply = read ? passo_frame_read_reply(host->send, words, count, &verdict)
	                              : passo_frame_write_reply(host->send, words, count, &verdict);
	error = fault_of(host, reply, verdict);
	if (reply == PASSO_REPLY_OK || reply == PASSO_REPLY_REFUSED) {
		host->counters.refused[verdict] += verdict != PASSO_VERDICT_OK;
		*known = passo_host_status_of(words, read ? PASSO_FRAME_DATA : count - 1u, &host->status);
	}
	return error;
}

static uint8_t less(uint8_t room, uint32_t count)
{
	return (uint8_t)(room > count ? room - count : 0u);
}

void passo_host_count_room(struct passo_host *host, bool known, bool executed)
{
	const struct passo_header header = passo_unpack_header(host->send[0]);
	const struct passo_status status = passo_unpack_status(host->status);
	uint32_t lines = 0, ramps = 0;

	if (known) {
		host->line_room = status.line_room;
		host->ramp_room = status.ramp_room;
	}
	if (executed && header.operation == PASSO_OPERATION_PUSH) {
		if ((header.address & PLACE) == PASSO_CHANNEL_LINE)
			lines = host->line_words ? (uint32_t)header.length / host->line_words : header.length;
		else if ((header.address & PLACE) == PASSO_CHANNEL_RAMP)
			ramps = header.length / PASSO_RAMP_WORDS;
	}
	host->line_room = less(host->line_room, lines);
	host->ramp_room = less(host->ramp_room, ramps);
}
