/* SPDX-License-Identifier: MIT */
#include "bridge_wire.h"

#include <string.h>

#define GAP_CLOCKS 3u /* from frame to frame: hardly more than the core needs */

#define FINISHES_MAX 4u

enum worse { WORSE_NONE, WORSE_LOST, WORSE_DOUBLED, WORSE_CUT };

static bool flips(struct wire *wire)
{
	const bool flip = wire->one_in != 0u && scenario_draw(wire->random, wire->one_in) == 0u;

	wire->counts->flips += flip ? 1u : 0u;
	return flip;
}

/* Exchanges one bit; the clock pulse may be lost. Returns MISO before the pulse. */
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
	if (wire->worse == 0u || !scenario_chance(wire->random, wire->worse))
		return WORSE_NONE;
	const enum worse worse = (enum worse)(1u + scenario_draw(wire->random, 3));
	wire->counts->lost += worse == WORSE_LOST ? 1u : 0u;
	wire->counts->doubled += worse == WORSE_DOUBLED ? 1u : 0u;
	wire->counts->cuts += worse == WORSE_CUT ? 1u : 0u;
	return worse;
}

bool wire_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct wire *wire = context;
	struct world *world = wire->world;
	const enum worse worse = draw_worse(wire);
	const size_t bad_bit = scenario_draw(wire->random, 32u * (uint32_t)words);
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
	world_run(world, GAP_CLOCKS);
	return true;
}

bool wire_start(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct wire *wire = context;

	if (wire->words != 0u)
		world_fail(wire->world, wire->world->clock, "two exchanges at a time");
	wire->send = send;
	wire->receive = receive;
	wire->words = words;
	wire->left = 1u + scenario_draw(wire->random, FINISHES_MAX);
	return true;
}

enum passo_error wire_finish(void *context)
{
	struct wire *wire = context;
	const size_t words = wire->words;

	if (words == 0u)
		return PASSO_OK;
	if (--wire->left != 0u)
		return PASSO_PENDING;
	wire->words = 0;
	wire_transfer(context, wire->send, wire->receive, words);
	return PASSO_OK;
}
