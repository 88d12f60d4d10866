/* SPDX-License-Identifier: MIT
 * Assembles bytes to lines and polls the core. The commands are in passo_commands.c.
 */
#include "passo_console.h"

#include <string.h>

#include "passo_commands.h"
#include "passo_release.h"

#define BACKSPACE '\b'
#define DELETE 0x7F

#define HOLD_MICROSECONDS 50000u
#define SEARCH_MICROSECONDS 500000u
#define LOOK_MICROSECONDS 5000u

void passo_console_start(struct passo_console *console, const struct passo_sink *sink,
    const struct passo_hardware *hardware, const struct passo_console_board *board, uint32_t clock_hz,
    uint32_t baud)
{
	memset(console, 0, sizeof *console);
	console->sink = *sink;
	console->hardware = *hardware;
	if (board)
		console->board = *board;
	console->clock_hz = clock_hz;
	console->baud = baud;
	console->hold_microseconds = console->stop_microseconds = HOLD_MICROSECONDS;
	console->flow_waits = true;
	passo_commands_reset_axes(console);
	passo_say(sink, "note: Passo console " PASSO_RELEASE "; help lists the commands\n");
	passo_say_error_note(console, passo_commands_open(console));
}

/* Executes the line of the waiting move once more: it waits on, or is answered. */
static void try_again(struct passo_console *console)
{
	char line[PASSO_LINE_MAX + 1u];

	memcpy(line, console->waiting, sizeof line);
	console->waits = false;
	passo_commands_execute(console, line);
}

/* Executes a line, then the waiting one, which it may have ended or let go on. */
static void take_line(struct passo_console *console)
{
	if (console->waits) {
		passo_commands_execute(console, console->line);
		try_again(console);
	} else {
		memcpy(console->waiting, console->line, console->length + 1u);
		passo_commands_execute(console, console->line);
	}
}

/* Executes a complete line, or prints why it cannot. */
static void finish_line(struct passo_console *console)
{
	console->line[console->length] = '\0';
	if (console->bad == PASSO_CONSOLE_LOST + 1)
		passo_complain(&console->sink, "bytes of this line were lost");
	else if (console->bad != 0u)
		passo_complain(&console->sink, "character %u is not text", console->bad - 1u);
	else if (console->too_long)
		passo_complain(&console->sink, "the line is longer than %u characters", PASSO_LINE_MAX);
	else
		take_line(console);
	console->length = 0;
	console->too_long = false;
	console->bad = 0;
}

void passo_console_receive(struct passo_console *console, char byte)
{
	bool after_return = console->ended_by_return;

	console->ended_by_return = byte == '\r';
	if (byte == '\n' && after_return)
		return; /* LF of CR LF */
	if (byte == '\n' || byte == '\r') {
		finish_line(console);
	} else if (byte == BACKSPACE || byte == DELETE) {
		if (console->length > 0u)
			console->length--;
	} else if ((byte < ' ' && byte != '\t') || (unsigned char)byte > DELETE) {
		if (console->bad == 0u)
			console->bad = (uint16_t)((unsigned char)byte + 1u);
	} else if (console->length == PASSO_LINE_MAX) {
		console->too_long = true;
	} else {
		console->line[console->length++] = byte;
	}
}

/* A stop or hold is being resent because it was not acknowledged. */
static bool insists(const struct passo_console *console)
{
	const enum passo_error fault = passo_fault(&console->passo);

	return fault == PASSO_ERROR_NOT_STOPPED || fault == PASSO_ERROR_NOT_HELD;
}

/* While a motion runs, polling seldom is enough; the irq pin signals a stop. */
static bool is_time_to_look(struct passo_console *console)
{
	const struct passo_hardware *hardware = &console->hardware;
	bool runs = passo_snapshot(&console->passo)->state == PASSO_STATE_RUN;
	uint32_t now = hardware->microseconds ? hardware->microseconds(hardware->context) : 0u;

	if (runs && !console->waits && !insists(console) && hardware->irq && !hardware->irq(hardware->context)
	    && now - console->tried_at < LOOK_MICROSECONDS)
		return false;
	console->tried_at = now;
	return true;
}

/* Number of frames without a valid reply. */
static uint32_t bad_frames(const struct passo_counters *counters)
{
	return counters->stuck + counters->no_ack + counters->damaged + counters->sequence + counters->failed
	     + counters->refused[PASSO_VERDICT_BAD_CRC];
}

static bool is_of_wire(enum passo_error error)
{
	return (error >= PASSO_ERROR_TRANSFER && error <= PASSO_ERROR_BAD_CRC)
	    || error == PASSO_ERROR_NOT_STOPPED || error == PASSO_ERROR_NOT_HELD;
}

/* Polls the core. A poll that sends no frame does not change what is known. */
static void look_at_core(struct passo_console *console)
{
	const struct passo_counters before = console->host.counters;
	const struct passo_counters *now = &console->host.counters;
	enum passo_error error = passo_poll(&console->passo);

	if (error != PASSO_OK) {
		if (error != console->noted)
			passo_say_error_note(console, error);
		console->noted = error;
	} else if (now->frames != before.frames && bad_frames(now) == bad_frames(&before)
	           && !insists(console)) {
		if (is_of_wire(console->noted))
			passo_say(&console->sink, "note: the core answers\n");
		console->noted = PASSO_OK;
		if (console->unset && passo_snapshot(&console->passo)->state == PASSO_STATE_IDLE
		    && passo_commands_open(console) == PASSO_OK)
			passo_say(&console->sink, "note: the core is at rest\n");
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

/* Something has changed since the last attempt to queue the waiting move. */
static bool may_go_on(const struct passo_console *console)
{
	const struct passo_snapshot *now = passo_snapshot(&console->passo);

	return console->noted != PASSO_OK || !passo_is_moving(&console->passo)
	    || now->state != console->seen_state || now->line_room != console->seen_lines
	    || now->ramp_room != console->seen_ramps;
}

void passo_console_poll(struct passo_console *console)
{
	if (!console->opened)
		look_for_core(console);
	else if (is_time_to_look(console))
		look_at_core(console);
	if (console->waits && may_go_on(console))
		try_again(console);
}

bool passo_console_owes(const struct passo_console *console)
{
	return console->waits;
}

bool passo_console_is_idle(const struct passo_console *console)
{
	return !console->opened || !passo_is_moving(&console->passo);
}

bool passo_console_is_well(const struct passo_console *console)
{
	return console->opened && passo_fault(&console->passo) == PASSO_OK;
}
