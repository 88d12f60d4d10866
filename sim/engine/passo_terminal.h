/* SPDX-License-Identifier: MIT
 * The console of the STM32 bridge (stm32_bridge/console) for a core behind two functions of the caller.
 */
#ifndef PASSO_TERMINAL_H
#define PASSO_TERMINAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the caller gives. All are called with its context. */
struct passo_terminal_caller {
	/* One chip select, and 64 clocks and 4 for each word after it. */
	bool (*transfer)(void *context, const uint32_t *mosi, uint32_t *miso, size_t count);
	/* Let the core run for this time; return the time since its reset. */
	uint32_t (*advance)(void *context, uint32_t microseconds);
	void (*write)(void *context, const char *text);
	void *context;
};

struct passo_terminal;

/* NULL if there is no memory. The greeting is written at once. */
struct passo_terminal *passo_terminal_create(const struct passo_terminal_caller *caller, uint32_t clock_hz);
void passo_terminal_destroy(struct passo_terminal *terminal);

/* Bytes that were typed. */
void passo_terminal_type(struct passo_terminal *terminal, const char *bytes, size_t count);

/* What the core does. */
enum passo_terminal_status {
	PASSO_TERMINAL_IDLE,
	PASSO_TERMINAL_MOVES, /* or something is queued */
	PASSO_TERMINAL_WAITS  /* a motion that is held, or waits for sync */
};

/* One round of the main loop. */
enum passo_terminal_status passo_terminal_poll(struct passo_terminal *terminal);

#ifdef __cplusplus
}
#endif

#endif
