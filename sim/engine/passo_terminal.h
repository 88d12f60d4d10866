/* SPDX-License-Identifier: MIT
 * The console of the STM32 bridge (stm32_bridge/console) with a core that the caller provides.
 */
#ifndef PASSO_TERMINAL_H
#define PASSO_TERMINAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Functions of the caller, called with its context. */
struct passo_terminal_caller {
	/* One chip select, followed by 64 clocks plus 4 for each word. */
	bool (*transfer)(void *context, const uint32_t *mosi, uint32_t *miso, size_t count);
	/* Runs the core for this time; returns the time since its reset in microseconds. */
	uint32_t (*advance)(void *context, uint32_t microseconds);
	/* Level of the irq pin. */
	bool (*irq)(void *context);
	void (*write)(void *context, const char *text);
	void *context;
};

struct passo_terminal;

/* NULL if memory is short. Writes the greeting. */
struct passo_terminal *passo_terminal_create(const struct passo_terminal_caller *caller, uint32_t clock_hz);
void passo_terminal_destroy(struct passo_terminal *terminal);

/* Input to the console. */
void passo_terminal_type(struct passo_terminal *terminal, const char *bytes, size_t count);

/* A move waits for room in the queues; its line is not answered yet. */
bool passo_terminal_owes(const struct passo_terminal *terminal);

/* State of the core. */
enum passo_terminal_status {
	PASSO_TERMINAL_IDLE,
	PASSO_TERMINAL_MOVES, /* a motion is running or queued */
	PASSO_TERMINAL_WAITS  /* a motion is held or waits for sync */
};

/* One round of the main loop. */
enum passo_terminal_status passo_terminal_poll(struct passo_terminal *terminal);

#ifdef __cplusplus
}
#endif

#endif
