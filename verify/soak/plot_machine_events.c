/* SPDX-License-Identifier: MIT
 * What happens to a machine: inputs, encoders, the trigger, measurements.
 */
#include "plot_draw.h"

uint32_t plot_some_trigger(struct plot *plot)
{
	struct plot_random *random = &plot->random;
	static const enum passo_trigger_source sources[] = {PASSO_TRIGGER_SOURCE_HOME,
	    PASSO_TRIGGER_SOURCE_PROBE, PASSO_TRIGGER_SOURCE_PROBE, PASSO_TRIGGER_SOURCE_LIMIT_LOW,
	    PASSO_TRIGGER_SOURCE_LIMIT_HIGH};
	const struct passo_channel_trigger trigger = {.source = sources[plot_draw(random, 5)],
	    .axis = (uint8_t)plot_draw(random, AXES),
	    .falling = plot_chance(random, 25),
	    .action = (enum passo_trigger_action)plot_draw(random, 4),
	    .arm = plot_chance(random, 95)};

	return passo_pack_channel_trigger(&trigger);
}

static struct action pulse(struct plot *plot, enum passo_input input, uint32_t clocks)
{
	const bool of_axis = input != PASSO_INPUT_PROBE && input != PASSO_INPUT_ESTOP_N;

	return (struct action){.kind = ACTION_INPUT,
	    .clocks = clocks,
	    .input = input,
	    .mask = (uint8_t)(1u << (of_axis ? plot_draw(&plot->random, AXES) : 0u)),
	    .edges = 2,
	    .event = EVENT_KINDS};
}

/* An edge, or a pulse about as long as the filter. */
static struct action edge(struct plot *plot, enum passo_input input)
{
	struct action action =
	    pulse(plot, input, plot->filter + plot_draw(&plot->random, plot->filter + 4u) + 1u);

	if (plot_chance(&plot->random, 60))
		action.edges = 1;
	return action;
}

static struct action noise(struct plot *plot)
{
	struct plot_random *random = &plot->random;
	static const enum passo_input inputs[] = {PASSO_INPUT_LIMIT_LOW, PASSO_INPUT_LIMIT_HIGH,
	    PASSO_INPUT_HOME, PASSO_INPUT_ALARM, PASSO_INPUT_PROBE, PASSO_INPUT_ENCODER_A,
	    PASSO_INPUT_ENCODER_B, PASSO_INPUT_ENCODER_INDEX};
	const enum passo_input input = inputs[plot_draw(random, 8)];
	const uint32_t longest = input >= PASSO_INPUT_ENCODER_A ? plot->encoder_filter : plot->filter;
	struct action action = pulse(plot, input, 1u + plot_draw(random, longest));

	if (plot_chance(random, 30)) { /* flicker */
		action.clocks = 1;
		action.edges = (uint16_t)(2u * (1u + plot_draw(random, 100)));
	}
	return action;
}

static struct action measure(struct plot *plot)
{
	static const struct {
		uint16_t place, length;
	} reads[] = {{PASSO_CHANNEL_TRIGGER_STATE, 1}, {PASSO_CHANNEL_TRIGGER_POSITION_BASE, AXES},
	    {PASSO_CHANNEL_ENCODER_POSITION_BASE, AXES}, {PASSO_CHANNEL_INPUT_FLAGS, 1}};
	const unsigned i = plot_draw(&plot->random, 4);
	struct action action = plot_frame(plot, PASSO_OPERATION_READ, channel_address(0, reads[i].place));

	action.length = reads[i].length;
	return action;
}

struct action plot_machine_event(struct plot *plot, enum plot_kind kind)
{
	struct plot_random *random = &plot->random;
	struct action action;

	switch (kind) {
	case PLOT_LIMIT:
		return edge(plot, plot_chance(random, 50) ? PASSO_INPUT_LIMIT_LOW : PASSO_INPUT_LIMIT_HIGH);
	case PLOT_ALARM:
		return edge(plot, PASSO_INPUT_ALARM);
	case PLOT_ESTOP:
		return pulse(plot, PASSO_INPUT_ESTOP_N, plot_log(random, 1, 2000));
	case PLOT_HOME:
		return edge(plot, PASSO_INPUT_HOME);
	case PLOT_PROBE:
		return edge(plot, PASSO_INPUT_PROBE);
	case PLOT_TURN:
		action = pulse(plot, PASSO_INPUT_COUNT, 0);
		action.mask = (uint8_t)plot_draw(random, AXES);
		action.edges = 1;
		action.turn = (int32_t)plot_draw(random, 101) - 50;
		return action;
	case PLOT_ARM:
		return plot_write_word(
		    plot, channel_address(0, PASSO_CHANNEL_TRIGGER), plot_some_trigger(plot));
	case PLOT_SILENCE:
		action = measure(plot);
		action.clocks = 140000;
		return action;
	case PLOT_MEASURE:
		return measure(plot);
	default:
		return noise(plot);
	}
}
