/* SPDX-License-Identifier: MIT
 * Histories of a machine: switches, probe, e-stop, encoders and outputs, and what happens to them.
 */
#include <string.h>

#include "plot_draw.h"

/* Substeps of a line that is repeated. */
#define REPEATED 64u
#define TRIES 26u

struct passo_parameters plot_machine_parameters(void)
{
	return (struct passo_parameters){.channels = 1,
	    .axes = AXES,
	    .tick_log2 = 7,
	    .line_queue_log2 = 5,
	    .ramp_queue_log2 = 5,
	    .inputs = 1,
	    .encoders = 1,
	    .outputs = 1};
}

static void write(struct plot *plot, uint16_t address, uint32_t word)
{
	struct action action = plot_write_word(plot, address, word);

	action.clocks = 2;
	plot_add(plot, &action);
}

static void write_channel(struct plot *plot, unsigned place, uint32_t word)
{
	write(plot, channel_address(0, place), word);
}

/* Polarities, filters, limits, alarms; the levels of the inputs are those of open switches. */
static void set_up_inputs(struct plot *plot, bool tries)
{
	static const uint32_t filters[] = {0, 1, 2, 5, 20, 100};
	struct plot_random *random = &plot->random;

	plot->filter = filters[plot_draw(random, tries ? 3 : 6)];
	plot->levels = (struct passo_inputs)PASSO_INPUTS_IDLE;
	write(plot, PASSO_ADDRESS_INPUT_FILTER, plot->filter);
	for (unsigned a = 0; a < AXES; a++) {
		const uint32_t inverted = plot_draw(random, 16), rest = plot_draw(random, 8);

		plot->levels.limit_low |= (uint64_t)(inverted & 1u) << a;
		plot->levels.limit_high |= (uint64_t)(inverted >> 1 & 1u) << a;
		plot->levels.home |= (uint64_t)(inverted >> 2 & 1u) << a;
		plot->levels.alarm |= (uint64_t)(inverted >> 3 & 1u) << a;
		write(plot, axis_address(0, a, PASSO_AXIS_INPUTS), inverted | rest << 4);
		write(plot, axis_address(0, a, PASSO_AXIS_ENABLE), 1);
	}
	plot->levels.probe = plot_chance(random, 50) ? 1u : 0u;
	write_channel(plot, PASSO_CHANNEL_PROBE, plot->levels.probe);
}

static void set_up_encoders(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	plot->encoder_filter = plot_draw(random, 4);
	plot->coupled = (uint8_t)plot_draw(random, 1u << AXES);
	plot->shaft_period = plot->encoder_filter + 2u + plot_draw(random, 6);
	write_channel(plot, PASSO_CHANNEL_ENCODER_FILTER, plot->encoder_filter);
	for (unsigned a = 0; a < AXES; a++) {
		struct action action = plot_frame(plot, PASSO_OPERATION_WRITE,
		    channel_address(0,
			PASSO_CHANNEL_ENCODER_BASE + a * PASSO_CHANNEL_ENCODER_STRIDE + PASSO_ENCODER_SETUP));
		const uint32_t stop = plot_draw(random, 3) << PASSO_ENCODER_SETUP_STOP_SOFT_LSB;

		if ((plot->coupled >> a & 1u) == 0u)
			continue;
		plot_add_word(&action, stop);
		plot_add_word(&action, 0x10000);
		plot_add_word(&action, 40);
		plot_add(plot, &action);
	}
}

static void set_up_outputs(struct plot *plot)
{
	struct plot_random *random = &plot->random;
	struct action action =
	    plot_frame(plot, PASSO_OPERATION_WRITE, channel_address(0, PASSO_CHANNEL_COMPARE_PULSE));

	plot_add_word(&action,
	    plot_draw(random, AXES) << PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB | (1u + plot_draw(random, 40)));
	plot_add_word(&action, plot_draw(random, 30) - 15u);
	plot_add_word(
	    &action, plot_chance(random, 50) ? 1u + plot_draw(random, 9) : 0u - 1u - plot_draw(random, 9));
	plot_add(plot, &action);
	write_channel(plot, PASSO_CHANNEL_PWM_STEP, 1u << (14u + plot_draw(random, 8)));
}

static uint32_t some_output(struct plot *plot)
{
	return passo_pack_line_output(
	    &(struct passo_line_output){.levels = (uint8_t)plot_draw(&plot->random, 256),
		.proportional = plot_chance(&plot->random, 50),
		.power = (uint16_t)plot_log(&plot->random, 1, 65535)});
}

/* Slow enough for the pins and for an encoder that follows. */
static void set_up_motion(struct plot *plot)
{
	struct plot_random *random = &plot->random;
	const unsigned speed = 1u + plot_draw(random, 4);
	struct motion motion = {.line_count = 2};
	const uint32_t closest = ((plot->shaft_period + 14u) >> (speed + 1u)) + 1u;
	const uint32_t period = closest + plot_draw(random, 4);

	for (unsigned a = 0; a < AXES; a++) {
		struct action action =
		    plot_frame(plot, PASSO_OPERATION_WRITE, axis_address(0, a, PASSO_AXIS_PINS));

		plot_add_word(&action, plot_draw(random, 8) << PASSO_AXIS_PINS_STEP_INVERTED_LSB);
		plot_add_word(&action, (1u + plot_draw(random, 6)) << 16 | (1u + plot_draw(random, 6)));
		plot_add_word(&action, (1u + plot_draw(random, 4)) << 16 | (1u + plot_draw(random, 4)));
		plot_add(plot, &action);
	}
	for (unsigned i = 0; i < 2u; i++) {
		struct passo_line *line = &motion.lines[i];

		*line = (struct passo_line){.substeps = REPEATED * period,
		    .endless = i == 0u,
		    .last = i == 1u,
		    .directions = (uint8_t)plot_draw(random, 1u << AXES),
		    .output = some_output(plot)};
		for (unsigned a = 0; a < AXES; a++)
			line->steps[a] = a == 0u                 ? REPEATED
			               : plot_chance(random, 15) ? 0u
			                                         : plot_draw(random, REPEATED);
	}
	plot->gap_enabled[0][0] = period << (speed + 1u);
	plot_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, plot_draw(random, 3), PASSO_SHAPE_LINEAR);
	plot_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, 100000, PASSO_SHAPE_LINEAR);
	motion.ramps[1].last = true;
	const struct action lines = plot_push_lines(plot, 0, &motion);
	const struct action ramps = plot_push_ramps(plot, 0, &motion);
	plot_add(plot, &lines);
	plot_add(plot, &ramps);
}

/* A switch that is active before the host knows of it. */
static void close_early(struct plot *plot, enum passo_input input, uint8_t mask)
{
	const struct action action = {
	    .kind = ACTION_INPUT, .at = 10, .input = input, .mask = mask, .edges = 1, .event = EVENT_KINDS};

	plot_add(plot, &action);
}

/* Again and again a line towards switches that are active, or off them. */
static void add_tries(struct plot *plot)
{
	const uint8_t low = (uint8_t)plot_draw(&plot->random, 1u << AXES);

	close_early(plot, PASSO_INPUT_LIMIT_LOW, low);
	close_early(plot, PASSO_INPUT_LIMIT_HIGH, low ^ ((1u << AXES) - 1u));
	for (unsigned i = 0; i < TRIES; i++) {
		const uint32_t speed = plot_draw(&plot->random, 4);
		const uint8_t off = plot_chance(&plot->random, 10) ? 0xFFu : 0u;
		struct motion motion = {.line_count = 1};
		struct action ramps, line;

		motion.lines[0] = (struct passo_line){.last = true,
		    .substeps = 32u >> speed,
		    .directions = (uint8_t)((low ^ off) & ((1u << AXES) - 1u))};
		for (unsigned a = 0; a < AXES; a++)
			motion.lines[0].steps[a] = 1u + plot_draw(&plot->random, 4);
		plot_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, 0, PASSO_SHAPE_LINEAR);
		plot_add_ramp(&motion, PASSO_VELOCITY_MAX >> speed, 2, PASSO_SHAPE_LINEAR);
		motion.ramps[1].last = true;
		write_channel(plot, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
		line = plot_push_lines(plot, 0, &motion);
		ramps = plot_push_ramps(plot, 0, &motion);
		plot_add(plot, &line);
		plot_add(plot, &ramps);
	}
}

void plot_begin_pokes(struct plot *plot, uint64_t seed, uint64_t number)
{
	memset(plot, 0, sizeof *plot);
	plot->parameters = plot_machine_parameters();
	plot_seed(&plot->random, seed, number);
	plot->half_period = plot->setup = 2;
	plot->levels = (struct passo_inputs)PASSO_INPUTS_IDLE;
	plot->shaft_period = 1;
}

void plot_begin_machine(struct plot *plot, uint64_t seed, uint64_t number, bool tries)
{
	struct plot_random *random = &plot->random;

	memset(plot, 0, sizeof *plot);
	plot->parameters = plot_machine_parameters();
	plot_seed(random, seed, number);
	plot->half_period = 2;
	plot->setup = 2u + plot_draw(random, 4);
	set_up_inputs(plot, tries);
	write(plot, PASSO_ADDRESS_RUN, plot_all_run(plot));
	if (tries) {
		add_tries(plot);
		plot->prologue = plot->count;
		return;
	}
	set_up_encoders(plot);
	set_up_outputs(plot);
	if (plot_chance(random, 10))
		write(plot, PASSO_ADDRESS_WATCHDOG, 1);
	write_channel(plot, PASSO_CHANNEL_STOP_SLEW, plot_log(random, 1024, PASSO_RATE_ONE));
	write_channel(plot, PASSO_CHANNEL_COMMAND, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	if (plot_chance(random, 80))
		write_channel(plot, PASSO_CHANNEL_TRIGGER, plot_some_trigger(plot));
	set_up_motion(plot);
	if (plot_chance(random, 5))
		close_early(plot, PASSO_INPUT_ALARM, (uint8_t)(1u << plot_draw(random, AXES)));
	plot->prologue = plot->count;
}
