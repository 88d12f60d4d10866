/* SPDX-License-Identifier: MIT
 * The console of the board on the web page: lines in. Time passes as in sim/passo/terminal.py.
 */
#include "passo_terminal.h"
#include "passo_web.h"

enum {
	ROUND = 1000,  /* microseconds between two polls */
	PATIENCE = 20, /* rounds that a motion may stand */
	LINE = 4096,
};

enum status { DONE, GOES_ON, STANDS = -1 /* nothing moves */ };

static struct passo_terminal *terminal;
static unsigned stands;
static char line[LINE];

/* Restarts; 0 if memory is short. */
EXPORT("open") int web_open(uint32_t axes, uint32_t clock_hz)
{
	const struct passo_terminal_caller caller = {
	    .transfer = web_transfer, .advance = web_advance, .irq = web_irq, .write = web_write};

	if (terminal)
		passo_terminal_destroy(terminal);
	terminal = NULL;
	if (web_start(axes, clock_hz, false, false))
		terminal = passo_terminal_create(&caller, clock_hz);
	return terminal != NULL;
}

/* Polls until the motions have ended, or with `room` until a move has room; at most a number of rounds. */
static enum status pass(bool room, uint32_t rounds)
{
	for (; rounds > 0u; rounds--) {
		const enum passo_terminal_status status = passo_terminal_poll(terminal);

		if (room ? !passo_terminal_owes(terminal) : status == PASSO_TERMINAL_IDLE)
			return DONE;
		stands = status == PASSO_TERMINAL_WAITS ? stands + 1 : 0;
		if (stands == PATIENCE)
			return STANDS;
		web_advance(NULL, ROUND);
	}
	return GOES_ON;
}

/* Types the line in the buffer; web_answer() executes it. */
EXPORT("type") void web_type(uint32_t length)
{
	stands = 0;
	passo_terminal_type(terminal, line, length);
}

EXPORT("answer") int32_t web_answer(uint32_t rounds)
{
	return pass(true, rounds);
}

EXPORT("wait") int32_t web_wait(uint32_t rounds)
{
	return pass(false, rounds);
}

EXPORT("line") char *web_line(void)
{
	return line;
}
