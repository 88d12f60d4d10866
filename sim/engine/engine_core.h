/* SPDX-License-Identifier: MIT
 * Internal: interface of engine.c to the core, which each engine implements.
 */
#ifndef PASSO_ENGINE_CORE_H
#define PASSO_ENGINE_CORE_H

#include "passo_engine.h"
#include "passo_shift.h"

#ifdef __cplusplus
extern "C" {
#endif

struct engine_core;

/* Creates a core after configuration and reset; null if the parameters are not supported or memory is
 * short. */
struct engine_core *engine_core_open(const struct passo_engine_config *config,
    const struct passo_inputs *inputs, struct passo_outputs *outputs);
void engine_core_close(struct engine_core *core);

/* Executes up to `limit` (at least 1) clocks, ending with the first on which an output other than MISO
 * changes. Returns the number of clocks; *outputs are the levels after the last one. */
uint64_t engine_core_run(struct engine_core *core, const struct passo_inputs *inputs, uint64_t limit,
    struct passo_outputs *outputs);

/* The same during an exchange, at most to its end; 0: it must be done by single edges. */
uint64_t engine_core_shift(struct engine_core *core, struct passo_inputs *inputs, struct passo_shift *shift,
    uint64_t limit, struct passo_outputs *outputs);

/* Whether a host that reads the state would read something else than at the last call: state, rate or room of
 * a channel. True if that is not known. */
bool engine_core_has_news(struct engine_core *core);
/* Clocks for which there certainly are no news; 0 if that is not known. */
uint64_t engine_core_calm(const struct engine_core *core);

bool engine_core_open_waves(struct engine_core *core, const char *path, uint64_t begin, uint64_t end);
void engine_core_close_waves(struct engine_core *core);

#ifdef __cplusplus
}
#endif

#endif
