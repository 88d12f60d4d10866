/* SPDX-License-Identifier: MIT */
#include "passo_terminal.h"

#include <stdlib.h>

#include "passo_console.h"

struct passo_terminal {
	struct passo_terminal_caller caller;
	struct passo_console console;
};

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	const struct passo_terminal *terminal = context;

	return terminal->caller.transfer(terminal->caller.context, send, receive, words);
}

static uint32_t microseconds(void *context)
{
	const struct passo_terminal *terminal = context;

	return terminal->caller.advance(terminal->caller.context, 0);
}

static void wait(void *context, uint32_t duration)
{
	const struct passo_terminal *terminal = context;

	terminal->caller.advance(terminal->caller.context, duration ? duration : 1);
}

static bool irq(void *context)
{
	const struct passo_terminal *terminal = context;

	return terminal->caller.irq(terminal->caller.context);
}

struct passo_terminal *passo_terminal_create(const struct passo_terminal_caller *caller, uint32_t clock_hz)
{
	struct passo_terminal *terminal = calloc(1, sizeof *terminal);

	if (!terminal)
		return NULL;
	terminal->caller = *caller;
	passo_console_start(&terminal->console,
	    &(struct passo_sink){.write = caller->write, .context = caller->context},
	    &(struct passo_hardware){.transfer = transfer,
		.microseconds = microseconds,
		.wait = wait,
		.irq = irq,
		.context = terminal},
	    NULL, clock_hz, 0);
	return terminal;
}

void passo_terminal_destroy(struct passo_terminal *terminal)
{
	free(terminal);
}

void passo_terminal_type(struct passo_terminal *terminal, const char *bytes, size_t count)
{
	for (size_t i = 0; i < count; i++)
		passo_console_receive(&terminal->console, bytes[i]);
}

bool passo_terminal_owes(const struct passo_terminal *terminal)
{
	return passo_console_owes(&terminal->console);
}

enum passo_terminal_status passo_terminal_poll(struct passo_terminal *terminal)
{
	passo_console_poll(&terminal->console);
	if (passo_console_is_idle(&terminal->console))
		return PASSO_TERMINAL_IDLE;
	return passo_console_stands(&terminal->console) ? PASSO_TERMINAL_WAITS : PASSO_TERMINAL_MOVES;
}
