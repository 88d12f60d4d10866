/* SPDX-License-Identifier: MIT
 * Setup of a history: parameters, settings and motions of every channel.
 */
#include "plot.h"

#include <string.h>

#include "plot_draw.h"

struct passo_parameters plot_parameters(unsigned set)
{
	static const struct passo_parameters sets[PLOT_SETS] = {
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

	return sets[set % PLOT_SETS];
}

static void set_up_channel(struct plot *plot, unsigned channel)
{
	struct plot_random *random = &plot->random;
	const bool constant = plot_chance(random, 40);
	uint32_t timing[PASSO_AXES_MAX];
	struct action action;

	for (unsigned a = 0; a < plot->parameters.axes; a++) {
		action = plot_frame(plot, PASSO_OPERATION_WRITE, axis_address(channel, a, PASSO_AXIS_PINS));
		timing[a] = plot_some_step_timing(plot);
		plot_add_word(&action, plot_some_pins(plot));
		plot_add_word(&action, timing[a]);
		plot_add_word(&action, constant ? 0x20002u : plot_some_dir_timing(plot));
		if (plot_chance(random, 85))
			plot_add(plot, &action);
		else
			timing[a] = 0;
	}
	if (plot_chance(random, 60)) {
		action = plot_rates(plot, channel, 0);
		if (plot_chance(random, 50))
			action.payload[1] = PASSO_RATE_ONE;
		plot_add(plot, &action);
	}
	plot_draw_motions(plot, channel, constant, timing);
}

/* A low rate that rises slowly during the motion, and that a stop must not raise. */
static void draw_rise(struct plot *plot, unsigned channel)
{
	struct action action =
	    plot_frame(plot, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_RATE_TARGET));

	plot_add_word(&action, plot_log(&plot->random, 2048, 32768));
	plot_add_word(&action, 1u + plot_draw(&plot->random, 64));
	plot_add_word(&action, plot_some_slew(plot));
	plot_add(plot, &action);
	action = plot_write_word(plot, channel_address(channel, PASSO_CHANNEL_RATE_TARGET), PASSO_RATE_ONE);
	action.clocks = 2000u + plot_draw(&plot->random, 1000);
	plot_add(plot, &action);
}

void plot_begin(struct plot *plot, uint64_t seed, uint64_t number)
{
	memset(plot, 0, sizeof *plot);
	plot->parameters = plot_parameters((unsigned)(number % PLOT_SETS));
	plot_seed(&plot->random, seed, number);
	struct plot_random *random = &plot->random;
	plot->half_period = plot_chance(random, 80) ? 2u : 3u;
	plot->setup = 2u + plot_draw(random, 4);
	const bool early = plot_chance(random, 25);
	const uint32_t waits =
	    plot_chance(random, 20) ? plot_draw(random, 1u << plot->parameters.channels) : 0u;
	struct action run =
	    plot_write_word(plot, PASSO_ADDRESS_RUN, plot_all_run(plot) | waits << PASSO_RUN_WAIT_SYNC_LSB);

	if (early)
		plot_add(plot, &run);
	for (unsigned c = 0; c < plot->parameters.channels; c++)
		set_up_channel(plot, c);
	const unsigned rising = plot_any_channel(plot);
	const bool rises = plot_chance(random, 25);
	if (!early && !rises)
		plot_add(plot, &run);
	plot->prologue = plot->count;
	if (rises) {
		draw_rise(plot, rising);
		if (!early) { /* between the two frames of the rise */
			plot->actions[plot->count] = plot->actions[plot->count - 1u];
			plot->actions[plot->count - 1u] = run;
			plot->count++;
			plot->prologue++;
		}
		plot->prologue++;
	}
	plot->waits = waits != 0u;
}
