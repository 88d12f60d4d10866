/* SPDX-License-Identifier: MIT
 * At the end of a history of a machine: an encoder that turns by some counts, one axis that does not
 * follow it, and a thread that does.
 */
#include "history_player.h"

#define SETTLES 60u /* clocks in which any of these filters knows its level */

#define FOLLOWS 600u /* what is owed is made, at half the speed of the clock */

static bool set(struct player *player, unsigned place, uint32_t word)
{
	return player_send(player, PASSO_OPERATION_WRITE, channel_address(0, place), &word, 1);
}

static const uint32_t *get(struct player *player, unsigned place, unsigned length)
{
	player_send(player, PASSO_OPERATION_READ, channel_address(0, place), NULL, length);
	return player->miso + PASSO_FRAME_DATA;
}

static unsigned encoder(unsigned axis, unsigned place)
{
	return PASSO_CHANNEL_ENCODER_BASE + axis * PASSO_CHANNEL_ENCODER_STRIDE + place;
}

static void invert(struct world *world, enum passo_input input, unsigned axis)
{
	world_add_pin(world,
	    (struct world_pin){.clock = world->clock + 1u, .input = input, .mask = (uint8_t)(1u << axis)});
}

/* Turns a shaft, and waits until the counts are there. */
static void turn(struct world *world, unsigned axis, int32_t counts)
{
	struct world_shaft *shaft = &world->shafts[axis];

	shaft->due += counts;
	world_run(world, (uint64_t)(counts < 0 ? -counts : counts) * shaft->period + SETTLES);
}

static void expect(struct player *player, const char *what, uint32_t seen, uint32_t wanted)
{
	if (seen != wanted)
		world_fail(player->world, player->world->clock, "%s: %x instead of %x", what, seen, wanted);
}

/* Counts, following error, index, and both lines together. */
static void check_counts(struct player *player, struct scenario_random *random, unsigned axis, uint32_t setup)
{
	struct world *world = player->world;
	const bool inverted = (setup >> PASSO_ENCODER_SETUP_INVERTED_LSB & 1u) != 0u;
	const bool index_inverted = (setup >> PASSO_ENCODER_SETUP_INDEX_INVERTED_LSB & 1u) != 0u;
	const bool gated = (setup >> PASSO_ENCODER_SETUP_INDEX_GATED_LSB & 1u) != 0u;
	const int32_t most = 1 + (int32_t)scenario_draw(random, 120);
	const int32_t counts = scenario_chance(random, 50) ? most : -most;
	const int32_t position = inverted ? -counts : counts;
	const uint32_t limit = 1u + scenario_draw(random, 150);
	const uint32_t words[2] = {1u + scenario_draw(random, 0x40000u), limit};

	player_send(
	    player, PASSO_OPERATION_WRITE, channel_address(0, encoder(axis, PASSO_ENCODER_RATIO)), words, 2);
	if ((world->inputs.encoder_index >> axis & 1u) != (index_inverted ? 1u : 0u))
		invert(world, PASSO_INPUT_ENCODER_INDEX, axis); /* not active */
	world_run(world, SETTLES);
	if (!set(player, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB))
		world_fail(world, world->clock, "ZERO was refused at rest");
	turn(world, axis, counts);
	const bool high =
	    (world->inputs.encoder_a >> axis & 1u) != 0u && (world->inputs.encoder_b >> axis & 1u) != 0u;
	for (unsigned i = 0; i < 4u; i++) {
		if (i < 2u) {
			invert(world, PASSO_INPUT_ENCODER_INDEX, axis);
		} else {
			invert(world, PASSO_INPUT_ENCODER_A, axis);
			invert(world, PASSO_INPUT_ENCODER_B, axis);
		}
		world_run(world, SETTLES);
	}
	const uint32_t *read = get(player, PASSO_CHANNEL_ENCODER_POSITION_BASE, player_axes(player));
	for (unsigned a = 0; a < player_axes(player); a++)
		expect(player, "encoder position", read[a], a == axis ? (uint32_t)position : 0u);
	read = get(player, encoder(axis, PASSO_ENCODER_ERROR), 3);
	expect(player, "following error", read[0], (uint32_t)(-position * 256));
	const uint32_t greatest = read[1] & ((1u << PASSO_ENCODER_GREATEST_GREATEST_BITS) - 1u);
	if (greatest > (uint32_t)most || greatest + 1u < (uint32_t)most)
		expect(player, "greatest following error", greatest, (uint32_t)most);
	if ((uint32_t)most != limit)
		expect(player, "limit exceeded", read[1] >> PASSO_ENCODER_GREATEST_EXCEEDED_LSB,
		    (uint32_t)most > limit ? 1u : 0u);
	const uint32_t indexes = gated && !high ? 0u : 1u;
	expect(player, "index", read[2],
	    2u << PASSO_ENCODER_INDEX_ILLEGAL_LSB | indexes << PASSO_ENCODER_INDEX_INDEXES_LSB
	        | (indexes != 0u ? (uint32_t)position & 0xFFFFu : 0u));
}

/* A move of one axis, whose encoder is stationary: it stops as the setup says when the error is at its limit.
 */
static void check_following(
    struct player *player, struct scenario_random *random, unsigned axis, uint32_t setup)
{
	const bool hard = (setup >> PASSO_ENCODER_SETUP_STOP_HARD_LSB & 1u) != 0u;
	const bool soft = (setup >> PASSO_ENCODER_SETUP_STOP_SOFT_LSB & 1u) != 0u;
	const uint32_t steps = 10u + scenario_draw(random, 16), limit = 2u + scenario_draw(random, 24);
	const uint32_t words[2] = {PASSO_ENCODER_RATIO_RESET, limit};
	struct passo_line line = {.last = true, .substeps = 2u * steps};
	const uint64_t velocity = PASSO_VELOCITY_MAX >> 5;

	line.steps[axis] = steps;
	player_send(
	    player, PASSO_OPERATION_WRITE, channel_address(0, encoder(axis, PASSO_ENCODER_RATIO)), words, 2);
	player_move(player, &line, 1, velocity, steps + 2u);
	const struct passo_channel_state state =
	    passo_unpack_channel_state(*get(player, PASSO_CHANNEL_STATE, 1));
	const bool stops = (hard || soft) && limit < steps - 2u;

	if ((stops || steps < limit) && (state.state == PASSO_STATE_STOPPED) != stops)
		world_fail(player->world, player->world->clock, "%u steps, limit %u: state %u", steps, limit,
		    (unsigned)state.state);
	if (stops && state.cause != PASSO_CAUSE_FOLLOWING_ERROR)
		expect(player, "cause", (uint32_t)state.cause, PASSO_CAUSE_FOLLOWING_ERROR);
	const uint32_t made = get(player, PASSO_CHANNEL_POSITION_BASE, player_axes(player))[axis];
	if (hard && stops && (made < limit || made > limit + 1u))
		expect(player, "steps until a hard stop", made, limit);
	if (!stops && steps < limit)
		expect(player, "steps", made, steps);
	expect(player, "following error", *get(player, encoder(axis, PASSO_ENCODER_ERROR), 1), made << 8);
	set(player, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB);
	set(player, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
}

/* A thread: the path is where the counts are. */
static void check_thread(struct player *player, struct scenario_random *random, unsigned axis, uint32_t setup)
{
	struct world *world = player->world;
	const bool inverted = (setup >> PASSO_ENCODER_SETUP_INVERTED_LSB & 1u) != 0u;
	const bool waits = scenario_chance(random, 50);
	const unsigned scale = scenario_draw(random, 3);
	const uint32_t ticks = 1u + scenario_draw(random, 2);
	const uint32_t tick = 1u << world->model.parameters.tick_log2;
	const uint64_t velocity = (PASSO_VELOCITY_MAX >> 2)
	                        - (uint64_t)scenario_draw(random, 0x10000u) * (PASSO_VELOCITY_MAX >> 20);
	const uint32_t substeps = (uint32_t)((PASSO_ONE_Q48 / 4u + velocity * tick * ticks) / PASSO_ONE_Q48);
	const struct passo_line line = {
	    .last = true, .substeps = substeps, .steps = {substeps, substeps / 2u}};
	const uint32_t all = tick * ticks >> scale, some = scenario_draw(random, all);
	const uint32_t follow[2] = {
	    1u << PASSO_CHANNEL_FOLLOW_FOLLOW_LSB | (waits ? 1u : 0u) << PASSO_CHANNEL_FOLLOW_WAIT_INDEX_LSB
	        | axis << PASSO_CHANNEL_FOLLOW_SOURCE_LSB | scale << PASSO_CHANNEL_FOLLOW_SCALE_LSB,
	    UINT32_C(1) << 31};

	if (!player_send(player, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_FOLLOW), follow, 2))
		world_fail(world, world->clock, "FOLLOW was refused at rest");
	if (player_axes(player) == 1u)
		return;
	player_start(player, &line, 1, velocity, ticks);
	turn(world, axis, inverted ? -3 : 3); /* before it begins, or waits: not made up for */
	if (waits) {
		expect(player, "state before the index",
		    passo_unpack_channel_state(*get(player, PASSO_CHANNEL_STATE, 1)).state,
		    PASSO_STATE_ARMED);
		invert(world, PASSO_INPUT_ENCODER_INDEX, axis);
		world_run(world, SETTLES);
		invert(world, PASSO_INPUT_ENCODER_INDEX, axis);
		world_run(world, SETTLES);
	}
	const uint32_t before = waits ? 0u : 3u;
	turn(world, axis, (int32_t)(inverted ? -some : some));
	for (unsigned i = 0; i < 2u; i++) {
		const uint32_t clocks = (some + before) << scale;
		const uint32_t due = i != 0u || clocks >= tick * ticks
		                       ? substeps
		                       : (uint32_t)((PASSO_ONE_Q48 / 4u + velocity * clocks) / PASSO_ONE_Q48);

		world_run(world, FOLLOWS);
		const uint32_t *read = get(player, PASSO_CHANNEL_POSITION_BASE, player_axes(player));

		expect(player, "position of a thread", read[0], due);
		if (i == 0u)
			turn(
			    world, axis, (int32_t)(inverted ? some - all : all - some) + (inverted ? -1 : 1));
	}
	expect(player, "state after a thread",
	    passo_unpack_channel_state(*get(player, PASSO_CHANNEL_STATE, 1)).state, PASSO_STATE_IDLE);
	set(player, PASSO_CHANNEL_FOLLOW, 0);
}

void player_check_encoder(struct player *player, struct scenario_random *random)
{
	struct world *world = player->world;
	const unsigned axis = scenario_draw(random, player_axes(player));
	const uint32_t filter = scenario_draw(random, 13);
	const uint32_t setup = scenario_draw(random, 1u + PASSO_ENCODER_SETUP_DEFINED);

	for (unsigned a = 0; a < player_axes(player); a++)
		world->shafts[a] =
		    (struct world_shaft){.place = world->shafts[a].place, .period = filter + 5u};
	set(player, PASSO_CHANNEL_ENCODER_FILTER, filter);
	set(player, encoder(axis, PASSO_ENCODER_SETUP), setup);
	check_counts(player, random, axis, setup);
	check_following(player, random, axis, setup);
	set(player, encoder(axis, PASSO_ENCODER_SETUP), setup & 3u);
	set(player, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB);
	check_thread(player, random, axis, setup);
	set(player, encoder(axis, PASSO_ENCODER_SETUP), 0);
}
