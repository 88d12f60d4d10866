/* SPDX-License-Identifier: MIT
 * Internal: interface of engine.c to the core, which each engine implements.
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

/* Creates a core after configuration and reset; null if the parameters are not supported or memory is
 * short. */
struct engine_core *engine_core_open(const struct passo_engine_config *config,
    const struct engine_inputs *inputs, struct engine_outputs *outputs);
void engine_core_close(struct engine_core *core);

/* Executes up to `limit` (at least 1) clocks, ending with the first on which an output other than MISO
 * changes. Returns the number of clocks; *outputs are the levels after the last one. */
uint64_t engine_core_run(struct engine_core *core, const struct engine_inputs *inputs, uint64_t limit,
    struct engine_outputs *outputs);

bool engine_core_open_waves(struct engine_core *core, const char *path, uint64_t begin, uint64_t end);
void engine_core_close_waves(struct engine_core *core);

#ifdef __cplusplus
}
#endif

#endif
