/* SPDX-License-Identifier: MIT
 * Pokes: any frames while anything happens at the pins. Not judged: the core must answer, and move again at
 * the end.
 */
#include "history_player.h"

/* Clocks of pokes in a history, most words of one, and clocks until any filter and any timing has ended. */
#define POKES 20000u
#define WORDS_MAX PASSO_FRAME_PAYLOAD_MAX
#define FORGETS 70000u
/* Of a machine. */
#define AXES 3u
/* Frames that fill the queue of the raster more often than not. */
#define RASTER_FILLS 20u
/* Least clocks between two frames. */
#define DESELECTED 2u
/* Long enough for the watchdog. */
#define SILENCE 140000u
/* Of the time scale of a ramp, UQ0.48. */
#define PROGRESS_ONE (UINT64_C(1) << 48)

struct poke {
	enum passo_operation operation;
	uint16_t address;
	uint32_t payload[WORDS_MAX];
	size_t length;
};

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

static uint32_t some_output(struct plot_random *random)
{
	const bool raster = plot_chance(random, 40);

	return passo_pack_line_output(&(struct passo_line_output){.raster = raster,
	    .proportional = plot_chance(random, 50),
	    .levels = (uint8_t)plot_draw(random, 256),
	    .power = raster ? 0u : (uint16_t)plot_draw(random, 65536)});
}

static struct poke some_lines(struct plot_random *random)
{
	struct poke poke = {PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_LINE), {0}, 0};

	for (unsigned i = 0; i <= plot_draw(random, 2); i++) {
		const uint32_t substeps = 1u << plot_draw(random, 10);
		const struct passo_line line = {.endless = plot_chance(random, 50),
		    .substeps = substeps,
		    .steps = {plot_draw(random, substeps + 1u), plot_draw(random, substeps + 1u),
			plot_draw(random, substeps + 1u)},
		    .directions = (uint8_t)plot_draw(random, 8)};

		poke.length += passo_line_words(poke.payload + poke.length, &line, 3);
		poke.payload[poke.length++] = some_output(random);
	}
	return poke;
}

static struct poke some_ramps(struct plot_random *random)
{
	struct poke poke = {PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_RAMP), {0}, 0};

	const unsigned holds = 1u + plot_draw(random, 2); /* long, at the velocity of the one before */
	uint64_t velocity = 0;

	for (unsigned i = 0; i <= holds; i++) {
		const uint32_t ticks = i == holds ? 1u << plot_draw(random, 13) : plot_draw(random, 60);

		if (i != holds)
			velocity = PASSO_VELOCITY_MAX >> plot_draw(random, 10);
		const struct passo_ramp ramp = {.velocity_end = velocity,
		    .ticks = ticks,
		    .progress_step = ticks == 0u ? 0u : (PROGRESS_ONE - 1u) / ticks,
		    .shape = (enum passo_shape)plot_draw(random, 4),
		    .mirror = plot_chance(random, 50),
		    .last = plot_chance(random, 10),
		    .now = plot_chance(random, 10)};

		poke.length += passo_ramp_words(poke.payload + poke.length, &ramp);
	}
	return poke;
}

static uint32_t some_word(struct plot_random *random)
{
	return plot_chance(random, 40) ? plot_draw(random, 64)
	     : plot_chance(random, 30) ? 1u << plot_draw(random, 32)
	                               : plot_draw(random, UINT32_MAX) >> plot_draw(random, 32);
}

static struct poke some_raster(struct plot_random *random)
{
	struct poke poke = {PASSO_OPERATION_PUSH, channel_address(0, PASSO_CHANNEL_RASTER), {0}, 0};

	poke.length = plot_chance(random, 80) ? 1u + plot_draw(random, 8) : WORDS_MAX;
	for (size_t i = 0; i < poke.length; i++)
		poke.payload[i] = some_word(random);
	return poke;
}

static struct poke command(uint32_t bits)
{
	return (struct poke){PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_COMMAND), {bits}, 1};
}

/* Mostly of registers that exist. */
static struct poke some_registers(struct plot_random *random)
{
	static const uint16_t places[][2] = {
	    {PASSO_ADDRESS_IDENTIFICATION, 4},
	    {PASSO_ADDRESS_INPUT_FILTER, 4},
	    {PASSO_ADDRESS_COSINE_BASE, 4},
	    {PASSO_ADDRESS_SIGMOID_BASE, 4},
	    {PASSO_ADDRESS_EASE_BASE, 4},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_COMMAND, 5},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_STATE, 4},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_INPUT_LEVELS, 7},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_LINE, 3},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_OUTPUT_LEVELS, 9},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_POSITION_BASE, AXES},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_TRIGGER_POSITION_BASE, AXES},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_ENCODER_POSITION_BASE, AXES},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_FOLLOW, 4},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_AXIS_BASE, 32},
	    {PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_ENCODER_BASE, 32},
	    {PASSO_ADDRESS_CHANNEL_BASE, PASSO_ADDRESS_CHANNEL_STRIDE},
	    {0, 4096},
	};
	const uint16_t *const place = places[plot_draw(random, (uint32_t)(sizeof places / sizeof places[0]))];
	const uint32_t begin = plot_chance(random, 50) ? 0u : plot_draw(random, place[1]);
	struct poke poke = {plot_chance(random, 50)   ? PASSO_OPERATION_READ
	                    : plot_chance(random, 90) ? PASSO_OPERATION_WRITE
	                                              : PASSO_OPERATION_PUSH,
	    (uint16_t)(place[0] + begin), {0}, 0};
	const uint32_t most = plot_chance(random, 90) ? place[1] - begin : 12u;

	poke.length = plot_chance(random, 50) ? 1u : 1u + plot_draw(random, most < 12u ? most : 12u);
	for (size_t i = 0; i < poke.length; i++)
		poke.payload[i] = some_word(random);
	return poke;
}

/* What changes while it moves. */
static struct poke some_reading(struct plot_random *random)
{
	static const uint16_t places[][2] = {{PASSO_CHANNEL_STATE, 4}, {PASSO_CHANNEL_POSITION_BASE, AXES},
	    {PASSO_CHANNEL_FOLLOW_STATE, 1}, {PASSO_CHANNEL_OUTPUT_STATE, 1}};
	const uint16_t *const place = places[plot_draw(random, (uint32_t)(sizeof places / sizeof places[0]))];

	return (struct poke){PASSO_OPERATION_READ, channel_address(0, place[0]), {0}, place[1]};
}

static struct poke some_poke(struct plot_random *random, bool stopped)
{
	const uint32_t kind = plot_draw(random, 100);

	if (stopped && plot_chance(random, 50))
		return command(1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	return kind < 14 ? some_lines(random)
	     : kind < 28 ? some_ramps(random)
	     : kind < 33 ? some_raster(random)
	     : kind < 36 ? command(plot_draw(random, 16))
	     : kind < 46 ? some_reading(random)
	                 : some_registers(random);
}

static void poke(struct player *player, struct plot_random *random)
{
	struct world *world = player->world;
	const struct poke poke =
	    some_poke(random, world->model.channel[0].motion.state == PASSO_STATE_STOPPED);

	if (plot_chance(random, 20))
		world->shafts[plot_draw(random, player_axes(player))].due +=
		    (int32_t)plot_draw(random, 4000) - 1000;
	world_run(world, plot_draw(random, 200));
	const enum passo_reply reply = send(player, &poke);
	player->counts->refused += reply == PASSO_REPLY_REFUSED ? 1u : 0u;
	if (reply != PASSO_REPLY_OK && reply != PASSO_REPLY_REFUSED)
		world_fail(
		    world, world->clock, "no sane reply to a poke at %03x: %d", poke.address, (int)reply);
}

static void write(struct player *player, uint16_t address, uint32_t word)
{
	const struct poke poke = {PASSO_OPERATION_WRITE, address, {word}, 1};
	const enum passo_reply reply = send(player, &poke);

	if (reply != PASSO_REPLY_OK)
		world_fail(player->world, player->world->clock, "a write to %03x is answered with %d",
		    address, (int)reply);
}

static uint32_t some_trigger(struct plot_random *random, unsigned axes)
{
	return (1u + plot_draw(random, 5)) << PASSO_CHANNEL_TRIGGER_SOURCE_LSB
	     | plot_draw(random, axes) << PASSO_CHANNEL_TRIGGER_AXIS_LSB
	     | plot_draw(random, 2) << PASSO_CHANNEL_TRIGGER_FALLING_LSB
	     | plot_draw(random, 4) << PASSO_CHANNEL_TRIGGER_ACTION_LSB | 1u << PASSO_CHANNEL_TRIGGER_ARM_LSB;
}

/* What would seldom become of single pokes: a laser, a raster, a compare, points of shapes, a profile that
 * follows an encoder, and a motion. */
static void set_up(struct player *player, struct plot_random *random)
{
	struct world *world = player->world;
	const unsigned axes = player_axes(player);
	const uint32_t filter = plot_draw(random, 4);
	const struct poke outputs = {PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_PWM_STEP),
	    {1u << (14u + plot_draw(random, 8)), PASSO_CHANNEL_POWER_REFERENCE_RESET >> plot_draw(random, 8),
		1u + plot_draw(random, 100),
		plot_draw(random, axes) << PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB
	            | (1u + plot_draw(random, 40)),
		plot_draw(random, 4), 1u + plot_draw(random, 4)},
	    6};
	const struct poke lines = some_lines(random), ramps = some_ramps(random);

	for (unsigned a = 0; a < axes; a++) {
		write(player, axis_address(0, a, PASSO_AXIS_ENABLE), 1);
		if (plot_chance(random, 30))
			write(player, axis_address(0, a, PASSO_AXIS_INPUTS),
			    plot_draw(random, 8) << PASSO_AXIS_INPUTS_LIMIT_SOFT_LSB);
		world->shafts[a].coupled = plot_chance(random, 50);
		world->shafts[a].period = filter + 3u;
		world->shafts[a].due = (int32_t)plot_draw(random, 4000) - 1000;
	}
	for (unsigned bank = 0; bank < 3u; bank++)
		write(player, (uint16_t)(PASSO_ADDRESS_COSINE_BASE + 256u * bank + plot_draw(random, 4)),
		    plot_draw(random, 65536));
	write(player, channel_address(0, PASSO_CHANNEL_TRIGGER), some_trigger(random, axes));
	write(player, channel_address(0, PASSO_CHANNEL_ENCODER_FILTER), filter);
	write(player, channel_address(0, PASSO_CHANNEL_FOLLOW_LIMIT), 1u << (24u + plot_draw(random, 8)));
	if (plot_chance(random, 50))
		write(player, channel_address(0, PASSO_CHANNEL_FOLLOW),
		    1u << PASSO_CHANNEL_FOLLOW_FOLLOW_LSB
		        | plot_draw(random, 2) << PASSO_CHANNEL_FOLLOW_WAIT_INDEX_LSB
		        | plot_draw(random, axes) << PASSO_CHANNEL_FOLLOW_SOURCE_LSB
		        | plot_draw(random, 8) << PASSO_CHANNEL_FOLLOW_SCALE_LSB);
	send(player, &outputs);
	for (unsigned fills = plot_chance(random, 10) ? RASTER_FILLS : plot_draw(random, 2); fills != 0u;
	    fills--) {
		const struct poke raster = some_raster(random);

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

void player_pokes(struct player *player, struct plot_random *random)
{
	struct world *world = player->world;

	const bool silent = plot_chance(random, 20);

	set_up(player, random);
	const uint64_t end = world->clock + POKES;
	world->noisy = plot_draw(random, 1u << PASSO_INPUT_COUNT);
	world->noise = random->state;
	while (world->clock < end && !world->failed_at)
		poke(player, random);
	if (silent) {
		write(player, PASSO_ADDRESS_WATCHDOG, 1u << PASSO_WATCHDOG_STOP_AFTER_LSB);
		world_run(world, SILENCE);
	}
	tidy(player);
}
