/* SPDX-License-Identifier: MIT
 * Opens the core and its channels, and applies the settings to them.
 */
#include "passo_call.h"
#include "passo_commands.h"

#define MICROSECONDS UINT64_C(1000000)
#define WATCHDOG_MICROSECONDS 500000u

uint8_t passo_commands_channels(const struct passo_console *console)
{
	return console->opened ? console->host.channels : 0u;
}

void passo_commands_reset_times(struct passo_console *console)
{
	const uint32_t clocks = (console->clock_hz + 999999u) / 1000000u;
	const uint64_t longest = PASSO_WATCHDOG_CLOCKS_MAX * MICROSECONDS / console->clock_hz;

	for (unsigned i = 0; i < PASSO_CHANNELS_MAX * PASSO_AXES_MAX; i++)
		console->channel[i / PASSO_AXES_MAX].axis[i % PASSO_AXES_MAX] =
		    (struct passo_axis_config){.in_clocks = true,
			.step_high_ns = clocks,
			.step_low_ns = clocks,
			.dir_setup_ns = clocks,
			.dir_hold_ns = clocks};
	console->watchdog_microseconds =
	    longest < WATCHDOG_MICROSECONDS ? (uint32_t)longest : WATCHDOG_MICROSECONDS;
	console->disable_microseconds = 0;
#ifndef PASSO_WITHOUT_PARTS
	for (unsigned i = 0; i < PASSO_CHANNELS_MAX; i++)
		passo_commands_reset_outputs(&console->channel[i], console->clock_hz);
#endif
}

enum passo_error passo_commands_set_core(struct passo_console *console)
{
	struct passo *passo = &console->channel[0].passo;
	enum passo_error error;

	if (!passo_has_inputs(passo))
		return PASSO_OK;
	error = passo_configure_filter(passo, passo_clocks(passo, console->filter_microseconds));
	if (error != PASSO_OK)
		return error;
	return passo_configure_watchdog(passo, passo_clocks(passo, console->watchdog_microseconds),
	    passo_clocks(passo, console->disable_microseconds));
}

/* Applies the settings of the inputs to a channel. */
static enum passo_error set_inputs(struct passo_console_channel *channel)
{
	struct passo *passo = &channel->passo;
	enum passo_error error = PASSO_OK;

	if (!passo_has_inputs(passo))
		return PASSO_OK;
	for (uint8_t axis = 0; axis < passo_axes(passo) && error == PASSO_OK; axis++) {
		if (((uint32_t)channel->inputs_given >> axis & 1u) != 0u)
			error = passo_commands_set_inputs(&channel->inputs[axis], passo, axis);
	}
	if (error == PASSO_OK && channel->probe != PASSO_LEVEL_NONE)
		error = passo_configure_probe(passo, channel->probe == PASSO_LEVEL_LOW);
	return error;
}

/* Applies the settings of outputs and encoders to a channel. */
static enum passo_error set_parts(struct passo_console_channel *channel)
{
#ifdef PASSO_WITHOUT_PARTS
	(void)channel;
	return PASSO_OK;
#else
	enum passo_error error = passo_commands_set_outputs(channel);

	return error == PASSO_OK ? passo_commands_set_encoders(channel) : error;
#endif
}

static enum passo_error set_trackers(struct passo_console_channel *channel)
{
#ifdef PASSO_WITHOUT_TRACKERS
	(void)channel;
	return PASSO_OK;
#else
	return passo_commands_set_trackers(channel);
#endif
}

/* Applies the settings to a channel. */
static enum passo_error set_up(const struct passo_console *console, struct passo_console_channel *channel)
{
	struct passo *passo = &channel->passo;
	enum passo_error error =
	    passo_configure_motion(passo, passo_clocks(passo, console->hold_microseconds),
		passo_clocks(passo, console->stop_microseconds), 0);

	for (uint8_t axis = 0; axis < passo_axes(passo) && error == PASSO_OK; axis++)
		error = passo_configure_axis(passo, axis, &channel->axis[axis]);
	if (error == PASSO_OK)
		error = set_inputs(channel);
	if (error == PASSO_OK)
		error = set_parts(channel);
	if (error == PASSO_OK)
		error = set_trackers(channel);
	channel->unset = error != PASSO_OK;
	return error;
}

/* Whether a channel is open with this result of passo_open(). */
static bool is_open(enum passo_error error)
{
	return error == PASSO_OK || error == PASSO_ERROR_MOVING || error == PASSO_ERROR_ESTOP
	    || error == PASSO_ERROR_ALARM;
}

static void set_spi(const struct passo_console *console, bool fast)
{
	if (console->board.set_spi_fast)
		console->board.set_spi_fast(console->board.context, fast);
}

/* The core is open: times are those of its clock. */
static void take_clock(struct passo_console *console)
{
	const uint32_t clock_hz = passo_machine(&console->channel[0].passo)->clock_hz;

	if (clock_hz != console->clock_hz) {
		console->clock_hz = clock_hz;
		passo_commands_reset_times(console);
		passo_say(&console->sink, "note: the core runs at %u Hz; pin timings are 1 us\n", clock_hz);
	}
	set_spi(console, !console->spi_slow && clock_hz >= console->board.spi_fast_hz);
}

/* Opens a channel; the first one opens the core. */
static enum passo_error open_channel(struct passo_console *console, uint8_t number)
{
	struct passo_console_channel *channel = &console->channel[number];
	const struct passo_options options = {.clock_hz = console->given_hz, .channel = number};

	if (number == 0u && !console->opened)
		set_spi(console, false); /* any core can follow */
	enum passo_error error = number == 0u
	                           ? passo_open(&channel->passo, &console->host, &console->hardware, &options)
	                           : passo_open_channel(&channel->passo, &console->host, &options);

	console->opened = is_open(error);
	console->absent = error;
	channel->unset = true;
	channel->noted = PASSO_OK;
	if (number == 0u && console->opened) {
		take_clock(console);
		const enum passo_error refused = passo_commands_set_core(console);

		if (error == PASSO_OK)
			error = refused;
	}
	passo_commands_see(console, channel, error);
	if (error == PASSO_ERROR_ALARM || error == PASSO_ERROR_ESTOP)
		set_inputs(channel); /* the alarm may have the other level */
	return error == PASSO_OK ? set_up(console, channel) : error;
}

enum passo_error passo_commands_open(struct passo_console *console)
{
	const bool is_other = !console->opened || console->host.lost;
	enum passo_error result = open_channel(console, 0);

	for (uint8_t number = 1; number < passo_commands_channels(console); number++) {
		const enum passo_error error = open_channel(console, number);

		if (result == PASSO_OK || !console->opened)
			result = error;
	}
	for (unsigned i = 0; is_other && i < PASSO_CHANNELS_MAX; i++)
		console->channel[i].enabled = console->channel[i].announced = 0;
	return result;
}

enum passo_error passo_commands_clear(struct passo_console *console, struct passo_console_channel *channel)
{
	enum passo_error error = passo_clear(&channel->passo);

	if (error == PASSO_ERROR_ESTOP && passo_clear_estop(&channel->passo) == PASSO_OK)
		error = passo_clear(&channel->passo);
	return error == PASSO_OK && channel->unset ? set_up(console, channel) : error;
}

void passo_commands_see(
    struct passo_console *console, struct passo_console_channel *channel, enum passo_error error)
{
	if (error == PASSO_ERROR_ESTOP
	    || (error == PASSO_ERROR_WATCHDOG && console->disable_microseconds != 0u)) {
		for (unsigned i = 0; i < PASSO_CHANNELS_MAX; i++)
			console->channel[i].enabled = console->channel[i].announced = 0;
	}
	for (unsigned i = 0; error == PASSO_ERROR_ALARM && i < PASSO_AXES_MAX; i++) {
		if (channel->inputs[i].alarm_disables)
			channel->enabled &= (uint8_t)~(1u << i);
	}
}

bool passo_commands_is_moving(const struct passo_console *console)
{
	return !console->host.lost && !passo_console_is_idle(console);
}

bool passo_run_open(const struct passo_call *call)
{
	if (passo_commands_is_moving(call->console))
		return passo_answer(call, PASSO_ERROR_MOVING);
	return passo_answer(call, passo_commands_open(call->console));
}

#ifdef PASSO_BOTH
bool passo_run_grbl(const struct passo_call *call)
{
	if (passo_commands_is_moving(call->console))
		return passo_answer(call, PASSO_ERROR_MOVING);
	call->console->board.leave();
	return passo_answer(call, PASSO_OK);
}
#endif

bool passo_run_clear(const struct passo_call *call)
{
	return passo_answer(call, passo_commands_clear(call->console, call->channel));
}
