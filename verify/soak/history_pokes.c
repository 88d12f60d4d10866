/* SPDX-License-Identifier: MIT
 * Register fuzzing: any frames while anything happens at the pins. Not judged: the core must answer, and move
 * again at the end.
 */
#include "history_player.h"
#include "poke.h"

/* Clocks of fuzzing in a history, and clocks until any filter and any timing has ended. */
#define POKES 20000u
#define FORGETS 70000u
/* Frames that fill the queue of the raster more often than not. */
#define RASTER_FILLS 20u
/* Least clocks between two frames. */
#define DESELECTED 2u
/* Long enough for the watchdog. */
#define SILENCE 140000u

static void print(
    const struct player *player, const struct poke *poke, uint64_t begin, enum passo_reply reply)
{
	static const char *const operations[] = PASSO_OPERATION_NAMES;
	const uint32_t *words =
	    poke->operation == PASSO_OPERATION_READ ? player->miso + PASSO_FRAME_DATA : poke->payload;

	if (!player->print)
		return;
	fprintf(player->print, "%8llu  %s %03x", (unsigned long long)begin, operations[poke->operation],
	    (unsigned)poke->address);
	for (size_t i = 0; i < poke->length; i++)
		fprintf(player->print, " %x", words[i]);
	fprintf(player->print, "%s\n", reply == PASSO_REPLY_REFUSED ? " -> refused" : "");
}

static enum passo_reply send(struct player *player, const struct poke *poke)
{
	struct world *world = player->world;
	const bool reads = poke->operation == PASSO_OPERATION_READ;
	uint32_t mosi[PASSO_FRAME_WORDS_MAX];
	enum passo_verdict verdict;
	size_t count;

	world_run(world, DESELECTED);
	const uint64_t begin = world->clock;
	world->sequence = world->sequence == 255u ? 1u : (uint8_t)(world->sequence + 1u);
	if (reads)
		count = passo_frame_read(mosi, 0, poke->address, poke->length);
	else if (poke->operation == PASSO_OPERATION_PUSH)
		count = passo_frame_push(mosi, world->sequence, poke->address, poke->payload, poke->length);
	else
		count = passo_frame_write(mosi, world->sequence, poke->address, poke->payload, poke->length);
	world_exchange(world, mosi, player->miso, count, 32u * count);
	player->counts->frames++;
	const enum passo_reply reply = reads ? passo_frame_read_reply(mosi, player->miso, count, &verdict)
	                                     : passo_frame_write_reply(mosi, player->miso, count, &verdict);
	print(player, poke, begin, reply);
	return reply;
}

static void poke(struct player *player, struct scenario_random *random)
{
	struct world *world = player->world;
	const bool stopped = world->model.channel[0].motion.state == PASSO_STATE_STOPPED;
	const struct poke poke = poke_any(random, stopped);

	if (scenario_chance(random, 20))
		world->shafts[scenario_draw(random, player_axes(player))].due +=
		    (int32_t)scenario_draw(random, 4000) - 1000;
	world_run(world, scenario_draw(random, 200));
	const enum passo_reply reply = send(player, &poke);
	player->counts->refused += reply == PASSO_REPLY_REFUSED ? 1u : 0u;
	if (reply != PASSO_REPLY_OK && reply != PASSO_REPLY_REFUSED)
		world_fail(
		    world, world->clock, "no sane reply to a frame at %03x: %d", poke.address, (int)reply);
}

static void write(struct player *player, uint16_t address, uint32_t word)
{
	const struct poke poke = {PASSO_OPERATION_WRITE, address, {word}, 1};
	const enum passo_reply reply = send(player, &poke);

	if (reply != PASSO_REPLY_OK)
		world_fail(player->world, player->world->clock, "a write to %03x is answered with %d",
		    address, (int)reply);
}

static uint32_t some_trigger(struct scenario_random *random, unsigned axes)
{
	return (1u + scenario_draw(random, 5)) << PASSO_CHANNEL_TRIGGER_SOURCE_LSB
	     | scenario_draw(random, axes) << PASSO_CHANNEL_TRIGGER_AXIS_LSB
	     | scenario_draw(random, 2) << PASSO_CHANNEL_TRIGGER_FALLING_LSB
	     | scenario_draw(random, 4) << PASSO_CHANNEL_TRIGGER_ACTION_LSB
	     | 1u << PASSO_CHANNEL_TRIGGER_ARM_LSB;
}

/* What single frames would seldom become: a laser, a raster, a compare, points of shapes, a profile that
 * follows an encoder, and a motion. */
static void set_up(struct player *player, struct scenario_random *random)
{
	struct world *world = player->world;
	const unsigned axes = player_axes(player);
	const uint32_t filter = scenario_draw(random, 4);
	const struct poke outputs = {PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_PWM_STEP),
	    {1u << (14u + scenario_draw(random, 8)),
		PASSO_CHANNEL_POWER_REFERENCE_RESET >> scenario_draw(random, 8),
		1u + scenario_draw(random, 100),
		scenario_draw(random, axes) << PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB
	            | (1u + scenario_draw(random, 40)),
		scenario_draw(random, 4), 1u + scenario_draw(random, 4)},
	    6};
	const struct poke lines = poke_lines(random), ramps = poke_ramps(random);

	for (unsigned a = 0; a < axes; a++) {
		write(player, axis_address(0, a, PASSO_AXIS_ENABLE), 1);
		if (scenario_chance(random, 30))
			write(player, axis_address(0, a, PASSO_AXIS_INPUTS),
			    scenario_draw(random, 8) << PASSO_AXIS_INPUTS_LIMIT_SOFT_LSB);
		world->shafts[a].coupled = scenario_chance(random, 50);
		world->shafts[a].period = filter + 3u;
		world->shafts[a].due = (int32_t)scenario_draw(random, 4000) - 1000;
	}
	for (unsigned bank = 0; bank < 3u; bank++)
		write(player, (uint16_t)(PASSO_ADDRESS_COSINE_BASE + 256u * bank + scenario_draw(random, 4)),
		    scenario_draw(random, 65536));
	write(player, channel_address(0, PASSO_CHANNEL_TRIGGER), some_trigger(random, axes));
	write(player, channel_address(0, PASSO_CHANNEL_ENCODER_FILTER), filter);
	write(player, channel_address(0, PASSO_CHANNEL_FOLLOW_LIMIT), 1u << (24u + scenario_draw(random, 8)));
	if (scenario_chance(random, 50))
		write(player, channel_address(0, PASSO_CHANNEL_FOLLOW),
		    1u << PASSO_CHANNEL_FOLLOW_FOLLOW_LSB
		        | scenario_draw(random, 2) << PASSO_CHANNEL_FOLLOW_WAIT_INDEX_LSB
		        | scenario_draw(random, axes) << PASSO_CHANNEL_FOLLOW_SOURCE_LSB
		        | scenario_draw(random, 8) << PASSO_CHANNEL_FOLLOW_SCALE_LSB);
	send(player, &outputs);
	for (unsigned fills = scenario_chance(random, 10) ? RASTER_FILLS : scenario_draw(random, 2);
	    fills != 0u; fills--) {
		const struct poke raster = poke_raster(random);

		send(player, &raster);
	}
	send(player, &lines);
	send(player, &ramps);
	write(player, PASSO_ADDRESS_RUN, 1);
}

/* What the end of a history needs. */
static void tidy(struct player *player)
{
	struct world *world = player->world;
	const uint32_t abort = 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB;

	world->noise = 0;
	world->inputs = world->levels;
	for (unsigned a = 0; a < player_axes(player); a++) {
		world->shafts[a].coupled = false;
		world->shafts[a].due = 0;
	}
	write(player, channel_address(0, PASSO_CHANNEL_COMMAND), abort);
	write(player, PASSO_ADDRESS_RUN, 0);
	write(player, PASSO_ADDRESS_WATCHDOG, 0);
	write(player, PASSO_ADDRESS_INPUT_FILTER, 0);
	write(player, channel_address(0, PASSO_CHANNEL_TRIGGER), 0);
	write(player, channel_address(0, PASSO_CHANNEL_PROBE), 0);
	for (unsigned a = 0; a < player_axes(player); a++) {
		write(player, axis_address(0, a, PASSO_AXIS_STEP_TIMING), 0x10001);
		write(player, axis_address(0, a, PASSO_AXIS_DIR_TIMING), 0x10001);
		write(player, axis_address(0, a, PASSO_AXIS_INPUTS), 0);
		write(player,
		    channel_address(0, PASSO_CHANNEL_ENCODER_BASE + a * PASSO_CHANNEL_ENCODER_STRIDE), 0);
	}
	world_run(world, FORGETS);
	write(player, PASSO_ADDRESS_ESTOP_CLEAR, 1);
	write(player, channel_address(0, PASSO_CHANNEL_FOLLOW), 0);
	write(player, channel_address(0, PASSO_CHANNEL_COMMAND), abort);
}

void player_pokes(struct player *player, struct scenario_random *random)
{
	struct world *world = player->world;
	const bool silent = scenario_chance(random, 20);

	set_up(player, random);
	const uint64_t end = world->clock + POKES;
	world->noisy = scenario_draw(random, 1u << PASSO_INPUT_COUNT);
	world->noise = random->state;
	while (world->clock < end && !world->failed_at)
		poke(player, random);
	if (silent) {
		write(player, PASSO_ADDRESS_WATCHDOG, 1u << PASSO_WATCHDOG_STOP_AFTER_LSB);
		world_run(world, SILENCE);
	}
	tidy(player);
}
