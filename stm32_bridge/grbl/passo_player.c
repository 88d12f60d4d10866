/* SPDX-License-Identifier: MIT
 * An action is taken immediately, or waits: a line for room on the path, a probe and M0 for the end of the
 * path.
 */
#include "passo_player.h"

#include "passo_driver.h"
#include "passo_math.h"
#include "passo_outputs.h"
#include "passo_player_private.h"

#define ACTIONS_MICROSECONDS 200u
#define MICROSECONDS_PER_SECOND 1000000u
#define SETTLES_MICROSECONDS 50000u /* until the input of a spindle that is to change its speed counts */
#define LEVELS_AT 16u               /* in the output word */

void passo_player_open(struct passo_player *player, struct passo_gcode *gcode, struct passo_path_feed *feed,
    const struct passo_player_machine *machine)
{
	*player = (struct passo_player){
	    .gcode = gcode, .feed = feed, .machine = machine, .levels = PASSO_PLAYER_UNSURE};
}

bool passo_player_has_taken(const struct passo_player *player)
{
	return !player->waits && !player->probes
	    && (!passo_player_follows(player) || passo_player_collects(player))
	    && !(PASSO_GCODE_HAS_TOOLS && (player->spins || player->restores))
	    && !passo_gcode_is_busy(player->gcode);
}

bool passo_player_is_ready(const struct passo_player *player)
{
	return passo_player_has_taken(player) && !player->paused;
}

bool passo_player_is_idle(const struct passo_player *player)
{
	return passo_player_is_ready(player) && !passo_player_follows(player)
	    && !passo_path_feed_is_moving(player->feed);
}

void passo_player_go_on(struct passo_player *player)
{
	if (PASSO_GCODE_HAS_TOOLS && player->changes) {
		passo_gcode_load(player->gcode, player->loads);
		player->restores = true;
	}
	player->paused = false;
	if (PASSO_GCODE_HAS_TOOLS)
		player->changes = false;
}

void passo_player_admit(struct passo_player *player)
{
	player->paused = false;
}

void passo_player_give_up(struct passo_player *player)
{
	player->changes = false;
}

void passo_player_take(struct passo_player *player, const struct passo_gcode_action *action)
{
	player->action = *action;
	player->waits = true;
}

/* Whether the spindle has to come up to speed for levels. */
static bool spins_up(const struct passo_player *player, uint8_t levels)
{
	const unsigned on = PASSO_GCODE_OUTPUT_SPINDLE >> LEVELS_AT,
		       reverse = PASSO_GCODE_OUTPUT_REVERSE >> LEVELS_AT;

	return PASSO_GCODE_HAS_TOOLS && player->machine->spin_up > 0 && (levels & on)
	    && ((levels ^ player->levels) & (on | reverse));
}

/* What the program has on; while a tool is changed, neither spindle nor coolant. */
static uint32_t output_of(const struct passo_player *player, uint32_t output)
{
	if (PASSO_GCODE_HAS_TOOLS && player->changes)
		output &= PASSO_GCODE_OUTPUTS_DIGITAL;
	return player->feed->passo->has_outputs ? output : 0u;
}

/* At rest. Error: MOVING, some pins still wait for their times. */
static enum passo_error set_output(struct passo_player *player, uint32_t output)
{
	struct passo *passo = player->feed->passo;
	const uint8_t levels = (uint8_t)(output_of(player, output) >> LEVELS_AT);

	if (!passo->has_outputs || levels == player->levels)
		return PASSO_OK;
	const enum passo_error error = passo_set_levels(passo, levels);
	if (error != PASSO_OK)
		return error;
	if (PASSO_GCODE_HAS_TOOLS) {
		player->spins = spins_up(player, levels);
		player->spins_at = passo_driver_now(passo);
	}
	player->levels = levels;
	return PASSO_OK;
}

/* Of set_output(), which is called again. */
static enum passo_error try_again(enum passo_error error)
{
	return error == PASSO_ERROR_MOVING ? PASSO_OK : error;
}

/* Time passes unless held. */
static enum passo_error mind_spindle(struct passo_player *player, enum passo_player_event *event)
{
#ifdef PASSO_PLAIN_GCODE
	(void)player, (void)event;
	return PASSO_OK;
#else
	const struct passo_player_machine *machine = player->machine;
	const uint32_t now = passo_driver_now(player->feed->passo);

	if (!player->spins)
		return PASSO_OK;
	if (player->held)
		player->spins_at = now;
	const uint32_t passed = now - player->spins_at;
	bool there = machine->at_speed == 0u && passed >= machine->spin_up;
	if (machine->at_speed > 0u && passed >= SETTLES_MICROSECONDS) {
		const enum passo_error error = passo_player_hear(player, machine->at_speed, &there);

		if (error != PASSO_OK)
			return error;
	}
	player->spins = !there && passed < machine->spin_up;
	if (!player->spins && !there) {
		*event = PASSO_PLAYER_SLOW;
		passo_player_drop(player);
	}
	return PASSO_OK;
#endif
}

bool passo_player_follows(const struct passo_player *player)
{
#ifdef PASSO_WITHOUT_THREADS
	(void)player;
	return false;
#else
	return player->thread.step != PASSO_PLAYER_FREE;
#endif
}

bool passo_player_collects(const struct passo_player *player)
{
#ifdef PASSO_WITHOUT_THREADS
	(void)player;
	return false;
#else
	const struct passo_player_thread *thread = &player->thread;

	return (thread->step == PASSO_PLAYER_SET || thread->step == PASSO_PLAYER_SPIN) && !thread->rigid
	    && thread->pass.lines < PASSO_PASS_LINES_MAX;
#endif
}

int64_t passo_player_length(int64_t steps, uint64_t scale)
{
	const uint64_t twice =
	    passo_mul_div(passo_size64(steps) * PASSO_GCODE_MILLION, UINT64_C(1) << 33, scale);
	const int64_t size = (int64_t)((twice + 1) / 2);

	return steps < 0 ? -size : size;
}

void passo_player_place(const struct passo_player *player, const int32_t *motors, passo_gcode_position place)
{
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++) {
		uint32_t parts = 1;
		const int64_t sum = passo_path_axis_place(player->feed->path, axis, motors, &parts);

		place[axis] = passo_player_length(sum, player->machine->axis[axis].steps_per_mm * parts);
	}
}

bool passo_player_allows(const struct passo_player *player, const int64_t *target)
{
	const struct passo_player_machine *machine = player->machine;

	for (unsigned axis = 0; machine->limited && axis < player->gcode->settings.axes; axis++) {
		if (target[axis] < machine->low[axis] || target[axis] > machine->high[axis])
			return false;
	}
	return true;
}

void passo_player_drop(struct passo_player *player)
{
	const struct passo_path_planner *path = player->feed->path;
	passo_gcode_position position;
	int32_t steps[PASSO_AXES_MAX];

	for (unsigned motor = 0; motor < passo_path_motors(path); motor++)
		steps[motor] = (int32_t)path->at.steps[motor];
	passo_player_place(player, steps, position);
	passo_gcode_set_position(player->gcode, position);
	player->waits = false;
}

static enum passo_error take_line(struct passo_player *player)
{
	const struct passo_gcode_action *action = &player->action;
	const uint32_t output = output_of(player, action->output);
	struct passo_path_move move = {.feed = action->feed, .output = output};

	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		move.target[axis] = passo_gcode_millimetres(action->target[axis]);
	passo_path_tolerance(player->feed->path, action->tolerance);
	const uint32_t known = player->feed->path->added;
	const enum passo_plan_error error = passo_path_add(player->feed->path, &move);
	player->waits = error == PASSO_PLAN_PATH_FULL;
	if (error == PASSO_PLAN_OK) {
		player->chords++;
		if (action->stops)
			passo_path_dwell(player->feed->path, 0);
	}
	const uint32_t added = player->feed->path->added;
	if (added != known) { /* a line of no length never gets to the core, nor one that is taken back */
		player->levels =
		    added > known ? (uint16_t)(output >> LEVELS_AT) : player->levels | PASSO_PLAYER_UNSURE;
		passo_player_note(player, known);
	}
	if (error == PASSO_PLAN_OK || player->waits)
		return PASSO_OK;
	passo_player_drop(player);
	return (enum passo_error)(PASSO_ERROR_PLAN + error);
}

enum passo_error passo_player_restart(struct passo_player *player)
{
	int32_t positions[PASSO_AXES_MAX] = {0};
	passo_gcode_position position = {0};
	const enum passo_error error = passo_positions(player->feed->passo, positions);

	if (error != PASSO_OK)
		return error;
	passo_player_place(player, positions, position);
	passo_path_restart(player->feed->path, positions);
	passo_path_feed_open(player->feed, player->feed->passo, player->feed->path);
	passo_gcode_set_position(player->gcode, position);
	player->waits = player->probes = player->paused = player->dwells = false;
#ifndef PASSO_WITHOUT_THREADS
	player->thread.step = PASSO_PLAYER_FREE;
#endif
	player->levels |= PASSO_PLAYER_UNSURE;
	if (PASSO_GCODE_HAS_TOOLS)
		player->restores = player->spins = player->listened = false;
	return PASSO_OK;
}

void passo_player_dwell(struct passo_player *player)
{
	const uint32_t now = passo_driver_now(player->feed->passo);
	const uint32_t passed = player->held || !player->dwells ? 0u : now - player->dwells_at;

	if (!player->dwells)
		player->dwell = player->action.microseconds;
	player->dwell -= passed < player->dwell ? passed : player->dwell;
	player->dwells_at = now;
	player->dwells = player->waits = player->dwell > 0;
}

/* What begins when the motion before has ended. */
static enum passo_error take_at_rest(struct passo_player *player, enum passo_player_event *event)
{
	passo_path_end(player->feed->path);
	player->waits = passo_path_feed_is_moving(player->feed);
	if (player->waits)
		return PASSO_OK;
	const enum passo_error error = set_output(player, player->action.output);
	player->waits = error != PASSO_OK;
	if (player->waits)
		return try_again(error);
	switch (player->action.kind) {
	case PASSO_GCODE_PROBE:
		return passo_player_begin_probe(player, event);
#ifndef PASSO_WITHOUT_THREADS
	case PASSO_GCODE_THREAD:
		return passo_player_begin_thread(player);
#endif
	case PASSO_GCODE_DWELL:
		passo_player_dwell(player);
		break;
#ifndef PASSO_PLAIN_GCODE
	case PASSO_GCODE_INPUT:
		return passo_player_listen(player, event);
#endif
	case PASSO_GCODE_PAUSE:
		player->paused = true;
		*event = PASSO_PLAYER_PAUSED;
		break;
	case PASSO_GCODE_CHANGE:
		if (!PASSO_GCODE_HAS_TOOLS)
			break;
		player->paused = player->changes = true;
		player->loads = player->action.tool;
		*event = PASSO_PLAYER_TOOL;
		break;
	case PASSO_GCODE_END:
		*event = PASSO_PLAYER_ENDED;
		break;
	default: /* the outputs alone */
		break;
	}
	return PASSO_OK;
}

static bool has_target(enum passo_gcode_kind kind)
{
#ifndef PASSO_WITHOUT_THREADS
	if (kind == PASSO_GCODE_THREAD)
		return true;
#endif
	return kind == PASSO_GCODE_LINE || kind == PASSO_GCODE_PROBE;
}

/* Of a line that is checked only: nothing moves. */
static void check_action(struct passo_player *player, enum passo_player_event *event)
{
	const enum passo_gcode_kind kind = player->action.kind;

	if (kind == PASSO_GCODE_END)
		*event = PASSO_PLAYER_ENDED;
	else if (PASSO_GCODE_HAS_TOOLS && kind == PASSO_GCODE_CHANGE)
		passo_gcode_load(player->gcode, player->action.tool);
}

#ifndef PASSO_WITHOUT_THREADS
/* A thread as lines between two rests; a rigid one as two of them. */
static enum passo_error rehearse(struct passo_player *player)
{
	passo_path_dwell(player->feed->path, 0);
	player->action.stops = true;
	const enum passo_error error = take_line(player);
	if (error != PASSO_OK || player->waits || !player->action.rigid)
		return error;
	for (unsigned axis = 0; axis < PASSO_GCODE_AXES_MAX; axis++)
		player->action.target[axis] = player->gcode->position[axis];
	player->action.rigid = false;
	player->waits = true;
	return PASSO_OK;
}
#endif

static enum passo_error take_action(struct passo_player *player, enum passo_player_event *event)
{
	struct passo_path_planner *path = player->feed->path;

	player->waits = false;
	if (has_target(player->action.kind) && !passo_player_allows(player, player->action.target)) {
		*event = PASSO_PLAYER_TRAVEL;
		passo_player_drop(player);
		return PASSO_OK;
	}
	if (player->checks) {
		check_action(player, event);
		return PASSO_OK;
	}
	switch (player->action.kind) {
	case PASSO_GCODE_LINE:
		return take_line(player);
	case PASSO_GCODE_DWELL:
		if (player->answers)
			return take_at_rest(player, event);
		passo_path_dwell(path, passo_mul_div_ceil(player->action.microseconds, path->machine.clock_hz,
					   MICROSECONDS_PER_SECOND));
		break;
	case PASSO_GCODE_THREAD:
#ifndef PASSO_WITHOUT_THREADS
		if (player->machine->rehearses)
			return rehearse(player);
		return take_at_rest(player, event);
#endif
	case PASSO_GCODE_PROBE:
	case PASSO_GCODE_PAUSE:
	case PASSO_GCODE_CHANGE:
	case PASSO_GCODE_INPUT:
	case PASSO_GCODE_END:
		return take_at_rest(player, event);
	case PASSO_GCODE_OFFSETS:
		*event = PASSO_PLAYER_OFFSETS;
		break;
	case PASSO_GCODE_OUTPUT: /* goes with the lines that follow */
		if ((PASSO_GCODE_HAS_TOOLS && player->action.stops)
		    || spins_up(player, (uint8_t)(output_of(player, player->action.output) >> LEVELS_AT)))
			return take_at_rest(player, event);
		break;
	}
	return PASSO_OK;
}

/* The chords of an arc are many: none while the core is short of ramps, and not all in one go. */
static enum passo_error take_actions(struct passo_player *player, enum passo_player_event *event)
{
	const struct passo *passo = player->feed->passo;
	const uint32_t began = passo_driver_now(passo);
	enum passo_error error = PASSO_OK;

	*event = PASSO_PLAYER_NOTHING;
	if (PASSO_GCODE_HAS_TOOLS && player->restores) {
		error = set_output(player, passo_gcode_output(player->gcode));
		player->restores = error != PASSO_OK;
		error = try_again(error);
	}
	if (PASSO_GCODE_HAS_TOOLS && error == PASSO_OK && !player->restores)
		error = mind_spindle(player, event);
	if (PASSO_GCODE_HAS_TOOLS && (player->restores || player->spins))
		return error;
	while (error == PASSO_OK && *event == PASSO_PLAYER_NOTHING && !player->probes && !player->paused
	       && !(PASSO_GCODE_HAS_TOOLS && player->spins) && !passo_path_feed_is_urgent(player->feed)
	       && passo_driver_now(passo) - began <= ACTIONS_MICROSECONDS) {
		if (!player->waits && !passo_gcode_next(player->gcode, &player->action))
			break;
#ifndef PASSO_WITHOUT_THREADS
		if (passo_player_follows(player)) {
			player->waits = !passo_player_continues(player);
			if (player->waits)
				break;
			continue;
		}
#endif
		error = take_action(player, event);
		if (player->waits)
			break;
	}
	return error;
}

/* The path has ended, and nothing else is under way. */
static enum passo_error mind_output(struct passo_player *player)
{
	if (player->checks || !passo_player_is_idle(player))
		return PASSO_OK;
	return try_again(set_output(player, passo_gcode_output(player->gcode)));
}

enum passo_error passo_player_poll(struct passo_player *player, enum passo_player_event *event)
{
	const bool probed = player->probes;
	enum passo_error error = take_actions(player, event);

	if (error == PASSO_OK && *event == PASSO_PLAYER_NOTHING)
		error = mind_output(player);
	if (error != PASSO_OK || *event != PASSO_PLAYER_NOTHING)
		return error;
	error = passo_path_feed_poll(player->feed);
#ifndef PASSO_WITHOUT_THREADS
	if (error == PASSO_OK && passo_player_follows(player))
		error = passo_player_follow(player);
#endif
	if (probed && error == PASSO_ERROR_SWITCH_MISSED) {
		*event = PASSO_PLAYER_UNTOUCHED;
		player->probes = player->touched = false;
		return PASSO_OK;
	}
	if (probed && error == PASSO_OK && !passo_is_moving(player->feed->passo))
		error = passo_player_end_probe(player, event);
	return error;
}
