/* SPDX-License-Identifier: MIT
 * What must be known before a motion begins: inputs that have been stable for a period of the filter, and a
 * trigger that is armed.
 */
#include "judge_state.h"

static uint64_t period(const struct judge *judge)
{
	return (uint64_t)judge->machine.filter + 1u;
}

static void restart(struct calm *calm, uint64_t now)
{
	*calm = (struct calm){.known = false, .from = now};
}

/* A level ends; it was known if it had lasted. */
static void end_level(struct calm *calm, const struct judge *judge)
{
	calm->known = calm->known || judge->now + SLACK >= calm->from + period(judge);
	calm->from = judge->now;
}

void judge_forget(struct judge *judge)
{
	struct machine *machine = &judge->machine;

	restart(&machine->calm, judge->now);
	restart(&machine->trigger.calm, judge->now);
	machine->forgot_at = judge->now;
	judge_rearm(judge);
}

void judge_changes(struct judge *judge, unsigned input, unsigned a)
{
	struct machine *machine = &judge->machine;

	machine->changed_at[input][a] = judge->now;
	end_level(&machine->calm, judge);
	if (input == machine->trigger.input && a == machine->trigger.axis)
		end_level(&machine->trigger.calm, judge);
}

static bool is_active(const struct machine *machine, unsigned input, unsigned a)
{
	return ((unsigned)(machine->pins[input] ^ machine->inverted[input]) >> a & 1u) != 0u;
}

void judge_begins(struct judge *judge)
{
	struct machine *machine = &judge->machine;
	const struct trigger *trigger = &machine->trigger;

	if (!machine->calm.known && judge->now < machine->calm.from + period(judge))
		FAIL(judge, "a motion begins while an input is unknown");
	if (trigger->armed && !trigger->latched && !trigger->calm.known
	    && judge->now < trigger->calm.from + period(judge))
		FAIL(judge, "a motion begins while the trigger is being armed");
	/* known, and as it was when it became unknown */
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		const uint8_t bit = (uint8_t)(1u << a);

		if (is_active(machine, PASSO_INPUT_LIMIT_LOW, a)
		    && machine->changed_at[PASSO_INPUT_LIMIT_LOW][a] <= machine->forgot_at)
			machine->closed_low |= bit;
		if (is_active(machine, PASSO_INPUT_LIMIT_HIGH, a)
		    && machine->changed_at[PASSO_INPUT_LIMIT_HIGH][a] <= machine->forgot_at)
			machine->closed_high |= bit;
	}
}
