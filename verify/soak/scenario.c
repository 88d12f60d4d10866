/* SPDX-License-Identifier: MIT
 * Setup of a history: parameters, settings and motions of every channel.
 */
#include "scenario.h"

#include <string.h>

#include "scenario_draw.h"

struct passo_parameters scenario_parameters(unsigned set)
{
	static const struct passo_parameters sets[SCENARIO_SETS] = {
	    {.channels = 1, .axes = 1, .tick_log2 = 7, .line_queue_log2 = 5, .ramp_queue_log2 = 3},
	    {.channels = 1,
		.axes = 3,
		.tick_log2 = 7,
		.line_queue_log2 = 2,
		.ramp_queue_log2 = 2,
		.step_reset = 5,
		.dir_reset = 3,
		.enable_reset = 6},
	    {.channels = 2,
		.axes = 2,
		.tick_log2 = 7,
		.line_queue_log2 = 3,
		.ramp_queue_log2 = 4,
		.step_reset = 1,
		.dir_reset = 4,
		.enable_reset = 15},
	};

	return sets[set % SCENARIO_SETS];
}

static void set_up_channel(struct scenario *scenario, unsigned channel)
{
	struct scenario_random *random = &scenario->random;
	const bool constant = scenario_chance(random, 40);
	uint32_t timing[PASSO_AXES_MAX];
	struct action action;

	for (unsigned a = 0; a < scenario->parameters.axes; a++) {
		action = scenario_frame(
		    scenario, PASSO_OPERATION_WRITE, axis_address(channel, a, PASSO_AXIS_PINS));
		timing[a] = scenario_some_step_timing(scenario);
		scenario_add_word(&action, scenario_some_pins(scenario));
		scenario_add_word(&action, timing[a]);
		scenario_add_word(&action, constant ? 0x20002u : scenario_some_dir_timing(scenario));
		if (scenario_chance(random, 85))
			scenario_add(scenario, &action);
		else
			timing[a] = 0;
	}
	if (scenario_chance(random, 60)) {
		action = scenario_rates(scenario, channel, 0);
		if (scenario_chance(random, 50))
			action.payload[1] = PASSO_RATE_ONE;
		scenario_add(scenario, &action);
	}
	scenario_draw_motions(scenario, channel, constant, timing);
}

/* A low rate that rises slowly during the motion, and that a stop must not raise. */
static void draw_rise(struct scenario *scenario, unsigned channel)
{
	struct action action = scenario_frame(
	    scenario, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_RATE_TARGET));

	scenario_add_word(&action, scenario_log(&scenario->random, 2048, 32768));
	scenario_add_word(&action, 1u + scenario_draw(&scenario->random, 64));
	scenario_add_word(&action, scenario_some_slew(scenario));
	scenario_add(scenario, &action);
	action = scenario_write_word(
	    scenario, channel_address(channel, PASSO_CHANNEL_RATE_TARGET), PASSO_RATE_ONE);
	action.clocks = 2000u + scenario_draw(&scenario->random, 1000);
	scenario_add(scenario, &action);
}

void scenario_begin(struct scenario *scenario, uint64_t seed, uint64_t number)
{
	memset(scenario, 0, sizeof *scenario);
	scenario->parameters = scenario_parameters((unsigned)(number % SCENARIO_SETS));
	scenario_seed(&scenario->random, seed, number);
	struct scenario_random *random = &scenario->random;
	scenario->half_period = scenario_chance(random, 80) ? 2u : 3u;
	scenario->setup = 2u + scenario_draw(random, 4);
	const bool early = scenario_chance(random, 25);
	const uint32_t waits =
	    scenario_chance(random, 20) ? scenario_draw(random, 1u << scenario->parameters.channels) : 0u;
	struct action run = scenario_write_word(
	    scenario, PASSO_ADDRESS_RUN, scenario_all_run(scenario) | waits << PASSO_RUN_WAIT_SYNC_LSB);

	if (early)
		scenario_add(scenario, &run);
	for (unsigned c = 0; c < scenario->parameters.channels; c++)
		set_up_channel(scenario, c);
	const unsigned rising = scenario_any_channel(scenario);
	const bool rises = scenario_chance(random, 25);
	if (!early && !rises)
		scenario_add(scenario, &run);
	scenario->prologue = scenario->count;
	if (rises) {
		draw_rise(scenario, rising);
		if (!early) { /* between the two frames of the rise */
			scenario->actions[scenario->count] = scenario->actions[scenario->count - 1u];
			scenario->actions[scenario->count - 1u] = run;
			scenario->count++;
			scenario->prologue++;
		}
		scenario->prologue++;
	}
	scenario->waits = waits != 0u;
}
