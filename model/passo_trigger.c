/* SPDX-License-Identifier: MIT
 * Trigger of a channel: one input, one edge, once. See rtl/passo_trigger.v.
 */
#include "passo_model.h"
#include "passo_words.h"

static bool chosen(const struct passo_trigger *trigger, const struct passo_inputs_unit *unit, uint8_t index)
{
	static const uint8_t kinds[] = {[PASSO_TRIGGER_SOURCE_NONE] = PASSO_KIND_PROBE,
	    [PASSO_TRIGGER_SOURCE_LIMIT_LOW] = PASSO_KIND_LIMIT_LOW,
	    [PASSO_TRIGGER_SOURCE_LIMIT_HIGH] = PASSO_KIND_LIMIT_HIGH,
	    [PASSO_TRIGGER_SOURCE_HOME] = PASSO_KIND_HOME,
	    [PASSO_TRIGGER_SOURCE_PROBE] = PASSO_KIND_PROBE};
	const enum passo_trigger_source source = (enum passo_trigger_source)trigger->source;

	if (source == PASSO_TRIGGER_SOURCE_INDEX)
		return ((unsigned)index >> trigger->axis & 1u) != 0u;
	const unsigned bit = kinds[source] == PASSO_KIND_PROBE ? 0u : trigger->axis;
	return (unit->input[kinds[source]].second >> bit & 1u) != 0u;
}

uint8_t passo_trigger_check(const struct passo_channel *channel, uint32_t data)
{
	const uint32_t source = data >> PASSO_CHANNEL_TRIGGER_SOURCE_LSB & 7u;
	const struct passo_channel_trigger word = passo_unpack_channel_trigger(data);
	const bool of_axis = source != PASSO_TRIGGER_SOURCE_NONE && source != PASSO_TRIGGER_SOURCE_PROBE;

	return (data & ~PASSO_CHANNEL_TRIGGER_DEFINED) != 0u || source > PASSO_TRIGGER_SOURCE_INDEX
	            || (word.arm && source == PASSO_TRIGGER_SOURCE_NONE)
	            || (of_axis && word.axis >= channel->axes)
	         ? PASSO_VERDICT_BAD_VALUE
	         : PASSO_VERDICT_OK;
}

void passo_trigger_clock(
    struct passo_trigger *trigger, const struct passo_inputs_unit *unit, uint8_t index, uint16_t filter)
{
	const bool picked = trigger->picked;
	const bool armed = trigger->armed;
	const bool arms = (trigger->arming & 2u) != 0u;
	const bool differs = picked != trigger->level;
	const bool changes = armed && differs && trigger->count == filter;
	const bool fires = changes && trigger->level == trigger->falling;

	trigger->picked = chosen(trigger, unit, index);
	trigger->arming = (uint8_t)((unsigned)trigger->arming << 1 & 3u);
	if (armed)
		trigger->clocks++;
	trigger->latch = fires;
	trigger->armed = (armed && !fires) || arms;
	trigger->fired = trigger->fired || fires;
	trigger->count = !differs || changes || !armed ? 0u : (uint16_t)(trigger->count + 1u);
	if (changes || arms)
		trigger->level = picked;
	if (arms)
		trigger->clocks = 0;
}

void passo_trigger_write(struct passo_trigger *trigger, uint32_t data)
{
	const struct passo_channel_trigger word = passo_unpack_channel_trigger(data);

	trigger->source = (uint8_t)word.source;
	trigger->axis = word.axis;
	trigger->action = (uint8_t)word.action;
	trigger->falling = word.falling;
	trigger->arming = word.arm ? 1u : 0u;
	trigger->armed = trigger->fired = trigger->latch = false;
}
