/* SPDX-License-Identifier: MIT
 * The line of G-code in motion, and its speed.
 */
#include "passo_math.h"
#include "passo_player.h"
#include "passo_player_private.h"

#define NUMBER_BITS 24u /* N is up to 9999999; the outputs but for the power are the eight bits above */
#define OUTPUT_BITS 16u
#define SECONDS_PER_MINUTE 60u

/* Bits 16 .. 19 and 24 of the output word in eight bits. */
static uint32_t pack(uint32_t output)
{
	return (output >> OUTPUT_BITS & 0xFu) | (output & PASSO_GCODE_OUTPUT_PROPORTIONAL ? 0x10u : 0u);
}

static uint32_t unpack(uint32_t bits)
{
	return (bits & 0xFu) << OUTPUT_BITS | (bits & 0x10u ? PASSO_GCODE_OUTPUT_PROPORTIONAL : 0u);
}

void passo_player_note(struct passo_player *player, uint32_t index)
{
	const struct passo_gcode_action *action = &player->action;

	player->number[index % PASSO_PLAYER_LINES] = action->line | pack(action->output) << NUMBER_BITS;
	player->power[index % PASSO_PLAYER_LINES] = (uint16_t)action->output;
	const uint8_t bit = (uint8_t)(1u << index % 8u);
	uint8_t *bits = &player->rapid[index / 8u % sizeof player->rapid];

	*bits = (uint8_t)(action->feed == PASSO_PATH_RAPID ? *bits | bit : *bits & ~bit);
}

enum passo_player_motion passo_player_motion(const struct passo_player *player)
{
	const struct passo_path_feed *feed = player->feed;
	const bool moves = passo_is_moving(feed->passo);
	const uint32_t index = moves ? feed->moving : feed->path->sent;

	if (player->probes || passo_player_follows(player) || feed->passo->task.kind == PASSO_TASK_HOME)
		return PASSO_PLAYER_SEEK;
	if (index == feed->path->added)
		return PASSO_PLAYER_AT_REST;
	return player->rapid[index / 8u % sizeof player->rapid] >> index % 8u & 1u ? PASSO_PLAYER_RAPID
	                                                                           : PASSO_PLAYER_FEED;
}

bool passo_player_moving_line(const struct passo_player *player, struct passo_player_line *line)
{
	const struct passo_path_feed *feed = player->feed;
	const uint32_t index = feed->moving;

	if (player->probes) {
		*line = (struct passo_player_line){player->action.line, player->action.output};
		return true;
	}
#ifndef PASSO_WITHOUT_THREADS
	if (passo_player_follows(player)) {
		*line = (struct passo_player_line){player->thread.line, player->thread.output};
		return true;
	}
#endif
	if (!passo_is_moving(feed->passo) || feed->path->added - index > PASSO_PLAYER_LINES
	    || feed->path->added == index)
		return false;
	const uint32_t number = player->number[index % PASSO_PLAYER_LINES];
	*line = (struct passo_player_line){number & ((UINT32_C(1) << NUMBER_BITS) - 1u),
	    unpack(number >> NUMBER_BITS) | player->power[index % PASSO_PLAYER_LINES]};
	return true;
}

/* Substeps per mm of what moves, UQ32.32: of the path, or of a motion that the driver has planned. */
static uint64_t scale_of(const struct passo_player *player)
{
	const struct passo *passo = player->feed->passo;
	const struct passo_home *home = passo->task.home;

	if (passo->task.kind == PASSO_TASK_HOME)
		return player->machine->axis[home->axis].steps_per_mm * passo->oversampling;
	if (player->probes)
		return player->probe_scale * passo->oversampling;
	return (uint64_t)player->feed->path->substeps_per_mm << 32;
}

uint64_t passo_player_speed(const struct passo_player *player)
{
	const struct passo *passo = player->feed->passo;
	const struct passo_snapshot *now = passo_snapshot(passo);
	const uint64_t velocity = (uint64_t)now->velocity * now->rate; /* UQ0.48 substeps per clock */
	const uint64_t clocks = (uint64_t)SECONDS_PER_MINUTE * passo->machine.clock_hz;
	const uint64_t scale = scale_of(player);

	if (!passo_is_moving(passo) || scale == 0)
		return 0;
	return passo_mul_div(velocity, clocks, scale); /* UQ0.48 / UQ32.32 */
}
