/* SPDX-License-Identifier: MIT
 * Retries of a frame until its outcome is known. See passo_host.h.
 *
 * Detection of a core reset: status words carry the sequence number that the core accepted last. The reply to
 * the first attempt of a frame must show a number that this host has sent; after reset the core shows 0,
 * which is never sent. If the first reply was not valid, the frame itself may already have changed that
 * number; then the host reads a reject counter that it made nonzero before and that a reset clears.
 */
#include "passo_link_retry.h"

#include <string.h>

#include "passo_link_frame.h"
#include "passo_words.h"

/* Sequence number of reads. The ack of a rejected read is repeated; with this number it stays distinguishable
 * when a clock is lost or doubled: shifted by a bit in either direction, it is a different number. */
#define READ_SEQUENCE 0x55u

/* Sequences are 1 .. 255. */
static uint8_t sequence_after(uint8_t sequence)
{
	return sequence == 255u ? 1u : (uint8_t)(sequence + 1u);
}

/* Whether the core has not been reset: the number it accepted last must be one of those sent since the last
 * known accepted one, up to `newest`. */
static bool continues(const struct passo_host *host, uint8_t last, uint8_t newest)
{
	uint8_t sequence = host->accepted;

	while (sequence != last && sequence != newest)
		sequence = sequence_after(sequence);
	return sequence == last;
}

bool passo_host_is_unsure(const struct passo_host *host)
{
	const uint8_t first = host->accepted != 0u ? host->accepted : 1u;

	return sequence_after(host->last_sequence) == first && host->last_sequence != host->accepted;
}

static enum passo_error lose(struct passo_host *host)
{
	host->lost = true;
	return PASSO_ERROR_CORE_RESET;
}

/* One attempt of a read. */
static enum passo_error try_read(struct passo_host *host)
{
	bool known;
	enum passo_error error = passo_host_exchange(host, &known);

	if (error == PASSO_OK && !known) {
		host->counters.damaged++;
		return PASSO_ERROR_DAMAGED;
	}
	if (!known)
		return error;
	uint8_t last = passo_unpack_status(host->status).sequence;
	if (host->guarded && !continues(host, last, host->last_sequence))
		return lose(host);
	host->accepted = last;
	if (passo_host_is_unsure(host))
		host->last_sequence = host->sent_before = last;
	passo_host_count_room(host, known, false);
	return error;
}

static bool is_final(enum passo_error error)
{
	return error == PASSO_OK || error == PASSO_ERROR_TRANSFER || error == PASSO_ERROR_CORE_RESET
	    || error >= PASSO_ERROR_REFUSED;
}

enum passo_error passo_host_read_with(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length, uint8_t tries)
{
	enum passo_error error;

	host->words = passo_frame_read(host->send, READ_SEQUENCE, address, length);
	host->attempt = 0;
	do
		error = try_read(host);
	while (!is_final(error) && host->attempt < tries);
	if (error == PASSO_OK)
		memcpy(words, host->receive + PASSO_FRAME_DATA, length * sizeof *words);
	else if (!is_final(error) && tries > 1u)
		host->counters.failed++;
	return error;
}

enum passo_error passo_host_prove(struct passo_host *host, uint8_t tries)
{
	uint32_t refusals;
	enum passo_error error = passo_host_read_with(host, PASSO_ADDRESS_REFUSALS_1, &refusals, 1, tries);

	if (error == PASSO_OK && passo_unpack_refusals_1(refusals).read_only == 0u)
		return lose(host);
	return error;
}

static bool is_run(const struct passo_host *host)
{
	const struct passo_header header = passo_unpack_header(host->send[0]);

	return header.operation == PASSO_OPERATION_WRITE && header.address == PASSO_ADDRESS_RUN;
}

void passo_host_give_up(struct passo_host *host)
{
	const struct passo_run before = passo_unpack_run(host->run);
	struct passo_run run = passo_unpack_run(host->send[1]);
	bool known;

	while (host->in_flight)
		passo_host_exchange(host, &known);
	if (!is_run(host))
		return;
	run.run &= before.run;
	run.wait_sync |= before.wait_sync;
	host->run = passo_pack_run(&run);
	host->run_due = true;
}

/* One attempt of a write; PENDING: another attempt, or a check for a core reset, must follow. */
static enum passo_error try_write(struct passo_host *host)
{
	bool known;
	enum passo_error error = passo_host_exchange(host, &known);
	const bool first = host->attempt == 1u;

	if (error == PASSO_PENDING)
		return error;
	if (known && first && host->guarded
	    && !continues(host, passo_unpack_status(host->status).sequence, host->sent_before))
		return lose(host);
	if (error == PASSO_OK || error >= PASSO_ERROR_REFUSED)
		passo_host_count_room(host, known, error == PASSO_OK);
	if (error == PASSO_OK) {
		host->accepted = host->last_sequence;
		if (is_run(host)) {
			host->run = host->send[1];
			host->run_due = false;
		}
		host->proving = host->guarded && !(known && first);
		return host->proving ? PASSO_PENDING : PASSO_OK;
	}
	if (!is_final(error) && host->attempt != host->hardware.tries)
		return PASSO_PENDING;
	host->counters.failed += !is_final(error);
	if (error < PASSO_ERROR_REFUSED)
		passo_host_give_up(host);
	return error;
}

enum passo_error passo_host_step_write(struct passo_host *host)
{
	if (!host->proving)
		return try_write(host);
	enum passo_error error = passo_host_prove(host, 1);
	host->proofs++;
	return is_final(error) || host->proofs == host->hardware.tries ? error : PASSO_PENDING;
}

static void begin(struct passo_host *host)
{
	host->sent_before = host->last_sequence;
	host->last_sequence = sequence_after(host->last_sequence);
	host->attempt = host->proofs = 0;
	host->proving = false;
}

void passo_host_begin_write(struct passo_host *host, enum passo_operation operation, uint16_t address,
    const uint32_t *words, size_t length)
{
	begin(host);
	host->words = operation == PASSO_OPERATION_PUSH
	                ? passo_frame_push(host->send, host->last_sequence, address, words, length)
	                : passo_frame_write(host->send, host->last_sequence, address, words, length);
}

void passo_host_prepare_push(struct passo_host *host, uint16_t address, size_t length)
{
	host->prepared = sequence_after(host->last_sequence);
	passo_frame_push(host->ahead, host->prepared, address, host->ahead + 1, length);
}

void passo_host_begin_prepared(struct passo_host *host)
{
	uint32_t *frame = host->ahead;
	const struct passo_header header = passo_unpack_header(frame[0]);

	if (host->prepared != sequence_after(host->last_sequence)) /* other writes came before it */
		passo_host_prepare_push(host, header.address, header.length);
	begin(host);
	host->prepared = 0;
	host->words = header.length + PASSO_FRAME_OVERHEAD;
	host->ahead = host->send;
	host->send = frame;
}
