/* SPDX-License-Identifier: MIT
 * Settings of a machine: power-up, reset, writes.
 */
#include <string.h>

#include "judge_state.h"

/* Clocks around a reset in which an encoder may miss an edge. */
#define MISSES 16u

void judge_machine_power_up(struct judge *judge)
{
	struct machine *machine = &judge->machine;
	const struct passo_inputs *inputs = &judge->world->levels;

	memset(machine, 0, sizeof *machine);
#define TAKE(name, type, number) machine->pins[number] = (uint8_t)inputs->name;
	PASSO_INPUTS(TAKE)
#undef TAKE
	machine->encoder_filter = PASSO_CHANNEL_ENCODER_FILTER_FILTER_RESET;
}

void judge_machine_reset(struct judge *judge, bool done)
{
	struct machine *machine = &judge->machine;

	judge_reset_inputs(judge, done);
	machine->stop_slew = PASSO_CHANNEL_STOP_SLEW_RESET;
	machine->full_rate = true;
	machine->held = false;
	machine->watchdog = 0;
	machine->trigger.armed = false;
	machine->compare_width = 0;
	machine->compare_until = 0;
	machine->compare_unsure = judge->now + MISSES;
	machine->compares = false;
	machine->word_count = machine->word = 0;
	machine->enable_unsure = 0;
	machine->stopped_at = machine->ran_from = 0;
	machine->encoder_filter = PASSO_CHANNEL_ENCODER_FILTER_FILTER_RESET;
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		struct shaft *shaft = &machine->shafts[a];

		*shaft = (struct shaft){.a = (machine->pins[PASSO_INPUT_ENCODER_A] >> a & 1u) != 0u,
		    .b = (machine->pins[PASSO_INPUT_ENCODER_B] >> a & 1u) != 0u,
		    .unsure = judge->now > MISSES,
		    .exceeded_from = NEVER - 1000u};
	}
}

void judge_machine_line(struct judge *judge, const struct world_fact *fact)
{
	struct machine *machine = &judge->machine;
	const uint8_t directions = passo_unpack_line_control(fact->words[0]).directions;
	uint8_t moves = 0;

	for (unsigned a = 0; a < judge_axes(judge); a++)
		moves |= (uint8_t)((fact->words[1u + a] != 0u ? 1u : 0u) << a);
	machine->line_low = directions & moves;
	machine->line_high = (uint8_t)(~directions & moves);
	if (machine->word_count < LEVELS_MAX)
		machine->words[machine->word_count++] =
		    passo_unpack_line_output(fact->words[1u + judge_axes(judge)]).levels;
}

static void write_inputs(struct judge *judge, unsigned a, uint32_t value)
{
	const struct passo_axis_inputs inputs = passo_unpack_axis_inputs(value);
	struct machine *machine = &judge->machine;
	const uint8_t bit = (uint8_t)(1u << a);

	machine->limit_soft = (uint8_t)((machine->limit_soft & ~bit) | (inputs.limit_soft ? bit : 0u));
	machine->alarm_soft = (uint8_t)((machine->alarm_soft & ~bit) | (inputs.alarm_soft ? bit : 0u));
	machine->alarm_disables =
	    (uint8_t)((machine->alarm_disables & ~bit) | (inputs.alarm_disables ? bit : 0u));
	judge_see_levels(judge, PASSO_INPUT_LIMIT_LOW, a, inputs.limit_low_inverted);
	judge_see_levels(judge, PASSO_INPUT_LIMIT_HIGH, a, inputs.limit_high_inverted);
	judge_see_levels(judge, PASSO_INPUT_HOME, a, inputs.home_inverted);
	judge_see_levels(judge, PASSO_INPUT_ALARM, a, inputs.alarm_inverted);
}

void judge_machine_enable(struct judge *judge, unsigned a)
{
	struct machine *machine = &judge->machine;
	struct axis *axis = &judge->channel[0].axis[a];

	if (machine->pressed)
		axis->enabled = false;
	machine->enable_unsure &= (uint8_t)~(1u << a);
	if (machine->unsettled)
		machine->enable_unsure |= (uint8_t)(1u << a);
}

static void write_compare(struct judge *judge, unsigned place, uint32_t value)
{
	struct machine *machine = &judge->machine;
	const struct passo_channel_compare_pulse pulse = passo_unpack_channel_compare_pulse(value);

	machine->compare_until = 0;
	machine->compare_unsure = judge->now + MISSES;
	if (place == PASSO_CHANNEL_COMPARE_PULSE) {
		machine->compare_width = pulse.width;
		machine->compare_axis = pulse.axis;
	} else if (place == PASSO_CHANNEL_COMPARE_DISTANCE) {
		machine->compare_distance = (int32_t)value;
		machine->compares = true;
	} else {
		machine->compare_interval = (int32_t)value;
	}
}

void judge_machine_command(struct judge *judge, struct passo_channel_command command)
{
	if (command.abort)
		judge_add_event(judge, PASSO_CAUSE_ABORT, true, judge->now - 8u, judge->now + SLACK);
	else if (command.stop)
		judge_add_event(judge, PASSO_CAUSE_STOP, false, judge->now - 8u, judge->now + SLACK);
	else if (command.clear)
		judge_clear_events(judge);
	if (command.zero && !command.abort && !command.stop)
		judge_zero_encoders(judge);
}

static void write_channel(struct judge *judge, unsigned place, uint32_t value)
{
	struct machine *machine = &judge->machine;

	switch (place) {
	case PASSO_CHANNEL_RATE_TARGET:
		machine->full_rate = machine->full_rate && value == PASSO_RATE_ONE;
		machine->held = false;
		break;
	case PASSO_CHANNEL_STOP_SLEW:
		machine->stop_slew = value;
		break;
	case PASSO_CHANNEL_TRIGGER:
		judge_arm(judge, value);
		break;
	case PASSO_CHANNEL_PROBE:
		judge_see_levels(judge, PASSO_INPUT_PROBE, 0, (value & 1u) != 0u);
		break;
	case PASSO_CHANNEL_COMPARE_PULSE:
	case PASSO_CHANNEL_COMPARE_DISTANCE:
	case PASSO_CHANNEL_COMPARE_INTERVAL:
		write_compare(judge, place, value);
		break;
	case PASSO_CHANNEL_ENCODER_FILTER:
		machine->encoder_filter = value;
		break;
	default:
		if (place >= PASSO_CHANNEL_ENCODER_BASE)
			judge_write_encoder(judge,
			    (place - PASSO_CHANNEL_ENCODER_BASE) / PASSO_CHANNEL_ENCODER_STRIDE,
			    place % PASSO_CHANNEL_ENCODER_STRIDE, value);
		else if (place >= PASSO_CHANNEL_AXIS_BASE
		         && place % PASSO_CHANNEL_AXIS_STRIDE == PASSO_AXIS_INPUTS)
			write_inputs(
			    judge, (place - PASSO_CHANNEL_AXIS_BASE) / PASSO_CHANNEL_AXIS_STRIDE, value);
		break;
	}
}

void judge_machine_write(struct judge *judge, uint32_t address, uint32_t value)
{
	struct machine *machine = &judge->machine;

	if (in_channel(address))
		write_channel(judge, place_of(address), value);
	else if (address == PASSO_ADDRESS_INPUT_FILTER) {
		machine->filter = value;
		judge_forget(judge);
	} else if (address == PASSO_ADDRESS_WATCHDOG)
		machine->watchdog = passo_unpack_watchdog(value).stop_after;
	else if (address == PASSO_ADDRESS_ESTOP_CLEAR && machine->pins[PASSO_INPUT_ESTOP_N] != 0u) {
		machine->unsettled = machine->pressed && judge->now < machine->released_at + MISSES;
		machine->pressed = machine->pressed && machine->unsettled;
	}
}
