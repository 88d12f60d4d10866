/* SPDX-License-Identifier: MIT
 * The Verilated engine. The parameters of the core are fixed at build time. Of its time 92 % go to the logic
 * of the core: some 5,000 instructions in each clock, whatever moves; no statement has 3 % of them. Its top
 * is passo_engine.v, which runs many clocks in one evaluation; with waves, which show both edges of clk, it
 * is the core itself.
 */
#include <algorithm>
#include <memory>

#include "Vpasso_spi_top.h"
#include "engine_core.h"
#include "verilated.h"
#ifdef PASSO_WAVES
#include "verilated_fst_c.h"
#endif

/* Clocks in one evaluation: two of the iterations that Verilator allows (--converge-limit). */
static const uint64_t CLOCKS_MOST = 4096;

struct engine_core {
	VerilatedContext context;
	Vpasso_spi_top top{&context};
#ifdef PASSO_WAVES
	std::unique_ptr<VerilatedFstC> waves;
	uint64_t half_period_ps = 0;
	uint64_t halves = 0;          /* of a clock, since reset */
	uint64_t begin = 0, end = 0;  /* clocks to record, from `origin` on */
	uint64_t origin = UINT64_MAX; /* the half in which `running` rose */
#endif

#ifdef PASSO_WAVES
	/* Half a clock period. */
	void half(bool level)
	{
		top.clk = level;
		top.eval();
		if (waves)
			record();
		halves++;
	}

	/* As engine_core_run(), but perhaps fewer clocks. */
	uint64_t advance(uint64_t limit)
	{
		(void)limit;
		half(false);
		half(true);
		return 1;
	}

	void record()
	{
		if (origin == UINT64_MAX && top.running)
			origin = halves;
		const bool started = origin != UINT64_MAX;
		if (started && halves - origin >= 2 * end) {
			waves->close();
			waves.reset();
		} else if (begin == 0 || (started && halves - origin >= 2 * begin)) {
			waves->dump(halves * half_period_ps);
		}
	}
#else
	/* As engine_core_run(), but perhaps fewer clocks. */
	uint64_t advance(uint64_t limit)
	{
		top.limit = std::min(limit, CLOCKS_MOST);
		top.go = !top.go;
		top.eval();
		return top.clocks;
	}
#endif

	void apply(const passo_inputs &inputs)
	{
#define SET(name, type, number) top.name = inputs.name;
		PASSO_INPUTS(SET)
#undef SET
	}

	/* All outputs except MISO are stable until the next rising edge of clk or change of an input. */
	bool read(passo_outputs &outputs) const
	{
		const passo_outputs was = outputs;

#define GET(name, type, number) outputs.name = top.name;
		PASSO_OUTPUTS(GET)
#undef GET
		return !PASSO_SAME_OUTPUTS(&was, &outputs);
	}
};

engine_core *engine_core_open(
    const passo_engine_config *config, const passo_inputs *inputs, passo_outputs *outputs)
{
#define DIFFERS(name, NAME) config->core.name != PASSO_CORE_##NAME ||
	if (PASSO_PARAMETERS(DIFFERS) PASSO_LEVELS(DIFFERS) false)
#undef DIFFERS
		return nullptr;
	auto *core = new engine_core;
#ifdef PASSO_WAVES
	core->context.traceEverOn(true);
	core->half_period_ps = UINT64_C(500000000000) / config->clock_hz;
#endif
	core->apply(*inputs);
	core->top.rst = 1;
	core->top.eval(); /* to see a change of an input, it must have seen the input */
	for (int i = 0; i < 8; i++) {
		/* A rising edge of chip select resets the SCLK domain. */
		core->top.spi_cs_n = i >= 4;
		core->advance(1);
	}
	core->top.rst = 0;
#ifdef PASSO_WAVES
	core->halves = 0;
#endif
	core->read(*outputs);
	outputs->spi_miso = core->top.spi_miso;
	return core;
}

void engine_core_close(engine_core *core)
{
	engine_core_close_waves(core);
	core->top.final();
	delete core;
}

uint64_t engine_core_run(
    engine_core *core, const passo_inputs *inputs, uint64_t limit, passo_outputs *outputs)
{
	uint64_t clocks = 0;
	bool changed = false;

	core->apply(*inputs);
	while (clocks < limit && !changed) {
		clocks += core->advance(limit - clocks);
		changed = core->read(*outputs);
	}
	outputs->spi_miso = core->top.spi_miso;
	return clocks;
}

uint64_t engine_core_shift(
    engine_core *core, passo_inputs *inputs, passo_shift *shift, uint64_t limit, passo_outputs *outputs)
{
	(void)core;
	(void)inputs;
	(void)shift;
	(void)limit;
	(void)outputs;
	return 0;
}

bool engine_core_has_news(engine_core *core)
{
	(void)core;
	return true;
}

uint64_t engine_core_calm(const engine_core *core)
{
	(void)core;
	return 0;
}

bool engine_core_open_waves(engine_core *core, const char *path, uint64_t begin, uint64_t end)
{
#ifdef PASSO_WAVES
	core->begin = begin;
	core->end = end;
	core->origin = UINT64_MAX;
	core->waves = std::make_unique<VerilatedFstC>();
	core->top.trace(core->waves.get(), 99);
	core->waves->open(path);
	return core->waves->isOpen();
#else
	(void)core;
	(void)path;
	(void)begin;
	(void)end;
	return false;
#endif
}

void engine_core_close_waves(engine_core *core)
{
#ifdef PASSO_WAVES
	if (core->waves)
		core->waves->close();
	core->waves.reset();
#else
	(void)core;
#endif
}
