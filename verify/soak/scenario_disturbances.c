/* SPDX-License-Identifier: MIT
 * Random disturbances.
 */
#include <string.h>

#include "scenario_draw.h"

static const struct {
	const char *name;
	uint32_t weights[2]; /* without and with a machine */
} kinds[SCENARIO_KINDS] = {
    [SCENARIO_STOP] = {"stop", {12, 5}},
    [SCENARIO_ABORT] = {"abort", {10, 3}},
    [SCENARIO_CLEAR] = {"clear", {4, 5}},
    [SCENARIO_ZERO] = {"zero", {10, 3}},
    [SCENARIO_COMMAND] = {"command bits", {4, 0}},
    [SCENARIO_RATE] = {"rate target", {8, 5}},
    [SCENARIO_RATES] = {"command and rates", {6, 0}},
    [SCENARIO_SLEW] = {"slews", {3, 0}},
    [SCENARIO_DRAIN] = {"drain velocity", {2, 0}},
    [SCENARIO_PINS] = {"pins", {8, 0}},
    [SCENARIO_ENABLE] = {"enable", {2, 4}},
    [SCENARIO_TIMING] = {"timing", {10, 0}},
    [SCENARIO_RUN] = {"run, wait for sync", {5, 0}},
    [SCENARIO_SYNC] = {"sync", {3, 0}},
    [SCENARIO_RESET] = {"core reset", {6, 4}},
    [SCENARIO_NOW] = {"NOW ramp", {8, 0}},
    [SCENARIO_MOTION] = {"lines or ramps", {6, 0}},
    [SCENARIO_TABLE] = {"table", {6, 0}},
    [SCENARIO_READ] = {"read", {4, 4}},
    [SCENARIO_BAD] = {"bad frame", {4, 0}},
    [SCENARIO_LIMIT] = {"limit", {0, 10}},
    [SCENARIO_ALARM] = {"alarm", {0, 8}},
    [SCENARIO_ESTOP] = {"e-stop", {0, 5}},
    [SCENARIO_HOME] = {"home", {0, 10}},
    [SCENARIO_PROBE] = {"probe", {0, 10}},
    [SCENARIO_NOISE] = {"noise", {0, 12}},
    [SCENARIO_TURN] = {"encoder", {0, 10}},
    [SCENARIO_ARM] = {"trigger", {0, 6}},
    [SCENARIO_SILENCE] = {"silence", {0, 2}},
    [SCENARIO_MEASURE] = {"measure", {0, 6}},
};

const char *scenario_kind_name(enum scenario_kind kind)
{
	return kinds[kind].name;
}

enum scenario_kind scenario_kind(struct scenario *scenario)
{
	const unsigned machine = scenario->parameters.inputs;
	uint32_t sum = 0, drawn;
	unsigned kind = 0;

	for (unsigned i = 0; i < SCENARIO_KINDS; i++)
		sum += kinds[i].weights[machine];
	drawn = scenario_draw(&scenario->random, sum);
	while (drawn >= kinds[kind].weights[machine])
		drawn -= kinds[kind++].weights[machine];
	return (enum scenario_kind)kind;
}

static struct action command(struct scenario *scenario, uint32_t bits)
{
	return scenario_write_word(
	    scenario, channel_address(scenario_any_channel(scenario), PASSO_CHANNEL_COMMAND), bits);
}

/* Writes random values to consecutive timing registers. */
static struct action timings(struct scenario *scenario)
{
	const unsigned channel = scenario_any_channel(scenario),
		       axis = scenario_draw(&scenario->random, scenario->parameters.axes);
	const unsigned which = scenario_draw(&scenario->random, 3);
	struct action action = scenario_frame(scenario, PASSO_OPERATION_WRITE,
	    axis_address(channel, axis, which == 1u ? PASSO_AXIS_DIR_TIMING : PASSO_AXIS_STEP_TIMING));

	if (which != 1u)
		scenario_add_word(&action, scenario_some_step_timing(scenario));
	if (which != 0u)
		scenario_add_word(&action, scenario_some_dir_timing(scenario));
	return action;
}

static struct action pins(struct scenario *scenario)
{
	const unsigned channel = scenario_any_channel(scenario),
		       axis = scenario_draw(&scenario->random, scenario->parameters.axes);
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_WRITE, axis_address(channel, axis, PASSO_AXIS_PINS));

	scenario_add_word(&action, scenario_some_pins(scenario));
	if (scenario_chance(&scenario->random, 30))
		scenario_add_word(&action, scenario_some_step_timing(scenario));
	return action;
}

static struct action now_ramp(struct scenario *scenario)
{
	struct motion motion = {0};
	const uint64_t velocity = scenario_chance(&scenario->random, 40)
	                            ? 0u
	                            : PASSO_VELOCITY_MAX >> scenario_draw(&scenario->random, 5);

	scenario_add_ramp(&motion, velocity, scenario_draw(&scenario->random, 6), PASSO_SHAPE_LINEAR);
	motion.ramps[0].now = true;
	motion.ramps[0].last = scenario_chance(&scenario->random, 60);
	return scenario_push_ramps(scenario, scenario_any_channel(scenario), &motion);
}

static struct action more_motion(struct scenario *scenario)
{
	const unsigned channel = scenario_any_channel(scenario);
	const uint32_t timing[PASSO_AXES_MAX] = {0};
	struct motion motion = {0};

	scenario_draw_ramps(scenario, &motion, false, scenario_draw(&scenario->random, 4));
	if (scenario_chance(&scenario->random, 50)) {
		motion.ramp_count = motion.ramp_count > 2u ? 2u : motion.ramp_count;
		return scenario_push_ramps(scenario, channel, &motion);
	}
	scenario_draw_lines(scenario, &motion, channel, false, 0, timing);
	motion.line_count = motion.line_count > 2u ? 2u : motion.line_count;
	return scenario_push_lines(scenario, channel, &motion);
}

static struct action table_points(struct scenario *scenario)
{
	const unsigned place = scenario_draw(&scenario->random, PASSO_BANKS * PASSO_BANK_POINTS - 4u);
	const unsigned first = passo_shape_addresses[place / PASSO_BANK_POINTS];
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_WRITE, (uint16_t)(first + place % PASSO_BANK_POINTS));
	const unsigned count = 1u + scenario_draw(&scenario->random, 4);

	/* with any table a ramp stays between its ends */
	for (unsigned i = 0; i < count; i++)
		scenario_add_word(&action, scenario_draw(&scenario->random, 0x10000));
	return action;
}

static struct action read(struct scenario *scenario)
{
	const bool positions = scenario_chance(&scenario->random, 50);
	struct action action = scenario_frame(scenario, PASSO_OPERATION_READ,
	    channel_address(scenario_any_channel(scenario),
		positions ? PASSO_CHANNEL_POSITION_BASE : PASSO_CHANNEL_STATE));

	action.length = positions ? scenario->parameters.axes : 3u;
	return action;
}

static struct action bad_frame(struct scenario *scenario)
{
	struct action action = scenario_disturbance(
	    scenario, (enum scenario_kind)scenario_draw(&scenario->random, SCENARIO_SYNC));

	switch (scenario_draw(&scenario->random, 3)) {
	case 0:
		action.fault = FAULT_CRC;
		break;
	case 1:
		action.fault = FAULT_REPEATED;
		break;
	default:
		action.fault = FAULT_CUT;
		action.bits = (uint16_t)scenario_draw(&scenario->random, 32u * (action.length + 2u));
		break;
	}
	return action;
}

static struct action set_run(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;
	const unsigned channels = scenario->parameters.channels;
	const uint32_t run =
	    scenario_chance(random, 70) ? scenario_all_run(scenario) : scenario_draw(random, 1u << channels);
	const uint32_t wait = scenario_chance(random, 60) ? 0u : scenario_draw(random, 1u << channels);
	const uint32_t status = scenario_draw(random, channels);

	return scenario_write_word(scenario, PASSO_ADDRESS_RUN,
	    run << PASSO_RUN_RUN_LSB | wait << PASSO_RUN_WAIT_SYNC_LSB
	        | status << PASSO_RUN_STATUS_CHANNEL_LSB);
}

/* With a CLEAR in one of five. */
static struct action command_perhaps_clear(struct scenario *scenario, uint32_t bit)
{
	return command(scenario,
	    bit | (scenario_chance(&scenario->random, 20) ? 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB : 0u));
}

/* After some disturbances the gaps between steps are unknown. */
static void forget_gaps(struct scenario *scenario, enum scenario_kind kind)
{
	if (kind == SCENARIO_NOW || kind == SCENARIO_MOTION || kind == SCENARIO_TIMING
	    || kind == SCENARIO_PINS || kind == SCENARIO_DRAIN || kind == SCENARIO_RESET)
		memset(scenario->gap_enabled, 0, sizeof scenario->gap_enabled);
}

struct action scenario_disturbance(struct scenario *scenario, enum scenario_kind kind)
{
	struct scenario_random *random = &scenario->random;
	struct action action;

	forget_gaps(scenario, kind);
	switch (kind) {
	case SCENARIO_STOP:
		return command(scenario, 1u << PASSO_CHANNEL_COMMAND_STOP_LSB);
	case SCENARIO_ABORT:
		return command_perhaps_clear(scenario, 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB);
	case SCENARIO_CLEAR:
		return command(scenario, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	case SCENARIO_ZERO:
		return command_perhaps_clear(scenario, 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB);
	case SCENARIO_COMMAND:
		return command(scenario, scenario_draw(random, 16));
	case SCENARIO_RATE:
		return scenario_write_word(scenario,
		    channel_address(scenario_any_channel(scenario), PASSO_CHANNEL_RATE_TARGET),
		    scenario_some_rate(scenario));
	case SCENARIO_RATES:
		return scenario_rates(
		    scenario, scenario_any_channel(scenario), scenario_chance(random, 50) ? 1u : 0u);
	case SCENARIO_SLEW:
		action = scenario_write_word(scenario,
		    channel_address(scenario_any_channel(scenario), PASSO_CHANNEL_RATE_SLEW),
		    scenario_some_slew(scenario));
		scenario_add_word(&action, scenario_some_slew(scenario));
		return action;
	case SCENARIO_DRAIN:
		action = scenario_write_word(scenario,
		    channel_address(scenario_any_channel(scenario), PASSO_CHANNEL_DRAIN_VELOCITY),
		    scenario_some_drain(scenario));
		if (action.payload[0] == 0u)
			action.fault = FAULT_VALUE;
		return action;
	case SCENARIO_PINS:
		return pins(scenario);
	case SCENARIO_ENABLE:
		return scenario_write_word(scenario,
		    axis_address(scenario_any_channel(scenario),
			scenario_draw(random, scenario->parameters.axes), PASSO_AXIS_ENABLE),
		    scenario_chance(random, 70) ? 1u : 0u);
	case SCENARIO_TIMING:
		return timings(scenario);
	case SCENARIO_RUN:
		return set_run(scenario);
	case SCENARIO_SYNC:
		return (struct action){
		    .kind = ACTION_SYNC, .clocks = 1u + scenario_draw(random, 20), .event = EVENT_KINDS};
	case SCENARIO_RESET:
		return (struct action){.kind = ACTION_RESET,
		    .clocks = scenario_chance(random, 50) ? 1u + scenario_draw(random, 8)
		                                          : 24u + scenario_draw(random, 40),
		    .event = EVENT_KINDS};
	case SCENARIO_NOW:
		return now_ramp(scenario);
	case SCENARIO_MOTION:
		return more_motion(scenario);
	case SCENARIO_TABLE:
		return table_points(scenario);
	case SCENARIO_READ:
		return read(scenario);
	case SCENARIO_BAD:
	case SCENARIO_KINDS:
		return bad_frame(scenario);
	case SCENARIO_LIMIT:
	case SCENARIO_ALARM:
	case SCENARIO_ESTOP:
	case SCENARIO_HOME:
	case SCENARIO_PROBE:
	case SCENARIO_NOISE:
	case SCENARIO_TURN:
	case SCENARIO_ARM:
	case SCENARIO_SILENCE:
	case SCENARIO_MEASURE:
		break;
	}
	return scenario_machine_event(scenario, kind);
}
