/* SPDX-License-Identifier: MIT
 * The C model engine. It skips the clocks on which nothing changes.
 */
#include <stdlib.h>

#include "engine_core.h"
#include "passo_core.h"

enum { STATE_WORDS = 3, IN_FLIGHT = 4 /* substeps between path and line */ };

struct engine_core {
	struct passo_core model;
	bool every_clock;
	uint32_t seen[PASSO_CHANNELS_MAX][STATE_WORDS]; /* by engine_core_has_news() */
};

static uint64_t smaller(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static uint64_t larger(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

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
	bool changed = false;

	while (clocks < limit && !changed) {
		if (core->every_clock)
			passo_core_clock(&core->model, inputs);
		clocks += core->every_clock ? 1u : passo_core_run(&core->model, inputs, limit - clocks);
		changed = read_outputs(&core->model, outputs);
	}
	return clocks;
}

uint64_t engine_core_shift(struct engine_core *core, struct passo_inputs *inputs, struct passo_shift *shift,
    uint64_t limit, struct passo_outputs *outputs)
{
	uint64_t clocks = 0;
	bool changed = false;

	while (!core->every_clock && !changed && clocks < limit && !passo_shift_done(shift)) {
		clocks += passo_core_exchange(&core->model, inputs, shift, limit - clocks);
		changed = read_outputs(&core->model, outputs);
	}
	return clocks;
}

bool engine_core_has_news(struct engine_core *core)
{
	static const uint8_t addresses[STATE_WORDS] = {
	    PASSO_CHANNEL_STATE, PASSO_CHANNEL_RATE, PASSO_CHANNEL_ROOM};
	bool news = false;

	for (unsigned i = 0; i < core->model.parameters.channels; i++)
		for (unsigned k = 0; k < STATE_WORDS; k++) {
			const uint32_t word =
			    passo_channel_registers_value(&core->model.channel[i], addresses[k]);
			news = news || word != core->seen[i][k];
			core->seen[i][k] = word;
		}
	return news;
}

/* Of a channel with a profile at full rate, until a ramp ends or a line does at the highest speed of the
 * ramp. */
static uint64_t calm(const struct passo_channel *channel, uint32_t tick_log2)
{
	const struct passo_timescale *timescale = &channel->timescale;
	const struct passo_ramp_unit *ramp = &channel->ramp;
	const uint64_t velocity = (uint64_t)channel->path.velocity_high << 24 | channel->path.velocity_low;
	const uint64_t highest =
	    larger(larger(velocity, ramp->velocity_next), larger(ramp->v_start, ramp->v_end));
	const uint64_t substeps = channel->line_queue.last_substep - channel->line.substep_number;

	if (channel->motion.state == PASSO_STATE_IDLE)
		return channel->line_queue.next_valid ? 0u : UINT64_MAX;
	if (channel->motion.state != PASSO_STATE_RUN || channel->motion.stopping || !timescale->enable
	    || timescale->rate != PASSO_RATE_ONE || timescale->goal != PASSO_RATE_ONE
	    || channel->registers.rate_target != PASSO_RATE_ONE || !ramp->loaded || ramp->ticks < 2u
	    || channel->ramp_queue.now_pending)
		return 0;
	const uint64_t clocks = (uint64_t)(ramp->ticks - 2u) << tick_log2;
	if (!channel->line.active || highest == 0u)
		return clocks;
	return smaller(
	    clocks, substeps < IN_FLIGHT ? 0u : (substeps - IN_FLIGHT) * (PASSO_ONE_Q48 / highest));
}

uint64_t engine_core_calm(const struct engine_core *core)
{
	const struct passo_parameters *parameters = &core->model.parameters;
	uint64_t clocks = parameters->inputs != 0u ? 0u : UINT64_MAX; /* a watchdog, switches */

	for (unsigned i = 0; i < parameters->channels; i++)
		clocks = smaller(clocks, calm(&core->model.channel[i], parameters->tick_log2));
	return clocks == UINT64_MAX ? 0u : clocks; /* nothing moves */
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
