/* SPDX-License-Identifier: MIT */
#include "bridge.h"

#include <string.h>

#include "bridge_host.h"

#define TRIES_NOISE 100u
#define TRIES_DEATH 4u

/* Makes the random numbers independent of the histories at register level. */
#define SEED_OFFSET UINT64_C(0x62726964)

static uint32_t microseconds(void *context)
{
	return (uint32_t)((struct wire *)context)->world->clock;
}

static void wait(void *context, uint32_t time)
{
	world_run(((struct wire *)context)->world, time);
}

static enum passo_error configure(struct bridge *bridge)
{
	struct scenario_random *random = bridge->random;

	for (uint8_t a = 0; a < bridge->world->model.parameters.axes; a++) {
		struct passo_axis_config config = {.in_clocks = true,
		    .step_high_ns = 1u + scenario_draw(random, 4),
		    .step_low_ns = 1u + scenario_draw(random, 4),
		    .dir_setup_ns = bridge->slow_turns ? 400u + scenario_draw(random, 600)
		                                       : 1u + scenario_draw(random, 9),
		    .dir_hold_ns = 1u + scenario_draw(random, 9),
		    .step_inverted = scenario_chance(random, 50),
		    .direction_inverted = scenario_chance(random, 50),
		    .both_edges = scenario_chance(random, 20)};
		enum passo_error error = passo_configure_axis(&bridge->passo, a, &config);

		bridge_note(bridge, "configure", error);
		if (error != PASSO_OK)
			return error;
		bridge_count_pins(bridge); /* a change of polarity is not a step */
		bridge->config[a] = config;
		error = passo_enable(&bridge->passo, a, true);
		if (error != PASSO_OK)
			return error;
	}
	enum passo_error error =
	    passo_configure_motion(&bridge->passo, passo_clocks(&bridge->passo, HOLD_MICROSECONDS),
		passo_clocks(&bridge->passo, STOP_MICROSECONDS), 1u << 28);
	world_run(bridge->world, 50);
	bridge->row = bridge->world->row_count - 1u;
	memset(bridge->made, 0, sizeof bridge->made);
	memset(bridge->pulses, 0, sizeof bridge->pulses);
	return error;
}

/* An earlier host may have stopped at any sequence number. */
static void begin_sequences(struct bridge *bridge)
{
	uint32_t mosi[PASSO_FRAME_WORDS_MAX], miso[PASSO_FRAME_WORDS_MAX];
	const uint32_t nothing = 0;
	const uint8_t sequence = (uint8_t)scenario_draw(bridge->random, 256);
	const size_t count = passo_frame_write(mosi, sequence, PASSO_ADDRESS_RUN, &nothing, 1);

	world_exchange(bridge->world, mosi, miso, count, 32u * count);
	world_run(bridge->world, 100);
}

void bridge_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    FILE *print, struct bridge_counts *counts)
{
	static struct bridge bridge;
	const struct passo_parameters parameters = scenario_parameters(BRIDGE_SET);
	struct scenario_random random;
	const struct passo_options options = {.clock_hz = CLOCK_HZ};

	scenario_seed(&random, seed + SEED_OFFSET, number);
	const bool death = scenario_chance(&random, 45);
	memset(&bridge, 0, sizeof bridge);
	world_open(world, &parameters, rtl);
	bridge.world = world;
	bridge.random = &random;
	bridge.counts = counts;
	bridge.print = print;
	bridge.slow_turns = scenario_chance(&random, 30);
	bridge.wire = (struct wire){.world = world, .random = &random, .counts = counts};
	struct passo_hardware hardware = {.transfer = wire_transfer,
	    .microseconds = microseconds,
	    .wait = wait,
	    .context = &bridge.wire,
	    .tries = death ? TRIES_DEATH : TRIES_NOISE};
	if (scenario_chance(&random, 50)) {
		hardware.start = wire_start;
		hardware.finish = wire_finish;
		hardware.spare = bridge.wire.spare;
	}
	world_run(world, 8);
	begin_sequences(&bridge);
	bridge_must(&bridge, "open", passo_open(&bridge.passo, &bridge.host, &hardware, &options));
	if (!world->failed_at)
		bridge_must(&bridge, "configure", configure(&bridge));
	if (!world->failed_at && death)
		bridge_play_death(&bridge);
	else if (!world->failed_at)
		bridge_play_noise(&bridge);
	counts->retries += bridge.host.counters.retries;
	counts->clocks += world->clock;
	world_close(world);
}
