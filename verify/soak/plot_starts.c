/* SPDX-License-Identifier: MIT
 * Histories of motions that begin while switches are active, or become so: with filters of any length, and
 * motions that follow one another without a rest.
 */
#include <string.h>

#include "plot_draw.h"

#define TRIES 7u
#define MOTIONS 3u /* of a try, one after the other */
#define MARGIN 300u

/* Up to a millisecond of a slow core and the longest there is. */
static uint32_t some_filter(struct plot *plot)
{
	static const uint32_t filters[] = {0, 1, 7, 100, 1000, 16000, 65535};

	return filters[plot_draw(&plot->random, 7)];
}

/* From the edge of a switch until its level is certain, at most. */
static uint32_t settles(const struct plot *plot)
{
	return 2u * plot->filter + MARGIN;
}

static uint64_t frame_clocks(const struct plot *plot, const struct action *action)
{
	return plot->setup + 64u * plot->half_period * (action->length + 4u) + action->clocks;
}

static void write_at(struct plot *plot, uint64_t clock, uint16_t address, uint32_t word)
{
	struct action action = plot_write_word(plot, address, word);

	action.clocks = 2;
	action.at = clock;
	plot_add(plot, &action);
}

static void read_state(struct plot *plot, uint64_t clock)
{
	struct action action =
	    plot_frame(plot, PASSO_OPERATION_READ, channel_address(0, PASSO_CHANNEL_STATE));

	action.at = clock;
	action.length = 3;
	plot_add(plot, &action);
}

static void set_up(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	plot->filter = some_filter(plot);
	plot->levels = (struct passo_inputs)PASSO_INPUTS_IDLE;
	write_at(plot, 0, PASSO_ADDRESS_INPUT_FILTER, plot->filter);
	for (unsigned a = 0; a < AXES; a++) {
		const uint32_t inverted = plot_draw(random, 4);
		const uint32_t soft = plot_chance(random, 70) ? 1u << PASSO_AXIS_INPUTS_LIMIT_SOFT_LSB : 0u;

		plot->levels.limit_low |= (uint64_t)(inverted & 1u) << a;
		plot->levels.limit_high |= (uint64_t)(inverted >> 1 & 1u) << a;
		write_at(plot, 0, axis_address(0, a, PASSO_AXIS_INPUTS), inverted | soft);
	}
	write_at(plot, 0, channel_address(0, PASSO_CHANNEL_STOP_SLEW), plot_log(random, 256, PASSO_RATE_ONE));
	write_at(plot, 0, PASSO_ADDRESS_RUN, plot_all_run(plot));
}

static void turn_switch(struct plot *plot, enum passo_input input, uint8_t mask, uint64_t clock)
{
	const struct action action = {.kind = ACTION_INPUT,
	    .at = clock,
	    .input = input,
	    .mask = mask,
	    .edges = 1,
	    .event = EVENT_KINDS};

	if (mask != 0u)
		plot_add(plot, &action);
}

/* Motions, each a line with a few steps of each axis and a ramp that ends soon after it; their clocks. */
static uint64_t draw_motions(struct plot *plot, struct motion *motion)
{
	struct plot_random *random = &plot->random;
	const unsigned speed = plot_draw(random, 4);
	uint64_t clocks = 0;

	for (unsigned i = 0; i < MOTIONS; i++) {
		struct passo_line *line = &motion->lines[motion->line_count++];
		/* some last longer than the filter */
		const uint32_t ticks = 4u + plot_log(random, 1, 8u + settles(plot) / TICK_CLOCKS * 2u);

		*line = (struct passo_line){.last = true,
		    .substeps = (ticks * TICK_CLOCKS * 3u / 4u) >> (speed + 1u),
		    .directions = (uint8_t)plot_draw(random, 1u << AXES)};
		for (unsigned a = 0; a < AXES; a++)
			line->steps[a] =
			    plot_chance(random, 70) ? 1u + plot_draw(random, line->substeps / 8u + 1u) : 0u;
		for (unsigned a = 0; a < AXES; a++)
			line->steps[a] = line->steps[a] > 40u ? 40u : line->steps[a];
		plot_add_ramp(motion, PASSO_VELOCITY_MAX >> speed, 0, PASSO_SHAPE_LINEAR);
		plot_add_ramp(motion, PASSO_VELOCITY_MAX >> speed, ticks, PASSO_SHAPE_LINEAR);
		motion->ramps[motion->ramp_count - 1u].last = true;
		clocks += ticks * TICK_CLOCKS + MARGIN;
	}
	return clocks;
}

/* Switches that become active some time before the motions, or during them, and are open again after them. */
static uint64_t add_try(struct plot *plot, uint64_t clock)
{
	struct plot_random *random = &plot->random;
	struct motion motion = {0};
	const uint64_t moves = draw_motions(plot, &motion);
	struct action lines = plot_push_lines(plot, 0, &motion), ramps = plot_push_ramps(plot, 0, &motion);
	const uint64_t begins = clock + settles(plot);
	const uint64_t runs = begins + frame_clocks(plot, &lines) + frame_clocks(plot, &ramps);
	const uint64_t ends = runs + moves + settles(plot);

	for (unsigned i = 0; i < 2u; i++) {
		const enum passo_input input = i == 0u ? PASSO_INPUT_LIMIT_LOW : PASSO_INPUT_LIMIT_HIGH;
		const uint8_t mask = (uint8_t)(plot_draw(random, 1u << AXES) & plot_draw(random, 1u << AXES));
		const uint64_t pressed = clock + plot_draw(random, (uint32_t)(runs + moves - clock));

		turn_switch(plot, input, mask, pressed);
		turn_switch(plot, input, mask, ends);
	}
	read_state(plot, clock);
	write_at(
	    plot, clock, channel_address(0, PASSO_CHANNEL_COMMAND), 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	lines.at = begins;
	plot_add(plot, &lines);
	plot_add(plot, &ramps);
	return ends + settles(plot);
}

void plot_begin_starts(struct plot *plot, uint64_t seed, uint64_t number)
{
	uint64_t clock = 4000;

	memset(plot, 0, sizeof *plot);
	plot->parameters = plot_machine_parameters();
	plot_seed(&plot->random, seed, number);
	plot->half_period = plot->setup = 2;
	plot->shaft_period = 1;
	set_up(plot);
	for (unsigned i = 0; i < TRIES; i++)
		clock = add_try(plot, clock);
	/* nothing is on the way when the end begins */
	write_at(
	    plot, clock, channel_address(0, PASSO_CHANNEL_COMMAND), 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	plot->prologue = plot->count;
}
