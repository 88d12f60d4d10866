/* SPDX-License-Identifier: MIT
 * At the end of a history of a machine: three lines at a constant speed, one of a power, one of a power in
 * proportion to the speed, one of a raster. The outputs change when they are due, and the power is on for its
 * share of the clocks.
 */
#include <string.h>

#include "history_player.h"

#define LINES 3u
#define VALUES 8u
#define POWERS 150u /* clocks until the speed counts */

struct lit {
	uint64_t from, until;
	uint32_t share; /* of 65535 */
};

static bool set(struct player *player, unsigned place, uint32_t word)
{
	return player_send(player, PASSO_OPERATION_WRITE, channel_address(0, place), &word, 1);
}

static void check_power(struct player *player, const struct lit *lit, uint32_t period)
{
	const struct world *world = player->world;
	uint64_t on = 0;

	for (size_t row = 0; row < world->row_count; row++) {
		uint64_t from = world->rows[row].clock;
		uint64_t until = row + 1u < world->row_count ? world->rows[row + 1u].clock : world->clock;

		if ((world->rows[row].pins.power & 1u) == 0u)
			continue;
		from = from < lit->from ? lit->from : from;
		until = until > lit->until ? lit->until : until;
		on += until > from ? until - from : 0u;
	}
	const uint64_t due = (lit->until - lit->from) * lit->share / 65535u;

	if (on > due + period || on + period < due)
		world_fail(player->world, lit->from,
		    "the power is on for %llu of %llu clocks, share %u of 65535", (unsigned long long)on,
		    (unsigned long long)(lit->until - lit->from), lit->share);
}

static uint64_t levels_since(const struct world *world, uint64_t from, uint32_t levels)
{
	for (size_t row = 0; row < world->row_count; row++)
		if (world->rows[row].clock >= from && (world->rows[row].pins.outputs & 0xFFu) == levels)
			return world->rows[row].clock;
	return 0;
}

void player_check_outputs(struct player *player, struct scenario_random *random)
{
	struct world *world = player->world;
	const uint64_t velocity = PASSO_VELOCITY_MAX >> 4; /* 32 clocks for each substep */
	const uint32_t lag = scenario_chance(random, 50) ? scenario_draw(random, 60) : 0u;
	const uint32_t period_log2 = 4u + scenario_draw(random, 2), period = 1u << period_log2;
	const uint32_t reference = (uint32_t)(velocity >> 16) * (1u + scenario_draw(random, 3));
	const uint32_t pitch = 2u + scenario_draw(random, 4);
	const uint32_t settings[5] = {
	    scenario_draw(random, 256), lag, 1u << (24u - period_log2), reference, pitch};
	const uint32_t counts[LINES] = {
	    20u + scenario_draw(random, 10), 20u + scenario_draw(random, 10), pitch * VALUES};
	struct passo_line lines[LINES];
	uint8_t levels[LINES + 1u], values[VALUES];
	uint32_t powers[LINES], words[VALUES / 4u] = {0};
	uint64_t place = 24u; /* of the first substep of a line, from the beginning: 3/4 of a substep */

	levels[LINES] = (uint8_t)settings[0];
	for (unsigned i = 0; i < VALUES; i++) {
		values[i] = (uint8_t)scenario_draw(random, 256);
		words[i / 4u] |= (uint32_t)values[i] << (8u * (i % 4u));
	}
	for (unsigned i = 0; i < LINES; i++) {
		levels[i] =
		    (uint8_t)((i != 0u ? levels[i - 1u] : levels[LINES]) ^ (1u + scenario_draw(random, 255)));
		powers[i] = scenario_chance(random, 20) ? 65535u : scenario_draw(random, 65536);
		lines[i] = (struct passo_line){.last = i + 1u == LINES,
		    .substeps = counts[i],
		    .steps = {counts[i] / 2u},
		    .output = passo_pack_line_output(&(struct passo_line_output){.levels = levels[i],
			.power = (uint16_t)(i < 2u ? powers[i] : 0u),
			.proportional = i == 1u,
			.raster = i == 2u})};
	}
	if (!player_send(
		player, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_OUTPUT_LEVELS), settings, 5)
	    || !player_send(
		player, PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_RASTER), words, VALUES / 4u))
		world_fail(world, world->clock, "settings of outputs were refused at rest");
	world_run(world, 10);
	if ((world->outputs.outputs & 0xFFu) != levels[LINES])
		world_fail(world, world->clock, "outputs: %x instead of %x at rest",
		    (unsigned)world->outputs.outputs, levels[LINES]);
	const uint64_t begin =
	    player_move(player, lines, LINES, velocity, (counts[0] + counts[1] + counts[2]) / 4u + 2u);
	for (unsigned i = 0; i < LINES; i++) {
		const uint64_t from = begin + place + lag;
		const uint64_t until = from + 32u * counts[i];

		if (levels_since(world, begin + place - 24u, levels[i]) != from)
			world_fail(world, from, "line %u: the outputs change at %llu instead of %llu", i,
			    (unsigned long long)levels_since(world, begin + place - 24u, levels[i]),
			    (unsigned long long)from);
		if (i == 0u)
			check_power(player, &(struct lit){from, until, powers[0]}, period);
		if (i == 1u)
			check_power(player,
			    &(struct lit){from + POWERS, until,
				(uint32_t)((uint64_t)powers[1] * (velocity >> 16) / reference)},
			    period);
		for (unsigned v = 0; i == 2u && v + 1u < VALUES; v++)
			check_power(player,
			    &(struct lit){
				from + 32u * pitch * v, from + 32u * pitch * (v + 1u), 257u * values[v]},
			    period);
		place += 32u * counts[i];
	}
	set(player, PASSO_CHANNEL_OUTPUT_LAG, 0);
}
