/* SPDX-License-Identifier: MIT
 * Inputs of a machine: what the filter lets through, and when it must stop the channel.
 */
#include "judge_state.h"

/* Clocks from an e-stop to the stop, at most. */
#define ESTOP_CLOCKS 4u
/* Clocks around CLEAR in which an event may come before or after it. */
#define CLEAR_CLOCKS 10u

bool judge_may(const struct level *level, uint64_t from, uint64_t until)
{
	return level->may_from <= until && from < level->may_until;
}

bool judge_must(const struct level *level, uint64_t clock)
{
	return level->must_from <= clock && clock < level->must_until;
}

static bool is_active(const struct machine *machine, unsigned input, unsigned a)
{
	return ((unsigned)(machine->pins[input] ^ machine->inverted[input]) >> a & 1u) != 0u;
}

/* Whether the input of a fact changes once more on the same clock: the core sees only the last level. */
static bool is_superseded(const struct judge *judge, size_t fact)
{
	const struct world_fact *facts = judge->world->facts;

	for (size_t i = fact + 1u; i < judge->world->fact_count && facts[i].clock == facts[fact].clock; i++)
		if (facts[i].kind == FACT_PIN && facts[i].words[0] == facts[fact].words[0])
			return true;
	return false;
}

uint64_t judge_next_change(const struct judge *judge, unsigned input, unsigned a)
{
	const uint32_t now = (uint32_t)judge->machine.pins[input] >> a & 1u;

	for (size_t i = judge->fact + 1u; i < judge->world->fact_count; i++) {
		const struct world_fact *fact = &judge->world->facts[i];

		if (fact->kind == FACT_PIN && fact->words[0] == input && (fact->words[1] >> a & 1u) != now
		    && !is_superseded(judge, i))
			return fact->clock;
	}
	return NEVER;
}

void judge_add_event(
    struct judge *judge, enum passo_cause cause, bool hard, uint64_t earliest, uint64_t latest)
{
	struct machine *machine = &judge->machine;

	for (unsigned i = 0; i < machine->event_count && latest == NEVER; i++)
		if (machine->events[i].cause == cause && machine->events[i].latest == NEVER)
			return; /* perhaps, and perhaps before */
	if (machine->event_count < EVENTS_MAX)
		machine->events[machine->event_count++] = (struct stop_event){cause, hard, earliest, latest};
}

/* The events of an input that becomes active. */
static void add_events(struct judge *judge, unsigned input, unsigned a, uint64_t earliest, uint64_t latest)
{
	const struct machine *machine = &judge->machine;

	if (input == PASSO_INPUT_ALARM)
		judge_add_event(
		    judge, PASSO_CAUSE_ALARM, (machine->alarm_soft >> a & 1u) == 0u, earliest, latest);
	if (input == PASSO_INPUT_LIMIT_LOW || input == PASSO_INPUT_LIMIT_HIGH)
		judge_add_event(judge, PASSO_CAUSE_LIMIT, false, earliest, NEVER);
}

/* An input has been at its present level from now on; `slack`: give or take. */
static void see_level(struct judge *judge, unsigned input, unsigned a, uint64_t slack)
{
	struct machine *machine = &judge->machine;
	struct level *level = &machine->levels[input][a];
	const uint64_t filter = (uint64_t)machine->filter + 1u, now = judge->now;
	const uint64_t next = judge_next_change(judge, input, a);
	const bool acts = next - now > filter - (slack < filter ? slack : 0u);
	const bool always = next - now >= 2u * filter + slack;
	const uint64_t earliest = now + filter - (slack < filter ? slack : 0u);
	const uint64_t latest = always ? now + 2u * filter + 2u + slack : NEVER;

	judge->counts->glitches += acts ? 0u : 1u;
	if (!is_active(machine, input, a)) {
		if (judge_must(level, now > 2u ? now - 2u : 0u))
			level->was = true;
		level->must_until = acts && earliest < level->must_until ? earliest : level->must_until;
		level->may_until = always ? latest + 1u : level->may_until;
		return;
	}
	if (!acts)
		return;
	judge->counts->levels++;
	level->may_from = judge_may(level, earliest, earliest) ? level->may_from : earliest;
	level->may_until = NEVER;
	level->may_have_been = true;
	if (always && (level->must_from == NEVER || level->must_until != NEVER)) {
		level->must_from = latest;
		level->must_until = NEVER;
	}
	add_events(judge, input, a, earliest, latest);
}

static void press(struct judge *judge)
{
	judge->machine.pressed = true;
	for (unsigned a = 0; a < judge_axes(judge); a++)
		judge->channel[0].axis[a].enabled = false;
	judge_add_event(judge, PASSO_CAUSE_ESTOP, true, judge->now, judge->now + ESTOP_CLOCKS);
	judge->counts->estops++;
}

void judge_pin(struct judge *judge, const struct world_fact *fact)
{
	struct machine *machine = &judge->machine;
	const unsigned input = fact->words[0];
	const uint8_t levels = (uint8_t)fact->words[1], changed = levels ^ machine->pins[input];

	if (is_superseded(judge, judge->fact))
		return;
	machine->pins[input] = levels;
	if (input == PASSO_INPUT_ESTOP_N) {
		if (levels == 0u)
			press(judge);
		else
			machine->released_at = judge->now;
		return;
	}
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		if ((changed >> a & 1u) == 0u)
			continue;
		if (input == PASSO_INPUT_ENCODER_A || input == PASSO_INPUT_ENCODER_B)
			judge_turn(judge, input, a);
		else if (input != PASSO_INPUT_ENCODER_INDEX) {
			judge_changes(judge, input, a);
			see_level(judge, input, a, 0);
		}
	}
}

void judge_see_levels(struct judge *judge, unsigned input, unsigned a, bool inverted)
{
	struct machine *machine = &judge->machine;
	const uint8_t bit = (uint8_t)(1u << a);
	const bool was = (machine->inverted[input] & bit) != 0u;

	machine->inverted[input] = (uint8_t)((machine->inverted[input] & ~bit) | (inverted ? bit : 0u));
	if (was != inverted) {
		judge_forget(judge);
		see_level(judge, input, a, SLACK);
	}
}

/* Inputs that are still active stop the channel again; what comes close to CLEAR may come after it. */
void judge_clear_events(struct judge *judge)
{
	struct machine *machine = &judge->machine;
	const unsigned count = machine->event_count;

	machine->event_count = 0;
	for (unsigned i = 0; i < count; i++) {
		const struct stop_event *event = &machine->events[i];

		if (event->latest != NEVER && event->latest + CLEAR_CLOCKS >= judge->now)
			judge_add_event(judge, event->cause, event->hard, event->earliest,
			    event->earliest > judge->now + CLEAR_CLOCKS ? event->latest : NEVER);
	}
	for (unsigned input = 0; input < KINDS; input++)
		for (unsigned a = 0; a < judge_axes(judge); a++) {
			const struct level *level = &machine->levels[input][a];

			if (level->may_until > judge->now && level->may_from != NEVER)
				add_events(judge, input, a, judge_later(level->may_from, judge->now),
				    judge_must(level, judge->now) && level->must_until == NEVER
					? judge->now + CLEAR_CLOCKS
					: NEVER);
		}
	if (machine->pressed)
		judge_add_event(judge, PASSO_CAUSE_ESTOP, true, judge->now,
		    machine->unsettled ? NEVER : judge->now + CLEAR_CLOCKS);
	judge_exceeding(judge);
}

void judge_reset_inputs(struct judge *judge, bool done)
{
	struct machine *machine = &judge->machine;

	machine->event_count = 0;
	judge_forget(judge);
	for (unsigned input = 0; input < KINDS; input++)
		for (unsigned a = 0; a < judge_axes(judge); a++) {
			machine->levels[input][a] = (struct level){NEVER, NEVER, NEVER, NEVER, false, false};
			if (input >= PASSO_INPUT_LIMIT_LOW && input <= PASSO_INPUT_PROBE
			    && is_active(machine, input, a))
				see_level(judge, input, a, SLACK);
		}
	/* it is seen for two more clocks */
	if (machine->pressed)
		judge_add_event(judge, PASSO_CAUSE_ESTOP, true, judge->now, NEVER);
	machine->pressed = machine->pressed && (machine->pins[PASSO_INPUT_ESTOP_N] == 0u || !done);
}

void judge_flags(struct judge *judge, const struct world_fact *fact)
{
	static const unsigned kinds[] = {
	    PASSO_INPUT_LIMIT_LOW, PASSO_INPUT_LIMIT_HIGH, PASSO_INPUT_HOME, PASSO_INPUT_ALARM};

	for (unsigned i = 0; i < 4u; i++)
		for (unsigned a = 0; a < judge_axes(judge); a++) {
			const struct level *level = &judge->machine.levels[kinds[i]][a];
			const bool flag = (fact->words[0] >> (8u * i + a) & 1u) != 0u;
			const uint64_t early = judge->now - fact->words[1];

			if (flag ? !level->may_have_been : level->was || judge_must(level, early))
				FAIL(judge, "axis %u: the flag of input %u is %d", a, kinds[i], flag);
		}
}
