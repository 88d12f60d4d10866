/* SPDX-License-Identifier: MIT
 * Starting the motions of several channels on one clock.
 */
#include "passo_driver.h"

/* A status read takes more than 1024 clocks, the preparation of a motion a few hundred and a tick, and before
 * it two periods of the filter, up to 2^17. */
#define PREPARING_LOOKS_MAX 160u

bool passo_waits_for_sync(const struct passo *passo)
{
	return passo && passo->gate == PASSO_GATE_SYNC;
}

/* Whether a queued motion of the channel is becoming ARMED. */
static bool is_preparing(const struct passo *passo)
{
	return passo->snapshot.state < PASSO_STATE_ARMED && !passo_driver_at_rest(passo);
}

/* OK if a motion of the channel is armed and waiting. */
static enum passo_error check_waits(struct passo *passo, const struct passo_host *host)
{
	if (passo->host != host)
		return PASSO_ERROR_ARGUMENT_CHANNEL;
	enum passo_error error = passo_driver_require_sent(passo, PASSO_POST_RUN);
	if (error != PASSO_OK)
		return error;
	if (passo_driver_is_broken(passo))
		return PASSO_ERROR_BROKEN;
	if (passo_driver_is_stopped(passo))
		return PASSO_ERROR_STOPPED;
	if (passo->gate != PASSO_GATE_SYNC || passo->stream == PASSO_STREAM_FILLS)
		return PASSO_ERROR_NOT_PREPARED;
	error = passo_driver_look(passo, false);
	for (unsigned looks = 1; error == PASSO_OK && looks < PREPARING_LOOKS_MAX && is_preparing(passo);
	    looks++)
		error = passo_driver_look(passo, false);
	if (error != PASSO_OK)
		return error;
	return passo->snapshot.state == PASSO_STATE_ARMED ? PASSO_OK : PASSO_ERROR_NOT_PREPARED;
}

enum passo_error passo_start_together(struct passo *const *channels, unsigned count)
{
	if (!channels)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (count == 0u || count > PASSO_CHANNELS_MAX)
		return PASSO_ERROR_ARGUMENT_CHANNEL;
	for (unsigned i = 0; i < count; i++) {
		enum passo_error error = passo_driver_check(channels[i]);
		if (error == PASSO_OK)
			error = check_waits(channels[i], channels[0]->host);
		if (error != PASSO_OK)
			return error;
	}
	struct passo_host *host = channels[0]->host;
	struct passo_run run = passo_unpack_run(host->run);
	for (unsigned i = 0; i < count; i++)
		run.wait_sync = (uint8_t)(run.wait_sync & ~(1u << channels[i]->channel));
	const uint32_t word = passo_pack_run(&run);
	enum passo_error error = passo_host_write(host, PASSO_ADDRESS_RUN, &word, 1);
	for (unsigned i = 0; error == PASSO_OK && i < count; i++)
		channels[i]->gate = PASSO_GATE_OPEN;
	return error;
}
