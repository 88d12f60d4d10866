/* SPDX-License-Identifier: MIT
 * Histories with a machine: their end, to measure, open all switches, and end what it waits for; and pokes.
 */
#include "history_player.h"

/* Longest filter, and clocks after which nothing is on the way. */
#define FILTER_MAX 100u
#define SETTLES (4u * FILTER_MAX + 100u)
/* Clocks of pokes in a history, words of a poke, and clocks until any filter and any timing has ended. */
#define POKES 20000u
#define POKE_MAX 12u
#define FORGETS 70000u

static void frame(
    struct player *player, enum passo_operation operation, uint16_t address, uint32_t word, uint16_t length)
{
	const struct action action = {.kind = ACTION_FRAME,
	    .clocks = 2,
	    .operation = (uint16_t)operation,
	    .address = address,
	    .length = length,
	    .payload = {word},
	    .event = EVENT_KINDS};

	player_frame(player, &action);
}

static void read(struct player *player, unsigned place, unsigned length)
{
	frame(player, PASSO_OPERATION_READ, channel_address(0, place), 0, (uint16_t)length);
}

static void measure(struct player *player)
{
	const unsigned axes = player_axes(player);

	read(player, PASSO_CHANNEL_STATE, 3);
	read(player, PASSO_CHANNEL_TRIGGER_STATE, 2);
	read(player, PASSO_CHANNEL_TRIGGER_POSITION_BASE, axes);
	read(player, PASSO_CHANNEL_ENCODER_POSITION_BASE, axes);
	read(player, PASSO_CHANNEL_INPUT_FLAGS, 1);
}

static void open_switches(struct world *world)
{
#define OPEN(name, type, number)                                                                             \
	if ((number) > PASSO_INPUT_SYNC && (number) <= PASSO_INPUT_PROBE)                                    \
		world_add_pin(world, (struct world_pin){.clock = world->clock + 2u,                          \
					 .input = (number),                                                  \
					 .mask = (uint8_t)(world->inputs.name ^ world->levels.name)});
	PASSO_INPUTS(OPEN)
#undef OPEN
}

void player_end_machine(struct player *player)
{
	struct world *world = player->world;

	measure(player);
	open_switches(world);
	world_run(world, SETTLES);
	measure(player);
	for (unsigned a = 0; a < player_axes(player); a++)
		frame(player, PASSO_OPERATION_WRITE,
		    channel_address(0, PASSO_CHANNEL_ENCODER_BASE + a * PASSO_CHANNEL_ENCODER_STRIDE), 0, 1);
	frame(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_WATCHDOG, 0, 1);
	frame(player, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_TRIGGER), 0, 1);
	frame(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_ESTOP_CLEAR, 1, 1);
}

/* A line or a ramp, so that something moves. */
static uint32_t some_motion(struct plot_random *random, uint16_t *address, uint32_t *payload)
{
	const struct passo_line line = {.endless = true,
	    .substeps = 64,
	    .steps = {64, plot_draw(random, 64), plot_draw(random, 64)},
	    .directions = (uint8_t)plot_draw(random, 8)};
	const struct passo_ramp ramp = {.velocity_end = PASSO_VELOCITY_MAX >> plot_draw(random, 8),
	    .ticks = plot_draw(random, 1000),
	    .now = plot_chance(random, 20)};

	if (plot_chance(random, 50)) {
		*address = channel_address(0, PASSO_CHANNEL_RAMP);
		return (uint32_t)passo_ramp_words(payload, &ramp);
	}
	*address = channel_address(0, PASSO_CHANNEL_LINE);
	payload[PASSO_LINE_WORDS(3u)] = plot_draw(random, 1u << 25);
	return (uint32_t)passo_line_words(payload, &line, 3) + 1u;
}

/* A frame of any kind; the core must answer, whatever it thinks of it. */
static void poke(struct player *player, struct plot_random *random)
{
	struct world *world = player->world;
	uint32_t mosi[PASSO_FRAME_WORDS_MAX], payload[POKE_MAX];
	uint32_t length = 1u + plot_draw(random, POKE_MAX);
	const bool moves = plot_chance(random, 30), reads = !moves && plot_chance(random, 30);
	uint16_t address = (uint16_t)(plot_chance(random, 75)   ? channel_address(0, plot_draw(random, 256))
	                              : plot_chance(random, 80) ? plot_draw(random, 64)
	                                                        : plot_draw(random, 4096));
	enum passo_verdict verdict;
	enum passo_reply reply;
	size_t count;

	for (uint32_t i = 0; i < length; i++)
		payload[i] = plot_chance(random, 60) ? plot_draw(random, 64)
		                                     : plot_draw(random, UINT32_MAX) >> plot_draw(random, 32);
	world->sequence = world->sequence == 255u ? 1u : (uint8_t)(world->sequence + 1u);
	if (moves)
		length = some_motion(random, &address, payload);
	if (reads)
		count = passo_frame_read(mosi, 0, address, length);
	else if (moves || plot_chance(random, 30))
		count = passo_frame_push(mosi, world->sequence, address, payload, length);
	else
		count = passo_frame_write(mosi, world->sequence, address, payload, length);
	world_run(world, 2u + plot_draw(random, 200));
	world_exchange(world, mosi, player->miso, count, 32u * count);
	player->counts->frames++;
	reply = reads ? passo_frame_read_reply(mosi, player->miso, count, &verdict)
	              : passo_frame_write_reply(mosi, player->miso, count, &verdict);
	player->counts->refused += reply == PASSO_REPLY_REFUSED ? 1u : 0u;
	if (reply != PASSO_REPLY_OK && reply != PASSO_REPLY_REFUSED)
		world_fail(world, world->clock, "no sane reply to a poke at %03x: %d", address, reply);
}

static void write(struct player *player, uint16_t address, uint32_t word)
{
	frame(player, PASSO_OPERATION_WRITE, address, word, 1);
}

void player_pokes(struct player *player, struct plot_random *random)
{
	struct world *world = player->world;
	const uint32_t abort = 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB;

	for (unsigned a = 0; a < player_axes(player); a++)
		write(player, axis_address(0, a, PASSO_AXIS_ENABLE), 1);
	write(player, PASSO_ADDRESS_RUN, 1);
	world->noise = random->state;
	while (world->clock < POKES && !world->failed_at)
		poke(player, random);
	world->noise = 0;
	world->inputs = world->levels;
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
