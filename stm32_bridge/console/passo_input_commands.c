/* SPDX-License-Identifier: MIT
 * Commands of the inputs: settings, levels, trigger.
 */
#include "passo_command_table.h"
#include "passo_commands.h"
#include "passo_value.h"

/* The keys of `input` before those of an axis's inputs. */
#define KEYS_OF_CHANNEL 3u

void passo_say_axes(const struct passo_sink *sink, const char *text, uint8_t axes)
{
	const char *before = text;

	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		if (((uint32_t)axes >> axis & 1u) == 0u)
			continue;
		passo_say(sink, "%s%u", before, axis);
		before = ",";
	}
	if (before == text)
		passo_say(sink, "%snone", text);
}

/* The same of some inputs: "limit_low:0,limit_low:3,home:0", or "none". */
struct named_levels {
	const char *name;
	uint8_t axes;
};
static void say_levels(
    const struct passo_sink *sink, const char *text, const struct named_levels levels[4], bool probe)
{
	const char *before = text;

	for (unsigned i = 0; i < 4u; i++) {
		for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
			if (((uint32_t)levels[i].axes >> axis & 1u) == 0u)
				continue;
			passo_say(sink, "%s%s:%u", before, levels[i].name, axis);
			before = ",";
		}
	}
	if (probe)
		passo_say(sink, "%sprobe", before);
	else if (before == text)
		passo_say(sink, "%snone", text);
}

void passo_say_inputs(const struct passo_call *call, const struct passo_readings *now)
{
	const struct passo_sink *sink = &call->console->sink;
	uint8_t homed = 0;

	for (uint8_t axis = 0; axis < call->reading->axes; axis++)
		homed |= (uint8_t)((unsigned)passo_is_homed(&call->channel->passo, axis) << axis);
	if (now->unknown)
		passo_say(sink, " inputs=unknown");
	else
		say_levels(sink, " inputs=",
		    (const struct named_levels[4]){{"limit_low", now->limit_low},
			{"limit_high", now->limit_high}, {"home", now->home}, {"alarm", now->alarm}},
		    now->probe);
	passo_say(sink, " estop=%u", (uint32_t)now->estop);
	passo_say_axes(sink, " stopped_by=", now->axes);
	passo_say_axes(sink, " homed=", homed);
}

bool passo_run_inputs(const struct passo_call *call)
{
	struct passo *passo = &call->channel->passo;
	struct passo_readings now;
	enum passo_error error = passo_read_inputs(passo, &now);

	if (error == PASSO_OK && call->values->clear)
		error = passo_clear_flags(passo);
	if (!passo_answer(call, error))
		return false;
	passo_say_inputs(call, &now);
	say_levels(&call->console->sink, " were=",
	    (const struct named_levels[4]){{"limit_low", now.was_limit_low},
		{"limit_high", now.was_limit_high}, {"home", now.was_home}, {"alarm", now.was_alarm}},
	    now.was_probe);
	return true;
}

enum passo_error passo_commands_set_inputs(
    const struct passo_console_inputs *inputs, struct passo *passo, uint8_t axis)
{
	const struct passo_input_config config = {.limit_low = inputs->limit_low != PASSO_LEVEL_NONE,
	    .limit_high = inputs->limit_high != PASSO_LEVEL_NONE,
	    .home = inputs->home != PASSO_LEVEL_NONE,
	    .limit_low_inverted = inputs->limit_low == PASSO_LEVEL_LOW,
	    .limit_high_inverted = inputs->limit_high == PASSO_LEVEL_LOW,
	    .home_inverted = inputs->home == PASSO_LEVEL_LOW,
	    .alarm_inverted = inputs->alarm == PASSO_LEVEL_LOW,
	    .limit_soft = inputs->limit_soft,
	    .alarm_soft = inputs->alarm_soft,
	    .alarm_disables = inputs->alarm_disables};

	return passo_configure_inputs(passo, axis, &config);
}

static bool configure_probe(const struct passo_call *call)
{
	struct passo_console_channel *channel = call->channel;
	const uint8_t level = call->values->probe;

	if (level == PASSO_LEVEL_NONE)
		return passo_complain(call->reading->sink, "probe must be active_high or active_low");
	if (!passo_answer(call, passo_configure_probe(&channel->passo, level == PASSO_LEVEL_LOW)))
		return false;
	channel->probe = level;
	return true;
}

static void show(const struct passo_call *call, uint8_t axis)
{
	const struct passo_console_inputs *inputs = &call->channel->inputs[axis];
	const struct passo_sink *sink = &call->console->sink;
	const struct {
		const char *text;
		uint8_t level;
	} levels[] = {{" limit_low=", inputs->limit_low}, {" limit_high=", inputs->limit_high},
	    {" home=", inputs->home}, {" alarm=", inputs->alarm}};

	passo_say(sink, "ok axis=%u", (uint32_t)axis);
	for (unsigned i = 0; i < PASSO_COUNT(levels); i++) {
		passo_say(sink, "%s", levels[i].text);
		passo_value_say(sink, PASSO_READ_LEVEL, levels[i].level);
	}
	passo_say(sink, " limit_soft=%u alarm_soft=%u alarm_disables=%u", (uint32_t)inputs->limit_soft,
	    (uint32_t)inputs->alarm_soft, (uint32_t)inputs->alarm_disables);
}

/* Changes only the settings that are given: reads them once more, over the present ones. */
bool passo_run_input(const struct passo_call *call)
{
	const struct passo_command *command = passo_command_find("input");
	struct passo_console_channel *channel = call->channel;
	const struct passo_reading *reading = call->reading;
	const uint8_t axis = call->values->axis;
	const bool has_axis = (reading->given & 1u) != 0u, has_probe = (reading->given >> 2 & 1u) != 0u;
	const uint32_t of_axis = reading->given >> KEYS_OF_CHANNEL;

	if (has_axis && has_probe)
		return passo_complain(reading->sink, "axis and probe are mutually exclusive");
	if (of_axis != 0u && !has_axis)
		return passo_complain(reading->sink, "axis is missing");
	if (has_probe)
		return configure_probe(call);
	if (!has_axis) {
		passo_say(reading->sink, "ok probe=");
		passo_value_say(reading->sink, PASSO_READ_LEVEL, channel->probe);
		return true;
	}
	if (of_axis == 0u) {
		show(call, axis);
		return true;
	}
	call->values->inputs = channel->inputs[axis];
	if (!passo_keys_read(call->reading, command->keys, command->count, call->words, call->values)
	    || !passo_answer(call, passo_commands_set_inputs(&call->values->inputs, &channel->passo, axis)))
		return false;
	channel->inputs[axis] = call->values->inputs;
	channel->inputs_given |= (uint8_t)(1u << axis);
	return true;
}

void passo_say_trigger(
    const struct passo_sink *sink, const struct passo *passo, const struct passo_trigger_report *report)
{
	for (unsigned axis = 0; report->fired && axis < passo_axes(passo); axis++)
		passo_say(sink, axis == 0u ? " position=%d" : ",%d", report->positions[axis]);
}

bool passo_run_trigger(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo *passo = &call->channel->passo;
	const struct passo_trigger_config config = {.source = (enum passo_trigger_source)values->source,
	    .action = (enum passo_trigger_action)values->action,
	    .axis = values->axis,
	    .falling = values->edge != 0u};
	struct passo_trigger_report report;

	if ((call->reading->given & 1u) != 0u)
		return passo_answer(call, values->source == PASSO_TRIGGER_SOURCE_NONE
					      ? passo_disarm_trigger(passo)
					      : passo_arm_trigger(passo, &config));
	if (call->reading->given >> 2 != 0u)
		return passo_complain(call->reading->sink, "source is missing");
	if (!passo_answer(call, passo_read_trigger(passo, &report)))
		return false;
	passo_say(&call->console->sink, " armed=%u fired=%u", (uint32_t)report.armed, (uint32_t)report.fired);
	passo_say_trigger(&call->console->sink, passo, &report);
	return true;
}
