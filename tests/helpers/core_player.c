/* SPDX-License-Identifier: MIT
 * Plays pin waveforms to the model, clock by clock or with passo_core_advance().
 */
#include "core_player.h"

/* False if the outputs changed while `may_change` was false, or if there is no more room for events. */
static bool look(struct player *player, bool may_change)
{
	const struct passo_outputs *now = passo_core_outputs(player->core);
	struct player_event *last = &player->last;

	if (now->step == last->step && now->dir == last->dir && now->enable == last->enable
	    && now->running == last->running && now->irq == (last->irq != 0u))
		return true;
	*last = (struct player_event){.clock = player->clock,
	    .step = now->step,
	    .dir = now->dir,
	    .enable = now->enable,
	    .running = now->running,
	    .irq = now->irq};
	if (!may_change || player->count == player->capacity)
		return false;
	player->events[player->count++] = *last;
	return true;
}

bool player_play(struct player *player, struct player_segment *segments, size_t count)
{
	bool good = true;

	for (size_t i = 0; i < count; i++) {
		const struct passo_inputs inputs = {.spi_sclk = segments[i].spi_sclk != 0u,
		    .spi_mosi = segments[i].spi_mosi != 0u,
		    .spi_cs_n = segments[i].spi_cs_n != 0u,
		    .sync = segments[i].sync != 0u};
		uint64_t left = segments[i].clocks;

		while (left != 0u) {
			const uint64_t quiet =
			    player->advance ? passo_core_advance(player->core, &inputs, left) : 0u;

			if (quiet > left)
				return false;
			if (quiet == 0u)
				passo_core_clock(player->core, &inputs);
			player->skipped += quiet;
			player->clock += quiet == 0u ? 1u : quiet;
			left -= quiet == 0u ? 1u : quiet;
			good = look(player, quiet == 0u) && good;
		}
		segments[i].spi_miso = passo_core_outputs(player->core)->spi_miso ? 1u : 0u;
	}
	return good;
}
