/* SPDX-License-Identifier: MIT
 * Exactly-once execution of frames. See passo_host.h.
 */
#include "passo_host.h"

#include <string.h>

#include "passo_link_retry.h"

/* Checks the arguments and completes the posted frame, whose buffer the next frame uses. */
static enum passo_error make_way(struct passo_host *host, const uint32_t *words, size_t length)
{
	if (!host || !words)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (length == 0u || length > PASSO_FRAME_PAYLOAD_MAX)
		return PASSO_ERROR_ARGUMENT_LENGTH;
	if (!host->opened)
		return PASSO_ERROR_NOT_OPEN;
	while (passo_host_step(host) == PASSO_PENDING)
		;
	return host->lost ? PASSO_ERROR_CORE_RESET : PASSO_OK;
}

enum passo_error passo_host_step(struct passo_host *host)
{
	if (!host)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (!host->posted)
		return PASSO_OK;
	enum passo_error error = passo_host_step_write(host);
	*host->posted = error;
	if (error == PASSO_PENDING)
		return PASSO_PENDING;
	host->posted = NULL;
	return PASSO_OK;
}

void passo_host_drop(struct passo_host *host)
{
	if (host && host->posted) {
		passo_host_give_up(host);
		host->posted = NULL;
	}
}

static enum passo_error send_now(struct passo_host *host, enum passo_operation operation, uint16_t address,
    const uint32_t *words, size_t length)
{
	enum passo_error error = make_way(host, words, length);
	uint32_t identification;

	if (error == PASSO_OK && passo_host_is_unsure(host))
		error = passo_host_read_with(
		    host, PASSO_ADDRESS_IDENTIFICATION, &identification, 1, host->hardware.tries);
	if (error != PASSO_OK)
		return error;
	passo_host_begin_write(host, operation, address, words, length);
	do
		error = passo_host_step_write(host);
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

	return error != PASSO_OK ? error
	                         : passo_host_read_with(host, address, words, length, host->hardware.tries);
}

enum passo_error passo_host_read_once(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length)
{
	enum passo_error error = make_way(host, words, length);

	return error != PASSO_OK ? error : passo_host_read_with(host, address, words, length, 1);
}

uint32_t *passo_host_payload(struct passo_host *host)
{
	return host->ahead + 1;
}

/* Takes the result of the starting frame. */
static enum passo_error post(struct passo_host *host, enum passo_error *result)
{
	if (!host || !result)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (host->posted || passo_host_is_unsure(host))
		return PASSO_ERROR_ARGUMENT_POSTED;
	if (!host->opened)
		return PASSO_ERROR_NOT_OPEN;
	if (host->lost)
		return PASSO_ERROR_CORE_RESET;
	*result = PASSO_PENDING;
	host->posted = result;
	return PASSO_OK;
}

enum passo_error passo_host_post_push(struct passo_host *host, enum passo_error *result)
{
	enum passo_error error = post(host, result);

	if (error == PASSO_OK)
		passo_host_begin_prepared(host);
	return error;
}

enum passo_error passo_host_post_write(
    struct passo_host *host, uint16_t address, uint32_t word, enum passo_error *result)
{
	enum passo_error error = post(host, result);

	if (error == PASSO_OK)
		passo_host_begin_write(host, PASSO_OPERATION_WRITE, address, &word, 1);
	return error;
}

enum passo_error passo_host_open(struct passo_host *host, const struct passo_hardware *hardware)
{
	uint32_t identification;

	if (!host || !hardware || !hardware->transfer)
		return PASSO_ERROR_ARGUMENT_POINTER;
	while (hardware->finish && hardware->finish(hardware->context) == PASSO_PENDING)
		; /* a frame of a previous connection */
	memset(host, 0, sizeof *host);
	host->hardware = *hardware;
	host->send = host->frame;
	host->ahead = hardware->spare ? hardware->spare : host->frame;
	if (host->hardware.tries == 0u)
		host->hardware.tries = PASSO_TRIES;
	enum passo_error error = passo_host_read_with(
	    host, PASSO_ADDRESS_IDENTIFICATION, &identification, 1, host->hardware.tries);
	if (error != PASSO_OK)
		return error;
	if (identification != PASSO_IDENTIFICATION_RESET)
		return PASSO_ERROR_NOT_PASSO;
	/* a write with the number accepted last would be taken for a duplicate */
	host->last_sequence = host->sent_before = host->accepted;
	host->fresh = host->accepted == 0u;
	host->opened = true;
	return PASSO_OK;
}

enum passo_error passo_host_guard(struct passo_host *host, uint8_t line_words)
{
	const uint32_t mark = PASSO_IDENTIFICATION_RESET;
	enum passo_error error;
	bool marked;

	if (!host)
		return PASSO_ERROR_ARGUMENT_POINTER;
	do { /* again if the counter has just wrapped to 0 */
		error = passo_host_write(host, PASSO_ADDRESS_IDENTIFICATION, &mark, 1);
		if ((unsigned)error != PASSO_ERROR_REFUSED + PASSO_VERDICT_READ_ONLY)
			return error;
		error = passo_host_prove(host, host->hardware.tries);
		marked = !host->lost;
		host->lost = false;
	} while (error == PASSO_ERROR_CORE_RESET && !marked);
	if (error != PASSO_OK)
		return error;
	host->counters.refused[PASSO_VERDICT_READ_ONLY] = 0;
	host->line_words = line_words;
	host->guarded = true;
	return PASSO_OK;
}
