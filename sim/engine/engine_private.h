/* SPDX-License-Identifier: MIT
 * Internal: the engine, for engine.c and engine_spi.c.
 */
#ifndef ENGINE_PRIVATE_H
#define ENGINE_PRIVATE_H

#include "engine_core.h"
#include "passo_rig.h"

/* Number of waiting events that ends a run; a transfer is not ended. */
#define ENGINE_LOG_FULL 65536u
struct passo_engine {
	struct engine_core *core;
	struct passo_inputs inputs;
	struct passo_rig *rig; /* what is at the pins; null: nothing */
	struct passo_outputs outputs;
	struct passo_pin_event last;
	uint64_t clock;
	uint32_t clock_hz;
	uint32_t spi_half_period;
	uint64_t tick, clocks, ticks, clock_of_tick_0; /* time of an external master */
	struct passo_pin_event *log;
	size_t log_length;
	size_t log_capacity;
};

/* The limit, or what the rig leaves of it. */
uint64_t engine_limited(const struct passo_engine *engine, uint64_t limit);

/* What follows from clocks that have passed; returns them. */
uint64_t engine_passed(struct passo_engine *engine, uint64_t clocks);

/* Runs until pins change, at most to the limit; returns the clocks. */
uint64_t engine_run_to_event(struct passo_engine *engine, uint64_t limit);
void engine_run_all(struct passo_engine *engine, uint64_t clocks);

#endif
