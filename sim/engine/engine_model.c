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

static bool read_outputs(const struct passo_core *model, struct engine_outputs *outputs)
{
	const struct passo_outputs *now = passo_core_outputs(model);
	bool changed = now->step != outputs->step || now->dir != outputs->dir
	            || now->enable != outputs->enable || now->running != outputs->running
	            || now->irq != outputs->irq;

	*outputs = (struct engine_outputs){.step = now->step,
	    .dir = now->dir,
	    .enable = now->enable,
	    .running = now->running,
	    .irq = now->irq,
	    .spi_miso = now->spi_miso};
	return changed;
}

struct engine_core *engine_core_open(const struct passo_engine_config *config,
    const struct engine_inputs *inputs, struct engine_outputs *outputs)
{
	const struct passo_parameters parameters = {.channels = (uint8_t)config->channels,
	    .axes = (uint8_t)config->axes,
	    .tick_log2 = (uint8_t)config->tick_log2,
	    .line_queue_log2 = (uint8_t)config->line_queue_log2,
	    .ramp_queue_log2 = (uint8_t)config->ramp_queue_log2,
	    .step_reset = config->step_reset,
	    .dir_reset = config->dir_reset,
	    .enable_reset = config->enable_reset};
	struct engine_core *core = malloc(sizeof *core);

	(void)inputs;
	if (!core)
		return NULL;
	core->every_clock = config->every_clock;
	if (!passo_core_reset(&core->model, &parameters)) {
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

uint64_t engine_core_run(struct engine_core *core, const struct engine_inputs *inputs, uint64_t limit,
    struct engine_outputs *outputs)
{
	const struct passo_inputs pins = {.spi_sclk = inputs->spi_sclk,
	    .spi_mosi = inputs->spi_mosi,
	    .spi_cs_n = inputs->spi_cs_n,
	    .sync = inputs->sync,
	    .rst = inputs->rst};
	uint64_t clocks = 0;

	while (clocks < limit) {
		uint64_t quiet =
		    core->every_clock ? 0 : passo_core_advance(&core->model, &pins, limit - clocks);

		clocks += quiet;
		if (quiet == 0) {
			passo_core_clock(&core->model, &pins);
			clocks++;
			if (read_outputs(&core->model, outputs))
				return clocks;
		}
	}
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
