/* SPDX-License-Identifier: MIT
 * Aiming: computes the start of a frame that hits a given event.
 */
#include "history_player.h"

#define BIT(event) (1u << EVENT_##event)

/* Preferred targets of each disturbance. */
static const uint32_t wanted_events[PLOT_KINDS] = {
    [PLOT_STOP] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(RAMP) | BIT(LINE),
    [PLOT_ABORT] = BIT(STEP) | BIT(DIR) | BIT(WAITS) | BIT(STATE) | BIT(STOPPING) | BIT(LINE),
    [PLOT_CLEAR] = BIT(GAP) | BIT(STATE) | BIT(WAITS) | BIT(STOPPING),
    [PLOT_ZERO] = BIT(GAP) | BIT(STATE) | BIT(WAITS) | BIT(QUIET),
    [PLOT_COMMAND] = BIT(GAP) | BIT(STATE) | BIT(QUIET),
    [PLOT_RATE] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(STOPPING),
    [PLOT_RATES] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(STOPPING),
    [PLOT_SLEW] = BIT(SLEW) | BIT(RATE) | BIT(STOPPING),
    [PLOT_DRAIN] = BIT(STATE),
    [PLOT_PINS] = BIT(GAP) | BIT(QUIET) | BIT(STATE) | BIT(DIR) | BIT(STEP),
    [PLOT_ENABLE] = BIT(STATE) | BIT(STEP),
    [PLOT_TIMING] = BIT(STEP) | BIT(DIR) | BIT(WAITS),
    [PLOT_RUN] = BIT(STATE) | BIT(LINE) | BIT(RAMP),
    [PLOT_SYNC] = BIT(STATE),
    [PLOT_RESET] = BIT(STEP) | BIT(DIR) | BIT(WAITS) | BIT(STATE) | BIT(TICK),
    [PLOT_NOW] = BIT(GAP) | BIT(RAMP) | BIT(TICK) | BIT(STATE) | BIT(STOPPING),
    [PLOT_MOTION] = BIT(LINE) | BIT(RAMP) | BIT(STATE) | BIT(STOPPING),
    [PLOT_TABLE] = BIT(GAP) | BIT(STATE),
    [PLOT_READ] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
    [PLOT_BAD] = BIT(STATE) | BIT(STEP),
    [PLOT_LIMIT] = BIT(STEP) | BIT(WAITS) | BIT(STATE) | BIT(DIR) | BIT(STOPPING),
    [PLOT_ALARM] = BIT(STEP) | BIT(STATE) | BIT(SLEW) | BIT(STOPPING) | BIT(RATE),
    [PLOT_ESTOP] = BIT(STEP) | BIT(STATE) | BIT(STOPPING) | BIT(LINE),
    [PLOT_HOME] = BIT(STEP) | BIT(STATE) | BIT(LINE) | BIT(STOPPING),
    [PLOT_PROBE] = BIT(STEP) | BIT(STATE) | BIT(SLEW) | BIT(STOPPING),
    [PLOT_NOISE] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
    [PLOT_TURN] = BIT(STEP) | BIT(STATE) | BIT(STOPPING),
    [PLOT_ARM] = BIT(STEP) | BIT(STATE),
    [PLOT_SILENCE] = BIT(STATE),
    [PLOT_MEASURE] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
};

/* Picks an event; all preferred kinds are equally likely. */
static const struct world_event *choose_event(
    const struct world *scout, struct plot_random *random, uint32_t wanted)
{
	uint32_t count[EVENT_KINDS] = {0}, kinds = 0, kind = 0;

	for (size_t i = 0; i < scout->event_count; i++)
		count[scout->events[i].kind]++;
	for (unsigned i = 0; i < EVENT_KINDS; i++)
		kinds += (wanted >> i & 1u) != 0u && count[i] != 0u ? 1u : 0u;
	if (kinds == 0u)
		return NULL;
	for (uint32_t drawn = plot_draw(random, kinds);; kind++)
		if ((wanted >> kind & 1u) != 0u && count[kind] != 0u && drawn-- == 0u)
			break;
	uint32_t drawn = plot_draw(random, count[kind]);
	for (size_t i = 0;; i++)
		if (scout->events[i].kind == kind && drawn-- == 0u)
			return &scout->events[i];
}

/* Whether a disturbance is allowed only in some states. */
static bool kind_is_gated(enum plot_kind kind)
{
	return kind == PLOT_CLEAR || kind == PLOT_ZERO || kind == PLOT_COMMAND || kind == PLOT_PINS
	    || kind == PLOT_TABLE || kind == PLOT_NOW;
}

/* Time from the start of an action to the point in it that is to hit the event. */
static int64_t lead(
    const struct world *scout, struct plot_random *random, enum plot_kind kind, struct action *action)
{
	const unsigned index = plot_draw(random, action->length);

	if (action->kind != ACTION_FRAME) {
		action->point = 'p';
		return 0;
	}
	if (action->operation == PASSO_OPERATION_READ || plot_chance(random, 8)) {
		action->point = 's';
		return (int64_t)plot_draw(random, 140);
	}
	if (plot_chance(random, kind_is_gated(kind) ? 60 : 20)) {
		action->point = 'c';
		return world_checks(scout, index);
	}
	action->point = 'e';
	return world_executes(scout, action->length, index);
}

void player_aim(
    const struct world *scout, struct plot_random *random, enum plot_kind kind, struct action *action)
{
	const uint32_t wanted = plot_chance(random, 80) ? wanted_events[kind] : ~0u;
	const int64_t from = (int64_t)scout->events_from;

	for (unsigned i = 0; i < 6u; i++) {
		const struct world_event *event = choose_event(scout, random, wanted);
		const int32_t range = plot_chance(random, 50) ? 4 : 16;
		const int32_t offset = (int32_t)plot_draw(random, 2u * (uint32_t)range + 1u) - range;

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
	action->at = (uint64_t)from + plot_draw(random, SCOUT_CLOCKS);
}
