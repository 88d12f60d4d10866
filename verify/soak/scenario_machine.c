/* SPDX-License-Identifier: MIT
 * Histories of a machine: switches, probe, e-stop, encoders and outputs, and what happens to them.
 */
#include <string.h>

#include "scenario_draw.h"

/* Substeps of a line that is repeated. */
#define REPEATED 64u
#define TRIES 26u

struct passo_parameters scenario_machine_parameters(void)
{
	return (struct passo_parameters){.channels = 1,
	    .axes = AXES,
	    .tick_log2 = 7,
	    .line_queue_log2 = 5,
	    .ramp_queue_log2 = 5,
	    .inputs = 1,
	    .encoders = 1,
	    .outputs = 1,
	    .raster = 1,
	    .compare = 1};
}

static void write(struct scenario *scenario, uint16_t address, uint32_t word)
{
	struct action action = scenario_write_word(scenario, address, word);

	action.clocks = 2;
	scenario_add(scenario, &action);
}

static void write_channel(struct scenario *scenario, unsigned place, uint32_t word)
{
	write(scenario, channel_address(0, place), word);
}

/* Polarities, filters, limits, alarms; the levels of the inputs are those of open switches. */
static void set_up_inputs(struct scenario *scenario, bool tries)
{
	static const uint32_t filters[] = {0, 1, 2, 5, 20, 100};
	struct scenario_random *random = &scenario->random;

	scenario->filter = filters[scenario_draw(random, tries ? 3 : 6)];
	scenario->levels = (struct passo_inputs)PASSO_INPUTS_IDLE;
	write(scenario, PASSO_ADDRESS_INPUT_FILTER, scenario->filter);
	for (unsigned a = 0; a < AXES; a++) {
		const uint32_t inverted = scenario_draw(random, 16), rest = scenario_draw(random, 8);

		scenario->levels.limit_low |= (uint64_t)(inverted & 1u) << a;
		scenario->levels.limit_high |= (uint64_t)(inverted >> 1 & 1u) << a;
		scenario->levels.home |= (uint64_t)(inverted >> 2 & 1u) << a;
		scenario->levels.alarm |= (uint64_t)(inverted >> 3 & 1u) << a;
		write(scenario, axis_address(0, a, PASSO_AXIS_INPUTS), inverted | rest << 4);
		write(scenario, axis_address(0, a, PASSO_AXIS_ENABLE), 1);
	}
	scenario->levels.probe = scenario_chance(random, 50) ? 1u : 0u;
	write_channel(scenario, PASSO_CHANNEL_PROBE, scenario->levels.probe);
}

static void set_up_encoders(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;

	scenario->encoder_filter = scenario_draw(random, 4);
	scenario->coupled = (uint8_t)scenario_draw(random, 1u << AXES);
	scenario->shaft_period = scenario->encoder_filter + 2u + scenario_draw(random, 6);
	write_channel(scenario, PASSO_CHANNEL_ENCODER_FILTER, scenario->encoder_filter);
	for (unsigned a = 0; a < AXES; a++) {
		struct action action = scenario_frame(scenario, PASSO_OPERATION_WRITE,
		    channel_address(0,
			PASSO_CHANNEL_ENCODER_BASE + a * PASSO_CHANNEL_ENCODER_STRIDE + PASSO_ENCODER_SETUP));
		const uint32_t stop = scenario_draw(random, 3) << PASSO_ENCODER_SETUP_STOP_SOFT_LSB;

		if ((scenario->coupled >> a & 1u) == 0u)
			continue;
		scenario_add_word(&action, stop);
		scenario_add_word(&action, 0x10000);
		scenario_add_word(&action, 40);
		scenario_add(scenario, &action);
	}
}

static void set_up_outputs(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_COMPARE_PULSE));

	scenario_add_word(&action, scenario_draw(random, AXES) << PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB
	                               | (1u + scenario_draw(random, 40)));
	scenario_add_word(&action, scenario_draw(random, 30) - 15u);
	scenario_add_word(&action,
	    scenario_chance(random, 50) ? 1u + scenario_draw(random, 9) : 0u - 1u - scenario_draw(random, 9));
	scenario_add(scenario, &action);
	write_channel(scenario, PASSO_CHANNEL_PWM_STEP, 1u << (14u + scenario_draw(random, 8)));
}

static uint32_t some_output(struct scenario *scenario)
{
	return passo_pack_line_output(
	    &(struct passo_line_output){.levels = (uint8_t)scenario_draw(&scenario->random, 256),
		.proportional = scenario_chance(&scenario->random, 50),
		.power = (uint16_t)scenario_log(&scenario->random, 1, 65535)});
}

/* Slow enough for the pins and for an encoder that follows. */
static void set_up_motion(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;
	const unsigned speed = 1u + scenario_draw(random, 4);
	struct motion motion = {.line_count = 2};
	const uint32_t closest = ((scenario->shaft_period + 14u) >> (speed + 1u)) + 1u;
	const uint32_t period = closest + scenario_draw(random, 4);

	for (unsigned a = 0; a < AXES; a++) {
		struct action action =
		    scenario_frame(scenario, PASSO_OPERATION_WRITE, axis_address(0, a, PASSO_AXIS_PINS));

		scenario_add_word(&action, scenario_draw(random, 8) << PASSO_AXIS_PINS_STEP_INVERTED_LSB);
		scenario_add_word(
		    &action, (1u + scenario_draw(random, 6)) << 16 | (1u + scenario_draw(random, 6)));
		scenario_add_word(
		    &action, (1u + scenario_draw(random, 4)) << 16 | (1u + scenario_draw(random, 4)));
		scenario_add(scenario, &action);
	}
	for (unsigned i = 0; i < 2u; i++) {
		struct passo_line *line = &motion.lines[i];

		*line = (struct passo_line){.substeps = REPEATED * period,
		    .endless = i == 0u,
		    .last = i == 1u,
		    .directions = (uint8_t)scenario_draw(random, 1u << AXES),
		    .output = some_output(scenario)};
		for (unsigned a = 0; a < AXES; a++)
			line->steps[a] = a == 0u                     ? REPEATED
			               : scenario_chance(random, 15) ? 0u
			                                             : scenario_draw(random, REPEATED);
	}
	scenario->gap_enabled[0][0] = period << (speed + 1u);
	scenario_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, scenario_draw(random, 3), PASSO_SHAPE_LINEAR);
	scenario_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, 100000, PASSO_SHAPE_LINEAR);
	motion.ramps[1].last = true;
	const struct action lines = scenario_push_lines(scenario, 0, &motion);
	const struct action ramps = scenario_push_ramps(scenario, 0, &motion);
	scenario_add(scenario, &lines);
	scenario_add(scenario, &ramps);
}

/* A switch that is active before the host knows of it. */
static void close_early(struct scenario *scenario, enum passo_input input, uint8_t mask)
{
	const struct action action = {
	    .kind = ACTION_INPUT, .at = 10, .input = input, .mask = mask, .edges = 1, .event = EVENT_KINDS};

	scenario_add(scenario, &action);
}

/* Again and again a line toward switches that are active, or off them. */
static void add_tries(struct scenario *scenario)
{
	const uint8_t low = (uint8_t)scenario_draw(&scenario->random, 1u << AXES);

	close_early(scenario, PASSO_INPUT_LIMIT_LOW, low);
	close_early(scenario, PASSO_INPUT_LIMIT_HIGH, low ^ ((1u << AXES) - 1u));
	for (unsigned i = 0; i < TRIES; i++) {
		const uint32_t speed = scenario_draw(&scenario->random, 4);
		const uint8_t off = scenario_chance(&scenario->random, 10) ? 0xFFu : 0u;
		struct motion motion = {.line_count = 1};
		struct action ramps, line;

		motion.lines[0] = (struct passo_line){.last = true,
		    .substeps = 32u >> speed,
		    .directions = (uint8_t)((low ^ off) & ((1u << AXES) - 1u))};
		for (unsigned a = 0; a < AXES; a++)
			motion.lines[0].steps[a] = 1u + scenario_draw(&scenario->random, 4);
		scenario_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, 0, PASSO_SHAPE_LINEAR);
		scenario_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, 2, PASSO_SHAPE_LINEAR);
		motion.ramps[1].last = true;
		write_channel(scenario, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
		line = scenario_push_lines(scenario, 0, &motion);
		ramps = scenario_push_ramps(scenario, 0, &motion);
		scenario_add(scenario, &line);
		scenario_add(scenario, &ramps);
	}
}

void scenario_begin_pokes(struct scenario *scenario, uint64_t seed, uint64_t number)
{
	memset(scenario, 0, sizeof *scenario);
	scenario->parameters = scenario_machine_parameters();
	scenario_seed(&scenario->random, seed, number);
	scenario->half_period = scenario->setup = 2;
	scenario->levels = (struct passo_inputs)PASSO_INPUTS_IDLE;
	scenario->shaft_period = 1;
}

void scenario_begin_machine(struct scenario *scenario, uint64_t seed, uint64_t number, bool tries)
{
	struct scenario_random *random = &scenario->random;

	memset(scenario, 0, sizeof *scenario);
	scenario->parameters = scenario_machine_parameters();
	scenario_seed(random, seed, number);
	scenario->half_period = 2;
	scenario->setup = 2u + scenario_draw(random, 4);
	set_up_inputs(scenario, tries);
	write(scenario, PASSO_ADDRESS_RUN, scenario_all_run(scenario));
	if (tries) {
		add_tries(scenario);
		scenario->prologue = scenario->count;
		return;
	}
	set_up_encoders(scenario);
	set_up_outputs(scenario);
	if (scenario_chance(random, 10))
		write(scenario, PASSO_ADDRESS_WATCHDOG, 1);
	write_channel(scenario, PASSO_CHANNEL_STOP_SLEW, scenario_log(random, 1024, PASSO_RATE_ONE));
	write_channel(scenario, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	if (scenario_chance(random, 80))
		write_channel(scenario, PASSO_CHANNEL_TRIGGER, scenario_some_trigger(scenario));
	set_up_motion(scenario);
	if (scenario_chance(random, 5))
		close_early(scenario, PASSO_INPUT_ALARM, (uint8_t)(1u << scenario_draw(random, AXES)));
	scenario->prologue = scenario->count;
}
