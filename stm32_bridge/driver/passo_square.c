/* SPDX-License-Identifier: MIT
 * Squaring: the motors of an axis are homed together, each by its own limit switch.
 *
 * All go to the first switch that is reached and off it again, then slowly back to its edge. From there on
 * the motors move one by one, each slowly to its own edge and at most by the bound; so no two of them are
 * ever further apart than that, beside what they were before. At the end each has a position of its own, and
 * they move to the same one.
 */
#include "passo_driver.h"

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

enum passo_error passo_driver_check_square(const struct passo *passo, const struct passo_home *home)
{
	enum passo_error error = PASSO_OK;

	if (home->source != (is_low(home) ? PASSO_TRIGGER_SOURCE_LIMIT_LOW : PASSO_TRIGGER_SOURCE_LIMIT_HIGH)
	    || home->forward == 0u || home->backward != 0u || home->back_off > home->racking
	    || home->racking > PASSO_SUBSTEPS_MAX / 4u)
		return PASSO_ERROR_ARGUMENT;
	for (uint8_t motor = 0; error == PASSO_OK && motor < PASSO_AXES_MAX; motor++) {
		if (!has(home->forward, motor))
			continue;
		const int64_t offset = home->offset ? home->offset[motor] : 0;

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
	return go(passo, PASSO_HOME_BACK_OFF, home->forward, away(home, home->back_off), home->speed, NO_EDGE,
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

/* Where a motor may go, from where it is, to stay within the bound. */
static int32_t left_of(const struct passo *passo, uint8_t motor, const int32_t *now)
{
	const int32_t moved = (int32_t)((uint32_t)now[motor] - (uint32_t)passo->square.begin[motor]);

	return away(passo->task.home, passo->task.home->racking) + moved;
}

static enum passo_error seek(struct passo *passo, uint8_t motor)
{
	const struct passo_home *home = passo->task.home;
	int32_t now[PASSO_AXES_MAX];
	const enum passo_error error = passo_positions(passo, now);

	if (error != PASSO_OK)
		return error;
	return go(passo, PASSO_HOME_SEEK, (uint8_t)(1u << motor), -left_of(passo, motor, now),
	    home->slow_speed, RISING, motor);
}

/* Each edge is at the position of home, and its offset. */
static enum passo_error set_positions(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	struct passo_move_by_speed move = {.speed = home->slow_speed, .acceleration = home->acceleration};
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = passo_positions(passo, now);
	bool moves = false;

	for (uint8_t motor = 0; error == PASSO_OK && motor < PASSO_AXES_MAX; motor++) {
		if (!has(home->forward, motor))
			continue;
		const int32_t off =
		    (home->offset ? home->offset[motor] : 0) + now[motor] - passo->square.edge[motor];

		error = passo_set_position(passo, motor, home->position + off);
		passo->axis[motor].homed = true;
		move.steps[motor] = away(home, home->pull_off) - off;
		moves = moves || move.steps[motor] != 0;
	}
	passo->task.phase = PASSO_HOME_PULL_OFF;
	if (error != PASSO_OK)
		return error;
	return moves ? passo_driver_seek(passo, NULL, &move) : PASSO_OK;
}

/* The next motor whose edge is not known. */
static enum passo_error go_on(struct passo *passo)
{
	const struct passo_home *home = passo->task.home;
	const uint8_t left = home->forward & (uint8_t)~passo->square.known;
	uint8_t pressed;
	enum passo_error error = PASSO_OK;

	if (left == 0u)
		return set_positions(passo);
	const uint8_t motor = first_of(left);
	error = read_pressed(passo, &pressed);
	if (error != PASSO_OK)
		return error;
	if (!has(pressed, motor))
		return seek(passo, motor);
	return go(passo, PASSO_HOME_LEAVE, (uint8_t)(1u << motor), away(home, home->racking),
	    home->slow_speed, FALLING, motor);
}

static enum passo_error keep_edge(struct passo *passo, const struct passo_trigger_report *report)
{
	const uint8_t motor = passo->square.motor;

	passo->square.edge[motor] = report->positions[motor];
	passo->square.known |= (uint8_t)(1u << motor);
	return go_on(passo);
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
	const struct passo_home *home = passo->task.home;
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
			passo->square.begin[i] = report->positions[i];
		return keep_edge(passo, report);
	case PASSO_HOME_LEAVE:
		if (!report->fired)
			return PASSO_ERROR_SWITCH_LEVEL;
		return go(passo, PASSO_HOME_LEFT, (uint8_t)(1u << motor), away(home, home->back_off),
		    home->slow_speed, NO_EDGE, motor);
	case PASSO_HOME_LEFT:
		return seek(passo, motor);
	case PASSO_HOME_SEEK:
		if (report->fired)
			return keep_edge(passo, report);
		/* stopped by its limit without an edge: from the switch again */
		return passo->square.stopped != 0u && ++passo->square.rounds <= ROUNDS_MAX
		         ? go_on(passo)
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
