/* SPDX-License-Identifier: MIT
 * Frames, and random register values.
 */
#include "plot_draw.h"

/* Clocks that chip select stays high: short, or the minimum. */
static uint32_t gap(struct plot *plot)
{
	return plot_chance(&plot->random, 40) ? 2u : 2u + plot_draw(&plot->random, 60);
}

struct action plot_frame(struct plot *plot, enum passo_operation operation, uint16_t address)
{
	return (struct action){.kind = ACTION_FRAME,
	    .clocks = gap(plot),
	    .operation = (uint16_t)operation,
	    .address = address,
	    .event = EVENT_KINDS};
}

void plot_add_word(struct action *action, uint32_t word)
{
	action->payload[action->length++] = word;
}

struct action plot_write_word(struct plot *plot, uint16_t address, uint32_t word)
{
	struct action action = plot_frame(plot, PASSO_OPERATION_WRITE, address);

	plot_add_word(&action, word);
	return action;
}

void plot_add(struct plot *plot, const struct action *action)
{
	if (plot->count < PLOT_ACTIONS_MAX)
		plot->actions[plot->count++] = *action;
}

unsigned plot_any_channel(struct plot *plot)
{
	return plot_draw(&plot->random, plot->parameters.channels);
}

uint32_t plot_some_pins(struct plot *plot)
{
	const uint32_t both = plot_chance(&plot->random, 20) ? 1u : 0u;

	return plot_draw(&plot->random, 8) << PASSO_AXIS_PINS_STEP_INVERTED_LSB
	     | both << PASSO_AXIS_PINS_BOTH_EDGES_LSB;
}

static uint32_t some_time(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	if (plot_chance(random, 60))
		return plot_draw(random, 4); /* 0 counts as 1 */
	return plot_chance(random, 80) ? 1u + plot_draw(random, 30) : plot_log(random, 32, 1500);
}

uint32_t plot_some_step_timing(struct plot *plot)
{
	const uint32_t high = some_time(plot);

	return (high > 200u ? 200u : high) << 16 | (some_time(plot) & 0xFFu);
}

uint32_t plot_some_dir_timing(struct plot *plot)
{
	const uint32_t setup =
	    plot_chance(&plot->random, 10) ? plot_log(&plot->random, 64, 1024) : some_time(plot);

	return setup << 16 | some_time(plot);
}

uint32_t plot_some_rate(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	if (plot->parameters.outputs != 0u && plot_chance(random, 50))
		return 0; /* a hold takes the power away */
	return plot_chance(random, 40) ? PASSO_RATE_ONE
	     : plot_chance(random, 30) ? 0u
	                               : plot_log(random, 256, PASSO_RATE_ONE);
}

uint32_t plot_some_slew(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	return plot_chance(random, 25) ? PASSO_RATE_ONE
	     : plot_chance(random, 25) ? plot_draw(random, 3)
	                               : plot_log(random, 16, PASSO_RATE_ONE);
}

uint32_t plot_some_drain(struct plot *plot)
{
	return plot_chance(&plot->random, 15) ? 0u : plot_log(&plot->random, 1u << 24, 1u << 31);
}

struct action plot_rates(struct plot *plot, unsigned channel, uint32_t command)
{
	struct action action =
	    plot_frame(plot, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_COMMAND));
	const uint32_t drain = plot_some_drain(plot);

	plot_add_word(&action, command);
	plot_add_word(&action, plot_some_rate(plot));
	plot_add_word(&action, plot_some_slew(plot));
	plot_add_word(&action, plot_some_slew(plot));
	plot_add_word(&action, drain == 0u ? 1u << 30 : drain);
	return action;
}

uint32_t plot_all_run(const struct plot *plot)
{
	return ((1u << plot->parameters.channels) - 1u) << PASSO_RUN_RUN_LSB;
}
