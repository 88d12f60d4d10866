/* SPDX-License-Identifier: MIT
 * The core under test, clock by clock.
 */
#include "world.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "mutants.h"
#include "world_private.h"

/* Clocks from the last edge of SCLK to chip select. */
#define HOLD 3u
#define ROWS_FIRST 4096u
/* Fewer clocks are not worth the trouble of skipping them. */
#define SKIPS 16u

struct world_rtl {
	struct engine_core *(*open)(const struct passo_engine_config *config,
	    const struct passo_inputs *inputs, struct passo_outputs *outputs);
	void (*close)(struct engine_core *core);
	uint64_t (*run)(struct engine_core *core, const struct passo_inputs *inputs, uint64_t limit,
	    struct passo_outputs *outputs);
};

const struct world_rtl *world_load(const char *library)
{
	static struct world_rtl rtl;
	void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);

	if (!handle) {
		fprintf(stderr, "%s\n", dlerror());
		return NULL;
	}
	*(void **)&rtl.open = dlsym(handle, "engine_core_open");
	*(void **)&rtl.close = dlsym(handle, "engine_core_close");
	*(void **)&rtl.run = dlsym(handle, "engine_core_run");
	return rtl.open && rtl.close && rtl.run ? &rtl : NULL;
}

void *world_more(void *array, size_t *room, size_t size)
{
	void *bigger;

	*room = *room ? 2u * *room : ROWS_FIRST;
	bigger = realloc(array, *room * size);
	if (!bigger)
		abort();
	return bigger;
}

void world_fail(struct world *world, uint64_t clock, const char *format, ...)
{
	va_list arguments;

	if (world->off || (world->failed_at && world->failed_at <= clock))
		return;
	world->failed_at = clock ? clock : 1u;
	va_start(arguments, format);
	vsnprintf(world->failure, sizeof world->failure, format, arguments);
	va_end(arguments);
	if (world->alone) /* a mutant is dead */
		mutants_end(world);
}

void world_add_fact(struct world *world, const struct world_fact *fact)
{
	if (world->fact_count == world->fact_room)
		world->facts = world_more(world->facts, &world->fact_room, sizeof *world->facts);
	world->facts[world->fact_count++] = *fact;
}

static void add_row(struct world *world)
{
	if (world->row_count && PASSO_SAME_OUTPUTS(&world->rows[world->row_count - 1u].pins, &world->outputs))
		return;
	if (world->row_count == world->row_room)
		world->rows = world_more(world->rows, &world->row_room, sizeof *world->rows);
	world->rows[world->row_count++] = (struct world_row){world->clock, world->outputs};
}

static void compare(struct world *world, const struct passo_outputs *rtl, const struct passo_outputs *model)
{
	if (rtl->spi_miso != model->spi_miso)
		world_fail(
		    world, world->clock, "RTL and model differ: miso %d %d", rtl->spi_miso, model->spi_miso);
#define COMPARE(name, type, number)                                                                          \
	if (rtl->name != model->name)                                                                        \
		world_fail(world, world->clock, "RTL and model differ: " #name " %llx %llx",                 \
		    (unsigned long long)rtl->name, (unsigned long long)model->name);
	PASSO_OUTPUTS(COMPARE)
#undef COMPARE
}

static struct passo_outputs run_rtl(struct world *world)
{
	struct passo_outputs now = world->outputs;

	world->rtl->run(world->core, &world->inputs, 1, &now);
	return now;
}

static void tick(struct world *world)
{
	struct world_before before[PASSO_CHANNELS_MAX];
	const struct passo_outputs was = world->outputs;
	const bool records = world->events_from != 0u && world->clock >= world->events_from;
	const unsigned channels = world->model.parameters.channels;
	uint32_t rate[PASSO_CHANNELS_MAX];
	bool stopping[PASSO_CHANNELS_MAX];

	world_change_pins(world);
	for (unsigned i = 0; i < channels; i++) {
		rate[i] = world->model.channel[i].timescale.rate;
		stopping[i] = world->model.channel[i].motion.stopping;
		if (records)
			before[i] = world_look(&world->model.channel[i]);
	}
	if (!world->alone || world->machine) /* shafts turn with its steps */
		passo_core_clock(&world->model, &world->inputs);
	world->clock++;
	if (!world->alone)
		world->outputs = *passo_core_outputs(&world->model);
	if (world->core) {
		const struct passo_outputs rtl = run_rtl(world);

		if (!world->alone)
			compare(world, &rtl, &world->outputs);
		world->outputs = rtl;
	}
	add_row(world);
	for (unsigned i = 0; i < channels; i++) {
		const struct passo_channel *channel = &world->model.channel[i];

		if (!world->blind && !world->alone && stopping[i] && channel->motion.stopping
		    && channel->timescale.rate > rate[i])
			world_fail(world, world->clock,
			    "channel %u: the rate rises from %u to %u after a stop was commanded", i, rate[i],
			    channel->timescale.rate);
	}
	if (records)
		world_note_events(world, before, &was);
	if (world->record)
		world_note_pins(world, &world->inputs, &world->outputs);
}

/* Clocks that the model skips, in which nothing happens at any pin: histories of long times are cheap. */
static uint64_t skip(struct world *world, uint64_t clocks)
{
	if (!world->starts || world->core || world->record || world->events_from != 0u || clocks < SKIPS)
		return 0;
	if (world->pin_next < world->pin_count && world->pins[world->pin_next].clock < world->clock + clocks)
		clocks = world->pins[world->pin_next].clock - world->clock;
	const uint64_t skipped =
	    clocks < SKIPS ? 0u : passo_core_advance(&world->model, &world->inputs, clocks - 2u);

	world->clock += skipped;
	return skipped;
}

void world_run(struct world *world, uint64_t clocks)
{
	while (clocks != 0u) {
		const uint64_t skipped = skip(world, clocks);

		clocks -= skipped;
		if (skipped == 0u) {
			tick(world);
			clocks--;
		}
	}
}

bool world_open(struct world *world, const struct passo_parameters *parameters, const struct world_rtl *rtl)
{
	struct world kept = *world;

	memset(world, 0, sizeof *world);
	world->rows = kept.rows;
	world->row_room = kept.row_room;
	world->facts = kept.facts;
	world->fact_room = kept.fact_room;
	world->events = kept.events;
	world->event_room = kept.event_room;
	world->latency = kept.latency;
	world->blind = kept.blind;
	world->machine = kept.machine;
	world->tries = kept.tries;
	world->pokes = kept.pokes;
	world->starts = kept.starts;
	world->off = kept.off;
	world->alone = kept.alone;
	world->mutants = kept.mutants;
	world->half_period = 2;
	world->setup = 4;
	world->inputs = (struct passo_inputs)PASSO_INPUTS_IDLE;
	if (!passo_core_reset(&world->model, parameters))
		return false;
	world->outputs = *passo_core_outputs(&world->model);
	if (rtl) {
		const struct passo_engine_config config = {
		    .core = *parameters, .clock_hz = 1, .spi_half_period = 1, .every_clock = 1};
		const struct passo_inputs inputs = PASSO_INPUTS_IDLE;
		struct passo_outputs outputs;

		world->rtl = rtl;
		world->core = rtl->open(&config, &inputs, &outputs);
		if (!world->core)
			return false;
	}
	add_row(world);
	return true;
}

void world_close(struct world *world)
{
	if (world->core)
		world->rtl->close(world->core);
	world->core = NULL;
}

void world_exchange(struct world *world, const uint32_t *mosi, uint32_t *miso, size_t count, size_t bits)
{
	memset(miso, 0xFF, count * sizeof *miso);
	world->inputs.spi_cs_n = false;
	world_run(world, world->setup);
	for (size_t bit = 0; bit < bits; bit++) {
		const size_t word = bit / 32u;

		world->inputs.spi_mosi = (mosi[word] >> (31u - bit % 32u) & 1u) != 0u;
		world_run(world, world->half_period);
		miso[word] = miso[word] << 1 | (world->outputs.spi_miso ? 1u : 0u);
		world->inputs.spi_sclk = true;
		world_run(world, world->half_period);
		world->inputs.spi_sclk = false;
	}
	world_run(world, HOLD);
	world->inputs.spi_cs_n = true;
}
