/* SPDX-License-Identifier: MIT
 * Squaring: the motors of an axis are homed together, each by its own limit switch.
 *
 * All go to the first switch that is reached and off it again, then slowly back to it: there they are in
 * line. From there one motor after the other goes away from its switch, as far as it needs to have its speed
 * again, then slowly to its own edge, and returns into line; so the filter is as late for each of them, and
 * none moves further than the bound from another one. At the end each has a position of its own, and they
 * move to the same one.
 */
#include "passo_driver.h"
#include "passo_math.h"

#ifndef PASSO_CARTESIAN

#define ROUNDS_MAX 8u /* slow approaches, if another motor is first each time */

bool passo_driver_squares(const struct passo_home *home)
{
	return home->racking > 0u;
}

static bool is_low(const struct passo_home *home)
{
	return home->distance < 0;
}

/* Steps off the switches, by a length. */
static int32_t away(const struct passo_home *home, uint32_t steps)
{
	return is_low(home) ? (int32_t)steps : -(int32_t)steps;
}

static bool has(uint8_t motors, uint8_t motor)
{
	return ((unsigned)motors >> motor & 1u) != 0u;
}

static uint8_t first_of(uint8_t motors)
{
	uint8_t motor = 0;

	while (!has(motors, motor))
		motor++;
	return motor;
}

/* From the position of the axis to that of a motor's edge. */
static int32_t offset_of(const struct passo_home *home, uint8_t motor)
{
	return home->offset ? home->offset[motor] : 0;
}

/* Steps in which a motor comes to its slow speed, or to rest from it. */
static uint32_t slowing(const struct passo_home *home)
{
	return (uint32_t)(passo_mul_div(home->slow_speed, home->slow_speed, home->acceleration) >> 33u) + 1u;
}

/* Steps from an edge to where it is sought from. */
static uint32_t run_up(const struct passo_home *home)
{
	const uint32_t steps = slowing(home);

	return steps > home->back_off ? steps : home->back_off;
}

enum passo_error passo_driver_check_square(const struct passo *passo, const struct passo_home *home)
{
	enum passo_error error = PASSO_OK;

	if (home->source != (is_low(home) ? PASSO_TRIGGER_SOURCE_LIMIT_LOW : PASSO_TRIGGER_SOURCE_LIMIT_HIGH)
	    || home->forward == 0u || home->backward != 0u || home->back_off > home->racking
	    || slowing(home) > home->racking / 2u || home->racking > PASSO_SUBSTEPS_MAX / 4u)
		return PASSO_ERROR_ARGUMENT;
	for (uint8_t motor = 0; error == PASSO_OK && motor < PASSO_AXES_MAX; motor++) {
		if (!has(home->forward, motor))
			continue;
		const int64_t offset = offset_of(home, motor);

		error = passo_driver_check_source(passo, home->source, motor);
		if (error == PASSO_OK
		    && (offset > (int64_t)home->pull_off || -offset > (int64_t)home->pull_off))
			error = PASSO_ERROR_ARGUMENT;
	}
	return error;
}

/* Moves some motors by the same steps, until an edge of the switch of one. */
enum edge { NO_EDGE, RISING, FALLING };
static enum passo_error go(struct passo *passo, enum passo_home_phase phase, uint8_t motors, int32_t steps,
    uint64_t speed, enum edge edge, uint8_t motor)
{
	const struct passo_home *home = passo->task.home;
	const struct passo_trigger_config trigger = {.source = home->source,
	    .action = PASSO_TRIGGER_ACTION_SOFT_STOP,
	    .axis = motor,
	    .falling = edge == FALLING};
	struct passo_move_by_speed move = {.speed = speed, .acceleration = home->acceleration};

	for (uint8_t i = 0; i < PASSO_AXES_MAX; i++)
		move.steps[i] = has(motors, i) ? steps : 0;
	passo->task.phase = phase;
	passo->square.motor = motor;
	return passo_driver_seek(passo, edge != NO_EDGE ? &trigger : NULL, &move);
}

/* Motors whose switches are active. */
static enum passo_error read_pressed(struct passo *passo, uint8_t *pressed)
{
	const struct passo_home *home = passo->task.home;
	struct passo_readings readings;
	const enum passo_error error = passo_read_inputs(passo, &readings);

	*pressed = (is_low(home) ? readings.limit_low : readings.limit_high) & home->forward;
	return error;
}

/* All motors, until the switch of one is left. */
static enum passo_error release(struct passo *passo, uint8_t motor)
{
	const struct passo_home *home = passo->task.home;

	return go(passo, PASSO_HOME_RELEASE, home->forward, -home->distance, home->speed, FALLING, motor);
}

static enum passo_error approach_slowly(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;

	if (++passo->square.rounds > ROUNDS_MAX)
		return PASSO_ERROR_SWITCH_LEVEL;
	return go(passo, PASSO_HOME_SLOW, home->forward, home->distance, home->slow_speed, RISING,
	    passo->square.first);
}

static enum passo_error back_off(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	uint8_t pressed;
	const enum passo_error error = read_pressed(passo, &pressed);

	if (error != PASSO_OK)
		return error;
	if (pressed != 0u)
		return release(passo, first_of(pressed));
	return go(passo, PASSO_HOME_BACK_OFF, home->forward, away(home, run_up(home)), home->speed, NO_EDGE,
	    passo->square.first);
}

enum passo_error passo_driver_square_first(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	uint8_t pressed;
	const enum passo_error error = read_pressed(passo, &pressed);

	passo->square = (struct passo_square){.first = first_of(home->forward)};
	if (error != PASSO_OK)
		return error;
	if (pressed != 0u) {
		passo->square.first = first_of(pressed);
		return release(passo, passo->square.first);
	}
	return go(passo, PASSO_HOME_APPROACH, home->forward, home->distance, home->speed, RISING,
	    passo->square.first);
}

/* Steps from the line toward the switch. */
static int32_t beyond(const struct passo *passo, uint8_t motor, int32_t position)
{
	const int32_t moved = (int32_t)((uint32_t)position - (uint32_t)passo->square.line[motor]);

	return is_low(passo->task.home) ? -moved : moved;
}

/* Moves each motor from where it is to a place of its own. OK: all are there. */
static enum passo_error go_each(
    struct passo *passo, enum passo_home_phase phase, const int32_t *now, const int32_t *places)
{
	const struct passo_home *home = passo->task.home;
	struct passo_move_by_speed move = {.speed = home->slow_speed, .acceleration = home->acceleration};
	bool moves = false;

	for (uint8_t motor = 0; motor < PASSO_AXES_MAX; motor++) {
		if (!has(home->forward, motor))
			continue;
		move.steps[motor] = (int32_t)((uint32_t)places[motor] - (uint32_t)now[motor]);
		moves = moves || move.steps[motor] != 0;
	}
	passo->task.phase = phase;
	return moves ? passo_driver_seek(passo, NULL, &move) : PASSO_OK;
}

static enum passo_error seek(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	const uint8_t motor = passo->square.motor, own = (uint8_t)(1u << motor);
	int32_t now[PASSO_AXES_MAX], behind = 0;
	const enum passo_error error = passo_positions(passo, now);

	if (error != PASSO_OK)
		return error;
	for (uint8_t i = 0; i < PASSO_AXES_MAX; i++) {
		if (has(home->forward & (uint8_t)~own, i) && beyond(passo, i, now[i]) < behind)
			behind = beyond(passo, i, now[i]);
	}
	const int32_t most = (int32_t)home->racking + behind - beyond(passo, motor, now[motor]);
	return go(passo, PASSO_HOME_SEEK, own, -away(home, (uint32_t)most), home->slow_speed, RISING, motor);
}

/* The next motor whose edge is not known goes away from it: still within the bound, and until its switch is
 * left. */
static enum passo_error leave(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	const uint8_t left = home->forward & (uint8_t)~passo->square.known;
	const uint8_t motor = has(left, passo->square.first) ? passo->square.first : first_of(left);
	const uint32_t wanted = run_up(home);
	int32_t now[PASSO_AXES_MAX];
	uint8_t pressed = 0;
	enum passo_error error = passo_positions(passo, now);

	if (error == PASSO_OK)
		error = read_pressed(passo, &pressed);
	if (error != PASSO_OK)
		return error;
	const int32_t most = (int32_t)home->racking + beyond(passo, motor, now[motor]);
	passo->square.motor = motor;
	if (most <= 0)
		return has(pressed, motor) ? PASSO_ERROR_SWITCH_LEVEL : seek(passo);
	return go(passo, has(pressed, motor) ? PASSO_HOME_LEAVE : PASSO_HOME_LEFT, (uint8_t)(1u << motor),
	    away(home, wanted < (uint32_t)most ? wanted : (uint32_t)most), home->slow_speed, NO_EDGE, motor);
}

/* Off the switches only: a motor whose switch was not quite there before stays there. */
static enum passo_error line_up(struct passo *passo)
{
	int32_t now[PASSO_AXES_MAX], places[PASSO_AXES_MAX];
	enum passo_error error = passo_positions(passo, now);

	for (uint8_t i = 0; error == PASSO_OK && i < PASSO_AXES_MAX; i++)
		places[i] = beyond(passo, i, now[i]) > 0 ? passo->square.line[i] : now[i];
	if (error == PASSO_OK)
		error = go_each(passo, PASSO_HOME_LINE, now, places);
	return error == PASSO_OK ? leave(passo) : error;
}

/* Each edge is at the position of home, and its offset. */
static enum passo_error set_positions(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	int32_t now[PASSO_AXES_MAX], places[PASSO_AXES_MAX];
	enum passo_error error = passo_positions(passo, now);

	for (uint8_t motor = 0; error == PASSO_OK && motor < PASSO_AXES_MAX; motor++) {
		if (!has(home->forward, motor))
			continue;
		now[motor] += home->position + offset_of(home, motor) - passo->square.edge[motor];
		places[motor] = home->position + away(home, home->pull_off);
		error = passo_set_position(passo, motor, now[motor]);
		passo->axis[motor].homed = true;
	}
	return error == PASSO_OK ? go_each(passo, PASSO_HOME_PULL_OFF, now, places) : error;
}

/* The bound is also one of where the motors end, with their offsets; and a motor that was about to stop at it
 * was not at its speed. */
static enum passo_error keep_edge(struct passo *passo, int32_t position)
{
	const struct passo_home *home = passo->task.home;
	struct passo_square *square = &passo->square;
	const uint8_t motor = square->motor;
	const int32_t racking = (int32_t)home->racking;
	const int32_t edge = beyond(passo, motor, position);
	const int32_t end = edge + away(home, (uint32_t)offset_of(home, motor));

	square->edge[motor] = position;
	if (square->known == 0u)
		square->least = square->most = end;
	square->known |= (uint8_t)(1u << motor);
	square->least = end < square->least ? end : square->least;
	square->most = end > square->most ? end : square->most;
	if (square->most - square->least > racking || edge > racking - (int32_t)slowing(home))
		return PASSO_ERROR_SWITCH_MISSED;
	return square->known == home->forward ? set_positions(passo) : line_up(passo);
}

/* A switch was reached, which is left again; by another motor than the one of the trigger, too. */
static enum passo_error turn_back(struct passo *passo, bool fired)
{
	const uint8_t others = passo->square.stopped;

	if (!fired && others == 0u)
		return PASSO_ERROR_SWITCH_MISSED;
	if (!fired)
		passo->square.first = first_of(others);
	return release(passo, passo->square.first);
}

enum passo_error passo_driver_square_next(struct passo *passo, const struct passo_trigger_report *report)
{
	const uint8_t motor = passo->square.motor;

	switch (passo->task.phase) {
	case PASSO_HOME_APPROACH:
		return turn_back(passo, report->fired);
	case PASSO_HOME_RELEASE:
		return report->fired ? back_off(passo) : PASSO_ERROR_SWITCH_MISSED;
	case PASSO_HOME_BACK_OFF:
		return approach_slowly(passo);
	case PASSO_HOME_SLOW:
		if (!report->fired)
			return turn_back(passo, false);
		for (uint8_t i = 0; i < PASSO_AXES_MAX; i++)
			passo->square.line[i] = report->positions[i];
		return line_up(passo);
	case PASSO_HOME_LINE:
	case PASSO_HOME_LEAVE:
		return leave(passo);
	case PASSO_HOME_LEFT:
		return seek(passo);
	case PASSO_HOME_SEEK:
		if (report->fired)
			return keep_edge(passo, report->positions[motor]);
		/* stopped by its limit without an edge: from the switch again */
		return passo->square.stopped != 0u && ++passo->square.rounds <= ROUNDS_MAX
		         ? leave(passo)
		         : PASSO_ERROR_SWITCH_MISSED;
	case PASSO_HOME_PULL_OFF:
		break;
	}
	return PASSO_OK;
}

bool passo_home_is_skewed(const struct passo *passo, uint8_t *motor)
{
	*motor = passo->square.motor;
	return passo->task.phase == PASSO_HOME_SEEK && passo->fault == PASSO_ERROR_SWITCH_MISSED;
}

#endif
