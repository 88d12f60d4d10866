/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the web page. There is one core, the C model, and its pins are recorded.
 */
#ifndef PASSO_WEB_H
#define PASSO_WEB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_command.h"
#include "passo_engine.h"

#define EXPORT(name) __attribute__((export_name(name)))

/* A core after reset, with no events and no text; false if memory is short. `turns`: it has encoders and
 * outputs, for a spindle. */
bool web_start(uint32_t axes, uint32_t clock_hz, bool encoders, bool outputs);

struct passo_engine *web_engine(void);

/* Runs the core. */
void web_run(uint64_t clocks);
/* Clock of the last step; 0: there was none. */
uint64_t web_last_step(void);

/* The functions of a struct passo_terminal_caller. */
bool web_transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count);
bool web_irq(void *context);
/* Runs the core; returns the microseconds since its reset. */
uint32_t web_advance(void *context, uint32_t microseconds);

/* Text for the page. */
void web_write(void *context, const char *text);

#endif
