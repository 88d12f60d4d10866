/* SPDX-License-Identifier: MIT
 * The console: lines of text in, answers out, a Passo core behind it.
 *
 * Every line is answered by one line that begins with `ok` or `error:`; before it `help` prints lines that
 * begin with two spaces. Lines that begin with `note:` come by themselves. docs/console.md is the language.
 * Portable: the board, or a simulation, gives it the hardware of the link and a place for text.
 */
#ifndef PASSO_CONSOLE_H
#define PASSO_CONSOLE_H

#include "passo.h"
#include "passo_forms.h"

/* Characters of a line, its end not counted. */
#define PASSO_LINE_MAX 255u

/* In the place of a byte that was lost or damaged on its way; its line is refused. */
#define PASSO_CONSOLE_LOST '\0'

/* Stands for the clock until `config clock_hz=` says another. */
#define PASSO_CLOCK_HZ_RESET 100000000u

/* What a board can change; unused functions are null. */
struct passo_console_board {
	/* After the answer has been sent. */
	void (*set_baud)(void *context, uint32_t baud);
	void (*set_spi_fast)(void *context, bool fast);
	/* How often bytes of the serial line were lost. */
	uint32_t (*lost_bytes)(void *context);
	void *context;
};

struct passo_console {
	struct passo_sink sink;
	struct passo_hardware hardware;
	struct passo_console_board board;
	struct passo_host host;
	struct passo passo;
	uint32_t clock_hz, hold_microseconds, stop_microseconds, baud;
	enum passo_error noted; /* the error that stands, and has been told in a note */
	uint32_t tried_at;      /* microseconds: when the core was last looked for, or at */
	bool spi_slow;
	bool opened;
	bool unset; /* the core has not been given the settings yet: it was in motion when it was opened */
	struct passo_axis_config axis[PASSO_AXES_MAX]; /* times in clocks */
	struct passo_loaded_table table;
	/* the line so far */
	char line[PASSO_LINE_MAX + 1u];
	uint16_t length;
	bool too_long, ended_by_return;
	uint16_t bad; /* the first byte that is no text, plus 1; 0: none */
};

/* Begin, greet with a note, and try to open the core. `board` may be null; `baud` is what holds at first. */
void passo_console_start(struct passo_console *console, const struct passo_sink *sink,
    const struct passo_hardware *hardware, const struct passo_console_board *board, uint32_t clock_hz,
    uint32_t baud);

/* The next byte of the input. At the end of a line it is executed and answered. */
void passo_console_receive(struct passo_console *console, char byte);

/* To be called again and again: at most one frame. An error becomes a note, once while it lasts.
 * A core that did not answer at the start is looked for twice a second. */
void passo_console_poll(struct passo_console *console);

/* Is nothing queued or moving (or no core there)? */
bool passo_console_is_idle(const struct passo_console *console);

/* Is everything as it should be: a core, and no fault? */
bool passo_console_is_well(const struct passo_console *console);

#endif
