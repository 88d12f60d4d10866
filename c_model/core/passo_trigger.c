/* SPDX-License-Identifier: MIT
 * Trigger of a channel: one-shot edge capture. See rtl/passo_trigger.v.
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
		return ((uint32_t)index >> trigger->axis & 1u) != 0u;
	const unsigned bit = kinds[source] == PASSO_KIND_PROBE ? 0u : trigger->axis;
	return (unit->input[kinds[source]].second >> bit & 1u) != 0u;
}

bool passo_trigger_objects(const struct passo_channel *channel, uint32_t data)
{
	const uint32_t source = data >> PASSO_CHANNEL_TRIGGER_SOURCE_LSB & 7u;
	const struct passo_channel_trigger word = passo_unpack_channel_trigger(data);
	const bool of_axis = source != PASSO_TRIGGER_SOURCE_NONE && source != PASSO_TRIGGER_SOURCE_PROBE;

	return source > PASSO_TRIGGER_SOURCE_INDEX || (word.arm && source == PASSO_TRIGGER_SOURCE_NONE)
	    || (of_axis && word.axis >= channel->axes);
}

/* An edge that may be one; while arming, a level that may be known. */
static bool counts(const struct passo_trigger *trigger)
{
	const bool differs = trigger->picked != trigger->level;

	return trigger->armed ? differs : trigger->arming && !differs;
}

void passo_trigger_clock(struct passo_trigger *trigger, const struct passo_inputs_unit *unit, uint8_t index,
    uint16_t filter, bool forget)
{
	const bool picked = trigger->picked;
	const bool armed = trigger->armed, arming = trigger->arming;
	const bool stale = trigger->stale != 0u;
	const bool accepts = counts(trigger) && trigger->count == filter && !stale;
	const bool fires = accepts && armed && trigger->level == trigger->falling;

	trigger->count = !counts(trigger) || accepts || stale ? 0u : (uint16_t)(trigger->count + 1u);
	trigger->picked = chosen(trigger, unit, index);
	trigger->stale = forget ? 3u : stale ? (uint8_t)(trigger->stale - 1u) : 0u;
	if (accepts || !armed)
		trigger->level = picked;
	trigger->latch = fires;
	trigger->fired = trigger->fired || fires;
	trigger->arming = forget ? arming || (armed && !fires) : arming && !accepts;
	trigger->armed = !forget && ((armed && !fires) || (arming && accepts));
}

void passo_trigger_write(struct passo_trigger *trigger, uint32_t data)
{
	const struct passo_channel_trigger word = passo_unpack_channel_trigger(data);

	trigger->source = (uint8_t)word.source;
	trigger->axis = word.axis;
	trigger->action = (uint8_t)word.action;
	trigger->falling = word.falling;
	trigger->arming = word.arm;
	trigger->stale = 3;
	trigger->armed = trigger->fired = trigger->latch = false;
}

uint64_t passo_trigger_quiet(
    const struct passo_trigger *trigger, const struct passo_inputs_unit *unit, uint8_t index, uint16_t filter)
{
	if (trigger->stale != 0u || trigger->latch || trigger->picked != chosen(trigger, unit, index)
	    || (!trigger->armed && trigger->level != trigger->picked))
		return 0;
	if (!counts(trigger))
		return trigger->count == 0u ? UINT64_MAX : 0u;
	return (uint64_t)filter - trigger->count; /* up to the clock before it accepts the level */
}

void passo_trigger_skip(struct passo_trigger *trigger, uint64_t clocks)
{
	if (counts(trigger))
		trigger->count = (uint16_t)(trigger->count + clocks);
}
