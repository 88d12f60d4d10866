/* SPDX-License-Identifier: MIT
 * Internal: plays a scenario to a world and records the replies, for history.c.
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
/* Plays all actions of a scenario; events after action `scout_from` are recorded. */
void player_actions(struct player *player, const struct scenario *scenario, size_t scout_from);
/* Converts the reply to a complete frame into facts for the judge. */
void player_note_reply(
    struct player *player, const struct action *action, const uint32_t *mosi, size_t count, uint64_t begin);
/* Before that: measures, opens all switches, and ends what a machine waits for. */
void player_end_machine(struct player *player);
/* Any frames while anything happens at the pins; then the settings that the end of a history needs. */
void player_pokes(struct player *player, struct scenario_random *random);
/* Brings the core to rest and, unless `brief`, makes one more move. */
void player_end(struct player *player, struct scenario_random *random, bool brief);
/* Chooses a target for a disturbance among the events of the scout. */
void player_aim(const struct world *scout, struct scenario_random *random, enum scenario_kind kind,
    struct action *action);

/* Sends a frame; whether it was accepted. */
bool player_send(struct player *player, enum passo_operation operation, uint16_t address,
    const uint32_t *words, unsigned length);
uint32_t player_state_of(struct player *player, unsigned channel);

#define PLAYER_STEPS_MAX 64u
/* The clocks of the first edges of STEP that make a step; `both`: all of them do. */
unsigned player_find_steps(
    const struct world *world, uint64_t from, unsigned bit, bool both, uint64_t *clocks);
/* At rest, with empty queues: one more move, of shaped ramps. */
void player_shaped_move(struct player *player, struct scenario_random *random, unsigned channel);

/* The first clock from another one on in which a channel is running, or is not; 0: none. */
uint64_t player_runs(const struct player *player, unsigned channel, uint64_t from, bool running);
/* STEP and DIR of channel 0 of a few clocks, full rate, and RUN. */
void player_prepare(struct player *player);
/* After that, at rest: lines at a constant speed for `ticks` ticks. Returns a clock before it. */
uint64_t player_start(
    struct player *player, const struct passo_line *lines, size_t count, uint64_t velocity, uint32_t ticks);
/* Until it is at rest again; returns the clock in which it is running first. */
uint64_t player_move(
    struct player *player, const struct passo_line *lines, size_t count, uint64_t velocity, uint32_t ticks);
/* At rest, with a machine: its encoders, its outputs. */
void player_check_encoder(struct player *player, struct scenario_random *random);
void player_check_outputs(struct player *player, struct scenario_random *random);

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
