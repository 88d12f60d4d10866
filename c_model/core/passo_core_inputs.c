/* SPDX-License-Identifier: MIT
 * Inputs of a channel: levels and flags, limits and alarms, the trigger. See rtl/passo_inputs.v.
 */
#include <string.h>

#include "passo_model.h"
#include "passo_words.h"

/* A bit of the setting INPUTS of all axes. */
static uint8_t setting(const struct passo_channel *channel, unsigned lsb)
{
	uint8_t bits = 0;

	for (unsigned i = 0; i < channel->axes; i++)
		bits |= (uint8_t)((channel->axis[i].settings.inputs >> lsb & 1u) << i);
	return bits;
}

static uint8_t inverted(
    const struct passo_channel *channel, const struct passo_inputs_unit *unit, unsigned kind)
{
	return kind == PASSO_KIND_PROBE ? (unit->probe_inverted ? 1u : 0u)
	                                : setting(channel, PASSO_AXIS_INPUTS_LIMIT_LOW_INVERTED_LSB + kind);
}

struct passo_requests passo_inputs_requests(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_inputs_unit *unit = &channel->inputs;
	const struct passo_limits *limits = &unit->limits;
	const struct passo_trigger *trigger = &unit->trigger;
	const struct passo_machine_unit *machine = inputs->machine;
	const enum passo_trigger_action action = (enum passo_trigger_action)trigger->action;
	const bool moving = passo_motion_moves(&channel->motion) || channel->trackers.busy;
	const bool all_off = machine->watchdog_disable || (machine->estop_seen & 2u) != 0u;
	const bool hard = trigger->latch && action == PASSO_TRIGGER_ACTION_HARD_STOP;
	const bool soft = trigger->latch && action == PASSO_TRIGGER_ACTION_SOFT_STOP;

	return (struct passo_requests){
	    .hard = limits->limit_hard || limits->alarm_hard || hard,
	    .hard_cause = limits->limit_hard ? PASSO_CAUSE_LIMIT
	                : limits->alarm_hard ? PASSO_CAUSE_ALARM
	                                     : PASSO_CAUSE_TRIGGER,
	    .soft =
		limits->limit_softly || limits->alarm_softly || soft || (machine->watchdog_stop && moving),
	    .soft_cause = limits->limit_softly ? PASSO_CAUSE_LIMIT
	                : limits->alarm_softly ? PASSO_CAUSE_ALARM
	                : soft                 ? PASSO_CAUSE_TRIGGER
	                                       : PASSO_CAUSE_WATCHDOG,
	    .wait = inputs->parameters->inputs != 0u && (unit->settling.unknown || trigger->arming),
	    .latch = trigger->latch,
	    .end_endless = trigger->latch && action == PASSO_TRIGGER_ACTION_END_ENDLESS,
	    .disable = all_off ? 0xFFu
	                       : (uint8_t)(unit->input[PASSO_KIND_ALARM].level
	                                   & setting(channel, PASSO_AXIS_INPUTS_ALARM_DISABLES_LSB)),
	};
}

static void clock_input(struct passo_input_filter *input, uint8_t pins, bool tick)
{
	const uint8_t differs = input->second ^ input->level;
	const uint8_t ticks = tick ? 0xFFu : 0u;

	input->was_active |= input->level;
	input->level ^= differs & input->pending & ticks;
	input->pending = (uint8_t)(differs & (input->pending ^ ticks));
	input->second = input->first;
	input->first = pins;
}

static void clock_settling(struct passo_settling *settling, bool changes, bool tick, bool forget)
{
	const bool changed = settling->changed;

	settling->changed = settling->forgot || changes || (changed && !tick) || forget;
	settling->unknown = (settling->unknown && (!tick || changed)) || forget;
	settling->forgot = forget;
}

static void clock_limits(struct passo_limits *limits, const struct passo_channel *channel, bool may_close)
{
	const struct passo_input_filter *input = channel->inputs.input;
	const uint8_t low = input[PASSO_KIND_LIMIT_LOW].level, high = input[PASSO_KIND_LIMIT_HIGH].level;
	const uint8_t alarm = input[PASSO_KIND_ALARM].level;
	const uint8_t soft = setting(channel, PASSO_AXIS_INPUTS_LIMIT_SOFT_LSB);
	const uint8_t alarm_soft = setting(channel, PASSO_AXIS_INPUTS_ALARM_SOFT_LSB);
	const uint8_t closes = may_close ? 0xFFu : (uint8_t)~soft;
	uint8_t to_low = 0, to_high = 0;

	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_axis *axis = &channel->axis[i];
		if ((axis->waits & 1u) != 0u && (axis->waiting & 1u) != 0u)
			to_low |= (uint8_t)(1u << i);
		if ((axis->waits & 1u) != 0u && (axis->waiting & 1u) == 0u)
			to_high |= (uint8_t)(1u << i);
	}
	const uint8_t hit = (uint8_t)((to_low & low) | (to_high & high));

	limits->limit_hard = ((to_low & limits->closed_low) | (to_high & limits->closed_high)) != 0u;
	limits->limit_softly = (hit & soft) != 0u;
	limits->alarm_hard = (alarm & ~alarm_soft) != 0;
	limits->alarm_softly = (alarm & alarm_soft) != 0u;
	limits->closed_low = (uint8_t)(low & (limits->closed_low | closes));
	limits->closed_high = (uint8_t)(high & (limits->closed_high | closes));
	if (limits->named == 0u)
		limits->named = hit | alarm;
	if (channel->registers.command_clear)
		limits->named = 0;
}

/* Writes to registers, which are in force with the next clock. */
static void write_register(
    struct passo_inputs_unit *unit, const struct passo_channel *channel, const struct passo_bus *bus)
{
	struct passo_input_filter *probe = &unit->input[PASSO_KIND_PROBE];

	switch ((uint8_t)bus->address) {
	case PASSO_CHANNEL_INPUT_CLEAR:
		for (unsigned kind = 0; kind < PASSO_KIND_PROBE; kind++)
			unit->input[kind].was_active &=
			    (uint8_t)(~(bus->data >> 8u * kind) | channel->inputs.input[kind].level);
		break;
	case PASSO_CHANNEL_TRIGGER:
		passo_trigger_write(&unit->trigger, bus->data);
		break;
	case PASSO_CHANNEL_PROBE:
		unit->probe_inverted = (bus->data >> PASSO_CHANNEL_PROBE_INVERTED_LSB & 1u) != 0u;
		if ((bus->data >> PASSO_CHANNEL_PROBE_CLEAR_LSB & 1u) != 0u)
			probe->was_active = channel->inputs.input[PASSO_KIND_PROBE].level;
		break;
	default:
		break;
	}
}

/* Whether a polarity or the filter changes with this clock: levels that were filtered otherwise say nothing.
 */
static bool forgets(const struct passo_channel *channel, const struct passo_bus *bus, bool selected)
{
	const bool probe_inverted = (bus->data >> PASSO_CHANNEL_PROBE_INVERTED_LSB & 1u) != 0u;

	return (bus->write && bus->address == PASSO_ADDRESS_INPUT_FILTER)
	    || (bus->write && selected && (uint8_t)bus->address == PASSO_CHANNEL_PROBE
	        && probe_inverted != channel->inputs.probe_inverted)
	    || (channel->writes_axis
	        && channel->written_register % PASSO_CHANNEL_AXIS_STRIDE == PASSO_AXIS_INPUTS);
}

void passo_inputs_clock(struct passo_inputs_unit *unit, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires)
{
	const bool may_close =
	    passo_channel_quiet(channel) || (wires->occupied && !wires->moving && !wires->tracking);
	const bool forget = forgets(channel, inputs->bus, wires->selected);
	bool changed = false;

	if (inputs->parameters->inputs == 0u)
		return;
	for (unsigned kind = 0; kind < PASSO_KINDS; kind++)
		changed = changed || channel->inputs.input[kind].first != channel->inputs.input[kind].second;
	clock_settling(&unit->settling, changed, inputs->machine->tick, forget);
	passo_trigger_clock(
	    &unit->trigger, &channel->inputs, passo_encoders_index(channel), inputs->machine->filter, forget);
	clock_limits(&unit->limits, channel, may_close);
	for (unsigned kind = 0; kind < PASSO_KINDS; kind++)
		clock_input(&unit->input[kind],
		    inputs->pins[kind] ^ inverted(channel, &channel->inputs, kind), inputs->machine->tick);
	if (wires->selected && inputs->bus->write)
		write_register(unit, channel, inputs->bus);
}

void passo_inputs_reset(struct passo_inputs_unit *unit)
{
	*unit = (struct passo_inputs_unit){.settling = {.changed = true, .forgot = true, .unknown = true}};
}

void passo_inputs_restart(struct passo_inputs_unit *unit, const struct passo_inputs_unit *before)
{
	passo_inputs_reset(unit);
	unit->probe_inverted = before->probe_inverted;
	unit->trigger.source = before->trigger.source;
	unit->trigger.axis = before->trigger.axis;
	unit->trigger.action = before->trigger.action;
	unit->trigger.falling = before->trigger.falling;
}

uint32_t passo_inputs_value(const struct passo_inputs_unit *unit, uint8_t address)
{
	const struct passo_input_filter *input = unit->input;

	switch (address) {
	case PASSO_CHANNEL_INPUT_LEVELS:
		return (uint32_t)input[3].level << 24 | (uint32_t)input[2].level << 16
		     | (uint32_t)input[1].level << 8 | input[0].level;
	case PASSO_CHANNEL_INPUT_FLAGS:
		return (uint32_t)input[3].was_active << 24 | (uint32_t)input[2].was_active << 16
		     | (uint32_t)input[1].was_active << 8 | input[0].was_active;
	case PASSO_CHANNEL_TRIGGER_STATE:
		return passo_pack_channel_trigger_state(&(struct passo_channel_trigger_state){
		    .unknown = unit->settling.unknown,
		    .source_active = unit->trigger.armed && unit->trigger.level,
		    .arming = unit->trigger.arming,
		    .armed = unit->trigger.armed,
		    .fired = unit->trigger.fired,
		    .probe = input[PASSO_KIND_PROBE].level != 0u,
		    .probe_flag = input[PASSO_KIND_PROBE].was_active != 0u,
		    .axes = unit->limits.named,
		});
	default:
		return 0;
	}
}

/* Whether an input is still on its way to the level. */
static bool is_on_its_way(const struct passo_input_filter *input, uint8_t pins)
{
	return input->first != pins || input->second != pins
	    || (input->second ^ input->level) != input->pending;
}

/* Clocks until the next one that sees a tick. */
static uint64_t clocks_to_tick(const struct passo_machine_unit *machine)
{
	return machine->tick ? 0u : (uint64_t)machine->filter - machine->count + 1u;
}

uint64_t passo_inputs_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_inputs_unit *unit = &channel->inputs;
	struct passo_inputs_unit then = *unit;
	const struct passo_channel_wires wires = {.occupied = passo_channel_occupied(channel),
	    .moving = channel->motion.state == PASSO_STATE_RUN,
	    .tracking = channel->trackers.busy};
	bool waits_for_tick = unit->settling.unknown || unit->settling.changed;

	if (inputs->parameters->inputs == 0u)
		return UINT64_MAX;
	const struct passo_requests requests = passo_inputs_requests(channel, inputs);
	if (requests.hard || requests.soft || requests.latch || (inputs->machine->estop_seen & 2u) != 0u)
		return 0;
	for (unsigned i = 0; i < channel->axes; i++)
		if ((requests.disable >> i & 1u) != 0u && channel->axis[i].settings.enable)
			return 0;
	for (unsigned kind = 0; kind < PASSO_KINDS; kind++) {
		const struct passo_input_filter *input = &unit->input[kind];
		const uint8_t pins = inputs->pins[kind] ^ inverted(channel, unit, kind);

		if (is_on_its_way(input, pins))
			return 0;
		waits_for_tick = waits_for_tick || input->pending != 0u;
	}
	if (channel->positions.latch_waits || channel->line.no_repeat != channel->line.no_repeat_before)
		return 0;
	for (unsigned i = 0; i < channel->axes; i++)
		if (channel->axis[i].closed.low != ((unit->limits.closed_low >> i & 1u) != 0u)
		    || channel->axis[i].closed.high != ((unit->limits.closed_high >> i & 1u) != 0u))
			return 0;
	passo_inputs_clock(&then, channel, inputs, &wires);
	then.trigger.count = unit->trigger.count;
	if (memcmp(&then, unit, sizeof *unit) != 0)
		return 0;
	const uint64_t trigger =
	    passo_trigger_quiet(&unit->trigger, unit, passo_encoders_index(channel), inputs->machine->filter);
	const uint64_t tick = waits_for_tick ? clocks_to_tick(inputs->machine) : UINT64_MAX;
	return trigger < tick ? trigger : tick;
}

void passo_inputs_skip(struct passo_inputs_unit *unit, uint64_t clocks)
{
	passo_trigger_skip(&unit->trigger, clocks);
}
