/* SPDX-License-Identifier: MIT
 * Trigger and encoders of a machine: latched positions, counts, following error.
 */
#include "judge_state.h"

/* Clocks around the write in which an edge may count or not; from the write, and from a pin, until the
 * trigger sees the source; from a pin to the latch, besides the filter; from the latch until it can be read;
 * from a pin to its count, besides the filter. */
#define ARMING 12u
#define SELECTING 1u
#define ARRIVING 3u
#define NEAR 6u
#define LATCH 3u
#define READABLE 140u
#define COUNTING 4u
/* Following error: limit, and counts that may be on the way. */
#define LIMIT 40
#define ON_THE_WAY 2

/* The source of a trigger, its level so far, and since when it has it. */
struct source {
	unsigned input, axis;
	uint32_t inverted, level;
	uint64_t since;
	bool changed; /* since the write */
};

static struct source source_of(const struct judge *judge, struct passo_channel_trigger word)
{
	static const unsigned inputs[] = {[PASSO_TRIGGER_SOURCE_LIMIT_LOW] = PASSO_INPUT_LIMIT_LOW,
	    [PASSO_TRIGGER_SOURCE_LIMIT_HIGH] = PASSO_INPUT_LIMIT_HIGH,
	    [PASSO_TRIGGER_SOURCE_HOME] = PASSO_INPUT_HOME,
	    [PASSO_TRIGGER_SOURCE_PROBE] = PASSO_INPUT_PROBE};
	const struct machine *machine = &judge->machine;
	struct source source = {
	    .input = inputs[word.source], .axis = word.source == PASSO_TRIGGER_SOURCE_PROBE ? 0 : word.axis};

	source.inverted = (uint32_t)machine->inverted[source.input] >> source.axis & 1u;
	source.level = ((uint32_t)machine->pins[source.input] >> source.axis & 1u) ^ source.inverted;
	source.since = judge->now + SELECTING;
	return source;
}

/* The next change of the source from a fact on: its number, or that of all facts. */
static size_t next_change(const struct judge *judge, const struct source *source, size_t from)
{
	const struct world *world = judge->world;
	size_t i = from;

	for (; i < world->fact_count; i++) {
		const struct world_fact *fact = &world->facts[i];

		if (fact->kind == FACT_PIN && fact->words[0] == source->input
		    && ((fact->words[1] >> source->axis & 1u) ^ source->inverted) != source->level
		    && (i + 1u == world->fact_count || world->facts[i + 1u].clock != fact->clock
		        || world->facts[i + 1u].kind != FACT_PIN
		        || world->facts[i + 1u].words[0] != source->input))
			break;
	}
	return i;
}

static uint64_t clock_of(const struct judge *judge, size_t fact)
{
	return fact < judge->world->fact_count ? judge->world->facts[fact].clock : NEVER - ARMING;
}

static bool is_near(uint64_t a, uint64_t b)
{
	return a < b + NEAR && b < a + NEAR;
}

/* When the trigger that has just been written will be armed, and fire. */
static void foretell(struct judge *judge, struct passo_channel_trigger word, struct trigger *trigger)
{
	const uint64_t filter = judge->machine.filter;
	struct source source = source_of(judge, word);
	size_t next = next_change(judge, &source, judge->fact);
	uint64_t until = clock_of(judge, next);

	for (size_t i = 0; i < judge->fact; i++)
		trigger->unsure = trigger->unsure
		               || (judge->world->facts[i].kind == FACT_PIN
		                   && judge->world->facts[i].words[0] == source.input
		                   && judge->world->facts[i].clock + ARMING > judge->now);
	for (;;) { /* until a level has lasted */
		trigger->armed_at = source.since + filter + (source.changed ? 2u : 1u);
		trigger->unsure = trigger->unsure || is_near(until + ARRIVING, trigger->armed_at);
		if (until + ARRIVING > trigger->armed_at)
			break;
		if (until + ARRIVING > source.since || source.changed)
			source.changed = true;
		source.since = judge_later(until + ARRIVING, source.since);
		source.level ^= 1u;
		next = next_change(judge, &source, next);
		until = clock_of(judge, next);
	}
	uint32_t level = source.level; /* the one that has been accepted */
	for (;;) {
		if (next >= judge->world->fact_count)
			return;
		const uint64_t since = until;
		source.level ^= 1u;
		next = next_change(judge, &source, next);
		until = clock_of(judge, next);
		if (source.level == level || until - since <= filter)
			continue;
		level = source.level;
		if (level != (word.falling ? 1u : 0u)) {
			trigger->fires_at = since + filter + LATCH;
			return;
		}
	}
}

void judge_arm(struct judge *judge, uint32_t value)
{
	const struct passo_channel_trigger word = passo_unpack_channel_trigger(value);
	struct trigger *trigger = &judge->machine.trigger;
	const bool stops =
	    word.action == PASSO_TRIGGER_ACTION_SOFT_STOP || word.action == PASSO_TRIGGER_ACTION_HARD_STOP;

	*trigger = (struct trigger){
	    .armed = word.arm, .action = word.action, .fires_at = NEVER, .calm = {.from = judge->now}};
	if (!word.arm)
		return;
	const struct source source = source_of(judge, word);
	trigger->input = source.input;
	trigger->axis = source.axis;
	foretell(judge, word, trigger);
	if (stops && trigger->unsure)
		judge_add_event(judge, PASSO_CAUSE_TRIGGER, false, judge->now, NEVER);
}

/* It takes the level of its source again. */
void judge_rearm(struct judge *judge)
{
	struct trigger *trigger = &judge->machine.trigger;

	if (!trigger->armed || trigger->latched || trigger->unsure)
		return;
	trigger->unsure = true;
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
	const uint64_t early = judge->now - fact->words[1];

	if (!trigger->armed || trigger->unsure)
		return;
	if (state.fired ? !trigger->latched : trigger->latched && trigger->fires_at + SLACK < early)
		FAIL(judge, "the trigger has %sfired", state.fired ? "" : "not ");
	if (trigger->armed_at + SLACK < early && !state.fired && !state.armed)
		FAIL(judge, "the trigger is not armed");
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
	/* A leads upward: after a change of A the levels differ, after one of B they are the same */
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
