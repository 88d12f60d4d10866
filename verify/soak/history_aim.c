/* SPDX-License-Identifier: MIT
 * Aiming: computes the start of a frame that hits a given event.
 */
#include "history_player.h"

#define BIT(event) (1u << EVENT_##event)

/* Preferred targets of each disturbance. */
static const uint32_t wanted_events[SCENARIO_KINDS] = {
    [SCENARIO_STOP] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(RAMP) | BIT(LINE),
    [SCENARIO_ABORT] = BIT(STEP) | BIT(DIR) | BIT(WAITS) | BIT(STATE) | BIT(STOPPING) | BIT(LINE),
    [SCENARIO_CLEAR] = BIT(GAP) | BIT(STATE) | BIT(WAITS) | BIT(STOPPING),
    [SCENARIO_ZERO] = BIT(GAP) | BIT(STATE) | BIT(WAITS) | BIT(QUIET),
    [SCENARIO_COMMAND] = BIT(GAP) | BIT(STATE) | BIT(QUIET),
    [SCENARIO_RATE] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(STOPPING),
    [SCENARIO_RATES] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(STOPPING),
    [SCENARIO_SLEW] = BIT(SLEW) | BIT(RATE) | BIT(STOPPING),
    [SCENARIO_DRAIN] = BIT(STATE),
    [SCENARIO_PINS] = BIT(GAP) | BIT(QUIET) | BIT(STATE) | BIT(DIR) | BIT(STEP),
    [SCENARIO_ENABLE] = BIT(STATE) | BIT(STEP),
    [SCENARIO_TIMING] = BIT(STEP) | BIT(DIR) | BIT(WAITS),
    [SCENARIO_RUN] = BIT(STATE) | BIT(LINE) | BIT(RAMP),
    [SCENARIO_SYNC] = BIT(STATE),
    [SCENARIO_RESET] = BIT(STEP) | BIT(DIR) | BIT(WAITS) | BIT(STATE) | BIT(TICK),
    [SCENARIO_NOW] = BIT(GAP) | BIT(RAMP) | BIT(TICK) | BIT(STATE) | BIT(STOPPING),
    [SCENARIO_MOTION] = BIT(LINE) | BIT(RAMP) | BIT(STATE) | BIT(STOPPING),
    [SCENARIO_TABLE] = BIT(GAP) | BIT(STATE),
    [SCENARIO_READ] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
    [SCENARIO_BAD] = BIT(STATE) | BIT(STEP),
    [SCENARIO_LIMIT] = BIT(STEP) | BIT(WAITS) | BIT(STATE) | BIT(DIR) | BIT(STOPPING),
    [SCENARIO_ALARM] = BIT(STEP) | BIT(STATE) | BIT(SLEW) | BIT(STOPPING) | BIT(RATE),
    [SCENARIO_ESTOP] = BIT(STEP) | BIT(STATE) | BIT(STOPPING) | BIT(LINE),
    [SCENARIO_HOME] = BIT(STEP) | BIT(STATE) | BIT(LINE) | BIT(STOPPING),
    [SCENARIO_PROBE] = BIT(STEP) | BIT(STATE) | BIT(SLEW) | BIT(STOPPING),
    [SCENARIO_NOISE] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
    [SCENARIO_TURN] = BIT(STEP) | BIT(STATE) | BIT(STOPPING),
    [SCENARIO_ARM] = BIT(STEP) | BIT(STATE),
    [SCENARIO_SILENCE] = BIT(STATE),
    [SCENARIO_MEASURE] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
};

/* Picks an event; all preferred kinds are equally likely. */
static const struct world_event *choose_event(
    const struct world *scout, struct scenario_random *random, uint32_t wanted)
{
	uint32_t count[EVENT_KINDS] = {0}, kinds = 0, kind = 0;

	for (size_t i = 0; i < scout->event_count; i++)
		count[scout->events[i].kind]++;
	for (unsigned i = 0; i < EVENT_KINDS; i++)
		kinds += (wanted >> i & 1u) != 0u && count[i] != 0u ? 1u : 0u;
	if (kinds == 0u)
		return NULL;
	for (uint32_t drawn = scenario_draw(random, kinds);; kind++)
		if ((wanted >> kind & 1u) != 0u && count[kind] != 0u && drawn-- == 0u)
			break;
	uint32_t drawn = scenario_draw(random, count[kind]);
	for (size_t i = 0;; i++)
		if (scout->events[i].kind == kind && drawn-- == 0u)
			return &scout->events[i];
}

/* Whether a disturbance is allowed only in some states. */
static bool kind_is_gated(enum scenario_kind kind)
{
	return kind == SCENARIO_CLEAR || kind == SCENARIO_ZERO || kind == SCENARIO_COMMAND
	    || kind == SCENARIO_PINS || kind == SCENARIO_TABLE || kind == SCENARIO_NOW;
}

/* Time from the start of an action to the point in it that is to hit the event. */
static int64_t lead(
    const struct world *scout, struct scenario_random *random, enum scenario_kind kind, struct action *action)
{
	const unsigned index = scenario_draw(random, action->length);

	if (action->kind != ACTION_FRAME) {
		action->point = 'p';
		return 0;
	}
	if (action->operation == PASSO_OPERATION_READ || scenario_chance(random, 8)) {
		action->point = 's';
		return (int64_t)scenario_draw(random, 140);
	}
	if (scenario_chance(random, kind_is_gated(kind) ? 60 : 20)) {
		action->point = 'c';
		return world_checks(scout, index);
	}
	action->point = 'e';
	return world_executes(scout, action->length, index);
}

void player_aim(
    const struct world *scout, struct scenario_random *random, enum scenario_kind kind, struct action *action)
{
	const uint32_t wanted = scenario_chance(random, 80) ? wanted_events[kind] : ~0u;
	const int64_t from = (int64_t)scout->events_from;

	for (unsigned i = 0; i < 6u; i++) {
		const struct world_event *event = choose_event(scout, random, wanted);
		const int32_t range = scenario_chance(random, 50) ? 4 : 16;
		const int32_t offset = (int32_t)scenario_draw(random, 2u * (uint32_t)range + 1u) - range;

		if (!event)
			break;
		const int64_t at = (int64_t)event->clock + offset - lead(scout, random, kind, action);
		if (at < from + 2)
			continue;
		action->at = (uint64_t)at;
		action->event = event->kind;
		action->event_clock = event->clock;
		action->offset = offset;
		return;
	}
	action->at = (uint64_t)from + scenario_draw(random, SCOUT_CLOCKS);
}
