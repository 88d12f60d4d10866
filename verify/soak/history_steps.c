/* SPDX-License-Identifier: MIT
 * The steps of a move of constant speed: each in its place.
 */
#include "history_player.h"

/* Clocks by which a step may be early or late at full rate: a substep ends with a clock. */
#define ROUNDING 2u

unsigned player_find_steps(
    const struct world *world, uint64_t from, unsigned bit, bool both, uint64_t *clocks)
{
	unsigned edges = 0, count = 0;

	for (size_t row = 1; row < world->row_count; row++) {
		const uint64_t changed = world->rows[row].pins.step ^ world->rows[row - 1u].pins.step;

		if (world->rows[row].clock < from || (changed >> bit & 1u) == 0u)
			continue;
		if ((both || edges % 2u == 0u) && count < PLAYER_STEPS_MAX)
			clocks[count++] = world->rows[row].clock;
		edges++;
	}
	return count;
}

void player_check_steps(struct player *player, unsigned channel, unsigned a, const struct last_move *move)
{
	struct world *world = player->world;
	uint64_t clocks[PLAYER_STEPS_MAX];
	const uint32_t steps = move->line.steps[a];
	const unsigned bit = channel * player_axes(player) + a;
	const unsigned count = player_find_steps(world, move->from, bit, move->both_edges[a], clocks);
	/* Clocks per substep, UQ48.16, and what a step may be off: all of a substep if steps are not evenly
	 * in them. */
	const uint64_t substep = (UINT64_C(1) << 63) / (move->velocity >> 1) * PASSO_RATE_ONE / move->rate;
	const uint64_t uneven = move->line.substeps % steps != 0u ? substep >> 16 : 0u;
	const uint64_t most = uneven + ROUNDING + ROUNDING * PASSO_RATE_ONE / move->rate;

	if (count != steps)
		world_fail(world, world->clock, "channel %u axis %u: %u steps instead of %u in the last move",
		    channel, a, count, steps);
	for (unsigned i = 1; i < count && i < steps; i++) {
		const uint64_t made = clocks[i] - clocks[0];
		const uint64_t due = ((uint64_t)i * move->line.substeps * substep / steps) >> 16;

		if (made + most < due || made > due + most)
			world_fail(world, world->clock,
			    "channel %u axis %u: step %u of the last move comes after %llu clocks instead of "
			    "%llu",
			    channel, a, i, (unsigned long long)made, (unsigned long long)due);
	}
}
