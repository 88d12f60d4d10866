/* SPDX-License-Identifier: MIT
 * Assembles bytes to lines. passo_console_poll.c polls the core. The commands are in passo_commands.c.
 */
#include "passo_console.h"

#include <string.h>

#include "passo_commands.h"
#include "passo_release.h"

#define BACKSPACE '\b'
#define DELETE 0x7F

#define HOLD_MICROSECONDS 50000u
#define FILTER_MICROSECONDS 20u

void passo_console_start(struct passo_console *console, const struct passo_sink *sink,
    const struct passo_hardware *hardware, const struct passo_console_board *board, uint32_t clock_hz,
    uint32_t baud)
{
	memset(console, 0, sizeof *console);
	console->sink = *sink;
	console->hardware = *hardware;
	if (board)
		console->board = *board;
	console->given_hz = clock_hz;
	console->clock_hz = clock_hz != 0u ? clock_hz : PASSO_CLOCK_HZ_RESET;
	console->baud = baud;
	console->hold_microseconds = console->stop_microseconds = HOLD_MICROSECONDS;
	console->filter_microseconds = FILTER_MICROSECONDS;
	console->flow_waits = true;
	passo_commands_reset_times(console);
#ifndef PASSO_WITHOUT_PARTS
	for (unsigned i = 0; i < PASSO_CHANNELS_MAX; i++)
		passo_commands_reset_encoders(&console->channel[i]);
#endif
	passo_say(sink, "note: Passo console " PASSO_RELEASE "; help lists the commands\n");
	passo_say_error_note(console, passo_commands_open(console));
}

/* Executes a line, then the waiting one, which it may have ended or let go on. */
static void take_line(struct passo_console *console)
{
	if (console->waits) {
		passo_commands_execute(console, console->line);
		passo_commands_try_again(console);
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
		passo_complain(&console->sink, "character %u is not printable", console->bad - 1u);
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
