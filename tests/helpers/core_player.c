/* SPDX-License-Identifier: MIT
 * Plays pin waveforms to the model, clock by clock or with passo_core_advance() and passo_core_run().
 */
#include "core_player.h"

/* False if the outputs changed while `may_change` was false, or if there is no more room for events. */
static bool look(struct player *player, bool may_change)
{
	const struct passo_outputs *now = passo_core_outputs(player->core);
	struct passo_pin_event *last = &player->last;

	if (PASSO_SAME_OUTPUTS(now, last))
		return true;
	last->clock = player->clock;
#define COPY(name, type, number) last->name = now->name;
	PASSO_OUTPUTS(COPY)
#undef COPY
	if (!may_change || player->count == player->capacity)
		return false;
	player->events[player->count++] = *last;
	return true;
}

bool player_exchange(
    struct player *player, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t clocks)
{
	const uint64_t end = shift->clock + clocks;
	bool good = true;

	while (shift->clock < end) {
		const uint64_t before = shift->clock;
		const uint64_t quiet = passo_core_shift(player->core, inputs, shift, end - before);

		if (shift->clock != before + quiet)
			return false;
		if (quiet == 0u)
			passo_core_exchange(player->core, inputs, shift, end - before);
		player->skipped += shift->clock - before - (quiet == 0u ? 1u : 0u);
		player->clock += shift->clock - before;
		good = look(player, quiet == 0u) && good;
	}
	return good && shift->clock == end;
}

bool player_play(struct player *player, struct player_segment *segments, size_t count)
{
	bool good = true;

	for (size_t i = 0; i < count; i++) {
		const struct passo_inputs inputs = segments[i].inputs;
		uint64_t left = segments[i].clocks;

		while (left != 0u) {
			const bool runs = player->advance && left % 2u != 0u; /* one of both ways */
			const uint64_t quiet = runs ? passo_core_run(player->core, &inputs, left)
			                     : player->advance
			                         ? passo_core_advance(player->core, &inputs, left)
			                         : 0u;

			if (quiet > left)
				return false;
			if (quiet == 0u)
				passo_core_clock(player->core, &inputs);
			player->skipped += runs ? quiet - 1u : quiet;
			player->clock += quiet == 0u ? 1u : quiet;
			left -= quiet == 0u ? 1u : quiet;
			good = look(player, runs || quiet == 0u) && good;
		}
		segments[i].spi_miso = passo_core_outputs(player->core)->spi_miso ? 1u : 0u;
	}
	return good;
}
