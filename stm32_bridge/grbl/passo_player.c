/* SPDX-License-Identifier: MIT
 * An action is taken at once, or waits: a line for room on the path, a probe and M0 for the end of the path.
 */
#include "passo_player.h"

#include "passo_driver.h"
#include "passo_math.h"

#define ACTIONS_MICROSECONDS 200u
#define MICROSECONDS_PER_SECOND 1000000u

void passo_player_open(struct passo_player *player, struct passo_gcode *gcode, struct passo_path_feed *feed,
    const struct passo_player_machine *machine)
{
	*player = (struct passo_player){.gcode = gcode, .feed = feed, .machine = machine};
}

bool passo_player_is_ready(const struct passo_player *player)
{
	return !player->waits && !player->probes && !player->paused && !passo_gcode_is_busy(player->gcode);
}

bool passo_player_is_idle(const struct passo_player *player)
{
	return passo_player_is_ready(player) && !passo_path_feed_is_moving(player->feed);
}

void passo_player_go_on(struct passo_player *player)
{
	player->paused = false;
}

static uint64_t magnitude(int64_t value)
{
	return value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
}

int64_t passo_player_nanometres(const struct passo_player *player, unsigned axis, int32_t steps)
{
	const uint64_t scale = player->machine->axis[axis].steps_per_mm; /* UQ32.32 */
	const uint64_t twice =
	    passo_mul_div(magnitude(steps) * PASSO_GCODE_MILLION, UINT64_C(1) << 33, scale);
	const int64_t size = (int64_t)((twice + 1) / 2);

	return steps < 0 ? -size : size;
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

/* Drops the rest of the line: the program goes on from where the path ends. */
static void drop_line(struct passo_player *player)
{
	const struct passo_path_planner *path = player->feed->path;
	passo_gcode_position position;

	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		position[axis] = passo_player_nanometres(player, axis, (int32_t)path->at.steps[axis]);
	passo_gcode_set_position(player->gcode, position);
	player->waits = false;
}

static enum passo_error take_line(struct passo_player *player, enum passo_player_event *event)
{
	const struct passo_gcode_action *action = &player->action;
	const uint32_t output = player->feed->passo->has_outputs ? action->output : 0u;
	struct passo_path_move move = {.feed = action->feed, .output = output};

	if (!passo_player_allows(player, action->target)) {
		*event = PASSO_PLAYER_TRAVEL;
		drop_line(player);
		return PASSO_OK;
	}
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		move.target[axis] = passo_gcode_millimetres(action->target[axis]);
	passo_path_tolerance(player->feed->path, player->gcode->tolerance);
	const enum passo_plan_error error = passo_path_add(player->feed->path, &move);
	player->waits = error == PASSO_PLAN_PATH_FULL;
	if (error == PASSO_PLAN_OK)
		player->chords++;
	if (error == PASSO_PLAN_OK || player->waits)
		return PASSO_OK;
	drop_line(player);
	return (enum passo_error)(PASSO_ERROR_PLAN + error);
}

/* Steps of the probe, and its speed and acceleration: those of the axis with the most steps. */
static struct passo_probe plan_probe(const struct passo_player *player, const int32_t *positions)
{
	const struct passo_gcode_action *action = &player->action;
	struct passo_probe probe = {.away = action->probe >= 384, .optional = action->probe % 2 == 1};
	struct passo_u128 square = {0, 0};
	uint64_t most = 0, way = 0, slowest = UINT64_MAX;

	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++) {
		const struct passo_path_axis *limits = &player->machine->axis[axis];
		const int64_t from = passo_player_nanometres(player, axis, positions[axis]);
		const uint64_t length = magnitude(action->target[axis] - from);
		const uint64_t steps = passo_mul_div(
		    passo_mul_div(length, limits->steps_per_mm, UINT64_C(1) << 32), 1, PASSO_GCODE_MILLION);

		probe.steps[axis] = action->target[axis] < from ? -(int32_t)steps : (int32_t)steps;
		square = passo_u128_add(square, passo_multiply(length, length));
		most = steps > most ? steps : most;
		if (steps > 0 && limits->acceleration < slowest)
			slowest = limits->acceleration;
	}
	way = passo_isqrt128(square);
	if (way > 0) { /* steps of the longest axis per mm of the way */
		const uint64_t scale = passo_mul_div(most, (uint64_t)PASSO_GCODE_MILLION << 32, way);

		probe.speed = passo_mul_div(action->feed, scale, UINT64_C(1) << 32);
		probe.acceleration = passo_mul_div(slowest, scale, UINT64_C(1) << 32);
	}
	return probe;
}

static enum passo_error begin_probe(struct passo_player *player, enum passo_player_event *event)
{
	int32_t positions[PASSO_AXES_MAX];
	struct passo *passo = player->feed->passo;
	enum passo_error error = PASSO_OK;

	player->waits = false;
	error = passo_positions(passo, positions);
	if (error != PASSO_OK)
		return error;
	const struct passo_probe probe = plan_probe(player, positions);
	error = passo_probe(passo, &probe);
	player->probes = error == PASSO_OK;
	if (player->probes)
		return PASSO_OK;
	drop_line(player);
	if (error == PASSO_ERROR_NO_INPUTS || error == PASSO_ERROR_NO_SWITCH) {
		*event = PASSO_PLAYER_NO_PROBE;
		return PASSO_OK;
	}
	*event = error == PASSO_ERROR_SWITCH_LEVEL ? PASSO_PLAYER_UNEXPECTED : PASSO_PLAYER_NOTHING;
	return error == PASSO_ERROR_SWITCH_LEVEL ? PASSO_OK : error;
}

static enum passo_error end_probe(struct passo_player *player, enum passo_player_event *event)
{
	struct passo_trigger_report report;
	enum passo_error error = passo_read_trigger(player->feed->passo, &report);

	player->probes = false;
	if (error != PASSO_OK)
		return error;
	player->touched = report.fired;
	for (unsigned axis = 0; report.fired && axis < player->gcode->settings.axes; axis++)
		player->touch[axis] = passo_player_nanometres(player, axis, report.positions[axis]);
	*event = PASSO_PLAYER_PROBED;
	return passo_player_restart(player);
}

enum passo_error passo_player_restart(struct passo_player *player)
{
	int32_t positions[PASSO_AXES_MAX] = {0};
	passo_gcode_position position = {0};
	const enum passo_error error = passo_positions(player->feed->passo, positions);

	if (error != PASSO_OK)
		return error;
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		position[axis] = passo_player_nanometres(player, axis, positions[axis]);
	passo_path_restart(player->feed->path, positions);
	passo_path_feed_open(player->feed, player->feed->passo, player->feed->path);
	passo_gcode_set_position(player->gcode, position);
	player->waits = player->probes = player->paused = false;
	return PASSO_OK;
}

static enum passo_error take_action(struct passo_player *player, enum passo_player_event *event)
{
	struct passo_path_planner *path = player->feed->path;
	const bool moves = passo_path_feed_is_moving(player->feed);

	player->waits = false;
	switch (player->action.kind) {
	case PASSO_GCODE_LINE:
		return take_line(player, event);
	case PASSO_GCODE_DWELL:
		passo_path_dwell(path, passo_mul_div_ceil(player->action.microseconds, path->machine.clock_hz,
					   MICROSECONDS_PER_SECOND));
		break;
	case PASSO_GCODE_PROBE:
		passo_path_end(path);
		player->waits = moves;
		return moves ? PASSO_OK : begin_probe(player, event);
	case PASSO_GCODE_PAUSE:
		passo_path_end(path);
		player->waits = moves;
		player->paused = !moves;
		*event = moves ? PASSO_PLAYER_NOTHING : PASSO_PLAYER_PAUSED;
		break;
	case PASSO_GCODE_END:
		passo_path_end(path);
		*event = PASSO_PLAYER_ENDED;
		break;
	case PASSO_GCODE_OFFSETS:
		*event = PASSO_PLAYER_OFFSETS;
		break;
	case PASSO_GCODE_OUTPUT: /* goes with the lines that follow */
		break;
	}
	return PASSO_OK;
}

/* The chords of an arc are many: none while the core is short of ramps, and not all at once. */
static enum passo_error take_actions(struct passo_player *player, enum passo_player_event *event)
{
	const struct passo *passo = player->feed->passo;
	const uint32_t began = passo_driver_now(passo);
	enum passo_error error = PASSO_OK;

	*event = PASSO_PLAYER_NOTHING;
	while (error == PASSO_OK && *event == PASSO_PLAYER_NOTHING && !player->probes && !player->paused
	       && !passo_path_feed_is_urgent(player->feed)
	       && passo_driver_now(passo) - began <= ACTIONS_MICROSECONDS) {
		if (!player->waits && !passo_gcode_next(player->gcode, &player->action))
			break;
		error = take_action(player, event);
		if (player->waits)
			break;
	}
	return error;
}

enum passo_error passo_player_poll(struct passo_player *player, enum passo_player_event *event)
{
	const bool probed = player->probes;
	enum passo_error error = take_actions(player, event);

	if (error != PASSO_OK || *event != PASSO_PLAYER_NOTHING)
		return error;
	error = passo_path_feed_poll(player->feed);
	if (probed && error == PASSO_ERROR_SWITCH_MISSED) {
		*event = PASSO_PLAYER_UNTOUCHED;
		player->probes = false;
		return PASSO_OK;
	}
	if (probed && error == PASSO_OK && !passo_is_moving(player->feed->passo))
		error = end_probe(player, event);
	return error;
}
