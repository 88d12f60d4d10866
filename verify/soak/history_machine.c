/* SPDX-License-Identifier: MIT
 * Histories with a machine: their end, to measure, open all switches, and end what it waits for.
 */
#include "history_player.h"

/* Longest filter, and clocks after which nothing is on the way. */
#define FILTER_MAX 100u
#define SETTLES (4u * FILTER_MAX + 100u)

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
	read(player, PASSO_CHANNEL_TRIGGER_STATE, 1);
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
	frame(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_INPUT_FILTER, 0, 1); /* soon known */
	frame(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_WATCHDOG, 0, 1);
	frame(player, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_TRIGGER), 0, 1);
	frame(player, PASSO_OPERATION_WRITE, PASSO_ADDRESS_ESTOP_CLEAR, 1, 1);
}
