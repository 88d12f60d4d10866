/* SPDX-License-Identifier: MIT
 * Random disturbances.
 */
#include <string.h>

#include "plot_draw.h"

static const struct {
	const char *name;
	uint32_t weights[2]; /* without and with a machine */
} kinds[PLOT_KINDS] = {
    [PLOT_STOP] = {"stop", {12, 5}},
    [PLOT_ABORT] = {"abort", {10, 3}},
    [PLOT_CLEAR] = {"clear", {4, 5}},
    [PLOT_ZERO] = {"zero", {10, 3}},
    [PLOT_COMMAND] = {"command bits", {4, 0}},
    [PLOT_RATE] = {"rate target", {8, 5}},
    [PLOT_RATES] = {"command and rates", {6, 0}},
    [PLOT_SLEW] = {"slews", {3, 0}},
    [PLOT_DRAIN] = {"drain velocity", {2, 0}},
    [PLOT_PINS] = {"pins", {8, 0}},
    [PLOT_ENABLE] = {"enable", {2, 4}},
    [PLOT_TIMING] = {"timing", {10, 0}},
    [PLOT_RUN] = {"run, wait for sync", {5, 0}},
    [PLOT_SYNC] = {"sync", {3, 0}},
    [PLOT_RESET] = {"core reset", {6, 4}},
    [PLOT_NOW] = {"NOW ramp", {8, 0}},
    [PLOT_MOTION] = {"lines or ramps", {6, 0}},
    [PLOT_TABLE] = {"table", {6, 0}},
    [PLOT_READ] = {"read", {4, 4}},
    [PLOT_BAD] = {"bad frame", {4, 0}},
    [PLOT_LIMIT] = {"limit", {0, 10}},
    [PLOT_ALARM] = {"alarm", {0, 8}},
    [PLOT_ESTOP] = {"e-stop", {0, 5}},
    [PLOT_HOME] = {"home", {0, 10}},
    [PLOT_PROBE] = {"probe", {0, 10}},
    [PLOT_NOISE] = {"noise", {0, 12}},
    [PLOT_TURN] = {"encoder", {0, 10}},
    [PLOT_ARM] = {"trigger", {0, 6}},
    [PLOT_SILENCE] = {"silence", {0, 2}},
    [PLOT_MEASURE] = {"measure", {0, 6}},
};

const char *plot_kind_name(enum plot_kind kind)
{
	return kinds[kind].name;
}

enum plot_kind plot_kind(struct plot *plot)
{
	const unsigned machine = plot->parameters.inputs;
	uint32_t sum = 0, drawn;
	unsigned kind = 0;

	for (unsigned i = 0; i < PLOT_KINDS; i++)
		sum += kinds[i].weights[machine];
	drawn = plot_draw(&plot->random, sum);
	while (drawn >= kinds[kind].weights[machine])
		drawn -= kinds[kind++].weights[machine];
	return (enum plot_kind)kind;
}

static struct action command(struct plot *plot, uint32_t bits)
{
	return plot_write_word(plot, channel_address(plot_any_channel(plot), PASSO_CHANNEL_COMMAND), bits);
}

/* Writes random values to consecutive timing registers. */
static struct action timings(struct plot *plot)
{
	const unsigned channel = plot_any_channel(plot),
		       axis = plot_draw(&plot->random, plot->parameters.axes);
	const unsigned which = plot_draw(&plot->random, 3);
	struct action action = plot_frame(plot, PASSO_OPERATION_WRITE,
	    axis_address(channel, axis, which == 1u ? PASSO_AXIS_DIR_TIMING : PASSO_AXIS_STEP_TIMING));

	if (which != 1u)
		plot_add_word(&action, plot_some_step_timing(plot));
	if (which != 0u)
		plot_add_word(&action, plot_some_dir_timing(plot));
	return action;
}

static struct action pins(struct plot *plot)
{
	const unsigned channel = plot_any_channel(plot),
		       axis = plot_draw(&plot->random, plot->parameters.axes);
	struct action action =
	    plot_frame(plot, PASSO_OPERATION_WRITE, axis_address(channel, axis, PASSO_AXIS_PINS));

	plot_add_word(&action, plot_some_pins(plot));
	if (plot_chance(&plot->random, 30))
		plot_add_word(&action, plot_some_step_timing(plot));
	return action;
}

static struct action now_ramp(struct plot *plot)
{
	struct motion motion = {0};
	const uint64_t velocity =
	    plot_chance(&plot->random, 40) ? 0u : PASSO_VELOCITY_MAX >> plot_draw(&plot->random, 5);

	plot_add_ramp(&motion, velocity, plot_draw(&plot->random, 6), PASSO_SHAPE_LINEAR);
	motion.ramps[0].now = true;
	motion.ramps[0].last = plot_chance(&plot->random, 60);
	return plot_push_ramps(plot, plot_any_channel(plot), &motion);
}

static struct action more_motion(struct plot *plot)
{
	const unsigned channel = plot_any_channel(plot);
	const uint32_t timing[PASSO_AXES_MAX] = {0};
	struct motion motion = {0};

	plot_draw_ramps(plot, &motion, false, plot_draw(&plot->random, 4));
	if (plot_chance(&plot->random, 50)) {
		motion.ramp_count = motion.ramp_count > 2u ? 2u : motion.ramp_count;
		return plot_push_ramps(plot, channel, &motion);
	}
	plot_draw_lines(plot, &motion, channel, false, 0, timing);
	motion.line_count = motion.line_count > 2u ? 2u : motion.line_count;
	return plot_push_lines(plot, channel, &motion);
}

static struct action table_points(struct plot *plot)
{
	const unsigned place = plot_draw(&plot->random, PASSO_BANKS * PASSO_BANK_POINTS - 4u);
	const unsigned first = passo_shape_addresses[place / PASSO_BANK_POINTS];
	struct action action =
	    plot_frame(plot, PASSO_OPERATION_WRITE, (uint16_t)(first + place % PASSO_BANK_POINTS));
	const unsigned count = 1u + plot_draw(&plot->random, 4);

	/* with any table a ramp stays between its ends */
	for (unsigned i = 0; i < count; i++)
		plot_add_word(&action, plot_draw(&plot->random, 0x10000));
	return action;
}

static struct action read(struct plot *plot)
{
	const bool positions = plot_chance(&plot->random, 50);
	struct action action = plot_frame(plot, PASSO_OPERATION_READ,
	    channel_address(
		plot_any_channel(plot), positions ? PASSO_CHANNEL_POSITION_BASE : PASSO_CHANNEL_STATE));

	action.length = positions ? plot->parameters.axes : 3u;
	return action;
}

static struct action bad_frame(struct plot *plot)
{
	struct action action = plot_disturbance(plot, (enum plot_kind)plot_draw(&plot->random, PLOT_SYNC));

	switch (plot_draw(&plot->random, 3)) {
	case 0:
		action.fault = FAULT_CRC;
		break;
	case 1:
		action.fault = FAULT_REPEATED;
		break;
	default:
		action.fault = FAULT_CUT;
		action.bits = (uint16_t)plot_draw(&plot->random, 32u * (action.length + 2u));
		break;
	}
	return action;
}

static struct action set_run(struct plot *plot)
{
	struct plot_random *random = &plot->random;
	const unsigned channels = plot->parameters.channels;
	const uint32_t run = plot_chance(random, 70) ? plot_all_run(plot) : plot_draw(random, 1u << channels);
	const uint32_t wait = plot_chance(random, 60) ? 0u : plot_draw(random, 1u << channels);
	const uint32_t status = plot_draw(random, channels);

	return plot_write_word(plot, PASSO_ADDRESS_RUN,
	    run << PASSO_RUN_RUN_LSB | wait << PASSO_RUN_WAIT_SYNC_LSB
	        | status << PASSO_RUN_STATUS_CHANNEL_LSB);
}

/* With a CLEAR in one of five. */
static struct action command_perhaps_clear(struct plot *plot, uint32_t bit)
{
	return command(
	    plot, bit | (plot_chance(&plot->random, 20) ? 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB : 0u));
}

/* After some disturbances the gaps between steps are unknown. */
static void forget_gaps(struct plot *plot, enum plot_kind kind)
{
	if (kind == PLOT_NOW || kind == PLOT_MOTION || kind == PLOT_TIMING || kind == PLOT_PINS
	    || kind == PLOT_DRAIN || kind == PLOT_RESET)
		memset(plot->gap_enabled, 0, sizeof plot->gap_enabled);
}

struct action plot_disturbance(struct plot *plot, enum plot_kind kind)
{
	struct plot_random *random = &plot->random;
	struct action action;

	forget_gaps(plot, kind);
	switch (kind) {
	case PLOT_STOP:
		return command(plot, 1u << PASSO_CHANNEL_COMMAND_STOP_LSB);
	case PLOT_ABORT:
		return command_perhaps_clear(plot, 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB);
	case PLOT_CLEAR:
		return command(plot, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	case PLOT_ZERO:
		return command_perhaps_clear(plot, 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB);
	case PLOT_COMMAND:
		return command(plot, plot_draw(random, 16));
	case PLOT_RATE:
		return plot_write_word(plot,
		    channel_address(plot_any_channel(plot), PASSO_CHANNEL_RATE_TARGET), plot_some_rate(plot));
	case PLOT_RATES:
		return plot_rates(plot, plot_any_channel(plot), plot_chance(random, 50) ? 1u : 0u);
	case PLOT_SLEW:
		action = plot_write_word(plot,
		    channel_address(plot_any_channel(plot), PASSO_CHANNEL_RATE_SLEW), plot_some_slew(plot));
		plot_add_word(&action, plot_some_slew(plot));
		return action;
	case PLOT_DRAIN:
		action = plot_write_word(plot,
		    channel_address(plot_any_channel(plot), PASSO_CHANNEL_DRAIN_VELOCITY),
		    plot_some_drain(plot));
		if (action.payload[0] == 0u)
			action.fault = FAULT_VALUE;
		return action;
	case PLOT_PINS:
		return pins(plot);
	case PLOT_ENABLE:
		return plot_write_word(plot,
		    axis_address(
			plot_any_channel(plot), plot_draw(random, plot->parameters.axes), PASSO_AXIS_ENABLE),
		    plot_chance(random, 70) ? 1u : 0u);
	case PLOT_TIMING:
		return timings(plot);
	case PLOT_RUN:
		return set_run(plot);
	case PLOT_SYNC:
		return (struct action){
		    .kind = ACTION_SYNC, .clocks = 1u + plot_draw(random, 20), .event = EVENT_KINDS};
	case PLOT_RESET:
		return (struct action){.kind = ACTION_RESET,
		    .clocks =
			plot_chance(random, 50) ? 1u + plot_draw(random, 8) : 24u + plot_draw(random, 40),
		    .event = EVENT_KINDS};
	case PLOT_NOW:
		return now_ramp(plot);
	case PLOT_MOTION:
		return more_motion(plot);
	case PLOT_TABLE:
		return table_points(plot);
	case PLOT_READ:
		return read(plot);
	case PLOT_BAD:
	case PLOT_KINDS:
		return bad_frame(plot);
	case PLOT_LIMIT:
	case PLOT_ALARM:
	case PLOT_ESTOP:
	case PLOT_HOME:
	case PLOT_PROBE:
	case PLOT_NOISE:
	case PLOT_TURN:
	case PLOT_ARM:
	case PLOT_SILENCE:
	case PLOT_MEASURE:
		break;
	}
	return plot_machine_event(plot, kind);
}
