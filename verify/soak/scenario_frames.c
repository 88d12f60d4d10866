/* SPDX-License-Identifier: MIT
 * Frames, and random register values.
 */
#include "scenario_draw.h"

/* Clocks that chip select stays high: short, or the minimum. */
static uint32_t gap(struct scenario *scenario)
{
	return scenario_chance(&scenario->random, 40) ? 2u : 2u + scenario_draw(&scenario->random, 60);
}

struct action scenario_frame(struct scenario *scenario, enum passo_operation operation, uint16_t address)
{
	return (struct action){.kind = ACTION_FRAME,
	    .clocks = gap(scenario),
	    .operation = (uint16_t)operation,
	    .address = address,
	    .event = EVENT_KINDS};
}

void scenario_add_word(struct action *action, uint32_t word)
{
	action->payload[action->length++] = word;
}

struct action scenario_write_word(struct scenario *scenario, uint16_t address, uint32_t word)
{
	struct action action = scenario_frame(scenario, PASSO_OPERATION_WRITE, address);

	scenario_add_word(&action, word);
	return action;
}

void scenario_add(struct scenario *scenario, const struct action *action)
{
	if (scenario->count < SCENARIO_ACTIONS_MAX)
		scenario->actions[scenario->count++] = *action;
}

unsigned scenario_any_channel(struct scenario *scenario)
{
	return scenario_draw(&scenario->random, scenario->parameters.channels);
}

uint32_t scenario_some_pins(struct scenario *scenario)
{
	const uint32_t both = scenario_chance(&scenario->random, 20) ? 1u : 0u;

	return scenario_draw(&scenario->random, 8) << PASSO_AXIS_PINS_STEP_INVERTED_LSB
	     | both << PASSO_AXIS_PINS_BOTH_EDGES_LSB;
}

static uint32_t some_time(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;

	if (scenario_chance(random, 60))
		return scenario_draw(random, 4); /* 0 counts as 1 */
	return scenario_chance(random, 80) ? 1u + scenario_draw(random, 30) : scenario_log(random, 32, 1500);
}

uint32_t scenario_some_step_timing(struct scenario *scenario)
{
	const uint32_t high = some_time(scenario);

	return (high > 200u ? 200u : high) << 16 | (some_time(scenario) & 0xFFu);
}

uint32_t scenario_some_dir_timing(struct scenario *scenario)
{
	const uint32_t setup = scenario_chance(&scenario->random, 10)
	                         ? scenario_log(&scenario->random, 64, 1024)
	                         : some_time(scenario);

	return setup << 16 | some_time(scenario);
}

uint32_t scenario_some_rate(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;

	if (scenario->parameters.outputs != 0u && scenario_chance(random, 50))
		return 0; /* a hold takes the power away */
	return scenario_chance(random, 40) ? PASSO_RATE_ONE
	     : scenario_chance(random, 30) ? 0u
	                                   : scenario_log(random, 256, PASSO_RATE_ONE);
}

uint32_t scenario_some_slew(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;

	return scenario_chance(random, 25) ? PASSO_RATE_ONE
	     : scenario_chance(random, 25) ? scenario_draw(random, 3)
	                                   : scenario_log(random, 16, PASSO_RATE_ONE);
}

uint32_t scenario_some_drain(struct scenario *scenario)
{
	return scenario_chance(&scenario->random, 15) ? 0u
	                                              : scenario_log(&scenario->random, 1u << 24, 1u << 31);
}

struct action scenario_rates(struct scenario *scenario, unsigned channel, uint32_t command)
{
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_COMMAND));
	const uint32_t drain = scenario_some_drain(scenario);

	scenario_add_word(&action, command);
	scenario_add_word(&action, scenario_some_rate(scenario));
	scenario_add_word(&action, scenario_some_slew(scenario));
	scenario_add_word(&action, scenario_some_slew(scenario));
	scenario_add_word(&action, drain == 0u ? 1u << 30 : drain);
	return action;
}

uint32_t scenario_all_run(const struct scenario *scenario)
{
	return ((1u << scenario->parameters.channels) - 1u) << PASSO_RUN_RUN_LSB;
}
