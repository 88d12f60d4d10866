/* SPDX-License-Identifier: MIT */
#include "bridge.h"

#include <string.h>

#include "passo.h"

/* Of the core, so that a microsecond of the driver is one clock. */
#define CLOCK_HZ 1000000u
#define TRIES_NOISE 100u
#define TRIES_DEATH 4u
#define HOLD_MICROSECONDS 600u
#define STOP_MICROSECONDS 900u
/* A queue of moves is over by then, even if each of its frames takes a hundred tries. */
#define WAIT_MICROSECONDS 4000000u
#define POLLS 50u
#define POLL_CLOCKS 150u

/* Its parts are numbered apart from the histories at the registers. */
#define SEED_OFFSET UINT64_C(0x62726964)

struct wire {
	struct world *world;
	struct plot_random *random;
	struct bridge_counts *counts;
	uint32_t one_in;  /* a bit in so many is flipped; 0: none */
	uint32_t worse;   /* percent of the frames with a lost or doubled clock, or cut */
	uint32_t dies_in; /* frames until the wire dies; 0: it does not */
	uint32_t dies_at; /* in that frame, at this bit */
	bool dead, level; /* of MISO when dead */
};

struct bridge {
	struct wire wire;
	struct world *world;
	struct plot_random *random;
	struct bridge_counts *counts;
	FILE *print;
	struct passo passo;
	struct passo_host host;
	struct passo_axis_config config[PASSO_AXES_MAX];
	size_t row; /* of the pins, counted so far */
	int64_t made[PASSO_AXES_MAX], pulses[PASSO_AXES_MAX];
	int64_t wanted[PASSO_AXES_MAX], wanted_pulses[PASSO_AXES_MAX];
	bool disabled[PASSO_AXES_MAX];
	bool slow_turns; /* DIR set-up lasts longer than some steps */
};

/* ---- the wire ---- */

enum worse { WORSE_NONE, WORSE_LOST, WORSE_DOUBLED, WORSE_CUT };

static bool flips(struct wire *wire)
{
	const bool flip = wire->one_in != 0u && plot_draw(wire->random, wire->one_in) == 0u;

	wire->counts->flips += flip ? 1u : 0u;
	return flip;
}

/* One bit; the clock pulse may be lost on its way. Returns MISO as it was before the pulse. */
static bool exchange_bit(struct world *world, bool mosi, bool lost)
{
	world->inputs.spi_mosi = mosi;
	world_run(world, world->half_period);
	const bool miso = world->outputs.spi_miso;
	world->inputs.spi_sclk = !lost;
	world_run(world, world->half_period);
	world->inputs.spi_sclk = false;
	return miso;
}

static enum worse draw_worse(struct wire *wire)
{
	if (wire->worse == 0u || !plot_chance(wire->random, wire->worse))
		return WORSE_NONE;
	const enum worse worse = (enum worse)(1u + plot_draw(wire->random, 3));
	wire->counts->lost += worse == WORSE_LOST ? 1u : 0u;
	wire->counts->doubled += worse == WORSE_DOUBLED ? 1u : 0u;
	wire->counts->cuts += worse == WORSE_CUT ? 1u : 0u;
	return worse;
}

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct wire *wire = context;
	struct world *world = wire->world;
	const enum worse worse = draw_worse(wire);
	const size_t bad_bit = plot_draw(wire->random, 32u * (uint32_t)words);
	const bool dies = wire->dies_in != 0u && --wire->dies_in == 0u;

	wire->counts->frames++;
	memset(receive, 0, words * sizeof *receive);
	world->inputs.spi_cs_n = wire->dead;
	world_run(world, world->setup);
	for (size_t bit = 0; bit < 32u * words; bit++) {
		const size_t word = bit / 32u;
		const bool out = (send[word] >> (31u - bit % 32u) & 1u) != 0u;

		if (dies && bit == wire->dies_at % (32u * words)) {
			wire->dead = true;
			wire->counts->deaths++;
		}
		if (wire->dead || (worse == WORSE_CUT && bit >= bad_bit))
			world->inputs.spi_cs_n = true;
		const bool mosi = out != flips(wire);
		const bool miso = exchange_bit(world, mosi, worse == WORSE_LOST && bit == bad_bit);
		const bool in = wire->dead ? wire->level : miso != flips(wire);
		receive[word] = receive[word] << 1 | (in ? 1u : 0u);
		if (worse == WORSE_DOUBLED && bit == bad_bit)
			exchange_bit(world, mosi, false);
	}
	world_run(world, 3);
	world->inputs.spi_cs_n = true;
	world_run(world, 64u + 4u * words);
	return true;
}

static uint32_t microseconds(void *context)
{
	return (uint32_t)((struct wire *)context)->world->clock;
}

static void wait(void *context, uint32_t time)
{
	world_run(((struct wire *)context)->world, time);
}

/* ---- the pins ---- */

static void count_pins(struct bridge *bridge)
{
	struct world *world = bridge->world;
	const unsigned axes = world->model.parameters.axes;

	for (; bridge->row + 1u < world->row_count; bridge->row++) {
		const struct world_row *row = &world->rows[bridge->row + 1u];
		const uint64_t edges = row->pins.step ^ world->rows[bridge->row].pins.step;

		for (unsigned a = 0; a < axes; a++) {
			const struct passo_axis_config *config = &bridge->config[a];
			const bool level = (row->pins.step >> a & 1u) != 0u;
			const bool down = ((row->pins.dir >> a & 1u) != 0u) != config->direction_inverted;

			if ((edges >> a & 1u) == 0u
			    || (!config->both_edges && level == config->step_inverted))
				continue;
			bridge->made[a] += down ? -1 : 1;
			bridge->pulses[a]++;
			bridge->counts->steps++;
			if (bridge->disabled[a])
				world_fail(world, row->clock,
				    "axis %u: a step to a drive that the driver disabled", a);
		}
	}
}

/* From here on: what left the pins so far is what is wanted. */
static void agree(struct bridge *bridge)
{
	count_pins(bridge);
	memcpy(bridge->wanted, bridge->made, sizeof bridge->wanted);
	memcpy(bridge->wanted_pulses, bridge->pulses, sizeof bridge->wanted_pulses);
}

static void note(struct bridge *bridge, const char *what, enum passo_error error)
{
	bridge->counts->errors += error != PASSO_OK ? 1u : 0u;
	if (bridge->print)
		fprintf(bridge->print, "%8llu  %s: %s\n", (unsigned long long)bridge->world->clock, what,
		    passo_error_name(error));
}

static void check_made(struct bridge *bridge, const char *when)
{
	struct world *world = bridge->world;

	count_pins(bridge);
	for (unsigned a = 0; a < world->model.parameters.axes; a++)
		if (bridge->made[a] != bridge->wanted[a] || bridge->pulses[a] != bridge->wanted_pulses[a])
			world_fail(world, world->clock,
			    "axis %u %s: at %lld after %lld steps, wanted %lld and %lld", a, when,
			    (long long)bridge->made[a], (long long)bridge->pulses[a],
			    (long long)bridge->wanted[a], (long long)bridge->wanted_pulses[a]);
}

static void must(struct bridge *bridge, const char *what, enum passo_error error)
{
	note(bridge, what, error);
	if (error != PASSO_OK)
		world_fail(bridge->world, bridge->world->clock, "%s: %s", what, passo_error_name(error));
}

static void check_positions(struct bridge *bridge)
{
	struct world *world = bridge->world;
	int32_t positions[PASSO_AXES_MAX];

	must(bridge, "positions", passo_positions(&bridge->passo, positions));
	count_pins(bridge);
	for (unsigned a = 0; a < world->model.parameters.axes && !world->failed_at; a++)
		if (positions[a] != (int32_t)bridge->made[a])
			world_fail(world, world->clock, "axis %u: position %d after %lld steps", a,
			    positions[a], (long long)bridge->made[a]);
}

/* ---- what the host does ---- */

static void poll(struct bridge *bridge, unsigned times)
{
	while (times-- != 0u) {
		enum passo_error error = passo_poll(&bridge->passo);

		if (error != PASSO_OK)
			note(bridge, "poll", error);
		world_run(bridge->world, POLL_CLOCKS);
	}
}

static struct passo_move_by_speed draw_move(struct bridge *bridge)
{
	const unsigned axes = bridge->world->model.parameters.axes;
	struct passo_move_by_speed move = {.profile = (enum passo_profile)plot_draw(bridge->random, 4),
	    .acceleration = 40000000u * PASSO_UNIT_Q32};

	/* no more than the queue of an axis holds come within its set-up time */
	move.speed = bridge->slow_turns ? 3000u : 10000u + plot_draw(bridge->random, 40000);
	move.speed *= PASSO_UNIT_Q32;

	for (unsigned a = 0; a < axes; a++)
		move.steps[a] = (int32_t)plot_draw(bridge->random, 41) - 20;
	move.steps[plot_draw(bridge->random, axes)] = 21;
	return move;
}

static void want(struct bridge *bridge, const struct passo_move_by_speed *move)
{
	for (unsigned a = 0; a < bridge->world->model.parameters.axes; a++) {
		bridge->wanted[a] += move->steps[a];
		bridge->wanted_pulses[a] += move->steps[a] < 0 ? -move->steps[a] : move->steps[a];
	}
	bridge->counts->moves++;
}

/* Queues a move; false if it was not taken, for whatever reason. */
static bool do_move(struct bridge *bridge, enum passo_error *error)
{
	const struct passo_move_by_speed move = draw_move(bridge);

	*error = passo_move_by_speed(&bridge->passo, &move);
	note(bridge, "move", *error);
	if (*error == PASSO_OK)
		want(bridge, &move);
	return *error == PASSO_OK;
}

static void finish(struct bridge *bridge)
{
	must(bridge, "wait", passo_wait(&bridge->passo, WAIT_MICROSECONDS));
	if (!bridge->world->failed_at)
		check_made(bridge, "at rest");
}

/* A stop that the driver was told of has taken place, or still does. */
static void check_stopped(struct bridge *bridge, const char *what)
{
	struct world *world = bridge->world;

	for (unsigned i = 0; i < 20u && !world->outputs.irq; i++)
		poll(bridge, 5);
	if (!world->outputs.irq)
		world_fail(world, world->clock, "%s: nothing is stopped, %s", what,
		    passo_error_name(passo_fault(&bridge->passo)));
	bridge->counts->stops++;
}

/* From STOPPED, or from whatever is left after an error, to rest. */
static void recover(struct bridge *bridge)
{
	enum passo_error error = PASSO_ERROR_MOVING;

	for (unsigned i = 0; i < 20u && error != PASSO_OK; i++) {
		error = passo_clear(&bridge->passo);
		note(bridge, "clear", error);
		if (error != PASSO_OK)
			poll(bridge, 10);
	}
	if (error != PASSO_OK)
		world_fail(
		    bridge->world, bridge->world->clock, "clear never succeeds: %s", passo_error_name(error));
	world_run(bridge->world, 3000);
	agree(bridge);
	check_positions(bridge);
}

static enum passo_error configure(struct bridge *bridge)
{
	struct plot_random *random = bridge->random;

	for (uint8_t a = 0; a < bridge->world->model.parameters.axes; a++) {
		struct passo_axis_config config = {.in_clocks = true,
		    .step_high_ns = 1u + plot_draw(random, 4),
		    .step_low_ns = 1u + plot_draw(random, 4),
		    .dir_setup_ns =
			bridge->slow_turns ? 400u + plot_draw(random, 600) : 1u + plot_draw(random, 9),
		    .dir_hold_ns = 1u + plot_draw(random, 9),
		    .step_inverted = plot_chance(random, 50),
		    .direction_inverted = plot_chance(random, 50),
		    .both_edges = plot_chance(random, 20)};
		enum passo_error error = passo_configure_axis(&bridge->passo, a, &config);

		note(bridge, "configure", error);
		if (error != PASSO_OK)
			return error;
		count_pins(bridge); /* the change of polarity is no step */
		bridge->config[a] = config;
		error = passo_enable(&bridge->passo, a, true);
		if (error != PASSO_OK)
			return error;
	}
	enum passo_error error =
	    passo_configure_motion(&bridge->passo, HOLD_MICROSECONDS, STOP_MICROSECONDS, 1u << 28);
	world_run(bridge->world, 50);
	bridge->row = bridge->world->row_count - 1u;
	memset(bridge->made, 0, sizeof bridge->made);
	memset(bridge->pulses, 0, sizeof bridge->pulses);
	return error;
}

struct supply {
	unsigned lines, ramps, wanted;
};

static bool next_line(void *context, struct passo_line *line)
{
	struct supply *supply = context;

	*line = (struct passo_line){.substeps = 64, .steps = {7}, .directions = supply->lines % 2u ? 1u : 0u};
	line->last = ++supply->lines == supply->wanted;
	return true;
}

/* 64 substeps at 1/64 are 32 ticks of 128 clocks */
static bool next_ramp(void *context, struct passo_ramp *ramp)
{
	struct supply *supply = context;

	*ramp = (struct passo_ramp){.velocity_end = PASSO_ONE_Q48 / 64, .progress_step = PASSO_ONE_Q48 / 32};
	ramp->ticks = supply->ramps == 0 ? 0 : 32;
	ramp->last = supply->ramps++ == supply->wanted;
	return true;
}

static void stream(struct bridge *bridge)
{
	struct supply supply = {.wanted = 3u + plot_draw(bridge->random, 8)};
	const struct passo_source source = {next_line, next_ramp, &supply};

	finish(bridge);
	if (bridge->world->failed_at)
		return;
	must(bridge, "stream", passo_stream(&bridge->passo, &source));
	bridge->wanted[0] += supply.wanted % 2u ? 7 : 0;
	bridge->wanted_pulses[0] += 7 * (int64_t)supply.wanted;
	bridge->counts->lines += supply.wanted;
	finish(bridge);
}

static void toggle_enable(struct bridge *bridge)
{
	const uint8_t axis = (uint8_t)plot_draw(bridge->random, bridge->world->model.parameters.axes);

	enum passo_error error = passo_enable(&bridge->passo, axis, false);
	note(bridge, "disable", error);
	if (error != PASSO_OK)
		return;
	count_pins(bridge);
	bridge->disabled[axis] = true;
	poll(bridge, 3);
	count_pins(bridge);
	bridge->disabled[axis] = false;
	must(bridge, "enable", passo_enable(&bridge->passo, axis, true));
}

/* ---- histories ---- */

static void play_noise(struct bridge *bridge)
{
	static const uint32_t rates[] = {100000, 10000, 1000};
	struct plot_random *random = bridge->random;
	enum passo_error error;

	bridge->wire.one_in = rates[plot_draw(random, 3)];
	bridge->wire.worse = plot_chance(random, 50) ? 5u : 0u;
	for (unsigned i = 6u + plot_draw(random, 6); i != 0u && !bridge->world->failed_at; i--) {
		switch (plot_draw(random, 16)) {
		case 0:
			must(bridge, "hold", passo_hold(&bridge->passo));
			poll(bridge, plot_draw(random, 12));
			must(bridge, "resume", passo_resume(&bridge->passo));
			break;
		case 1:
			must(bridge, "override", passo_override(&bridge->passo, 20u + plot_draw(random, 81)));
			break;
		case 2:
			must(bridge, "stop", passo_stop(&bridge->passo));
			check_stopped(bridge, "stop");
			recover(bridge);
			break;
		case 3:
			must(bridge, "abort", passo_abort(&bridge->passo));
			check_stopped(bridge, "abort");
			recover(bridge);
			break;
		case 4:
			stream(bridge);
			break;
		case 5:
			finish(bridge);
			toggle_enable(bridge);
			break;
		case 6:
			poll(bridge, plot_draw(random, 8));
			break;
		default:
			if (!do_move(bridge, &error) && error != PASSO_ERROR_FULL
			    && error != PASSO_ERROR_TABLE)
				must(bridge, "move", error);
			break;
		}
	}
	if (!bridge->world->failed_at)
		finish(bridge);
}

/* The wire dies in one of the next frames, and comes back later. */
static void arm(struct bridge *bridge)
{
	bridge->wire.level = plot_chance(bridge->random, 50);
	bridge->wire.dies_in = 1u + plot_draw(bridge->random, 3);
	bridge->wire.dies_at = plot_draw(bridge->random, 32u * 12u);
}

static void reconnect(struct bridge *bridge)
{
	poll(bridge, plot_draw(bridge->random, 4));
	bridge->wire.dead = false;
	bridge->wire.dies_in = 0;
	poll(bridge, POLLS);
}

static void expect_standstill(struct bridge *bridge)
{
	struct world *world = bridge->world;

	world_run(world, 2u * HOLD_MICROSECONDS);
	count_pins(bridge);
	int64_t before[PASSO_AXES_MAX];
	memcpy(before, bridge->pulses, sizeof before);
	poll(bridge, 20);
	count_pins(bridge);
	if (memcmp(before, bridge->pulses, sizeof before) != 0)
		world_fail(world, world->clock, "it moves although a hold was commanded: %s",
		    passo_error_name(passo_fault(&bridge->passo)));
}

static void die_in_move(struct bridge *bridge)
{
	struct world *world = bridge->world;
	const struct passo_move_by_speed move = draw_move(bridge);

	arm(bridge);
	enum passo_error error = passo_move_by_speed(&bridge->passo, &move);
	note(bridge, "move while the wire dies", error);
	reconnect(bridge);
	world_run(world, 30000);
	count_pins(bridge);
	const bool none = memcmp(bridge->made, bridge->wanted, sizeof bridge->made) == 0;
	want(bridge, &move);
	const bool all = memcmp(bridge->made, bridge->wanted, sizeof bridge->made) == 0;
	if (!all && (error == PASSO_OK || !none))
		world_fail(world, world->clock, "move while the wire died, %s: neither made nor left out",
		    passo_error_name(error));
	agree(bridge);
	if (error != PASSO_OK) {
		passo_abort(&bridge->passo);
		recover(bridge);
	}
}

static void die_in_enable(struct bridge *bridge)
{
	finish(bridge);
	arm(bridge);
	note(bridge, "disable while the wire dies", passo_enable(&bridge->passo, 0, false));
	reconnect(bridge);
	must(bridge, "disable", passo_enable(&bridge->passo, 0, false));
	world_run(bridge->world, 100);
	if ((bridge->world->outputs.enable & 1u) != 0u)
		world_fail(bridge->world, bridge->world->clock, "axis 0 is enabled");
	must(bridge, "enable", passo_enable(&bridge->passo, 0, true));
}

static void die_in_zero(struct bridge *bridge)
{
	finish(bridge);
	arm(bridge);
	note(bridge, "zero while the wire dies", passo_zero(&bridge->passo));
	reconnect(bridge);
	must(bridge, "zero", passo_zero(&bridge->passo));
	memset(bridge->made, 0, sizeof bridge->made);
	agree(bridge);
	check_positions(bridge);
}

static void die_in_rate(struct bridge *bridge, unsigned which)
{
	enum passo_error error;

	if (which == 1u)
		must(bridge, "hold", passo_hold(&bridge->passo));
	arm(bridge);
	if (which == 0u)
		error = passo_hold(&bridge->passo);
	else if (which == 1u)
		error = passo_resume(&bridge->passo);
	else
		error = passo_override(&bridge->passo, 1u + plot_draw(bridge->random, 100));
	note(bridge,
	    which == 0u   ? "hold while the wire dies"
	    : which == 1u ? "resume ..."
	                  : "override ...",
	    error);
	reconnect(bridge);
	if (which == 0u || (which == 1u && error != PASSO_OK))
		expect_standstill(bridge);
	must(bridge, "resume", passo_resume(&bridge->passo));
	must(bridge, "override", passo_override(&bridge->passo, 100));
	finish(bridge);
}

static void die_in_stop(struct bridge *bridge, bool softly)
{
	const char *what = softly ? "stop while the wire dies" : "abort while the wire dies";

	arm(bridge);
	note(bridge, what, softly ? passo_stop(&bridge->passo) : passo_abort(&bridge->passo));
	reconnect(bridge);
	check_stopped(bridge, what);
	if (plot_chance(bridge->random, 50)) {
		arm(bridge);
		note(bridge, "clear while the wire dies", passo_clear(&bridge->passo));
		reconnect(bridge);
	}
	recover(bridge);
}

static void play_death(struct bridge *bridge)
{
	struct plot_random *random = bridge->random;
	const unsigned kind = plot_draw(random, 8);
	enum passo_error error;

	for (unsigned i = 1u + plot_draw(random, 6); i != 0u; i--)
		do_move(bridge, &error);
	poll(bridge, plot_draw(random, 6));
	if (kind <= 1u)
		die_in_stop(bridge, kind == 0u);
	else if (kind <= 4u)
		die_in_rate(bridge, kind - 2u);
	else if (kind == 5u)
		die_in_move(bridge);
	else if (kind == 6u)
		die_in_enable(bridge);
	else
		die_in_zero(bridge);
	if (bridge->world->failed_at)
		return;
	must(bridge, "finish", do_move(bridge, &error) ? PASSO_OK : error);
	finish(bridge);
	check_positions(bridge);
}

/* An earlier host has left off at any sequence number. */
static void begin_sequences(struct bridge *bridge)
{
	uint32_t mosi[PASSO_FRAME_WORDS_MAX], miso[PASSO_FRAME_WORDS_MAX];
	const uint32_t nothing = 0;
	const uint8_t sequence = (uint8_t)plot_draw(bridge->random, 256);
	const size_t count = passo_frame_write(mosi, sequence, PASSO_ADDRESS_RUN, &nothing, 1);

	world_exchange(bridge->world, mosi, miso, count, 32u * count);
	world_run(bridge->world, 100);
}

void bridge_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    FILE *print, struct bridge_counts *counts)
{
	static struct bridge bridge;
	const struct passo_parameters parameters = plot_parameters(BRIDGE_SET);
	struct plot_random random;
	const struct passo_options options = {.clock_hz = CLOCK_HZ};

	plot_seed(&random, seed + SEED_OFFSET, number);
	const bool death = plot_chance(&random, 45);
	memset(&bridge, 0, sizeof bridge);
	world_open(world, &parameters, rtl);
	bridge.world = world;
	bridge.random = &random;
	bridge.counts = counts;
	bridge.print = print;
	bridge.slow_turns = plot_chance(&random, 30);
	bridge.wire = (struct wire){.world = world, .random = &random, .counts = counts};
	const struct passo_hardware hardware = {.transfer = transfer,
	    .microseconds = microseconds,
	    .wait = wait,
	    .context = &bridge.wire,
	    .tries = death ? TRIES_DEATH : TRIES_NOISE,
	    .paced = true};
	world_run(world, 8);
	begin_sequences(&bridge);
	must(&bridge, "open", passo_open(&bridge.passo, &bridge.host, &hardware, &options));
	if (!world->failed_at)
		must(&bridge, "configure", configure(&bridge));
	if (!world->failed_at && death)
		play_death(&bridge);
	else if (!world->failed_at)
		play_noise(&bridge);
	counts->retries += bridge.host.counters.retries;
	counts->clocks += world->clock;
	world_close(world);
}
