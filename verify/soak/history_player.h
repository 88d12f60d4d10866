/* SPDX-License-Identifier: MIT
 * Internal: plays a plot to a world and records the replies, for history.c.
 */
#ifndef SOAK_HISTORY_PLAYER_H
#define SOAK_HISTORY_PLAYER_H

#include "address.h"
#include "history.h"
#include "passo_words.h"

/* Clocks that motions run after the last action while targets are recorded. */
#define SCOUT_CLOCKS 5000u
/* Clocks around a reset in which no write may take effect. */
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

/* Clock at which word `index` of a frame that started at `begin` takes effect. */
static inline uint64_t player_executed_at(
    const struct world *world, uint64_t begin, const struct action *action, unsigned index)
{
	return begin + (uint64_t)world_executes(world, action->length, index);
}

/* Sends a frame, with its fault if it has one. */
void player_frame(struct player *player, const struct action *action);
/* Plays all actions of a plot; events after action `scout_from` are recorded. */
void player_actions(struct player *player, const struct plot *plot, size_t scout_from);
/* Converts the reply to a complete frame into facts for the judge. */
void player_note_reply(
    struct player *player, const struct action *action, const uint32_t *mosi, size_t count, uint64_t begin);
/* Before that: measures, opens all switches, and ends what a machine waits for. */
void player_end_machine(struct player *player);
/* Any frames while anything happens at the pins; then the settings that the end of a history needs. */
void player_pokes(struct player *player, struct plot_random *random);
/* Brings the core to rest and, unless `brief`, makes one more move. */
void player_end(struct player *player, struct plot_random *random, bool brief);
/* Chooses a target for a disturbance among the events of the scout. */
void player_aim(
    const struct world *scout, struct plot_random *random, enum plot_kind kind, struct action *action);

/* A move of constant speed, and the clock before it. */
struct last_move {
	struct passo_line line;
	uint64_t velocity; /* UQ0.48 */
	uint32_t rate;
	bool both_edges[PASSO_AXES_MAX];
	uint64_t from;
};
/* Each step of an axis is in its place. */
void player_check_steps(struct player *player, unsigned channel, unsigned a, const struct last_move *move);

#endif
