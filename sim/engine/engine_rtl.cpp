/* SPDX-License-Identifier: MIT
 * The Verilated engine. The parameters of the core are fixed at build time.
 */
#include <memory>

#include "Vpasso_spi_top.h"
#include "engine_core.h"
#include "verilated.h"
#ifdef PASSO_WAVES
#include "verilated_fst_c.h"
#endif

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

	/* Half a clock period. */
	void half(bool level)
	{
		top.clk = level;
		top.eval();
#ifdef PASSO_WAVES
		if (waves)
			record();
		halves++;
#endif
	}

#ifdef PASSO_WAVES
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
#endif

	void apply(const engine_inputs &inputs)
	{
		top.spi_sclk = inputs.spi_sclk;
		top.spi_mosi = inputs.spi_mosi;
		top.spi_cs_n = inputs.spi_cs_n;
		top.sync = inputs.sync;
		top.rst = inputs.rst;
	}

	/* All outputs except MISO are registered on clk: they are stable until the next rising edge. */
	bool read(engine_outputs &outputs) const
	{
		const uint64_t step = top.step, dir = top.dir, enable = top.enable;
		const uint32_t running = top.running, irq = top.irq;
		const uint64_t difference = (step ^ outputs.step) | (dir ^ outputs.dir)
		                          | (enable ^ outputs.enable) | (running ^ outputs.running)
		                          | (irq ^ outputs.irq);
		if (!difference)
			return false;
		outputs.step = step;
		outputs.dir = dir;
		outputs.enable = enable;
		outputs.running = running;
		outputs.irq = irq;
		return true;
	}
};

engine_core *engine_core_open(
    const passo_engine_config *config, const engine_inputs *inputs, engine_outputs *outputs)
{
	if (config->channels != PASSO_CHANNELS || config->axes != PASSO_AXES
	    || config->tick_log2 != PASSO_TICK_LOG2 || config->line_queue_log2 != PASSO_LINE_QUEUE_LOG2
	    || config->ramp_queue_log2 != PASSO_RAMP_QUEUE_LOG2 || config->step_reset != PASSO_STEP_RESET
	    || config->dir_reset != PASSO_DIR_RESET || config->enable_reset != PASSO_ENABLE_RESET)
		return nullptr;
	auto *core = new engine_core;
#ifdef PASSO_WAVES
	core->context.traceEverOn(true);
	core->half_period_ps = UINT64_C(500000000000) / config->clock_hz;
#endif
	core->apply(*inputs);
	core->top.rst = 1;
	for (int i = 0; i < 8; i++) {
		/* A rising edge of chip select resets the SCLK domain. */
		core->top.spi_cs_n = i >= 4;
		core->half(false);
		core->half(true);
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
    engine_core *core, const engine_inputs *inputs, uint64_t limit, engine_outputs *outputs)
{
	uint64_t clocks = 0;
	bool changed = false;

	core->apply(*inputs);
	while (clocks < limit && !changed) {
		core->half(false);
		core->half(true);
		clocks++;
		changed = core->read(*outputs);
	}
	outputs->spi_miso = core->top.spi_miso;
	return clocks;
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
