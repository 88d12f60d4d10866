/* SPDX-License-Identifier: MIT
 * What happens to a machine: inputs, encoders, the trigger, measurements.
 */
#include "scenario_draw.h"

uint32_t scenario_some_trigger(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;
	static const enum passo_trigger_source sources[] = {PASSO_TRIGGER_SOURCE_HOME,
	    PASSO_TRIGGER_SOURCE_PROBE, PASSO_TRIGGER_SOURCE_PROBE, PASSO_TRIGGER_SOURCE_LIMIT_LOW,
	    PASSO_TRIGGER_SOURCE_LIMIT_HIGH};
	const struct passo_channel_trigger trigger = {.source = sources[scenario_draw(random, 5)],
	    .axis = (uint8_t)scenario_draw(random, AXES),
	    .falling = scenario_chance(random, 25),
	    .action = (enum passo_trigger_action)scenario_draw(random, 4),
	    .arm = scenario_chance(random, 95)};

	return passo_pack_channel_trigger(&trigger);
}

static struct action pulse(struct scenario *scenario, enum passo_input input, uint32_t clocks)
{
	const bool of_axis = input != PASSO_INPUT_PROBE && input != PASSO_INPUT_ESTOP_N;

	return (struct action){.kind = ACTION_INPUT,
	    .clocks = clocks,
	    .input = input,
	    .mask = (uint8_t)(1u << (of_axis ? scenario_draw(&scenario->random, AXES) : 0u)),
	    .edges = 2,
	    .event = EVENT_KINDS};
}

/* An edge, or a pulse about as long as the filter. */
static struct action edge(struct scenario *scenario, enum passo_input input)
{
	struct action action = pulse(
	    scenario, input, scenario->filter + scenario_draw(&scenario->random, scenario->filter + 4u) + 1u);

	if (scenario_chance(&scenario->random, 60))
		action.edges = 1;
	return action;
}

static struct action noise(struct scenario *scenario)
{
	struct scenario_random *random = &scenario->random;
	static const enum passo_input inputs[] = {PASSO_INPUT_LIMIT_LOW, PASSO_INPUT_LIMIT_HIGH,
	    PASSO_INPUT_HOME, PASSO_INPUT_ALARM, PASSO_INPUT_PROBE, PASSO_INPUT_ENCODER_A,
	    PASSO_INPUT_ENCODER_B, PASSO_INPUT_ENCODER_INDEX};
	const enum passo_input input = inputs[scenario_draw(random, 8)];
	const uint32_t longest = input >= PASSO_INPUT_ENCODER_A ? scenario->encoder_filter : scenario->filter;
	struct action action = pulse(scenario, input, 1u + scenario_draw(random, longest));

	if (scenario_chance(random, 30)) { /* flicker */
		action.clocks = 1;
		action.edges = (uint16_t)(2u * (1u + scenario_draw(random, 100)));
	}
	return action;
}

static struct action measure(struct scenario *scenario)
{
	static const struct {
		uint16_t place, length;
	} reads[] = {{PASSO_CHANNEL_TRIGGER_STATE, 1}, {PASSO_CHANNEL_TRIGGER_POSITION_BASE, AXES},
	    {PASSO_CHANNEL_ENCODER_POSITION_BASE, AXES}, {PASSO_CHANNEL_INPUT_FLAGS, 1}};
	const unsigned i = scenario_draw(&scenario->random, 4);
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_READ, channel_address(0, reads[i].place));

	action.length = reads[i].length;
	return action;
}

struct action scenario_machine_event(struct scenario *scenario, enum scenario_kind kind)
{
	struct scenario_random *random = &scenario->random;
	struct action action;

	switch (kind) {
	case SCENARIO_LIMIT:
		return edge(
		    scenario, scenario_chance(random, 50) ? PASSO_INPUT_LIMIT_LOW : PASSO_INPUT_LIMIT_HIGH);
	case SCENARIO_ALARM:
		return edge(scenario, PASSO_INPUT_ALARM);
	case SCENARIO_ESTOP:
		return pulse(scenario, PASSO_INPUT_ESTOP_N, scenario_log(random, 1, 2000));
	case SCENARIO_HOME:
		return edge(scenario, PASSO_INPUT_HOME);
	case SCENARIO_PROBE:
		return edge(scenario, PASSO_INPUT_PROBE);
	case SCENARIO_TURN:
		action = pulse(scenario, PASSO_INPUT_COUNT, 0);
		action.mask = (uint8_t)scenario_draw(random, AXES);
		action.edges = 1;
		action.turn = (int32_t)scenario_draw(random, 101) - 50;
		return action;
	case SCENARIO_ARM:
		return scenario_write_word(
		    scenario, channel_address(0, PASSO_CHANNEL_TRIGGER), scenario_some_trigger(scenario));
	case SCENARIO_SILENCE:
		action = measure(scenario);
		action.clocks = 140000;
		return action;
	case SCENARIO_MEASURE:
		return measure(scenario);
	default:
		return noise(scenario);
	}
}
