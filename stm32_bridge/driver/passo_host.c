/* SPDX-License-Identifier: MIT
 * Frames that are executed exactly once. See passo_host.h.
 *
 * How a reset of the core is noticed: status words carry the sequence that the core accepted last. A reply to
 * the first try of a frame must show one that this host has sent; a core after reset shows 0, which is never
 * sent. When the first reply was not clear, the frame itself may have changed that number already: then a
 * counter of refusals is read, which the host has made other than 0, and which is 0 after reset.
 */
#include "passo_host.h"

#include <string.h>

#include "passo_exchange.h"

#define MARK (((UINT32_C(1) << PASSO_REFUSALS_1_READ_ONLY_BITS) - 1u) << PASSO_REFUSALS_1_READ_ONLY_LSB)

/* A refused read repeats its ack. With this sequence it is no ack of the same sequence when a clock was lost
 * or doubled: shifted by a bit, in either direction, it is another number. */
#define READ_SEQUENCE 0x55u

#define RUN_BITS (((UINT32_C(1) << PASSO_RUN_RUN_BITS) - 1u) << PASSO_RUN_RUN_LSB)
#define WAIT_SYNC_BITS (((UINT32_C(1) << PASSO_RUN_WAIT_SYNC_BITS) - 1u) << PASSO_RUN_WAIT_SYNC_LSB)

/* Sequences are 1 .. 255. */
static uint8_t sequence_after(uint8_t sequence)
{
	return sequence == 255u ? 1u : (uint8_t)(sequence + 1u);
}

/* Is this the core that this host knows: what it accepted last is one of those sent since the last one that
 * it is known to have accepted, up to `newest`. */
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

/* One try of a read. */
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
	uint8_t last = (uint8_t)(host->status >> 16);
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

static enum passo_error read_with(
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

/* The mark is still there: the core was not reset. */
static enum passo_error prove(struct passo_host *host, uint8_t tries)
{
	uint32_t refusals;
	enum passo_error error = read_with(host, PASSO_ADDRESS_REFUSALS_1, &refusals, 1, tries);

	if (error == PASSO_OK && (refusals & MARK) == 0u)
		return lose(host);
	return error;
}

static bool is_run(const struct passo_host *host)
{
	return host->send[0] >> 28 == PASSO_OPERATION_WRITE && (host->send[0] & 0xFFFu) == PASSO_ADDRESS_RUN;
}

/* It is not known whether the present frame was executed. */
static void give_up(struct passo_host *host)
{
	const uint32_t before = host->run, word = host->send[1];

	if (!is_run(host))
		return;
	host->run = (word & ~(RUN_BITS | WAIT_SYNC_BITS)) | (word & before & RUN_BITS)
	          | ((word | before) & WAIT_SYNC_BITS);
	host->run_due = true;
}

/* One try of a write; PENDING: there must be another, or it must be proved. */
static enum passo_error try_write(struct passo_host *host)
{
	const bool first = host->attempt == 0u;
	bool known;
	enum passo_error error = passo_host_exchange(host, &known);

	if (known && first && host->guarded
	    && !continues(host, (uint8_t)(host->status >> 16), host->sent_before))
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
		give_up(host);
	return error;
}

/* One chip select for the present write. */
static enum passo_error step_write(struct passo_host *host)
{
	if (!host->proving)
		return try_write(host);
	enum passo_error error = prove(host, 1);
	host->proofs++;
	return is_final(error) || host->proofs == host->hardware.tries ? error : PASSO_PENDING;
}

static void begin_write(struct passo_host *host, enum passo_operation operation, uint16_t address,
    const uint32_t *words, size_t length)
{
	host->sent_before = host->last_sequence;
	host->last_sequence = sequence_after(host->last_sequence);
	host->words = operation == PASSO_OPERATION_PUSH
	                ? passo_frame_push(host->send, host->last_sequence, address, words, length)
	                : passo_frame_write(host->send, host->last_sequence, address, words, length);
	host->attempt = host->proofs = 0;
	host->proving = false;
}

/* Before another frame takes its place the posted one is settled. */
static enum passo_error make_way(struct passo_host *host, const uint32_t *words, size_t length)
{
	if (!host || !words || length == 0u || length > PASSO_FRAME_PAYLOAD_MAX)
		return PASSO_ERROR_ARGUMENT;
	if (!host->opened)
		return PASSO_ERROR_NOT_OPEN;
	while (passo_host_step(host) == PASSO_PENDING)
		;
	return host->lost ? PASSO_ERROR_CORE_RESET : PASSO_OK;
}

enum passo_error passo_host_step(struct passo_host *host)
{
	if (!host)
		return PASSO_ERROR_ARGUMENT;
	if (!host->posted)
		return PASSO_OK;
	enum passo_error error = step_write(host);
	*host->posted = error;
	if (error == PASSO_PENDING)
		return PASSO_PENDING;
	host->posted = NULL;
	return PASSO_OK;
}

void passo_host_drop(struct passo_host *host)
{
	if (host && host->posted) {
		give_up(host);
		host->posted = NULL;
	}
}

static enum passo_error send_now(struct passo_host *host, enum passo_operation operation, uint16_t address,
    const uint32_t *words, size_t length)
{
	enum passo_error error = make_way(host, words, length);
	uint32_t identification;

	if (error == PASSO_OK && passo_host_is_unsure(host))
		error =
		    read_with(host, PASSO_ADDRESS_IDENTIFICATION, &identification, 1, host->hardware.tries);
	if (error != PASSO_OK)
		return error;
	begin_write(host, operation, address, words, length);
	do
		error = step_write(host);
	while (error == PASSO_PENDING);
	return error;
}

enum passo_error passo_host_write(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length)
{
	return send_now(host, PASSO_OPERATION_WRITE, address, words, length);
}

enum passo_error passo_host_push(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length)
{
	return send_now(host, PASSO_OPERATION_PUSH, address, words, length);
}

enum passo_error passo_host_read(struct passo_host *host, uint16_t address, uint32_t *words, size_t length)
{
	enum passo_error error = make_way(host, words, length);

	return error != PASSO_OK ? error : read_with(host, address, words, length, host->hardware.tries);
}

enum passo_error passo_host_read_once(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length)
{
	enum passo_error error = make_way(host, words, length);

	return error != PASSO_OK ? error : read_with(host, address, words, length, 1);
}

uint32_t *passo_host_payload(struct passo_host *host)
{
	return host->send + 1;
}

static enum passo_error post(struct passo_host *host, enum passo_operation operation, uint16_t address,
    size_t length, enum passo_error *result)
{
	if (!host || !result || host->posted || length == 0u || length > PASSO_FRAME_PAYLOAD_MAX
	    || passo_host_is_unsure(host))
		return PASSO_ERROR_ARGUMENT;
	if (!host->opened)
		return PASSO_ERROR_NOT_OPEN;
	if (host->lost)
		return PASSO_ERROR_CORE_RESET;
	begin_write(host, operation, address, host->send + 1, length);
	*result = PASSO_PENDING;
	host->posted = result;
	return PASSO_OK;
}

enum passo_error passo_host_post_push(
    struct passo_host *host, uint16_t address, size_t length, enum passo_error *result)
{
	return post(host, PASSO_OPERATION_PUSH, address, length, result);
}

enum passo_error passo_host_post_write(
    struct passo_host *host, uint16_t address, size_t length, enum passo_error *result)
{
	return post(host, PASSO_OPERATION_WRITE, address, length, result);
}

enum passo_error passo_host_open(struct passo_host *host, const struct passo_hardware *hardware)
{
	uint32_t identification;

	if (!host || !hardware || !hardware->transfer)
		return PASSO_ERROR_ARGUMENT;
	memset(host, 0, sizeof *host);
	host->hardware = *hardware;
	if (host->hardware.tries == 0u)
		host->hardware.tries = PASSO_TRIES;
	enum passo_error error =
	    read_with(host, PASSO_ADDRESS_IDENTIFICATION, &identification, 1, host->hardware.tries);
	if (error != PASSO_OK)
		return error;
	if (identification != PASSO_IDENTIFICATION_RESET)
		return PASSO_ERROR_NOT_PASSO;
	/* a write with the number that was accepted last would pass for a duplicate */
	host->last_sequence = host->sent_before = host->accepted;
	host->fresh = host->accepted == 0u;
	host->opened = true;
	return PASSO_OK;
}

enum passo_error passo_host_guard(struct passo_host *host, uint8_t axes, uint32_t clock_hz)
{
	const uint32_t mark = PASSO_IDENTIFICATION_RESET;
	enum passo_error error;
	bool marked;

	if (!host)
		return PASSO_ERROR_ARGUMENT;
	do { /* a second time if the counter has just wrapped */
		error = passo_host_write(host, PASSO_ADDRESS_IDENTIFICATION, &mark, 1);
		if ((unsigned)error != PASSO_ERROR_REFUSED + PASSO_VERDICT_READ_ONLY)
			return error;
		error = prove(host, host->hardware.tries);
		marked = !host->lost;
		host->lost = false;
	} while (error == PASSO_ERROR_CORE_RESET && !marked);
	if (error != PASSO_OK)
		return error;
	host->counters.refused[PASSO_VERDICT_READ_ONLY] = 0;
	host->axes = axes;
	host->clock_hz = clock_hz;
	host->guarded = true;
	return PASSO_OK;
}
