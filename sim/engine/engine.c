/* SPDX-License-Identifier: MIT
 * Shared by both engines: time, what is at the pins, and the log of the output pins.
 */
#include <stdlib.h>
#include <string.h>

#include "engine_private.h"

/* Appends the pins to the log if they have changed. */
static void log_pins(struct passo_engine *engine)
{
	const struct passo_outputs *outputs = &engine->outputs;
	struct passo_pin_event *last = &engine->last;

	if (PASSO_SAME_OUTPUTS(last, outputs))
		return;
	if (engine->log_length == engine->log_capacity) {
		engine->log_capacity *= 2;
		engine->log = realloc(engine->log, engine->log_capacity * sizeof *engine->log);
		if (!engine->log)
			abort();
	}
	last->clock = engine->clock;
#define COPY(name, type, number) last->name = outputs->name;
	PASSO_OUTPUTS(COPY)
#undef COPY
	engine->log[engine->log_length++] = *last;
}

struct passo_engine *passo_engine_create(const struct passo_engine_config *config)
{
	struct passo_engine *engine = calloc(1, sizeof *engine);

	if (!engine)
		return NULL;
	engine->inputs = (struct passo_inputs)PASSO_INPUTS_IDLE;
	engine->spi_half_period = config->spi_half_period ? config->spi_half_period : 1;
	engine->clock_hz = config->clock_hz;
	engine->clocks = engine->ticks = 1;
	engine->log_capacity = ENGINE_LOG_FULL;
	engine->log = malloc(engine->log_capacity * sizeof *engine->log);
	engine->core = engine_core_open(config, &engine->inputs, &engine->outputs);
	if (!engine->core || !engine->log) {
		passo_engine_destroy(engine);
		return NULL;
	}
	log_pins(engine);
	return engine;
}

void passo_engine_destroy(struct passo_engine *engine)
{
	if (!engine)
		return;
	if (engine->core)
		engine_core_close(engine->core);
	passo_rig_destroy(engine->rig);
	free(engine->log);
	free(engine);
}

uint64_t engine_limited(const struct passo_engine *engine, uint64_t limit)
{
	const uint64_t next = engine->rig ? passo_rig_next(engine->rig, engine->clock) : UINT64_MAX;

	return limit > next - engine->clock ? next - engine->clock : limit;
}

uint64_t engine_passed(struct passo_engine *engine, uint64_t clocks)
{
	engine->clock += clocks;
	log_pins(engine);
	if (engine->rig)
		passo_rig_follow(engine->rig, engine->clock, &engine->outputs, &engine->inputs);
	return clocks;
}

uint64_t engine_run_to_event(struct passo_engine *engine, uint64_t limit)
{
	return engine_passed(engine,
	    engine_core_run(engine->core, &engine->inputs, engine_limited(engine, limit), &engine->outputs));
}

void engine_run_all(struct passo_engine *engine, uint64_t clocks)
{
	while (clocks)
		clocks -= engine_run_to_event(engine, clocks);
}

uint64_t passo_engine_run(struct passo_engine *engine, uint64_t clocks)
{
	uint64_t left = clocks;

	while (left && engine->log_length < ENGINE_LOG_FULL && !(engine->rig && passo_rig_calls(engine->rig)))
		left -= engine_run_to_event(engine, left);
	return clocks - left;
}

uint64_t passo_engine_pass_looks(struct passo_engine *engine, uint64_t period, uint64_t look)
{
	const uint64_t begin = engine->clock;
	const uint32_t irq = engine->outputs.irq;

	while (!engine->rig && engine->log_length < ENGINE_LOG_FULL && engine->outputs.irq == irq
	       && !engine_core_has_news(engine->core)) {
		const uint64_t calm = engine_core_calm(engine->core);
		uint64_t left = calm < look ? 0u : ((calm - look) / period + 1u) * period;

		if (left == 0u)
			break;
		while (left != 0u && engine->outputs.irq == irq)
			left -= engine_run_to_event(engine, left);
	}
	return engine->clock - begin;
}

size_t passo_engine_waiting(const struct passo_engine *engine)
{
	return engine->log_length;
}

struct passo_rig *passo_engine_attach(struct passo_engine *engine, const struct passo_rig_config *config)
{
	passo_rig_destroy(engine->rig);
	engine->rig = passo_rig_create(config, &engine->inputs);
	return engine->rig;
}

uint32_t passo_engine_irq(const struct passo_engine *engine)
{
	return engine->outputs.irq;
}

uint32_t passo_engine_running(const struct passo_engine *engine)
{
	return engine->outputs.running;
}

void passo_engine_set(struct passo_engine *engine, enum passo_input input, uint64_t levels)
{
	switch (input) {
#define SET(name, type, number)                                                                              \
	case number:                                                                                         \
		engine->inputs.name = (type)levels;                                                          \
		break;
		PASSO_INPUTS(SET)
#undef SET
	case PASSO_INPUT_COUNT:
		break;
	}
}

uint64_t passo_engine_clock(const struct passo_engine *engine)
{
	return engine->clock;
}

size_t passo_engine_drain(struct passo_engine *engine, struct passo_pin_event *events, size_t capacity)
{
	size_t count = engine->log_length < capacity ? engine->log_length : capacity;

	memcpy(events, engine->log, count * sizeof *events);
	memmove(engine->log, engine->log + count, (engine->log_length - count) * sizeof *events);
	engine->log_length -= count;
	return count;
}

bool passo_engine_open_waves(struct passo_engine *engine, const char *path, uint64_t begin, uint64_t end)
{
	return engine_core_open_waves(engine->core, path, begin, end);
}

void passo_engine_close_waves(struct passo_engine *engine)
{
	engine_core_close_waves(engine->core);
}
