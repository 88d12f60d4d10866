/* SPDX-License-Identifier: MIT
 * Opening a channel.
 */
#include <string.h>

#include "passo_driver.h"

#define OPEN_WORDS 4u

static bool fits(uint32_t actual, uint32_t expected)
{
	return expected == 0u || actual == expected;
}

/* Disarms whatever a previous connection armed: trigger, compare points, the encoder as the clock, stops by
 * encoders. Limits, alarms and the filter describe the machine and stay. */
enum passo_error passo_driver_disown(struct passo *passo)
{
	const uint32_t none = 0;
	enum passo_error error = PASSO_OK;

	if (passo->has_inputs)
		error = passo_driver_disarm(passo);
	if (error == PASSO_OK && passo->has_compare)
		error = passo_driver_write(passo, PASSO_CHANNEL_COMPARE_PULSE, &none, 1);
	if (error == PASSO_OK && passo->has_encoders)
		error = passo_driver_write(passo, PASSO_CHANNEL_FOLLOW, &none, 1);
	for (unsigned i = 0; error == PASSO_OK && passo->has_encoders && i < passo->axes; i++)
		error = passo_driver_write(passo,
		    (uint16_t)(PASSO_CHANNEL_ENCODER_BASE + i * PASSO_CHANNEL_ENCODER_STRIDE
		               + PASSO_ENCODER_SETUP),
		    &none, 1);
	if (error == PASSO_OK)
		passo->follows = false;
	return passo_driver_moving(error);
}

/* Reads the clock of the core; one that does not tell it runs at that of the options. */
static enum passo_error agree_on_clock(struct passo *passo)
{
	const uint32_t expected = passo->machine.clock_hz;
	uint32_t told;
	const enum passo_error error = passo_host_read(passo->host, PASSO_ADDRESS_CLOCK, &told, 1);

	if (error != PASSO_OK)
		return error;
	if (told != 0u)
		passo->machine.clock_hz = told;
	if (passo->machine.clock_hz == 0u)
		return PASSO_ERROR_CLOCK_UNKNOWN;
	return fits(passo->machine.clock_hz, expected) ? PASSO_OK : PASSO_ERROR_CLOCK;
}

/* Reads the identity and parameters of the core and compares them with the options. */
static enum passo_error identify(struct passo *passo, const struct passo_options *options, uint32_t *run)
{
	uint32_t words[OPEN_WORDS]; /* IDENTIFICATION, VERSION, PARAMETERS, RUN */
	enum passo_error error =
	    passo_host_read(passo->host, PASSO_ADDRESS_IDENTIFICATION, words, OPEN_WORDS);

	if (error != PASSO_OK)
		return error;
	if (words[0] != PASSO_IDENTIFICATION_RESET)
		return PASSO_ERROR_NOT_PASSO;
	const struct passo_version version = passo_unpack_version(words[1]);
	if (version.major != PASSO_VERSION_MAJOR_RESET || version.minor != PASSO_VERSION_MINOR_RESET)
		return PASSO_ERROR_VERSION;

	const struct passo_parameters_word core = passo_unpack_parameters(words[2]);
	if (!fits(core.channels, options->channels) || !fits(core.axes, options->axes)
	    || !fits(core.tick_log2, options->tick_log2) || options->channel >= core.channels
	    || core.channels > PASSO_CHANNELS_MAX || core.axes <= core.tracked || core.axes > PASSO_AXES_MAX)
		return PASSO_ERROR_PARAMETERS;
	passo->axes = core.axes;
	passo->machine = (struct passo_machine){.clock_hz = options->clock_hz,
	    .tick_log2 = core.tick_log2,
	    .axes = (uint8_t)(core.axes - core.tracked)};
	passo->line_places = (uint16_t)(1u << core.line_queue_log2);
	passo->ramp_places = (uint16_t)(1u << core.ramp_queue_log2);
	passo->has_inputs = core.inputs;
	passo->has_outputs = core.outputs;
	passo->has_raster = core.raster;
	passo->has_compare = core.compare;
	passo->has_encoders = passo->follows = core.encoders;
	passo->has_trackers = core.trackers;
	passo->host->channels = core.channels;
	*run = words[3];
	return agree_on_clock(passo);
}

static uint64_t watchdog_of(const struct passo *passo, const struct passo_options *options)
{
	if (options->watchdog_clocks == PASSO_NO_WATCHDOG)
		return 0;
	if (options->watchdog_clocks != 0u)
		return options->watchdog_clocks;
	const uint64_t clocks = passo->machine.clock_hz / 2u;
	return clocks < PASSO_WATCHDOG_CLOCKS_MAX ? clocks : PASSO_WATCHDOG_CLOCKS_MAX;
}

/* The channel is open, and stopped while this lasts. */
static bool is_kept_stopped(enum passo_error error)
{
	return error == PASSO_ERROR_ESTOP || error == PASSO_ERROR_ALARM;
}

/* Trackers of a previous connection slow down; its motion that is queued, prepared or waiting for an edge
 * must not start. A soft stop flushes it immediately, or stops it if it has just started. */
static enum passo_error keep_from_beginning(struct passo *passo)
{
	const uint32_t none = 0;
	enum passo_error error = PASSO_OK;

	if (passo->has_trackers)
		error = passo_driver_write(passo, PASSO_CHANNEL_TRACKER_ENABLE, &none, 1);
	if (error == PASSO_OK)
		error = passo_driver_look_at_rest(passo);
	if (error != PASSO_OK || passo->snapshot.state > PASSO_STATE_ARMED || passo_driver_at_rest(passo))
		return error;
	error = passo_driver_command(passo, (struct passo_channel_command){.stop = true});
	return error != PASSO_OK ? error : passo_driver_look_at_rest(passo);
}

/* Identifies the core and takes over the channel, unless it is in motion. */
static enum passo_error make_contact(struct passo *passo, const struct passo_options *options)
{
	struct passo_host *host = passo->host;
	uint32_t run;
	enum passo_error error = identify(passo, options, &run);

	if (error != PASSO_OK)
		return error;
	if (!host->guarded) {
		host->run = run;
		if (host->fresh && run == 0u)
			passo_driver_tables_fresh(host);
	}
	passo->inherits = true;
	error = passo_driver_recall_outputs(passo);
	if (error == PASSO_OK)
		error = keep_from_beginning(passo);
	const bool is_quiet = passo->snapshot.quiet;
	if (error == PASSO_OK && is_quiet)
		error = passo_driver_take_over(passo);
	if (error != PASSO_OK && is_kept_stopped(error))
		error = PASSO_OK;
	/* motions queued behind one of an earlier session must not start */
	if (error == PASSO_OK)
		error = passo_driver_gate(passo, is_quiet ? PASSO_GATE_OPEN : PASSO_GATE_CLOSED);
	if (error == PASSO_OK && !host->guarded && passo->has_inputs)
		error = passo_driver_watchdog(passo, watchdog_of(passo, options), 0);
	if (error == PASSO_OK && !host->guarded)
		error = passo_host_guard(
		    host, (uint8_t)(PASSO_LINE_WORDS(passo->machine.axes) + passo->has_outputs));
	return error;
}

static enum passo_error check(const struct passo *passo, const struct passo_options *options)
{
	if (!passo || !options)
		return PASSO_ERROR_ARGUMENT_POINTER;
	return options->channel < PASSO_CHANNELS_MAX ? PASSO_OK : PASSO_ERROR_ARGUMENT_CHANNEL;
}

enum passo_error passo_open_channel(
    struct passo *passo, struct passo_host *host, const struct passo_options *options)
{
	enum passo_error error = check(passo, options);

	if (error != PASSO_OK)
		return error;
	if (!host)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (host->prepared != 0u)
		return PASSO_ERROR_STREAMING;
	if (host->guarded)
		host->ahead = host->send; /* shared: a prepared frame would block another channel */
	memset(passo, 0, sizeof *passo);
	passo->host = host;
	passo->channel = options->channel;
	passo->base =
	    (uint16_t)(PASSO_ADDRESS_CHANNEL_BASE + options->channel * PASSO_ADDRESS_CHANNEL_STRIDE);
	passo->rate_target = PASSO_RATE_FULL;
	error = make_contact(passo, options);
	if (error == PASSO_OK && passo->assumed == PASSO_ASSUMED_STOPPED)
		return passo->fault;
	passo->assumed = error == PASSO_OK ? PASSO_ASSUMED_READY : PASSO_ASSUMED_NOT_OPEN;
	passo->fault = error;
	if (error != PASSO_OK || passo->snapshot.quiet)
		return error;
	passo_driver_break(passo); /* a motion of a previous connection */
	return PASSO_ERROR_MOVING;
}

enum passo_error passo_open(struct passo *passo, struct passo_host *host,
    const struct passo_hardware *hardware, const struct passo_options *options)
{
	enum passo_error error = check(passo, options);

	if (error != PASSO_OK)
		return error;
	passo->assumed = PASSO_ASSUMED_NOT_OPEN;
	error = passo_host_open(host, hardware);
	passo->fault = error;
	return error != PASSO_OK ? error : passo_open_channel(passo, host, options);
}
