/* SPDX-License-Identifier: MIT
 * Polls the channels of the core, reports errors in notes, and retries a waiting move.
 */
#include "passo_commands.h"

#define SEARCH_MICROSECONDS 500000u
#define LOOK_MICROSECONDS 5000u

/* A stop or hold is being resent because it was not acknowledged. */
static bool has_due_command(const struct passo_console_channel *channel)
{
	const enum passo_error fault = passo_fault(&channel->passo);

	return fault == PASSO_ERROR_NOT_STOPPED || fault == PASSO_ERROR_NOT_HELD;
}

/* While a motion runs, polling seldom is enough; the irq pin signals a stop. */
static bool is_time_to_look(const struct passo_console *console, struct passo_console_channel *channel)
{
	const struct passo_hardware *hardware = &console->hardware;
	bool runs = passo_snapshot(&channel->passo)->state == PASSO_STATE_RUN;
	uint32_t now = hardware->microseconds ? hardware->microseconds(hardware->context) : 0u;

	if (runs && !console->waits && !has_due_command(channel) && hardware->irq
	    && !hardware->irq(hardware->context) && now - channel->looked_at < LOOK_MICROSECONDS)
		return false;
	channel->looked_at = now;
	return true;
}

/* Number of frames without a valid reply. */
static uint32_t bad_frames(const struct passo_counters *counters)
{
	return counters->stuck + counters->no_ack + counters->damaged + counters->sequence + counters->failed
	     + counters->refused[PASSO_VERDICT_BAD_CRC];
}

static bool is_of_link(enum passo_error error)
{
	return error >= PASSO_ERROR_TRANSFER && error <= PASSO_ERROR_BAD_CRC;
}

static bool is_of_wire(enum passo_error error)
{
	return is_of_link(error) || error == PASSO_ERROR_NOT_STOPPED || error == PASSO_ERROR_NOT_HELD;
}

static bool is_several(const struct passo_console *console)
{
	return passo_commands_channels(console) > 1u;
}

/* An error of the link, or a reset of the core, is reported once for all channels. */
static bool is_told(
    const struct passo_console *console, const struct passo_console_channel *channel, enum passo_error error)
{
	bool told = channel->noted == error;

	for (unsigned i = 0; i < passo_commands_channels(console); i++)
		told |= (is_of_link(error) || error == PASSO_ERROR_CORE_RESET)
		     && console->channel[i].noted == error;
	return told;
}

/* The line that waits for this channel is answered with its error. */
static bool is_answer(const struct passo_console *console, unsigned number)
{
	return (console->waits == PASSO_AWAITS_HOME || console->waits == PASSO_AWAITS_PROBE)
	    && console->waiting_channel == number && !has_due_command(&console->channel[number]);
}

static void note_error(struct passo_console *console, unsigned number, enum passo_error error)
{
	if (is_several(console) && !is_of_link(error) && error != PASSO_ERROR_CORE_RESET)
		passo_say(&console->sink, "note: channel %u: %s: %s\n", (uint32_t)number,
		    passo_error_name(error), passo_error_text(error));
	else
		passo_say_error_note(console, error);
}

/* The link works again. */
static void note_answer(struct passo_console *console)
{
	passo_say(&console->sink, "note: the core answers\n");
	for (unsigned i = 0; i < passo_commands_channels(console); i++) {
		if (is_of_link(console->channel[i].noted))
			console->channel[i].noted = PASSO_OK;
	}
}

/* A motion of an earlier session has ended. */
static void note_rest(struct passo_console *console, unsigned number)
{
	if (is_several(console))
		passo_say(&console->sink, "note: channel %u is at rest\n", (uint32_t)number);
	else
		passo_say(&console->sink, "note: the core is at rest\n");
}

/* Polls a channel. A poll that sends no frame does not change what is known. */
static void look_at_channel(struct passo_console *console, unsigned number)
{
	struct passo_console_channel *channel = &console->channel[number];
	const struct passo_counters before = console->host.counters;
	const struct passo_counters *now = &console->host.counters;
	enum passo_error error = passo_poll(&channel->passo);

	if (error != PASSO_OK) {
		if (!is_told(console, channel, error) && !is_answer(console, number))
			note_error(console, number, error);
		channel->noted = error;
		passo_commands_see(console, channel, error);
	} else if (now->frames != before.frames && bad_frames(now) == bad_frames(&before)
	           && !has_due_command(channel)) {
		if (is_of_wire(channel->noted))
			note_answer(console);
		channel->noted = PASSO_OK;
		if (channel->unset && passo_snapshot(&channel->passo)->state == PASSO_STATE_IDLE
		    && passo_commands_clear(console, channel) == PASSO_OK)
			note_rest(console, number);
	}
}

/* Retries to open the core: an FPGA may take longer to start than this board. */
static void look_for_core(struct passo_console *console)
{
	const struct passo_hardware *hardware = &console->hardware;
	uint32_t now = hardware->microseconds ? hardware->microseconds(hardware->context) : 0u;

	if (now - console->tried_at < SEARCH_MICROSECONDS)
		return;
	console->tried_at = now;
	if (passo_commands_open(console) == PASSO_OK)
		passo_say(&console->sink, "note: the core answers\n");
}

/* Bit i: channel i moves. */
static uint8_t moving_channels(const struct passo_console *console)
{
	uint8_t found = 0;

	for (unsigned i = 0; i < passo_commands_channels(console); i++)
		found |= (uint8_t)((unsigned)passo_is_moving(&console->channel[i].passo) << i);
	return found;
}

/* Something has changed since the last attempt to queue the waiting move. Other lines are not attempts. */
static bool may_go_on(const struct passo_console *console)
{
	const struct passo_console_channel *channel = &console->channel[console->waiting_channel];
	const struct passo_snapshot *now = passo_snapshot(&channel->passo);

	return console->waits != PASSO_AWAITS_ROOM || channel->noted != PASSO_OK
	    || moving_channels(console) != console->seen_moving || now->state != console->seen_state
	    || now->line_room != console->seen_lines || now->ramp_room != console->seen_ramps;
}

static void look_at_channels(struct passo_console *console)
{
	for (unsigned i = 0; i < passo_commands_channels(console); i++) {
		if (is_time_to_look(console, &console->channel[i]))
			look_at_channel(console, i);
	}
}

void passo_console_poll(struct passo_console *console)
{
	if (!console->opened)
		look_for_core(console);
	else
		look_at_channels(console);
	if (console->waits && may_go_on(console))
		passo_commands_try_again(console);
}

static bool stands(const struct passo_console_channel *channel)
{
	const struct passo_snapshot *seen = passo_snapshot(&channel->passo);
	bool armed = seen->state == PASSO_STATE_ARMED;

#ifndef PASSO_WITHOUT_PARTS
	armed = armed && passo_waits_for_sync(&channel->passo); /* a thread starts with its index */
#endif
	return seen->rate == 0u || armed;
}

bool passo_console_stands(const struct passo_console *console)
{
	const uint8_t moving = moving_channels(console);
	bool all = moving != 0u;

	if (console->waits && (moving >> console->waiting_channel & 1u) != 0u)
		return stands(&console->channel[console->waiting_channel]);
	for (unsigned i = 0; i < passo_commands_channels(console); i++)
		all &= (moving >> i & 1u) == 0u || stands(&console->channel[i]);
	return all;
}

bool passo_console_owes(const struct passo_console *console)
{
	return console->waits;
}

bool passo_console_is_idle(const struct passo_console *console)
{
	return moving_channels(console) == 0u;
}

bool passo_console_is_well(const struct passo_console *console)
{
	bool well = console->opened;

	for (unsigned i = 0; i < passo_commands_channels(console); i++)
		well &= passo_fault(&console->channel[i].passo) == PASSO_OK;
	return well;
}
