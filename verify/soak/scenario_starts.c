/* SPDX-License-Identifier: MIT
 * Histories of motions that begin while switches are active, or become so: with filters of any length, and
 * motions that follow one another without a rest.
 */
#include <string.h>

#include "scenario_draw.h"

#define TRIES 7u
#define MOTIONS 3u /* of a try, one after the other */
#define MARGIN 300u

/* Up to a millisecond of a slow core and the longest there is. */
static uint32_t some_filter(struct scenario *scenario)
{
	static const uint32_t filters[] = {0, 1, 7, 100, 1000, 16000, 65535};

	return filters[scenario_draw(&scenario->random, 7)];
}

/* From the edge of a switch until its level is certain, at most. */
static uint32_t settles(const struct scenario *scenario)
{
	return 2u * scenario->filter + MARGIN;
}

static uint64_t frame_clocks(const struct scenario *scenario, const struct action *action)
{
	return scenario->setup + 64u * scenario->half_period * (action->length + 4u) + action->clocks;
}

static void write_at(struct scenario *scenario, uint64_t clock, uint16_t address, uint32_t word)
{
	struct action action = scenario_write_word(scenario, address, word);

	action.clocks = 2;
	action.at = clock;
	scenario_add(scenario, &action);
}

static void read_state(struct scenario *scenario, uint64_t clock)
{
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_READ, channel_address(0, PASSO_CHANNEL_STATE));

	action.at = clock;
	action.length = 3;
	scenario_add(scenario, &action);
}

static void set_up(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;

	scenario->filter = some_filter(scenario);
	scenario->levels = (struct passo_inputs)PASSO_INPUTS_IDLE;
	write_at(scenario, 0, PASSO_ADDRESS_INPUT_FILTER, scenario->filter);
	for (unsigned a = 0; a < AXES; a++) {
		const uint32_t inverted = scenario_draw(random, 4);
		const uint32_t soft =
		    scenario_chance(random, 70) ? 1u << PASSO_AXIS_INPUTS_LIMIT_SOFT_LSB : 0u;

		scenario->levels.limit_low |= (uint64_t)(inverted & 1u) << a;
		scenario->levels.limit_high |= (uint64_t)(inverted >> 1 & 1u) << a;
		write_at(scenario, 0, axis_address(0, a, PASSO_AXIS_INPUTS), inverted | soft);
	}
	write_at(scenario, 0, channel_address(0, PASSO_CHANNEL_STOP_SLEW),
	    scenario_log(random, 256, PASSO_RATE_ONE));
	write_at(scenario, 0, PASSO_ADDRESS_RUN, scenario_all_run(scenario));
}

static void turn_switch(struct scenario *scenario, enum passo_input input, uint8_t mask, uint64_t clock)
{
	const struct action action = {.kind = ACTION_INPUT,
	    .at = clock,
	    .input = input,
	    .mask = mask,
	    .edges = 1,
	    .event = EVENT_KINDS};

	if (mask != 0u)
		scenario_add(scenario, &action);
}

/* Motions, each a line with a few steps of each axis and a ramp that ends soon after it; their clocks. */
static uint64_t draw_motions(struct scenario *scenario, struct motion *motion)
{
	struct scenario_random *random = &scenario->random;
	const unsigned speed = scenario_draw(random, 4);
	uint64_t clocks = 0;

	for (unsigned i = 0; i < MOTIONS; i++) {
		struct passo_line *line = &motion->lines[motion->line_count++];
		/* some last longer than the filter */
		const uint32_t ticks =
		    4u + scenario_log(random, 1, 8u + settles(scenario) / TICK_CLOCKS * 2u);

		*line = (struct passo_line){.last = true,
		    .substeps = (ticks * TICK_CLOCKS * 3u / 4u) >> (speed + 1u),
		    .directions = (uint8_t)scenario_draw(random, 1u << AXES)};
		for (unsigned a = 0; a < AXES; a++)
			line->steps[a] = scenario_chance(random, 70)
			                   ? 1u + scenario_draw(random, line->substeps / 8u + 1u)
			                   : 0u;
		for (unsigned a = 0; a < AXES; a++)
			line->steps[a] = line->steps[a] > 40u ? 40u : line->steps[a];
		scenario_add_ramp(motion, PASSO_VELOCITY_MAX >> speed, 0, PASSO_SHAPE_LINEAR);
		scenario_add_ramp(motion, PASSO_VELOCITY_MAX >> speed, ticks, PASSO_SHAPE_LINEAR);
		motion->ramps[motion->ramp_count - 1u].last = true;
		clocks += ticks * TICK_CLOCKS + MARGIN;
	}
	return clocks;
}

/* Switches that become active some time before the motions, or during them, and are open again after them. */
static uint64_t add_try(struct scenario *scenario, uint64_t clock)
{
	struct scenario_random *random = &scenario->random;
	struct motion motion = {0};
	const uint64_t moves = draw_motions(scenario, &motion);
	struct action lines = scenario_push_lines(scenario, 0, &motion),
		      ramps = scenario_push_ramps(scenario, 0, &motion);
	const uint64_t begins = clock + settles(scenario);
	const uint64_t runs = begins + frame_clocks(scenario, &lines) + frame_clocks(scenario, &ramps);
	const uint64_t ends = runs + moves + settles(scenario);

	for (unsigned i = 0; i < 2u; i++) {
		const enum passo_input input = i == 0u ? PASSO_INPUT_LIMIT_LOW : PASSO_INPUT_LIMIT_HIGH;
		const uint8_t mask =
		    (uint8_t)(scenario_draw(random, 1u << AXES) & scenario_draw(random, 1u << AXES));
		const uint64_t pressed = clock + scenario_draw(random, (uint32_t)(runs + moves - clock));

		turn_switch(scenario, input, mask, pressed);
		turn_switch(scenario, input, mask, ends);
	}
	read_state(scenario, clock);
	write_at(scenario, clock, channel_address(0, PASSO_CHANNEL_COMMAND),
	    1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	lines.at = begins;
	scenario_add(scenario, &lines);
	scenario_add(scenario, &ramps);
	return ends + settles(scenario);
}

void scenario_begin_starts(struct scenario *scenario, uint64_t seed, uint64_t number)
{
	uint64_t clock = 4000;

	memset(scenario, 0, sizeof *scenario);
	scenario->parameters = scenario_machine_parameters();
	scenario_seed(&scenario->random, seed, number);
	scenario->half_period = scenario->setup = 2;
	scenario->shaft_period = 1;
	set_up(scenario);
	for (unsigned i = 0; i < TRIES; i++)
		clock = add_try(scenario, clock);
	/* nothing is on the way when the end begins */
	write_at(scenario, clock, channel_address(0, PASSO_CHANNEL_COMMAND),
	    1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	scenario->prologue = scenario->count;
}
