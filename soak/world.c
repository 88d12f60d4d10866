/* SPDX-License-Identifier: MIT */
#include "world.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "address.h"

/* Clocks from the last edge of SCLK to chip select. */
#define HOLD 3u
#define ROWS_FIRST 4096u
/* Clocks at rest between two consecutive queued motions. */
#define GAP_CLOCKS 4u

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

static void *more(void *array, size_t *room, size_t size)
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

	if (world->failed_at && world->failed_at <= clock)
		return;
	world->failed_at = clock ? clock : 1u;
	va_start(arguments, format);
	vsnprintf(world->failure, sizeof world->failure, format, arguments);
	va_end(arguments);
}

void world_add_fact(struct world *world, const struct world_fact *fact)
{
	if (world->fact_count == world->fact_room)
		world->facts = more(world->facts, &world->fact_room, sizeof *world->facts);
	world->facts[world->fact_count++] = *fact;
}

static void add_row(struct world *world)
{
	if (world->row_count && PASSO_SAME_OUTPUTS(&world->rows[world->row_count - 1u].pins, &world->outputs))
		return;
	if (world->row_count == world->row_room)
		world->rows = more(world->rows, &world->row_room, sizeof *world->rows);
	world->rows[world->row_count++] = (struct world_row){world->clock, world->outputs};
}

static void add_event(struct world *world, enum world_event_kind kind, unsigned channel)
{
	if (world->event_count == world->event_room)
		world->events = more(world->events, &world->event_room, sizeof *world->events);
	world->events[world->event_count++] = (struct world_event){world->clock, kind, (uint8_t)channel};
}

/* State of a channel before the clock. */
struct before {
	enum passo_state state;
	bool stopping, at_rest;
	uint32_t rate;
	uint16_t line, ramp, tick;
	uint8_t waits;
};

static uint8_t waits_of(const struct passo_channel *channel)
{
	uint8_t waits = 0;

	for (unsigned i = 0; i < channel->axes; i++)
		waits |= (uint8_t)((channel->axis[i].waits != 0u ? 1u : 0u) << i);
	return waits;
}

static bool axes_rest(const struct passo_channel *channel)
{
	for (unsigned i = 0; i < channel->axes; i++)
		if (channel->axis[i].state != PASSO_AXIS_READY || channel->axis[i].waits != 0u)
			return false;
	return true;
}

static struct before look(const struct passo_channel *channel)
{
	return (struct before){.state = channel->motion.state,
	    .stopping = channel->motion.stopping,
	    .at_rest = axes_rest(channel),
	    .rate = channel->timescale.rate,
	    .line = channel->line_queue.next_line,
	    .ramp = channel->ramp_queue.read_ramp,
	    .tick = (uint16_t)channel->ramp.tick_count,
	    .waits = waits_of(channel)};
}

static void note_events(struct world *world, const struct before *before, const struct passo_outputs *pins)
{
	const unsigned axes = world->model.parameters.axes;

	for (unsigned i = 0; i < world->model.parameters.channels; i++) {
		const struct passo_channel *channel = &world->model.channel[i];
		const struct before *was = &before[i];
		const struct before now = look(channel);
		const uint64_t mine = ((UINT64_C(1) << axes) - 1u) << (i * axes);

		if (was->state != now.state)
			add_event(world, EVENT_STATE, i);
		if (was->state == PASSO_STATE_IDLE && now.state == PASSO_STATE_PREPARE
		    && world->clock <= world->idle_since[i] + GAP_CLOCKS)
			add_event(world, EVENT_GAP, i);
		if (was->state != PASSO_STATE_IDLE && now.state == PASSO_STATE_IDLE)
			world->idle_since[i] = world->clock;
		if (was->stopping != now.stopping)
			add_event(world, EVENT_STOPPING, i);
		if (world->model.slew_tick && now.state >= PASSO_STATE_RUN && now.state <= PASSO_STATE_DRAIN)
			add_event(world, EVENT_SLEW, i);
		if (was->rate != now.rate)
			add_event(world, EVENT_RATE, i);
		if (was->line != now.line)
			add_event(world, EVENT_LINE, i);
		if (was->ramp != now.ramp)
			add_event(world, EVENT_RAMP, i);
		if (now.tick < was->tick && now.state == PASSO_STATE_RUN)
			add_event(world, EVENT_TICK, i);
		if ((pins->step ^ world->outputs.step) & mine)
			add_event(world, EVENT_STEP, i);
		if ((pins->dir ^ world->outputs.dir) & mine)
			add_event(world, EVENT_DIR, i);
		if (was->waits != now.waits)
			add_event(world, EVENT_WAITS, i);
		if (!was->at_rest && now.at_rest)
			add_event(world, EVENT_QUIET, i);
	}
}

static void record(
    struct world *world, const struct passo_inputs *inputs, const struct passo_outputs *outputs)
{
	const bool same = PASSO_SAME_OUTPUTS(outputs, &world->recorded_outputs)
	               && outputs->spi_miso == world->recorded_outputs.spi_miso
	               && PASSO_SAME_INPUTS(inputs, &world->recorded_inputs);

	if (same || world->recorded_clocks == 0u) {
		world->recorded_clocks++;
	} else {
		world_end_record(world);
		world->recorded_clocks = 1;
	}
	world->recorded_inputs = *inputs;
	world->recorded_outputs = *outputs;
}

/* Writes the clocks recorded with equal inputs and outputs. */
static void write_run(struct world *world)
{
	const struct passo_inputs *inputs = &world->recorded_inputs;
	const struct passo_outputs *outputs = &world->recorded_outputs;

	if (world->record) {
		fprintf(world->record, "%llx", (unsigned long long)world->recorded_clocks);
#define WRITE_INPUT(name, type, number) fprintf(world->record, " %llx", (unsigned long long)inputs->name);
#define WRITE_OUTPUT(name, type, number) fprintf(world->record, " %llx", (unsigned long long)outputs->name);
		PASSO_INPUTS(WRITE_INPUT)
		PASSO_OUTPUTS(WRITE_OUTPUT)
#undef WRITE_INPUT
#undef WRITE_OUTPUT
		fprintf(world->record, " %x\n", outputs->spi_miso ? 1u : 0u);
	}
	world->recorded_clocks = 0;
}

void world_end_record(struct world *world)
{
	if (world->recorded_clocks != 0u)
		write_run(world);
}

void world_record_estop(struct world *world)
{
	world->recorded_inputs.estop_n = false;
	world->recorded_outputs.enable = passo_core_enable(&world->model, false);
	write_run(world);
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
	struct before before[PASSO_CHANNELS_MAX];
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
			before[i] = look(&world->model.channel[i]);
	}
	passo_core_clock(&world->model, &world->inputs);
	world->clock++;
	world->outputs = *passo_core_outputs(&world->model);
	if (world->core) {
		const struct passo_outputs rtl = run_rtl(world);

		compare(world, &rtl, &world->outputs);
		world->outputs = rtl;
	}
	add_row(world);
	for (unsigned i = 0; i < channels; i++) {
		const struct passo_channel *channel = &world->model.channel[i];

		if (!world->blind && stopping[i] && channel->motion.stopping
		    && channel->timescale.rate > rate[i])
			world_fail(world, world->clock,
			    "channel %u: the rate rises from %u to %u after a stop was commanded", i, rate[i],
			    channel->timescale.rate);
	}
	if (records)
		note_events(world, before, &was);
	if (world->record)
		record(world, &world->inputs, &world->outputs);
}

void world_run(struct world *world, uint64_t clocks)
{
	while (clocks-- != 0u)
		tick(world);
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

static int64_t word_clocks(const struct world *world)
{
	return 64 * (int64_t)world->half_period;
}

int64_t world_executes(const struct world *world, unsigned length, unsigned index)
{
	return (int64_t)world->setup + ((int64_t)length + 2) * word_clocks(world) + world->latency->pins
	     + 4 * (int64_t)index;
}

int64_t world_checks(const struct world *world, unsigned index)
{
	return (int64_t)world->setup + ((int64_t)index + 2) * word_clocks(world) + world->latency->check;
}

/* Writes one word to a new model; returns the latency from the end of the CRC word to the first pin
 * change. */
static int64_t first_change(uint16_t address, uint32_t value)
{
	const struct passo_parameters parameters = {
	    .channels = 1, .axes = 1, .tick_log2 = 7, .line_queue_log2 = 2, .ramp_queue_log2 = 2};
	static struct world world;
	uint32_t mosi[PASSO_FRAME_WORDS_MAX], miso[PASSO_FRAME_WORDS_MAX];

	if (!world_open(&world, &parameters, NULL))
		return -1;
	world_run(&world, 100);
	const uint64_t begin = world.clock;
	const size_t count = passo_frame_write(mosi, 1, address, &value, 1);
	world_exchange(&world, mosi, miso, count, 32u * count);
	world_run(&world, 100);
	if (world.row_count < 2u)
		return -1;
	return (int64_t)(world.rows[1].clock - begin) - (int64_t)world.setup - 3 * word_clocks(&world);
}

bool world_measure(struct world_latency *latency)
{
	latency->pins =
	    first_change(axis_address(0, 0, PASSO_AXIS_PINS), 1u << PASSO_AXIS_PINS_STEP_INVERTED_LSB);
	latency->enable = first_change(axis_address(0, 0, PASSO_AXIS_ENABLE), 1u << PASSO_AXIS_ENABLE_LSB);
	latency->command =
	    first_change(channel_address(0, PASSO_CHANNEL_COMMAND), 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB);
	latency->check = 40;
	return latency->pins > 0 && latency->enable > 0 && latency->command > 0;
}
