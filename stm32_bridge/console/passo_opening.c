/* SPDX-License-Identifier: MIT
 * Opens the core and its channels, and applies the settings to them.
 */
#include "passo_call.h"
#include "passo_commands.h"

uint8_t passo_commands_channels(const struct passo_console *console)
{
	return console->opened ? console->host.channels : 0u;
}

void passo_commands_reset_axes(struct passo_console *console)
{
	uint32_t clocks = (console->clock_hz + 999999u) / 1000000u;

	for (unsigned i = 0; i < PASSO_CHANNELS_MAX * PASSO_AXES_MAX; i++)
		console->channel[i / PASSO_AXES_MAX].axis[i % PASSO_AXES_MAX] =
		    (struct passo_axis_config){.in_clocks = true,
			.step_high_ns = clocks,
			.step_low_ns = clocks,
			.dir_setup_ns = clocks,
			.dir_hold_ns = clocks};
}

/* Applies the settings to a channel. */
static enum passo_error set_up(const struct passo_console *console, struct passo_console_channel *channel)
{
	struct passo *passo = &channel->passo;
	enum passo_error error =
	    passo_configure_motion(passo, passo_clocks(passo, console->hold_microseconds),
		passo_clocks(passo, console->stop_microseconds), 0);

	for (uint8_t axis = 0; axis < passo_machine(passo)->axes && error == PASSO_OK; axis++)
		error = passo_configure_axis(passo, axis, &channel->axis[axis]);
	channel->unset = error != PASSO_OK;
	return error;
}

/* Opens a channel; the first one opens the core. */
static enum passo_error open_channel(struct passo_console *console, uint8_t number)
{
	struct passo_console_channel *channel = &console->channel[number];
	const struct passo_options options = {.clock_hz = console->clock_hz, .channel = number};
	enum passo_error error = number == 0u
	                           ? passo_open(&channel->passo, &console->host, &console->hardware, &options)
	                           : passo_open_channel(&channel->passo, &console->host, &options);

	console->opened = error == PASSO_OK || error == PASSO_ERROR_MOVING;
	console->absent = error;
	channel->unset = true;
	channel->noted = PASSO_OK;
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

	return error == PASSO_OK && channel->unset ? set_up(console, channel) : error;
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

bool passo_run_clear(const struct passo_call *call)
{
	return passo_answer(call, passo_commands_clear(call->console, call->channel));
}
