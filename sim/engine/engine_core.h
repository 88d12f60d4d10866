/* SPDX-License-Identifier: MIT
 * What an engine has to supply: the core itself, one clock after another. engine.c does the rest.
 */
#ifndef PASSO_ENGINE_CORE_H
#define PASSO_ENGINE_CORE_H

#include "passo_engine.h"

#ifdef __cplusplus
extern "C" {
#endif

struct engine_inputs {
	bool spi_sclk, spi_mosi, spi_cs_n, sync, rst;
};

struct engine_outputs {
	uint64_t step, dir, enable;
	uint32_t running, irq;
	bool spi_miso;
};

struct engine_core;

/* A core fresh out of configuration and reset. */
struct engine_core *engine_core_open(const struct passo_engine_config *config,
    const struct engine_inputs *inputs, struct engine_outputs *outputs);
void engine_core_close(struct engine_core *core);

/* Executes up to `limit` (at least 1) clocks, but none after one on which an output other than MISO changes.
 * Returns how many; *outputs are as they stand then. */
uint64_t engine_core_run(struct engine_core *core, const struct engine_inputs *inputs, uint64_t limit,
    struct engine_outputs *outputs);

bool engine_core_open_waves(struct engine_core *core, const char *path);
void engine_core_close_waves(struct engine_core *core);

#ifdef __cplusplus
}
#endif

#endif
