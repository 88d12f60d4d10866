/* SPDX-License-Identifier: MIT
 * Frames of any kind, to fuzz the registers of a machine.
 */
#include "poke.h"

#include "address.h"
#include "passo_words.h"

/* Of a machine. */
#define AXES 3u
/* Progress of a ramp at its end, UQ0.48. */
#define PROGRESS_ONE (UINT64_C(1) << 48)

static uint32_t some_output(struct scenario_random *random)
{
	const bool raster = scenario_chance(random, 40);

	return passo_pack_line_output(&(struct passo_line_output){.raster = raster,
	    .proportional = scenario_chance(random, 50),
	    .levels = (uint8_t)scenario_draw(random, 256),
	    .power = raster ? 0u : (uint16_t)scenario_draw(random, 65536)});
}

struct poke poke_lines(struct scenario_random *random)
{
	struct poke poke = {PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_LINE), {0}, 0};

	for (unsigned i = 0; i <= scenario_draw(random, 2); i++) {
		const uint32_t substeps = 1u << scenario_draw(random, 10);
		const struct passo_line line = {.endless = scenario_chance(random, 50),
		    .substeps = substeps,
		    .steps = {scenario_draw(random, substeps + 1u), scenario_draw(random, substeps + 1u),
			scenario_draw(random, substeps + 1u)},
		    .directions = (uint8_t)scenario_draw(random, 8)};

		poke.length += passo_line_words(poke.payload + poke.length, &line, 3);
		poke.payload[poke.length++] = some_output(random);
	}
	return poke;
}

struct poke poke_ramps(struct scenario_random *random)
{
	struct poke poke = {PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_RAMP), {0}, 0};
	const unsigned holds = 1u + scenario_draw(random, 2); /* long, at the velocity of the one before */
	uint64_t velocity = 0;

	for (unsigned i = 0; i <= holds; i++) {
		const uint32_t ticks =
		    i == holds ? 1u << scenario_draw(random, 13) : scenario_draw(random, 60);

		if (i != holds)
			velocity = PASSO_VELOCITY_MAX >> scenario_draw(random, 10);
		const struct passo_ramp ramp = {.velocity_end = velocity,
		    .ticks = ticks,
		    .progress_step = ticks == 0u ? 0u : (PROGRESS_ONE - 1u) / ticks,
		    .shape = (enum passo_shape)scenario_draw(random, 4),
		    .mirror = scenario_chance(random, 50),
		    .last = scenario_chance(random, 10),
		    .now = scenario_chance(random, 10)};

		poke.length += passo_ramp_words(poke.payload + poke.length, &ramp);
	}
	return poke;
}

static uint32_t some_word(struct scenario_random *random)
{
	return scenario_chance(random, 40) ? scenario_draw(random, 64)
	     : scenario_chance(random, 30) ? 1u << scenario_draw(random, 32)
	                                   : scenario_draw(random, UINT32_MAX) >> scenario_draw(random, 32);
}

struct poke poke_raster(struct scenario_random *random)
{
	struct poke poke = {PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_RASTER), {0}, 0};

	poke.length = scenario_chance(random, 80) ? 1u + scenario_draw(random, 8) : PASSO_FRAME_PAYLOAD_MAX;
	for (size_t i = 0; i < poke.length; i++)
		poke.payload[i] = some_word(random);
	return poke;
}

static struct poke command(uint32_t bits)
{
	return (struct poke){PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_COMMAND), {bits}, 1};
}

/* Mostly of registers that exist. */
static struct poke some_registers(struct scenario_random *random)
{
	static const uint16_t places[][2] = {
	    {PASSO_ADDRESS_IDENTIFICATION, 4},
	    {PASSO_ADDRESS_INPUT_FILTER, 4},
	    {PASSO_ADDRESS_COSINE_BASE, 4},
	    {PASSO_ADDRESS_SIGMOID_BASE, 4},
	    {PASSO_ADDRESS_EASE_BASE, 4},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_COMMAND, 5},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_STATE, 4},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_INPUT_LEVELS, 7},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_LINE, 3},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_OUTPUT_LEVELS, 9},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_POSITION_BASE, AXES},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_TRIGGER_POSITION_BASE, AXES},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_ENCODER_POSITION_BASE, AXES},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_FOLLOW, 4},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_AXIS_BASE, 32},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_ENCODER_BASE, 32},
	    {PASSO_ADDRESS_CHANNEL_BASE, PASSO_ADDRESS_CHANNEL_STRIDE},
	    {0, 4096},
	};
	const uint16_t *const place =
	    places[scenario_draw(random, (uint32_t)(sizeof places / sizeof places[0]))];
	const uint32_t begin = scenario_chance(random, 50) ? 0u : scenario_draw(random, place[1]);
	struct poke poke = {scenario_chance(random, 50)   ? PASSO_OPERATION_READ
	                    : scenario_chance(random, 90) ? PASSO_OPERATION_WRITE
	                                                  : PASSO_OPERATION_PUSH,
	    (uint16_t)(place[0] + begin), {0}, 0};
	const uint32_t most = scenario_chance(random, 90) ? place[1] - begin : 12u;

	poke.length = scenario_chance(random, 50) ? 1u : 1u + scenario_draw(random, most < 12u ? most : 12u);
	for (size_t i = 0; i < poke.length; i++)
		poke.payload[i] = some_word(random);
	return poke;
}

/* What changes while it moves. */
static struct poke some_reading(struct scenario_random *random)
{
	static const uint16_t places[][2] = {{PASSO_CHANNEL_STATE, 4}, {PASSO_CHANNEL_POSITION_BASE, AXES},
	    {PASSO_CHANNEL_FOLLOW_STATE, 1}, {PASSO_CHANNEL_OUTPUT_STATE, 1}};
	const uint16_t *const place =
	    places[scenario_draw(random, (uint32_t)(sizeof places / sizeof places[0]))];

	return (struct poke){PASSO_OPERATION_READ, channel_address(0, place[0]), {0}, place[1]};
}

struct poke poke_any(struct scenario_random *random, bool stopped)
{
	const uint32_t kind = scenario_draw(random, 100);

	if (stopped && scenario_chance(random, 50))
		return command(1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	return kind < 14 ? poke_lines(random)
	     : kind < 28 ? poke_ramps(random)
	     : kind < 33 ? poke_raster(random)
	     : kind < 36 ? command(scenario_draw(random, 16))
	     : kind < 46 ? some_reading(random)
	                 : some_registers(random);
}
