/* SPDX-License-Identifier: MIT
 * Plays a plot to a world and notes what comes back, for history.c.
 */
#ifndef SOAK_HISTORY_PLAYER_H
#define SOAK_HISTORY_PLAYER_H

#include "address.h"
#include "history.h"
#include "passo_words.h"

/* How long the motions run, after the last action, while they are looked at for clocks to aim at; and at most
 * without any. */
#define SCOUT_CLOCKS 5000u
/* Before and after a reset nothing may be written of which it is not certain whether it counts. */
#define RESET_MARGIN 3u

struct player {
	struct world *world;
	struct history_counts *counts;
	FILE *print;
	uint32_t miso[PASSO_FRAME_WORDS_MAX];
	uint32_t repeat[PASSO_FRAME_WORDS_MAX]; /* the last write that was accepted */
	size_t repeat_count;
	uint64_t repeat_at;
};

static inline unsigned player_channels(const struct player *player)
{
	return player->world->model.parameters.channels;
}

static inline unsigned player_axes(const struct player *player)
{
	return player->world->model.parameters.axes;
}

/* When word `index` of a frame that began at `begin` takes effect. */
static inline uint64_t player_executed_at(
    const struct world *world, uint64_t begin, const struct action *action, unsigned index)
{
	return begin + (uint64_t)world_executes(world, action->length, index);
}

/* Sends a frame that may be spoilt. */
void player_frame(struct player *player, const struct action *action);
/* Everything in a plot; the events after the action `scout_from` are recorded. */
void player_actions(struct player *player, const struct plot *plot, size_t scout_from);
/* What the reply to a whole frame tells becomes facts for the judge. */
void player_note_reply(
    struct player *player, const struct action *action, const uint32_t *mosi, size_t count, uint64_t begin);
/* The core comes to rest and, unless `brief`, makes one more move. */
void player_end(struct player *player, struct plot_random *random, bool brief);
/* Chooses a clock for a disturbance by what the scout saw. */
void player_aim(
    const struct world *scout, struct plot_random *random, enum plot_kind kind, struct action *action);

#endif
