/* SPDX-License-Identifier: MIT
 * Input pins that change beside the link: reset, sync, and those of a machine.
 */
#include <stdlib.h>

#include "world.h"

void world_add_pin(struct world *world, struct world_pin pin)
{
	size_t at = world->pin_count;

	if (at == WORLD_PINS_MAX)
		abort();
	while (at > world->pin_next && world->pins[at - 1u].clock > pin.clock) {
		world->pins[at] = world->pins[at - 1u];
		at--;
	}
	world->pins[at] = pin;
	world->pin_count++;
}

static uint32_t levels_of(const struct passo_inputs *inputs, enum passo_input input)
{
#define LEVELS(name, type, number)                                                                           \
	if (input == (number))                                                                               \
		return (uint32_t)inputs->name;
	PASSO_INPUTS(LEVELS)
#undef LEVELS
	return 0;
}

/* Inverts pins of the machine, and notes it for the judge. */
static void invert(struct world *world, enum passo_input input, uint8_t mask)
{
	struct passo_inputs *inputs = &world->inputs;

#define INVERT(name, type, number)                                                                           \
	if (input == (number))                                                                               \
		inputs->name = (type)(inputs->name ^ mask);
	PASSO_INPUTS(INVERT)
#undef INVERT
	const struct world_fact fact = {.clock = world->clock + 1u,
	    .kind = FACT_PIN,
	    .words = {(uint32_t)input, levels_of(inputs, input)}};

	world_add_fact(world, &fact);
}

static void turn_shafts(struct world *world)
{
	for (unsigned a = 0; a < world->model.parameters.axes; a++) {
		struct world_shaft *shaft = &world->shafts[a];
		const struct passo_axis *axis = &world->model.channel[0].axis[a];

		if (shaft->coupled && axis->step_made)
			shaft->due += axis->dir ? -1 : 1;
		if (shaft->due == 0 || world->clock < shaft->next)
			continue;
		const bool up = shaft->due > 0;
		const bool even = (shaft->place & 1u) == 0u;

		/* A leads: upward it changes first, at the even places of the cycle */
		invert(world, up == even ? PASSO_INPUT_ENCODER_A : PASSO_INPUT_ENCODER_B, (uint8_t)(1u << a));
		shaft->place = (uint8_t)((shaft->place + (up ? 1u : 3u)) & 3u);
		shaft->due -= up ? 1 : -1;
		shaft->next = world->clock + shaft->period;
	}
}

/* Now and then any input of the machine, or sync. */
static void make_noise(struct world *world)
{
	uint64_t x = world->noise;

	x ^= x >> 12;
	x ^= x << 25;
	x ^= x >> 27;
	world->noise = x;
	const enum passo_input input = (enum passo_input)(PASSO_INPUT_SYNC + (x >> 8) % 10u);

	if ((x & 0x1Fu) != 0u || (input == PASSO_INPUT_ESTOP_N && (x >> 20 & 0xFFu) != 0u))
		return;
	if ((world->noisy >> input & 1u) == 0u)
		return;
	invert(world, input, input <= PASSO_INPUT_ESTOP_N ? 1u : (uint8_t)(x >> 32));
	world->fact_count--;
}

static void change_reset(struct world *world)
{
	const struct world_fact fact = {
	    .clock = world->clock + 1u, .kind = world->resets != 0u ? FACT_RESET : FACT_RESET_DONE};

	world_add_fact(world, &fact);
	world->inputs.rst = world->resets != 0u;
	if (world->inputs.rst)
		world->reset_at = fact.clock;
	world->reset_until = world->inputs.rst ? UINT64_MAX : fact.clock;
}

void world_change_pins(struct world *world)
{
	if (world->machine)
		turn_shafts(world);
	if (world->noise != 0u)
		make_noise(world);
	while (
	    world->pin_next < world->pin_count && world->pins[world->pin_next].clock <= world->clock + 1u) {
		const struct world_pin *pin = &world->pins[world->pin_next++];

		if (pin->input == PASSO_INPUT_SYNC)
			world->inputs.sync = pin->level;
		else if (pin->input == PASSO_INPUT_COUNT)
			world->shafts[pin->mask].due += pin->turn;
		else if (pin->input != PASSO_INPUT_RST)
			invert(world, pin->input, pin->mask);
		if (pin->input != PASSO_INPUT_RST)
			continue;
		/* resets may overlap */
		const bool was = world->resets != 0u;
		world->resets += pin->level ? 1u : UINT32_MAX;
		if ((world->resets != 0u) != was)
			change_reset(world);
	}
}
