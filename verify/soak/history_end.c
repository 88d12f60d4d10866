/* SPDX-License-Identifier: MIT
 * The end of a history: come to rest, and make one more move.
 */
#include <string.h>

#include "history_player.h"

#define ABORT (1u << PASSO_CHANNEL_COMMAND_ABORT_LSB)
#define STOP (1u << PASSO_CHANNEL_COMMAND_STOP_LSB)
#define CLEAR (1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB)
#define ZERO (1u << PASSO_CHANNEL_COMMAND_ZERO_LSB)
/* Polls after which a motion must have ended; fewer for a mutant, as the core itself needs fewer. */
#define POLLS_MAX (player->world->alone ? 120u : 400u)
#define LAST_MOVE_STEPS 24u

bool player_send(struct player *player, enum passo_operation operation, uint16_t address,
    const uint32_t *words, unsigned length)
{
	struct action action = {.kind = ACTION_FRAME,
	    .clocks = 2,
	    .operation = (uint16_t)operation,
	    .address = address,
	    .length = (uint16_t)length,
	    .event = EVENT_KINDS};

	if (words)
		memcpy(action.payload, words, length * sizeof *words);
	player_frame(player, &action);
	return operation == PASSO_OPERATION_READ
	    || passo_unpack_ack(player->miso[length + 3u]).verdict == PASSO_VERDICT_OK;
}

static bool write_one(struct player *player, uint16_t address, uint32_t word)
{
	return player_send(player, PASSO_OPERATION_WRITE, address, &word, 1);
}

uint32_t player_state_of(struct player *player, unsigned channel)
{
	player_send(player, PASSO_OPERATION_READ, channel_address(channel, PASSO_CHANNEL_STATE), NULL, 3);
	return player->miso[PASSO_FRAME_DATA];
}

static enum passo_state motion_of(uint32_t state)
{
	return passo_unpack_channel_state(state).state;
}

static bool is_occupied(uint32_t state)
{
	return motion_of(state) != PASSO_STATE_IDLE && motion_of(state) != PASSO_STATE_STOPPED;
}

static bool is_quiet(uint32_t state)
{
	return passo_unpack_channel_state(state).quiet;
}

static void command(struct player *player, unsigned channel, uint32_t bits, const char *why)
{
	if (!write_one(player, channel_address(channel, PASSO_CHANNEL_COMMAND), bits))
		world_fail(player->world, player->world->clock, "channel %u: command %x was refused %s",
		    channel, bits, why);
}

static uint32_t empty_room(const struct player *player)
{
	const struct passo_parameters *parameters = &player->world->model.parameters;

	return passo_pack_channel_room(
	    &(struct passo_channel_room){.line_room = (uint16_t)(1u << parameters->line_queue_log2),
		.ramp_room = (uint16_t)(1u << parameters->ramp_queue_log2)});
}

static void read_positions(struct player *player, unsigned channel)
{
	player_send(player, PASSO_OPERATION_READ, channel_address(channel, PASSO_CHANNEL_POSITION_BASE), NULL,
	    player_axes(player));
}

/* Whatever is in progress, a stop or an abort ends it in time. */
static uint32_t end_motion(struct player *player, struct scenario_random *random, unsigned channel)
{
	struct world *world = player->world;
	uint32_t state = player_state_of(player, channel);
	const uint32_t slew = 8192;

	for (unsigned i = scenario_draw(random, 6); is_occupied(state) && i != 0u; i--)
		state = player_state_of(player, channel);
	if (is_occupied(state) && scenario_chance(random, 60)) {
		write_one(player, channel_address(channel, PASSO_CHANNEL_STOP_SLEW), slew);
		command(player, channel, STOP, "");
		/* the ticks that the rate needs; a read takes longer than five */
		for (unsigned i = 0; i < PASSO_RATE_ONE / slew / 5u + 3u; i++)
			state = player_state_of(player, channel);
		if (is_occupied(state))
			world_fail(world, world->clock,
			    "channel %u: a stop does not end the motion, state %x", channel, state);
	}
	if (is_occupied(state) || scenario_chance(random, 20)) {
		command(player, channel, ABORT | (scenario_chance(random, 30) ? CLEAR : 0u), "");
		state = player_state_of(player, channel);
		if (motion_of(state) != PASSO_STATE_STOPPED)
			world_fail(
			    world, world->clock, "channel %u: state %x after an abort", channel, state);
	}
	return state;
}

static uint32_t come_to_rest(struct player *player, struct scenario_random *random, unsigned channel)
{
	struct world *world = player->world;
	uint32_t state = end_motion(player, random, channel);

	for (unsigned i = 0; i < POLLS_MAX && !is_quiet(state) && !world->failed_at; i++) {
		state = player_state_of(player, channel);
		if (is_occupied(state)) /* another motion was queued */
			state = end_motion(player, random, channel);
	}
	if (!is_quiet(state))
		world_fail(world, world->clock, "channel %u: never quiet, state %x", channel, state);
	read_positions(player, channel);
	return state;
}

/* Restores empty queues, IDLE, quiet, position 0 and full rate. */
static void start_again(
    struct player *player, struct scenario_random *random, unsigned channel, uint32_t state)
{
	struct world *world = player->world;
	const uint32_t rates[4] = {ZERO, PASSO_RATE_ONE, PASSO_RATE_ONE, PASSO_RATE_ONE};

	if (motion_of(state) == PASSO_STATE_IDLE && scenario_chance(random, 50)) {
		command(player, channel, scenario_chance(random, 50) ? STOP : ABORT, "");
		state = player_state_of(player, channel);
	}
	if (motion_of(state) != PASSO_STATE_IDLE)
		command(player, channel, CLEAR, "in STOPPED");
	state = player_state_of(player, channel);
	for (unsigned i = 0; i < POLLS_MAX && !is_quiet(state); i++)
		state = player_state_of(player, channel);
	const struct passo_channel_state now = passo_unpack_channel_state(state);
	if (!now.quiet || now.stopping || now.cause != PASSO_CAUSE_NONE || now.state != PASSO_STATE_IDLE)
		world_fail(world, world->clock, "channel %u: state %x after CLEAR", channel, state);
	if (player->miso[PASSO_FRAME_DATA + 2u] != empty_room(player)) {
		/* lines or ramps left in the queues must not join the last move */
		command(player, channel, ABORT, "");
		command(player, channel, CLEAR, "in STOPPED");
	}
	if (!player_send(
		player, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_COMMAND), rates, 4))
		world_fail(world, world->clock, "channel %u: ZERO was refused at rest", channel);
	read_positions(player, channel);
}

static void last_move(struct player *player, struct scenario_random *random, unsigned channel)
{
	struct world *world = player->world;
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX];
	struct last_move move = {
	    .line = {.last = true, .substeps = 2u * LAST_MOVE_STEPS, .directions = (uint8_t)channel}};
	struct passo_line line = move.line;
	/* slow enough for the steps that queue during the DIR setup time */
	const bool slow = scenario_chance(random, 20);
	const uint64_t most = PASSO_VELOCITY_MAX >> (slow ? 7 : 4);
	const uint64_t any = world->clock * UINT64_C(0x9E3779B97F4A7C15);
	const uint64_t velocity = most - (any >> 16) % (most / 2u);
	const uint32_t rate =
	    slow || (any & 1u) != 0u ? PASSO_RATE_ONE : PASSO_RATE_ONE / 2u + (any >> 4) % 32768u;
	const uint64_t tick = UINT64_C(1) << world->model.parameters.tick_log2;
	const uint32_t ticks = (uint32_t)(line.substeps * (PASSO_ONE_Q48 / velocity + 1u) / tick) + 2u;
	const struct passo_ramp ramps[2] = {{.velocity_end = velocity},
	    {.last = true, .velocity_end = velocity, .ticks = ticks, .progress_step = PASSO_ONE_Q48 / ticks}};
	uint32_t state = 0;

	for (unsigned a = 0; a < player_axes(player); a++)
		line.steps[a] = LAST_MOVE_STEPS - a;
	size_t length = passo_ramp_words(words, &ramps[0]);
	length += passo_ramp_words(words + length, &ramps[1]);
	const bool ramps_taken = player_send(player, PASSO_OPERATION_PUSH,
	    channel_address(channel, PASSO_CHANNEL_RAMP), words, (unsigned)length);
	passo_line_words(words, &line, (uint8_t)player_axes(player));
	length = world_line_words(&world->model.parameters);
	words[length - 1u] = world->machine ? 0u : words[length - 1u];
	if (!player_send(player, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_LINE), words,
		(unsigned)length)
	    || !ramps_taken)
		world_fail(world, world->clock, "channel %u: the last move was refused", channel);
	for (unsigned a = 0; a < player_axes(player); a++) {
		/* longer than the time from the polarity change to the first step */
		const uint32_t frames = 5u * 64u * world->half_period + world->setup;
		const uint32_t dir_setup = slow && a + 1u == player_axes(player) ? frames + 400u : 3u;
		const uint32_t timings[2] = {0x40004u, dir_setup << 16 | 3u};

		player_send(player, PASSO_OPERATION_WRITE, axis_address(channel, a, PASSO_AXIS_STEP_TIMING),
		    timings, 2);
		const uint32_t pins = scenario_draw(random, 16) << 1;
		move.both_edges[a] = (pins >> PASSO_AXIS_PINS_BOTH_EDGES_LSB & 1u) != 0u;
		if (!write_one(player, axis_address(channel, a, PASSO_AXIS_PINS), pins))
			world_fail(world, world->clock, "channel %u: PINS were refused at rest", channel);
	}
	write_one(player, channel_address(channel, PASSO_CHANNEL_RATE_TARGET), rate);
	move.from = world->clock;
	write_one(player, PASSO_ADDRESS_RUN, 1u << channel);
	for (unsigned i = 0; i < POLLS_MAX && !(state != 0u && is_quiet(state)); i++)
		state = player_state_of(player, channel);
	if (motion_of(state) != PASSO_STATE_IDLE)
		world_fail(world, world->clock, "channel %u: state %x after the last move", channel, state);
	read_positions(player, channel);
	for (unsigned a = 0; a < player_axes(player); a++) {
		move.line = line;
		move.velocity = velocity;
		move.rate = rate;
		if (!slow
		    || a + 1u < player_axes(player)) /* the steps of that one wait for the DIR setup time */
			player_check_steps(player, channel, a, &move);
		const int32_t steps = (int32_t)line.steps[a];
		const int32_t wanted = (line.directions >> a & 1u) != 0u ? -steps : steps;

		if ((int32_t)player->miso[PASSO_FRAME_DATA + a] != wanted)
			world_fail(world, world->clock,
			    "channel %u axis %u: the last move ended at %d instead of %d", channel, a,
			    (int32_t)player->miso[PASSO_FRAME_DATA + a], wanted);
	}
}

void player_end(struct player *player, struct scenario_random *random, bool brief)
{
	struct world *world = player->world;
	uint32_t states[PASSO_CHANNELS_MAX] = {0};

	if (scenario_chance(random, 8)) { /* a reset leads to the same state */
		world_add_pin(world, (struct world_pin){world->clock + 3u, PASSO_INPUT_RST, true, 0, 0});
		world_add_pin(world, (struct world_pin){world->clock + 5u, PASSO_INPUT_RST, false, 0, 0});
		world_run(world, 20);
	}
	for (unsigned c = 0; c < player_channels(player) && !world->failed_at; c++)
		states[c] = come_to_rest(player, random, c);
	if (brief)
		return;
	write_one(player, PASSO_ADDRESS_RUN, 0);
	for (unsigned c = 0; c < player_channels(player) && !world->failed_at; c++)
		start_again(player, random, c, states[c]);
	for (unsigned c = 0; c < player_channels(player) && !world->failed_at; c++)
		last_move(player, random, c);
	world->known_from = world->clock + 1u;
	if (!world->machine && !world->failed_at)
		player_shaped_move(player, random, scenario_draw(random, player_channels(player)));
	if (world->machine && !world->tries && !world->starts && !world->pokes && !world->failed_at) {
		world_run(world, 300);
		world->judged_until = world->clock;
		world->half_period = 2;
		player_prepare(player);
		player_check_encoder(player, random);
		player_check_outputs(player, random);
	}
	world_run(world, 300);
}
