/* SPDX-License-Identifier: MIT
 * The C model engine. It skips the clocks on which nothing changes.
 */
#include <stdlib.h>

#include "engine_core.h"
#include "passo_core.h"

struct engine_core {
	struct passo_core model;
	bool every_clock;
};

static bool read_outputs(const struct passo_core *model, struct passo_outputs *outputs)
{
	const struct passo_outputs *now = passo_core_outputs(model);
	const bool changed = !PASSO_SAME_OUTPUTS(now, outputs);

	*outputs = *now;
	return changed;
}

struct engine_core *engine_core_open(const struct passo_engine_config *config,
    const struct passo_inputs *inputs, struct passo_outputs *outputs)
{
	struct engine_core *core = malloc(sizeof *core);

	(void)inputs;
	if (!core)
		return NULL;
	core->every_clock = config->every_clock;
	if (!passo_core_reset(&core->model, &config->core)) {
		free(core);
		return NULL;
	}
	read_outputs(&core->model, outputs);
	return core;
}

void engine_core_close(struct engine_core *core)
{
	free(core);
}

uint64_t engine_core_run(struct engine_core *core, const struct passo_inputs *inputs, uint64_t limit,
    struct passo_outputs *outputs)
{
	uint64_t clocks = 0;

	while (clocks < limit) {
		uint64_t quiet =
		    core->every_clock ? 0 : passo_core_advance(&core->model, inputs, limit - clocks);

		clocks += quiet;
		if (quiet == 0) {
			passo_core_clock(&core->model, inputs);
			clocks++;
			if (read_outputs(&core->model, outputs))
				return clocks;
		}
	}
	read_outputs(&core->model, outputs);
	return clocks;
}

uint64_t engine_core_shift(struct engine_core *core, struct passo_inputs *inputs, struct passo_shift *shift,
    uint64_t limit, struct passo_outputs *outputs)
{
	const uint64_t clocks = core->every_clock ? 0 : passo_core_shift(&core->model, inputs, shift, limit);

	read_outputs(&core->model, outputs);
	return clocks;
}

bool engine_core_open_waves(struct engine_core *core, const char *path, uint64_t begin, uint64_t end)
{
	(void)core;
	(void)path;
	(void)begin;
	(void)end;
	return false;
}

void engine_core_close_waves(struct engine_core *core)
{
	(void)core;
}
