/* SPDX-License-Identifier: MIT
 * A move of channel 0 at a constant speed.
 */
#include "history_player.h"

#define POLLS_MAX 60u

uint64_t player_runs(const struct player *player, unsigned channel, uint64_t from, bool running)
{
	const struct world *world = player->world;

	for (size_t row = 0; row < world->row_count; row++)
		if (world->rows[row].clock >= from
		    && (world->rows[row].pins.running >> channel & 1u) == (running ? 1u : 0u))
			return world->rows[row].clock;
	return 0;
}

void player_prepare(struct player *player)
{
	const uint32_t timings[2] = {0x40004u, 0x30003u}, run = 1, rate = PASSO_RATE_ONE;

	for (unsigned a = 0; a < player_axes(player); a++)
		player_send(
		    player, PASSO_OPERATION_WRITE, axis_address(0, a, PASSO_AXIS_STEP_TIMING), timings, 2);
	player_send(player, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_RATE_TARGET), &rate, 1);
	player_send(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_RUN, &run, 1);
}

uint64_t player_start(
    struct player *player, const struct passo_line *lines, size_t count, uint64_t velocity, uint32_t ticks)
{
	struct world *world = player->world;
	const struct passo_ramp ramps[2] = {
	    {.velocity_end = velocity}, {.last = true,
					    .velocity_end = velocity,
					    .ticks = ticks,
					    .progress_step = (PASSO_ONE_Q48 - 1u) / ticks}};
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX];
	size_t length = passo_ramp_words(words, &ramps[0]);

	length += passo_ramp_words(words + length, &ramps[1]);
	bool taken = player_send(
	    player, PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_RAMP), words, (unsigned)length);

	length = 0;
	for (size_t i = 0; i < count; i++) {
		passo_line_words(words + length, &lines[i], (uint8_t)player_axes(player));
		length += world_line_words(&world->model.parameters);
		words[length - 1u] = lines[i].output;
	}
	const uint64_t from = world->clock;
	taken = player_send(player, PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_LINE), words,
		    (unsigned)length)
	     && taken;
	if (!taken)
		world_fail(world, world->clock, "a move of %zu lines was refused", count);
	return from;
}

uint64_t player_move(
    struct player *player, const struct passo_line *lines, size_t count, uint64_t velocity, uint32_t ticks)
{
	struct world *world = player->world;
	const uint64_t from = player_start(player, lines, count, velocity, ticks);

	for (unsigned i = 0; i < POLLS_MAX; i++) {
		const struct passo_channel_state state =
		    passo_unpack_channel_state(player_state_of(player, 0));

		if (state.quiet && (state.state == PASSO_STATE_IDLE || state.state == PASSO_STATE_STOPPED))
			return player_runs(player, 0, from, true);
	}
	world_fail(world, world->clock, "a move of %zu lines does not end", count);
	return from;
}
