/* SPDX-License-Identifier: MIT
 * Stops of a machine: the first event is the cause, none is missed, hard ones end steps, soft ones keep their
 * slew.
 */
#include "judge_state.h"

/* Clocks from a level to the last edge of STEP, and to a state that shows the stop. */
#define LAST_STEP 4u
#define SHOWN 8u

void judge_machine_step(struct judge *judge, unsigned a)
{
	struct machine *machine = &judge->machine;
	const struct axis *axis = &judge->channel[0].axis[a];
	const unsigned input = axis->down ? PASSO_INPUT_LIMIT_LOW : PASSO_INPUT_LIMIT_HIGH;
	const uint8_t closed = axis->down ? machine->closed_low : machine->closed_high;
	const struct level *limit = &machine->levels[input][a];
	const bool soft = (machine->limit_soft >> a & 1u) != 0u && (closed >> a & 1u) == 0u;

	if (!soft && judge_must(limit, judge->now) && judge_must(limit, judge->now - LAST_STEP - 1u))
		FAIL(judge, "axis %u: a step toward its active limit switch", a);
	for (unsigned i = 0; i < machine->event_count; i++) {
		const struct stop_event *event = &machine->events[i];

		if (event->hard && event->latest != NEVER && judge->now > event->latest + LAST_STEP)
			FAIL(judge, "axis %u: a step %llu clocks after a hard stop, cause %d", a,
			    (unsigned long long)(judge->now - event->latest), event->cause);
	}
	if (machine->compares && a == machine->compare_axis) {
		machine->compare_distance -= axis->down ? -1 : 1;
		if (machine->compare_distance == 0) {
			machine->compare_distance = machine->compare_interval;
			machine->compare_until = judge->now + machine->compare_width;
			judge->counts->compares++;
		}
	}
	judge_follow(judge, a);
}

/* The limits that are closed as a motion begins. */
static void begin_motion(struct judge *judge)
{
	struct machine *machine = &judge->machine;

	machine->closed_low = machine->closed_high = 0;
	machine->ran_from = judge->now;
	for (unsigned a = 0; a < judge_axes(judge) && judge->now > 40u; a++) {
		const uint64_t before = judge->now - 40u;

		if (judge_must(&machine->levels[PASSO_INPUT_LIMIT_LOW][a], before))
			machine->closed_low |= (uint8_t)(1u << a);
		if (judge_must(&machine->levels[PASSO_INPUT_LIMIT_HIGH][a], before))
			machine->closed_high |= (uint8_t)(1u << a);
	}
	judge_begins(judge);
}

void judge_machine_before(struct judge *judge, const struct passo_outputs *pins)
{
	if ((pins->running & ~judge->pins.running) != 0u)
		begin_motion(judge);
	if ((judge->pins.running & ~pins->running) != 0u)
		judge->machine.rested_at = judge->now;
}

void judge_machine_after(struct judge *judge, const struct passo_outputs *pins)
{
	struct machine *machine = &judge->machine;

	if (pins->irq && !judge->pins.irq) {
		machine->stopped_at = judge->now;
		for (unsigned a = 0; a < judge_axes(judge); a++)
			judge->counts->tries += ((machine->closed_low & machine->line_low)
			                            | (machine->closed_high & machine->line_high))
			                         >> a
			                      & 1u;
		machine->closed_low = machine->closed_high = 0;
	}
	if (pins->power != 0u && pins->running == 0u)
		FAIL(judge, "power while nothing moves");
	if (pins->power != 0u && machine->held && judge->now > machine->held_from)
		FAIL(judge, "power in a hold");
	if (judge->now >= machine->compare_unsure
	    && (pins->compare != 0u) != (judge->now < machine->compare_until))
		FAIL(judge, "compare is %u", pins->compare);
	if (pins->outputs != judge->pins.outputs && judge->now >= judge->enable_unknown_until) {
		while (machine->word < machine->word_count && machine->words[machine->word] != pins->outputs)
			machine->word++;
		if (machine->word == machine->word_count)
			FAIL(judge, "outputs %02llx are not those of a line to come",
			    (unsigned long long)pins->outputs);
		judge->counts->words++;
	}
}

bool judge_enabled(struct judge *judge, unsigned a, bool *unsure)
{
	struct machine *machine = &judge->machine;
	struct axis *axis = &judge->channel[0].axis[a];
	const struct level *alarm = &machine->levels[PASSO_INPUT_ALARM][a];
	const uint8_t bit = (uint8_t)(1u << a);

	if ((machine->alarm_disables & bit) != 0u && judge->now > 6u) {
		if (judge_may(alarm, judge->now - 6u, judge->now + 2u))
			machine->enable_unsure |= bit;
		if (judge_must(alarm, judge->now) && judge_must(alarm, judge->now - 6u)) {
			machine->enable_unsure &= (uint8_t)~bit;
			axis->enabled = false;
		}
	}
	*unsure = (machine->enable_unsure & bit) != 0u && !machine->pressed;
	return axis->enabled && !machine->pressed;
}

/* The slew of the only stop, from full speed. */
static void see_slew(struct judge *judge, const struct stop_event *event)
{
	const struct machine *machine = &judge->machine;
	const uint64_t tick = UINT64_C(1) << judge->world->model.parameters.tick_log2;
	const uint64_t slew = judge_later(machine->stop_slew, 1);
	const uint64_t ticks = (PASSO_RATE_ONE + slew - 1u) / slew;
	const uint64_t stopped = machine->stopped_at;

	if (event->hard || event->latest == NEVER || !machine->full_rate || machine->event_count != 1u
	    || machine->ran_from == 0u || machine->ran_from > event->earliest || stopped <= event->latest
	    || machine->rested_at + SHOWN < stopped)
		return;
	judge->counts->slews++;
	if (stopped + SHOWN < event->earliest + (ticks - 1u) * tick
	    || stopped > event->latest + (ticks + 1u) * tick + 64u)
		FAIL(judge, "a soft stop took %llu clocks, its slew %llu ticks",
		    (unsigned long long)(stopped - event->latest), (unsigned long long)ticks);
}

static void see_cause(struct judge *judge, enum passo_cause cause)
{
	const struct machine *machine = &judge->machine;
	const struct stop_event *first = NULL, *found = NULL;

	for (unsigned i = 0; i < machine->event_count; i++) {
		const struct stop_event *event = &machine->events[i];

		if (!first || event->latest < first->latest)
			first = event;
	}
	for (unsigned i = 0; i < machine->event_count; i++) {
		const struct stop_event *event = &machine->events[i];

		if (event->cause == cause && event->earliest <= first->latest
		    && event->earliest <= machine->stopped_at)
			found = event;
	}
	if (!found)
		FAIL(judge, "stopped at %llu, cause %d, but the first event was %d at %llu",
		    (unsigned long long)machine->stopped_at, cause, first ? (int)first->cause : 0,
		    first ? (unsigned long long)first->latest : 0ull);
	else
		see_slew(judge, found);
	judge->counts->causes++;
}

void judge_machine_state(struct judge *judge, struct passo_channel_state now, uint32_t rate)
{
	struct machine *machine = &judge->machine;
	const bool stopped = now.state == PASSO_STATE_STOPPED;

	if (stopped && judge->pins.irq)
		see_cause(judge, now.cause);
	for (unsigned i = 0; i < machine->event_count && !stopped; i++) {
		const struct stop_event *event = &machine->events[i];

		if (event->latest != NEVER && judge->now > event->latest + SHOWN
		    && (event->hard || !now.stopping))
			FAIL(judge, "state %d although cause %d stops it at %llu", now.state, event->cause,
			    (unsigned long long)event->latest);
	}
	for (unsigned a = 0; a < judge_axes(judge) && !stopped && !now.stopping; a++)
		if (now.state == PASSO_STATE_RUN && machine->shafts[a].exceeded_from + 200u < judge->now)
			FAIL(judge, "axis %u: its following error does not stop the channel", a);
	machine->held = rate == 0u;
	machine->held_from = judge->now + SHOWN;
	judge->counts->holds += machine->held && (judge->pins.running != 0u) ? 1u : 0u;
}

void judge_feed(struct judge *judge, const struct world_fact *fact)
{
	judge->machine.fed_from = fact->clock;
	judge->machine.fed_until = fact->clock + fact->words[0];
	judge->machine.silent = judge->machine.starved = false;
}

/* Called in the order of the clocks, before anything is seen. */
void judge_silence(struct judge *judge)
{
	struct machine *machine = &judge->machine;
	const uint64_t time = (uint64_t)machine->watchdog << 16;
	const uint64_t tick = UINT64_C(1) << judge->world->model.parameters.tick_log2;
	const uint64_t earliest = machine->fed_from + time - SHOWN,
		       latest = machine->fed_until + time + tick + SHOWN;

	if (machine->watchdog == 0u || machine->silent || judge->now <= earliest)
		return;
	if (!machine->starved)
		machine->starved_moving = judge->pins.running != 0u;
	machine->starved = true;
	if (judge->now <= latest)
		return;
	machine->silent = true;
	/* a fast stop may be over by now */
	if (machine->starved_moving)
		judge_add_event(
		    judge, PASSO_CAUSE_WATCHDOG, false, earliest, judge->pins.running != 0u ? latest : NEVER);
}
