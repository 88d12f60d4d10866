/* SPDX-License-Identifier: MIT
 * Opening a channel, and what the rest of the driver is built on.
 */
#include "passo.h"

#include <string.h>

#include "passo_driver.h"

enum { OPEN_WORDS = 4, STATE_WORDS = 4 };

/* Four steps that wait and one under way, with four times of at most 65535 clocks each, take no longer than
 * so many looks: one takes more than 1024 clocks. */
#define PIN_LOOKS_MAX 1280u

enum passo_error passo_driver_check(const struct passo *passo)
{
	if (!passo)
		return PASSO_ERROR_ARGUMENT;
	return passo->opened ? PASSO_OK : PASSO_ERROR_NOT_OPEN;
}

bool passo_driver_is_wire(enum passo_error error)
{
	return error >= PASSO_ERROR_TRANSFER && error <= PASSO_ERROR_BAD_CRC;
}

uint32_t passo_driver_now(const struct passo *passo)
{
	const struct passo_hardware *hardware = &passo->host->hardware;

	return hardware->microseconds ? hardware->microseconds(hardware->context) : 0u;
}

enum passo_error passo_driver_write(
    struct passo *passo, uint16_t address, const uint32_t *words, size_t length)
{
	return passo_host_write(passo->host, (uint16_t)(passo->base + address), words, length);
}

enum passo_error passo_driver_command(struct passo *passo, uint32_t bits)
{
	return passo_driver_write(passo, PASSO_CHANNEL_COMMAND, &bits, 1);
}

uint32_t passo_driver_run(const struct passo *passo, enum passo_gate gate)
{
	const uint32_t run = UINT32_C(1) << (PASSO_RUN_RUN_LSB + passo->channel);
	const uint32_t wait = UINT32_C(1) << (PASSO_RUN_WAIT_SYNC_LSB + passo->channel);
	const uint32_t status = (uint32_t)passo->channel << PASSO_RUN_STATUS_CHANNEL_LSB;

	return (passo->host->run & 0xFFFFu & ~(run | wait)) | status | (gate != PASSO_GATE_CLOSED ? run : 0u)
	     | (gate == PASSO_GATE_SYNC ? wait : 0u);
}

enum passo_error passo_driver_gate(struct passo *passo, enum passo_gate gate)
{
	const uint32_t word = passo_driver_run(passo, gate);

	if (word == passo->host->run && !passo->host->run_due)
		return PASSO_OK;
	return passo_host_write(passo->host, PASSO_ADDRESS_RUN, &word, 1);
}

/* No motion runs or waits; steps may still be at the pins. */
static bool is_empty(const struct passo *passo)
{
	const struct passo_snapshot *snapshot = &passo->snapshot;

	return snapshot->state == PASSO_STATE_IDLE && snapshot->line_room == passo->line_places
	    && snapshot->ramp_room == passo->ramp_places;
}

enum passo_error passo_driver_look(struct passo *passo, bool once)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_STATE);
	struct passo_snapshot *snapshot = &passo->snapshot;
	uint32_t words[STATE_WORDS]; /* STATE, RATE, ROOM, VELOCITY */
	enum passo_error error = once ? passo_host_read_once(passo->host, address, words, STATE_WORDS)
	                              : passo_host_read(passo->host, address, words, STATE_WORDS);

	passo->looked_at = passo_driver_now(passo);
	if (error != PASSO_OK)
		return error;
	*snapshot = (struct passo_snapshot){
	    .state = (enum passo_state)(words[0] >> PASSO_CHANNEL_STATE_STATE_LSB & 7u),
	    .cause = (enum passo_cause)(words[0] >> PASSO_CHANNEL_STATE_CAUSE_LSB & 7u),
	    .quiet = (words[0] >> PASSO_CHANNEL_STATE_QUIET_LSB & 1u) != 0u,
	    .stopping = (words[0] >> PASSO_CHANNEL_STATE_STOPPING_LSB & 1u) != 0u,
	    .overrun = (uint8_t)(words[0] >> PASSO_CHANNEL_STATE_OVERRUN_LSB),
	    .drained = (uint16_t)(words[0] >> PASSO_CHANNEL_STATE_DRAINED_LSB),
	    .rate = words[1],
	    .line_room = (uint16_t)(words[2] >> PASSO_CHANNEL_ROOM_LINE_ROOM_LSB),
	    .ramp_room = (uint16_t)(words[2] >> PASSO_CHANNEL_ROOM_RAMP_ROOM_LSB),
	    .velocity = words[3],
	};
	return PASSO_OK;
}

enum passo_error passo_driver_look_at_rest(struct passo *passo)
{
	const struct passo_snapshot *snapshot = &passo->snapshot;
	enum passo_error error = passo_driver_look(passo, false);

	for (unsigned looks = 1; error == PASSO_OK && looks < PIN_LOOKS_MAX && !snapshot->quiet
	                         && (snapshot->state == PASSO_STATE_STOPPED || is_empty(passo));
	    looks++)
		error = passo_driver_look(passo, false);
	return error;
}

enum passo_error passo_driver_positions(struct passo *passo, int32_t *positions, bool once)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_POSITION_BASE);
	uint32_t words[PASSO_AXES_MAX];
	enum passo_error error = once ? passo_host_read_once(passo->host, address, words, passo->machine.axes)
	                              : passo_host_read(passo->host, address, words, passo->machine.axes);

	if (error != PASSO_OK)
		return error;
	for (unsigned i = 0; i < passo->machine.axes; i++)
		positions[i] = (int32_t)words[i];
	return PASSO_OK;
}

bool passo_driver_at_rest(const struct passo *passo)
{
	return is_empty(passo) && passo->snapshot.quiet;
}

enum passo_error passo_driver_moving(enum passo_error error)
{
	const bool is_busy = (unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_BUSY;

	return is_busy ? PASSO_ERROR_MOVING : error;
}

void passo_driver_ended(struct passo *passo, const int32_t *positions)
{
	for (unsigned i = 0; i < passo->machine.axes; i++)
		passo->axis[i].expected = positions[i];
	passo->certain = true;
	passo->expecting = false;
	passo->turning_is_on = false;
	passo->idle_looks = 0;
}

void passo_driver_break(struct passo *passo)
{
	passo->broken = passo->expecting = true;
	passo->certain = false;
	passo->idle_looks = 0;
}

enum passo_error passo_driver_ready(struct passo *passo, bool needs_rest)
{
	enum passo_error error = passo_driver_restrain(passo, PASSO_POST_RUN);

	if (error != PASSO_OK)
		return error;
	if (passo->broken)
		return PASSO_ERROR_BROKEN;
	if (passo->halted)
		return PASSO_ERROR_STOPPED;
	if (passo->stream != PASSO_STREAM_NONE)
		return PASSO_ERROR_STREAMING;
	error = needs_rest ? passo_driver_look_at_rest(passo) : passo_driver_look(passo, false);
	if (error != PASSO_OK)
		return error;
	if (passo->snapshot.state == PASSO_STATE_STOPPED || passo->snapshot.stopping)
		return PASSO_ERROR_STOPPED;
	if (passo->turning_is_on && passo_driver_at_rest(passo)) {
		int32_t positions[PASSO_AXES_MAX];
		error = passo_driver_positions(passo, positions, false);
		if (error != PASSO_OK)
			return error;
		passo_driver_ended(passo, positions);
	}
	if (passo->turning_is_on || (needs_rest && !passo_driver_at_rest(passo)))
		return PASSO_ERROR_MOVING;
	return PASSO_OK;
}

static bool fits(uint32_t actual, uint8_t expected)
{
	return expected == 0u || actual == expected;
}

/* What the core is, against what is expected. */
static enum passo_error identify(struct passo *passo, const struct passo_options *options, uint32_t *run)
{
	uint32_t words[OPEN_WORDS]; /* IDENTIFICATION, VERSION, PARAMETERS, RUN */
	enum passo_error error =
	    passo_host_read(passo->host, PASSO_ADDRESS_IDENTIFICATION, words, OPEN_WORDS);

	if (error != PASSO_OK)
		return error;
	if (words[0] != PASSO_IDENTIFICATION_RESET)
		return PASSO_ERROR_NOT_PASSO;
	if ((words[1] >> PASSO_VERSION_MAJOR_LSB & 0xFFu) != PASSO_VERSION_MAJOR_RESET
	    || (words[1] >> PASSO_VERSION_MINOR_LSB & 0xFFu) != PASSO_VERSION_MINOR_RESET)
		return PASSO_ERROR_VERSION;

	const uint32_t channels = words[2] >> PASSO_PARAMETERS_CHANNELS_LSB & 0xFu;
	const uint32_t axes = words[2] >> PASSO_PARAMETERS_AXES_LSB & 0xFu;
	const uint32_t tick_log2 = words[2] >> PASSO_PARAMETERS_TICK_LOG2_LSB & 0x1Fu;
	if (!fits(channels, options->channels) || !fits(axes, options->axes)
	    || !fits(tick_log2, options->tick_log2) || options->channel >= channels || axes == 0u
	    || axes > PASSO_AXES_MAX)
		return PASSO_ERROR_PARAMETERS;
	passo->machine = (struct passo_machine){
	    .clock_hz = options->clock_hz, .tick_log2 = (uint8_t)tick_log2, .axes = (uint8_t)axes};
	passo->line_places = (uint16_t)(1u << (words[2] >> PASSO_PARAMETERS_LINE_QUEUE_LOG2_LSB & 0xFu));
	passo->ramp_places = (uint16_t)(1u << (words[2] >> PASSO_PARAMETERS_RAMP_QUEUE_LOG2_LSB & 0xFu));
	*run = words[3];
	return PASSO_OK;
}

enum passo_error passo_driver_take_over(struct passo *passo)
{
	const uint32_t rate = passo_driver_rate(passo);
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = PASSO_OK;

	passo->broken = true; /* until it is done */
	if (passo->snapshot.state == PASSO_STATE_IDLE && !passo_driver_at_rest(passo))
		error = passo_driver_command(passo, UINT32_C(1) << PASSO_CHANNEL_COMMAND_ABORT_LSB);
	if (error == PASSO_OK && !passo_driver_at_rest(passo))
		error = passo_driver_command(passo, UINT32_C(1) << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	if (error == PASSO_OK)
		error = passo_driver_write(passo, PASSO_CHANNEL_RATE_TARGET, &rate, 1);
	if (error == PASSO_OK)
		error = passo_driver_look(passo, false);
	if (error == PASSO_OK)
		error = passo_driver_positions(passo, positions, false);
	if (error != PASSO_OK)
		return error;
	passo_driver_ended(passo, positions);
	passo->broken = passo->halted = false;
	passo->fault = PASSO_OK;
	return passo_driver_at_rest(passo) ? PASSO_OK : PASSO_ERROR_MOVING;
}

enum passo_error passo_open_channel(
    struct passo *passo, struct passo_host *host, const struct passo_options *options)
{
	uint32_t run;

	if (!passo || !host || !options || options->clock_hz == 0u || options->channel >= PASSO_CHANNELS_MAX)
		return PASSO_ERROR_ARGUMENT;
	memset(passo, 0, sizeof *passo);
	passo->host = host;
	passo->channel = options->channel;
	passo->base =
	    (uint16_t)(PASSO_ADDRESS_CHANNEL_BASE + options->channel * PASSO_ADDRESS_CHANNEL_STRIDE);
	passo->rate_target = PASSO_RATE_FULL;
	enum passo_error error = identify(passo, options, &run);
	if (error != PASSO_OK)
		return error;
	if (!host->guarded) {
		host->run = run;
		if (host->fresh && run == 0u)
			passo_driver_tables_fresh(host);
	}
	error = passo_driver_look(passo, false);
	if (error == PASSO_OK && passo->snapshot.quiet && !passo_driver_at_rest(passo))
		error = passo_driver_gate(passo, PASSO_GATE_CLOSED);
	passo->broken = true;
	if (error == PASSO_OK && passo->snapshot.quiet)
		error = passo_driver_take_over(passo);
	/* what follows a motion of the past is not to start */
	if (error == PASSO_OK)
		error = passo_driver_gate(passo, passo->broken ? PASSO_GATE_CLOSED : PASSO_GATE_OPEN);
	if (error != PASSO_OK)
		return error;
	if (!host->guarded)
		error = passo_host_guard(host, passo->machine.axes, options->clock_hz);
	if (error != PASSO_OK)
		return error;
	passo->opened = true;
	return passo->broken ? PASSO_ERROR_MOVING : PASSO_OK;
}

enum passo_error passo_open(struct passo *passo, struct passo_host *host,
    const struct passo_hardware *hardware, const struct passo_options *options)
{
	if (!passo || !options || options->clock_hz == 0u || options->channel >= PASSO_CHANNELS_MAX)
		return PASSO_ERROR_ARGUMENT;
	passo->opened = false;
	enum passo_error error = passo_host_open(host, hardware);
	return error != PASSO_OK ? error : passo_open_channel(passo, host, options);
}

const struct passo_machine *passo_machine(const struct passo *passo)
{
	return &passo->machine;
}
