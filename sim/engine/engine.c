/* SPDX-License-Identifier: MIT
 * Shared by both engines: the SPI master and the log of the output pins.
 */
#include <stdlib.h>
#include <string.h>

#include "engine_core.h"
#include "passo_rig.h"

/* Number of waiting events that ends a run; a transfer is not ended. */
#define LOG_FULL 65536u
/* Clocks from chip select to the first edge of SCLK and from the last edge to chip select. */
#define CS_SETUP 4u
#define CS_HOLD 4u

struct passo_engine {
	struct engine_core *core;
	struct passo_inputs inputs;
	struct passo_rig *rig; /* what is at the pins; null: nothing */
	struct passo_outputs outputs;
	struct passo_pin_event last;
	uint64_t clock;
	uint32_t spi_half_period;
	uint64_t tick, clocks, ticks, clock_of_tick_0; /* time of an external master */
	struct passo_pin_event *log;
	size_t log_length;
	size_t log_capacity;
};

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
	engine->clocks = engine->ticks = 1;
	engine->log_capacity = LOG_FULL;
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

/* The limit, or what the rig leaves of it. */
static uint64_t limited(const struct passo_engine *engine, uint64_t limit)
{
	const uint64_t next = engine->rig ? passo_rig_next(engine->rig, engine->clock) : UINT64_MAX;

	return limit > next - engine->clock ? next - engine->clock : limit;
}

/* What follows from clocks that have passed. */
static uint64_t passed(struct passo_engine *engine, uint64_t clocks)
{
	engine->clock += clocks;
	log_pins(engine);
	if (engine->rig)
		passo_rig_follow(engine->rig, engine->clock, &engine->outputs, &engine->inputs);
	return clocks;
}

static uint64_t run_to_event(struct passo_engine *engine, uint64_t limit)
{
	return passed(
	    engine, engine_core_run(engine->core, &engine->inputs, limited(engine, limit), &engine->outputs));
}

static void run_all(struct passo_engine *engine, uint64_t clocks)
{
	while (clocks)
		clocks -= run_to_event(engine, clocks);
}

uint64_t passo_engine_run(struct passo_engine *engine, uint64_t clocks)
{
	uint64_t left = clocks;

	while (left && engine->log_length < LOG_FULL && !(engine->rig && passo_rig_calls(engine->rig)))
		left -= run_to_event(engine, left);
	return clocks - left;
}

struct passo_rig *passo_engine_attach(struct passo_engine *engine, const struct passo_rig_config *config)
{
	passo_rig_destroy(engine->rig);
	engine->rig = passo_rig_create(config, &engine->inputs);
	return engine->rig;
}

void passo_engine_pace(struct passo_engine *engine, uint64_t clocks, uint64_t ticks)
{
	uint64_t a = clocks, b = ticks;

	/* divide by the greatest common divisor to keep products small */
	while (b) {
		uint64_t rest = a % b;

		a = b;
		b = rest;
	}
	engine->tick = 0;
	engine->clock_of_tick_0 = engine->clock;
	engine->clocks = clocks / a;
	engine->ticks = ticks / a;
}

/* Clocks from now to the end of a tick. */
static uint64_t clocks_to(const struct passo_engine *engine, uint64_t tick)
{
	return engine->clock_of_tick_0 + tick * engine->clocks / engine->ticks - engine->clock;
}

static void wait_ticks(struct passo_engine *engine, uint64_t ticks)
{
	engine->tick += ticks;
	run_all(engine, clocks_to(engine, engine->tick));
}

uint64_t passo_engine_follow(struct passo_engine *engine, uint64_t tick)
{
	const uint32_t irq = engine->outputs.irq;
	uint64_t left;

	if (tick <= engine->tick)
		return engine->tick;
	left = clocks_to(engine, tick);
	while (left && engine->log_length < LOG_FULL && engine->outputs.irq == irq)
		left -= run_to_event(engine, left);
	if (left) {
		const uint64_t clocks = engine->clock - engine->clock_of_tick_0;

		/* the first tick that ends at this clock or later */
		tick = (clocks * engine->ticks + engine->clocks - 1) / engine->clocks;
		if (tick < engine->tick)
			tick = engine->tick;
	}
	engine->tick = tick;
	return tick;
}

void passo_engine_select(struct passo_engine *engine, bool selected)
{
	engine->inputs.spi_cs_n = !selected;
}

void passo_engine_exchange(
    struct passo_engine *engine, const uint8_t *mosi, uint8_t *miso, size_t count, uint32_t half_period)
{
	for (size_t i = 0; i < count; i++) {
		unsigned received = 0;

		for (unsigned bit = 8; bit-- > 0;) {
			engine->inputs.spi_mosi = mosi[i] >> bit & 1u;
			wait_ticks(engine, half_period);
			received = received << 1 | engine->outputs.spi_miso;
			engine->inputs.spi_sclk = true;
			wait_ticks(engine, half_period);
			engine->inputs.spi_sclk = false;
		}
		miso[i] = (uint8_t)received;
	}
}

uint32_t passo_engine_irq(const struct passo_engine *engine)
{
	return engine->outputs.irq;
}

uint32_t passo_engine_running(const struct passo_engine *engine)
{
	return engine->outputs.running;
}

static void run_shift(struct passo_engine *engine, struct passo_shift *shift)
{
	const uint64_t skipped = engine_core_shift(
	    engine->core, &engine->inputs, shift, limited(engine, UINT64_MAX), &engine->outputs);

	if (skipped != 0u) {
		passed(engine, skipped);
		return;
	}
	passo_shift_pins(shift, &engine->inputs, engine->outputs.spi_miso);
	shift->clock += run_to_event(engine, passo_shift_constant(shift));
}

void passo_engine_transfer(
    struct passo_engine *engine, const uint32_t *mosi, uint32_t *miso, size_t count, uint64_t gap)
{
	struct passo_shift shift = {
	    .mosi = mosi, .miso = miso, .bits = 32u * count, .half_period = engine->spi_half_period};

	engine->inputs.spi_cs_n = false;
	run_all(engine, CS_SETUP);
	while (!passo_shift_done(&shift))
		run_shift(engine, &shift);
	engine->inputs.spi_sclk = false;
	run_all(engine, CS_HOLD);
	engine->inputs.spi_cs_n = true;
	run_all(engine, gap);
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
