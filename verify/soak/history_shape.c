/* SPDX-License-Identifier: MIT
 * A move of two shaped ramps: each substep is made in the clock in which the recurrences of
 * docs/architecture.md make it, with the points that a host knows.
 */
#include <string.h>

#include "history_player.h"
#include "passo_shapes.h"

#define ONE_Q49 (UINT64_C(1) << 49)
#define RAMPS 2u
#define TICKS_MAX 24u
/* Every second substep is a step of the first axis; all of them are distinguished. */
#define STEPS_MOST 60u
#define WRITTEN 24u

struct shaped_move {
	struct passo_line line;
	struct passo_ramp ramps[RAMPS];
	bool both_edges[PASSO_AXES_MAX];
	uint32_t points[PASSO_BANKS][PASSO_BANK_POINTS + 1u];
	uint64_t from; /* the clock before it */
};

/* The points as they are after a reset and all writes. */
static void known_points(const struct world *world, struct shaped_move *move)
{
	for (unsigned bank = 0; bank < PASSO_BANKS; bank++) {
		for (unsigned k = 0; k < PASSO_BANK_POINTS; k++)
			move->points[bank][k] = (uint16_t)passo_shape_point(bank + 1u, k);
		move->points[bank][PASSO_BANK_POINTS] = 65536u;
	}
	for (size_t i = 0; i < world->fact_count; i++) {
		const struct world_fact *fact = &world->facts[i];
		const unsigned bank = fact->kind == FACT_WRITE ? passo_bank_at(fact->words[0]) : 0u;

		if (bank != 0u)
			move->points[bank - 1u][fact->words[0] - passo_shape_addresses[bank - 1u]] =
			    fact->words[1];
	}
}

/* UQ1.24 of a progress in UQ0.49. */
static uint64_t shape(const struct shaped_move *move, enum passo_shape kind, uint64_t progress)
{
	if (kind == PASSO_SHAPE_LINEAR)
		return (progress + (UINT64_C(1) << 24)) >> 25;
	const uint32_t *points = move->points[kind - PASSO_SHAPE_COSINE] + (progress >> 41);
	const uint64_t part = ((progress & ((UINT64_C(1) << 41) - 1u)) + (UINT64_C(1) << 16)) >> 17;
	const uint64_t one = UINT64_C(1) << 24;

	return (points[0] * (one - part) + points[1] * part + (UINT64_C(1) << 15)) >> 16;
}

/* from + floor((to - from) * s) */
static uint64_t between(uint64_t from, uint64_t to, uint64_t s)
{
	const int64_t change = (int64_t)to - (int64_t)from;
	const int64_t high = change >> 24, low = change & 0xFFFFFF;

	return from + (uint64_t)(high * (int64_t)s + (low * (int64_t)s >> 24));
}

/* The clock of each substep, as they are counted from the beginning; returns how many the profile lasts. */
static uint32_t profile(const struct player *player, const struct shaped_move *move, uint32_t *substeps,
    uint32_t *clocks, uint32_t room)
{
	const uint32_t tick = 1u << player->world->model.parameters.tick_log2;
	uint64_t phase = PASSO_ONE_Q48 / 4u, start = 0;
	uint32_t clock = 0;

	*substeps = 0;
	for (unsigned r = 0; r < RAMPS; r++) {
		const struct passo_ramp *ramp = &move->ramps[r];
		uint64_t progress = ramp->progress_step;

		for (uint32_t t = 0; t < ramp->ticks; t++) {
			const uint64_t velocity =
			    ramp->mirror
				? between(ramp->velocity_end, start,
				      shape(move, ramp->shape, ONE_Q49 - 1u - progress))
				: between(start, ramp->velocity_end, shape(move, ramp->shape, progress));

			for (uint32_t i = 0; i < tick; i++, clock++) {
				phase += velocity;
				if (phase >= PASSO_ONE_Q48) {
					phase -= PASSO_ONE_Q48;
					if (*substeps < room)
						clocks[*substeps] = clock + 1u;
					++*substeps;
				}
			}
			progress = (progress + 2u * ramp->progress_step) % ONE_Q49;
		}
		start = ramp->velocity_end;
	}
	return clock;
}

static void check(struct player *player, unsigned channel, unsigned axis, const struct shaped_move *move,
    const uint32_t *due, uint32_t substeps)
{
	struct world *world = player->world;
	const unsigned bit = channel * player_axes(player) + axis;
	const uint64_t begin = player_runs(player, channel, move->from, true);
	uint64_t made[PLAYER_STEPS_MAX];
	const unsigned count = player_find_steps(world, move->from, bit, move->both_edges[axis], made);
	uint32_t error = move->line.substeps / 2u, step = 0;

	for (uint32_t i = 0; i < substeps; i++) {
		error += move->line.steps[axis];
		if (error < move->line.substeps)
			continue;
		error -= move->line.substeps;
		if (step >= count || made[step] != begin + due[i]) {
			world_fail(world, world->clock,
			    "channel %u axis %u: step %u of a shaped move comes %lld clocks late", channel,
			    axis, step, step < count ? (long long)(made[step] - begin - due[i]) : -1LL);
			return;
		}
		step++;
	}
	if (step != count)
		world_fail(world, world->clock, "channel %u axis %u: %u steps in a shaped move of %u",
		    channel, axis, count, step);
}

static void draw(
    struct player *player, struct scenario_random *random, unsigned channel, struct shaped_move *move)
{
	uint32_t words[WRITTEN];
	uint64_t most = PASSO_VELOCITY_MAX >> 3;
	const unsigned bank = scenario_draw(random, PASSO_BANKS);
	const unsigned first = scenario_draw(random, PASSO_BANK_POINTS - WRITTEN + 1u);

	for (unsigned i = 0; i < WRITTEN; i++)
		words[i] = scenario_draw(random, 65536u);
	if (!player_send(player, PASSO_OPERATION_WRITE, (uint16_t)(passo_shape_addresses[bank] + first),
		words, WRITTEN))
		world_fail(player->world, player->world->clock, "points were refused at rest");
	known_points(player->world, move);
	for (unsigned r = 0; r < RAMPS; r++) {
		const uint32_t ticks = 3u + scenario_draw(random, TICKS_MAX - 2u);

		move->ramps[r] = (struct passo_ramp){.last = r + 1u == RAMPS,
		    .mirror = scenario_chance(random, 50),
		    .shape = scenario_chance(random, 60)
		               ? (enum passo_shape)(PASSO_SHAPE_COSINE + bank)
		               : (enum passo_shape)scenario_draw(random, PASSO_BANKS + 1u),
		    .velocity_end = most - scenario_draw(random, 0x10000u) * (most >> 17),
		    .ticks = ticks,
		    .progress_step = (PASSO_ONE_Q48 + ticks / 2u) / ticks};
		most >>= 1;
	}
	move->line = (struct passo_line){.last = true, .directions = (uint8_t)(channel + 1u)};
}

void player_shaped_move(struct player *player, struct scenario_random *random, unsigned channel)
{
	struct world *world = player->world;
	static struct shaped_move move;
	static uint32_t due[1024];
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX], substeps;
	const uint32_t stay = 0;
	size_t length = 0;
	uint32_t state = 0;

	player_send(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_RUN, &stay, 1);
	draw(player, random, channel, &move);
	const uint32_t clocks = profile(player, &move, &substeps, due, sizeof due / sizeof *due);
	move.line.substeps = substeps;
	for (unsigned a = 0; a < player_axes(player); a++) {
		const uint32_t timings[2] = {0x40004u, 0x30003u};
		const uint32_t pins = scenario_draw(random, 16) << 1;

		move.both_edges[a] = (pins >> PASSO_AXIS_PINS_BOTH_EDGES_LSB & 1u) != 0u;
		move.line.steps[a] = substeps / 2u - a < STEPS_MOST ? substeps / 2u - a : STEPS_MOST - a;
		player_send(player, PASSO_OPERATION_WRITE, axis_address(channel, a, PASSO_AXIS_STEP_TIMING),
		    timings, 2);
		player_send(
		    player, PASSO_OPERATION_WRITE, axis_address(channel, a, PASSO_AXIS_PINS), &pins, 1);
	}
	for (unsigned r = 0; r < RAMPS; r++)
		length += passo_ramp_words(words + length, &move.ramps[r]);
	const uint32_t rates[3] = {PASSO_RATE_ONE, PASSO_RATE_ONE, PASSO_RATE_ONE};
	const uint32_t zero = 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB, run = 1u << channel;
	bool taken = player_send(player, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_RAMP),
	    words, (unsigned)length);
	passo_line_words(words, &move.line, (uint8_t)player_axes(player));
	taken = player_send(player, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_LINE), words,
		    world_line_words(&world->model.parameters))
	     && taken
	     && player_send(
		 player, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_RATE_TARGET), rates, 3)
	     && player_send(
		 player, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_COMMAND), &zero, 1);
	move.from = world->clock;
	if (!player_send(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_RUN, &run, 1) || !taken)
		world_fail(world, world->clock, "channel %u: a shaped move was refused", channel);
	world_run(world, clocks);
	for (unsigned i = 0; i < 20u && !(state != 0u && passo_unpack_channel_state(state).quiet); i++)
		state = player_state_of(player, channel);
	if (passo_unpack_channel_state(state).state != PASSO_STATE_IDLE)
		world_fail(world, world->clock, "channel %u: state %x after a shaped move", channel, state);
	const uint64_t begin = player_runs(player, channel, move.from, true);
	if (player_runs(player, channel, begin, false) != begin + clocks)
		world_fail(world, world->clock, "channel %u: a shaped move does not last %u clocks", channel,
		    clocks);
	for (unsigned a = 0; a < player_axes(player); a++)
		check(player, channel, a, &move, due, substeps);
}
