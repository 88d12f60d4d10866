/* SPDX-License-Identifier: MIT
 * Shared by both engines: the SPI masters, one that transfers whole frames and one with a time of its own.
 */
#include "engine_private.h"

/* Clocks from chip select to the first edge of SCLK and from the last edge to chip select. */
#define CS_SETUP 4u
#define CS_HOLD 4u
#define MICROSECONDS UINT64_C(1000000)

static void run_shift(struct passo_engine *engine, struct passo_shift *shift)
{
	const uint64_t skipped = engine_core_shift(
	    engine->core, &engine->inputs, shift, engine_limited(engine, UINT64_MAX), &engine->outputs);

	if (skipped != 0u) {
		engine_passed(engine, skipped);
		return;
	}
	passo_shift_pins(shift, &engine->inputs, engine->outputs.spi_miso);
	shift->clock += engine_run_to_event(engine, passo_shift_constant(shift));
}

void passo_engine_transfer(
    struct passo_engine *engine, const uint32_t *mosi, uint32_t *miso, size_t count, uint64_t gap)
{
	struct passo_shift shift = {
	    .mosi = mosi, .miso = miso, .bits = 32u * count, .half_period = engine->spi_half_period};

	engine_core_has_news(engine->core); /* from now on */
	engine->inputs.spi_cs_n = false;
	engine_run_all(engine, CS_SETUP);
	while (!passo_shift_done(&shift))
		run_shift(engine, &shift);
	engine->inputs.spi_sclk = false;
	engine_run_all(engine, CS_HOLD);
	engine->inputs.spi_cs_n = true;
	engine_run_all(engine, gap);
}

bool passo_engine_host_transfer(void *engine, const uint32_t *mosi, uint32_t *miso, size_t words)
{
	passo_engine_transfer(engine, mosi, miso, words, PASSO_ENGINE_GAP);
	return true;
}

uint32_t passo_engine_host_microseconds(void *engine)
{
	const struct passo_engine *own = engine;
	const uint64_t seconds = own->clock / own->clock_hz, rest = own->clock % own->clock_hz;

	return (uint32_t)(seconds * MICROSECONDS + rest * MICROSECONDS / own->clock_hz);
}

void passo_engine_host_wait(void *engine, uint32_t microseconds)
{
	const struct passo_engine *own = engine;

	passo_engine_run(engine, (uint64_t)microseconds * own->clock_hz / MICROSECONDS + 1u);
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
	engine_run_all(engine, clocks_to(engine, engine->tick));
}

uint64_t passo_engine_follow(struct passo_engine *engine, uint64_t tick)
{
	const uint32_t irq = engine->outputs.irq;
	uint64_t left;

	if (tick <= engine->tick)
		return engine->tick;
	left = clocks_to(engine, tick);
	while (left && engine->log_length < ENGINE_LOG_FULL && engine->outputs.irq == irq)
		left -= engine_run_to_event(engine, left);
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
