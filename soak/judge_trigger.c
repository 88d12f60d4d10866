/* SPDX-License-Identifier: MIT
 * Trigger and encoders of a machine: latched positions, counts, following error.
 */
#include "judge_state.h"

/* Clocks around arming in which an edge may count or not; from a pin to the latch, besides the filter; from
 * the latch until it can be read; from a pin to its count, besides the filter. */
#define ARMING 12u
#define LATCH 3u
#define READABLE 140u
#define COUNTING 4u
/* Clocks that the core counts from arming to firing, less those from the write. */
#define ARMED 0
/* Following error: limit, and counts that may be on the way. */
#define LIMIT 40
#define ON_THE_WAY 2

/* When the trigger that has just been armed will fire. */
static uint64_t fires_at(struct judge *judge, struct passo_channel_trigger word, bool *unsure)
{
	static const unsigned inputs[] = {[PASSO_TRIGGER_SOURCE_LIMIT_LOW] = PASSO_INPUT_LIMIT_LOW,
	    [PASSO_TRIGGER_SOURCE_LIMIT_HIGH] = PASSO_INPUT_LIMIT_HIGH,
	    [PASSO_TRIGGER_SOURCE_HOME] = PASSO_INPUT_HOME,
	    [PASSO_TRIGGER_SOURCE_PROBE] = PASSO_INPUT_PROBE};
	const struct machine *machine = &judge->machine;
	const unsigned input = inputs[word.source],
		       a = word.source == PASSO_TRIGGER_SOURCE_PROBE ? 0 : word.axis;
	const uint32_t inverted = (uint32_t)machine->inverted[input] >> a & 1u;
	uint32_t level = ((uint32_t)machine->pins[input] >> a & 1u) ^ inverted, pin = level;
	uint64_t since = judge->now;

	*unsure = false;
	for (size_t i = 0; i < judge->world->fact_count; i++) {
		const struct world_fact *fact = &judge->world->facts[i];

		if (fact->kind != FACT_PIN || fact->words[0] != input)
			continue;
		const uint32_t now = (fact->words[1] >> a & 1u) ^ inverted;
		if (i < judge->fact) {
			*unsure = *unsure || fact->clock + ARMING > judge->now;
			continue;
		}
		*unsure = *unsure || fact->clock < judge->now + ARMING;
		if (now == pin)
			continue;
		if (pin != level && fact->clock - since > machine->filter) {
			level = pin;
			if (level != (word.falling ? 1u : 0u))
				return since + machine->filter + LATCH;
		}
		pin = now;
		since = fact->clock;
	}
	return pin != level && pin != (word.falling ? 1u : 0u) ? since + machine->filter + LATCH : NEVER;
}

void judge_arm(struct judge *judge, uint32_t value)
{
	const struct passo_channel_trigger word = passo_unpack_channel_trigger(value);
	struct trigger *trigger = &judge->machine.trigger;

	*trigger = (struct trigger){
	    .armed = word.arm, .action = word.action, .armed_at = judge->now, .fires_at = NEVER};
	if (!word.arm)
		return;
	trigger->fires_at = fires_at(judge, word, &trigger->unsure);
	if (word.action != PASSO_TRIGGER_ACTION_SOFT_STOP && word.action != PASSO_TRIGGER_ACTION_HARD_STOP)
		return;
	if (trigger->unsure)
		judge_add_event(judge, PASSO_CAUSE_TRIGGER, false, judge->now, NEVER);
}

/* The latch has the steps up to its clock. */
void judge_latch(struct judge *judge)
{
	struct trigger *trigger = &judge->machine.trigger;
	const bool hard = trigger->action == PASSO_TRIGGER_ACTION_HARD_STOP;

	if (!trigger->armed || trigger->unsure || trigger->latched || judge->now <= trigger->fires_at)
		return;
	trigger->latched = true;
	for (unsigned a = 0; a < judge_axes(judge); a++)
		trigger->position[a] = judge->channel[0].axis[a].position;
	if (hard || trigger->action == PASSO_TRIGGER_ACTION_SOFT_STOP)
		judge_add_event(judge, PASSO_CAUSE_TRIGGER, hard, trigger->fires_at, trigger->fires_at + 1u);
}

void judge_trigger_state(struct judge *judge, const struct world_fact *fact)
{
	const struct passo_channel_trigger_state state = passo_unpack_channel_trigger_state(fact->words[0]);
	const struct trigger *trigger = &judge->machine.trigger;
	const uint64_t early = judge->now - fact->words[2];

	if (!trigger->armed || trigger->unsure)
		return;
	if (state.fired ? !trigger->latched : trigger->latched && trigger->fires_at + SLACK < early)
		FAIL(judge, "the trigger has %sfired", state.fired ? "" : "not ");
	const int64_t clocks = (int64_t)(trigger->fires_at - trigger->armed_at);
	if (state.fired && (int64_t)fact->words[1] - clocks != ARMED)
		FAIL(judge, "the trigger fired %u clocks after arming instead of %lld", fact->words[1],
		    (long long)clocks);
	judge->counts->fired += state.fired ? 1u : 0u;
}

void judge_latched(struct judge *judge, const struct world_fact *fact)
{
	const struct trigger *trigger = &judge->machine.trigger;

	if (!trigger->armed || trigger->unsure || !trigger->latched
	    || trigger->fires_at + READABLE > judge->now - fact->words[judge_axes(judge)])
		return;
	judge->counts->latches++;
	for (unsigned a = 0; a < judge_axes(judge); a++)
		if ((int32_t)fact->words[a] != (int32_t)trigger->position[a])
			FAIL(judge, "axis %u: latched %d instead of %lld", a, (int32_t)fact->words[a],
			    (long long)trigger->position[a]);
}

void judge_turn(struct judge *judge, unsigned input, unsigned a)
{
	struct machine *machine = &judge->machine;
	struct shaft *shaft = &machine->shafts[a];
	const bool is_b = input == PASSO_INPUT_ENCODER_B;
	const bool level = (machine->pins[input] >> a & 1u) != 0u;
	bool last = is_b ? shaft->b : shaft->a;

	for (unsigned i = 0; i < shaft->turn_count; i++)
		last = last != (shaft->turns[i].is_b == is_b);
	if (judge_next_change(judge, input, a) - judge->now <= machine->encoder_filter || level == last)
		return;
	if (shaft->turn_count < TURNS_MAX)
		shaft->turns[shaft->turn_count++] =
		    (struct turn){judge->now + machine->encoder_filter + COUNTING, is_b};
}

static void count(struct judge *judge, unsigned a, bool a_changes, bool b_changes)
{
	struct shaft *shaft = &judge->machine.shafts[a];
	/* A leads upwards: after a change of A the levels differ, after one of B they are the same */
	const bool differ = (shaft->a != a_changes) != (shaft->b != b_changes);

	shaft->a = shaft->a != a_changes;
	shaft->b = shaft->b != b_changes;
	if (a_changes && b_changes)
		return;
	shaft->count += differ == a_changes ? 1 : -1;
	if (shaft->count < shaft->lowest)
		shaft->lowest = shaft->count;
	if (shaft->count > shaft->highest)
		shaft->highest = shaft->count;
	judge->counts->counted++;
	judge_follow(judge, a);
}

void judge_turns(struct judge *judge)
{
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		struct shaft *shaft = &judge->machine.shafts[a];
		unsigned done = 0;

		while (done < shaft->turn_count && shaft->turns[done].clock <= judge->now) {
			const struct turn *turn = &shaft->turns[done];
			const bool both = done + 1u < shaft->turn_count && turn[1].clock == turn->clock;

			count(judge, a, both || !turn->is_b, both || turn->is_b);
			done += both ? 2u : 1u;
		}
		for (unsigned i = done; i < shaft->turn_count; i++)
			shaft->turns[i - done] = shaft->turns[i];
		shaft->turn_count -= done;
	}
}

void judge_counts_read(struct judge *judge, const struct world_fact *fact)
{
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		const struct shaft *shaft = &judge->machine.shafts[a];
		const int64_t read = (int32_t)fact->words[a];

		judge->counts->encoders++;
		if (!shaft->unsure && (read < shaft->lowest || read > shaft->highest))
			FAIL(judge, "axis %u: encoder position %lld after %lld counts", a, (long long)read,
			    (long long)shaft->count);
	}
}

static int64_t error_of(const struct judge *judge, unsigned a)
{
	const struct shaft *shaft = &judge->machine.shafts[a];
	const int64_t error = judge->channel[0].axis[a].position - shaft->count - shaft->offset;

	return error < 0 ? -error : error;
}

/* The following error of an axis has changed. */
void judge_follow(struct judge *judge, unsigned a)
{
	struct shaft *shaft = &judge->machine.shafts[a];
	const int64_t error = error_of(judge, a);

	if (!shaft->judged)
		return;
	if (error >= LIMIT - ON_THE_WAY && !shaft->near) {
		shaft->near = true;
		judge_add_event(judge, PASSO_CAUSE_FOLLOWING_ERROR, false, judge->now, NEVER);
	}
	if (error < LIMIT - ON_THE_WAY)
		shaft->near = false;
	if (error < LIMIT + ON_THE_WAY)
		shaft->exceeded_from = NEVER - 1000u;
	else if (shaft->exceeded_from > judge->now)
		shaft->exceeded_from = judge->now;
}

void judge_exceeding(struct judge *judge)
{
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		judge->machine.shafts[a].near = false;
		judge_follow(judge, a);
	}
}

void judge_write_encoder(struct judge *judge, unsigned a, unsigned place, uint32_t value)
{
	struct shaft *shaft = &judge->machine.shafts[a];
	const uint32_t stops = 3u << PASSO_ENCODER_SETUP_STOP_SOFT_LSB;

	if (place == PASSO_ENCODER_SETUP)
		shaft->judged = (value & stops) != 0u;
	if (place == PASSO_ENCODER_RATIO)
		shaft->offset = judge->channel[0].axis[a].position - shaft->count;
	shaft->exceeded_from = NEVER - 1000u;
}

void judge_zero_encoders(struct judge *judge)
{
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		struct shaft *shaft = &judge->machine.shafts[a];

		shaft->unsure = shaft->turn_count != 0u;
		shaft->count = shaft->lowest = shaft->highest = shaft->offset = 0;
	}
}
