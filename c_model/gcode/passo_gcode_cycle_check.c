/* SPDX-License-Identifier: MIT
 * Checks of the words of a drilling cycle.
 */
#include "passo_gcode_private.h"

#define LINEAR_AXES 3u /* X, Y, Z */

bool passo_gcode_is_cycle(passo_gcode_command motion)
{
	return motion == PASSO_GCODE_G(73, 0) || motion > PASSO_GCODE_G(80, 0);
}

/* A word, or the one that the cycle in force keeps. */
static enum passo_gcode_error keep(struct passo_gcode_check *check, char letter, bool kept, int64_t *value)
{
	if (passo_gcode_take(check, letter)) {
		*value = passo_gcode_length_of(check, letter);
		return passo_gcode_in_range(*value) ? PASSO_GCODE_OK : PASSO_GCODE_TARGET;
	}
	return kept ? PASSO_GCODE_OK : PASSO_GCODE_NO_VALUE;
}

static enum passo_gcode_error check_words(
    struct passo_gcode_check *check, char letter, struct passo_gcode_cycle *cycle)
{
	const bool kept = check->gcode->mode[PASSO_GCODE_MOTION] == cycle->kind;
	const bool pecks = cycle->kind == PASSO_GCODE_G(73, 0) || cycle->kind == PASSO_GCODE_G(83, 0);
	const bool dwells = cycle->kind == PASSO_GCODE_G(82, 0) || cycle->kind == PASSO_GCODE_G(86, 0)
	                 || cycle->kind == PASSO_GCODE_G(89, 0);
	struct passo_gcode_drill *drill = &check->drill;
	enum passo_gcode_error error = keep(check, letter, kept, &drill->bottom);

	if (error == PASSO_GCODE_OK)
		error = keep(check, 'R', kept, &drill->level);
	if (error == PASSO_GCODE_OK && pecks) {
		error = keep(check, 'Q', kept, &drill->peck);
		if (error == PASSO_GCODE_OK && drill->peck == 0)
			error = PASSO_GCODE_NO_VALUE;
	}
	if (error == PASSO_GCODE_OK && dwells) {
		if (passo_gcode_take(check, 'P'))
			drill->microseconds = (uint64_t)check->block.value['P' - 'A'];
		else if (!kept)
			error = PASSO_GCODE_NO_VALUE;
	}
	cycle->peck = pecks ? drill->peck : 0;
	cycle->microseconds = dwells ? drill->microseconds : 0;
	return error;
}

/* Whether a coordinate stays in range over all holes. */
static bool reaches(int64_t first, int64_t increment, uint32_t holes)
{
	const int64_t size = increment < 0 ? -increment : increment;

	if (size > 0 && holes > 2 * PASSO_GCODE_COORDINATE_MAX / size)
		return false;
	return passo_gcode_in_range(first + (int64_t)(holes - 1) * increment);
}

static enum passo_gcode_error check_holes(struct passo_gcode_check *check, struct passo_gcode_cycle *cycle)
{
	const unsigned first = cycle->plane.first, second = cycle->plane.second;
	int64_t *destination = check->job->destination;

	cycle->holes = 1;
	if (passo_gcode_take(check, 'L')) {
		const int64_t count = check->block.value['L' - 'A'] / PASSO_GCODE_MILLION;

		if (count < 1)
			return PASSO_GCODE_NEGATIVE;
		cycle->holes = (uint32_t)count;
	}
	cycle->hole = (struct passo_gcode_vector){destination[first], destination[second]};
	if (check->mode[PASSO_GCODE_DISTANCE] == PASSO_GCODE_G(91, 0)) {
		cycle->increment = (struct passo_gcode_vector){
		    destination[first] - cycle->at[first], destination[second] - cycle->at[second]};
	}
	if (!reaches(cycle->hole.x, cycle->increment.x, cycle->holes)
	    || !reaches(cycle->hole.y, cycle->increment.y, cycle->holes))
		return PASSO_GCODE_TARGET;
	destination[first] += (int64_t)(cycle->holes - 1) * cycle->increment.x;
	destination[second] += (int64_t)(cycle->holes - 1) * cycle->increment.y;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_levels(struct passo_gcode_check *check, struct passo_gcode_cycle *cycle)
{
	struct passo_gcode_drill *drill = &check->drill;

	if (!passo_gcode_is_cycle(check->gcode->mode[PASSO_GCODE_MOTION]))
		drill->initial = cycle->at[cycle->axis];
	if (check->mode[PASSO_GCODE_DISTANCE] == PASSO_GCODE_G(91, 0)) {
		cycle->level = drill->initial + drill->level;
		cycle->bottom = cycle->level + drill->bottom;
	} else {
		const int64_t offset = passo_gcode_offset_of(check, cycle->axis);

		cycle->level = drill->level + offset;
		cycle->bottom = drill->bottom + offset;
	}
	if (cycle->bottom > cycle->level || !passo_gcode_in_range(cycle->level)
	    || !passo_gcode_in_range(cycle->bottom))
		return PASSO_GCODE_TARGET;
	cycle->clear = cycle->level;
	if (check->mode[PASSO_GCODE_RETRACT] == PASSO_GCODE_G(98, 0) && drill->initial > cycle->level)
		cycle->clear = drill->initial;
	check->job->destination[cycle->axis] = cycle->clear;
	return PASSO_GCODE_OK;
}

enum passo_gcode_error passo_gcode_check_cycle(struct passo_gcode_check *check)
{
	const struct passo_gcode *gcode = check->gcode;
	const struct passo_gcode_plane plane = passo_gcode_plane_of(check);
	const unsigned letter = LINEAR_AXES - plane.first - plane.second;
	struct passo_gcode_cycle *cycle = &check->job->cycle;
	enum passo_gcode_error error;

	*cycle = (struct passo_gcode_cycle){
	    .kind = check->mode[PASSO_GCODE_MOTION],
	    .axis = (uint8_t)passo_gcode_linear(gcode, letter),
	    .plane = {(uint8_t)passo_gcode_linear(gcode, plane.first),
		(uint8_t)passo_gcode_linear(gcode, plane.second)},
	};
	if (cycle->axis >= gcode->settings.axes || check->mode[PASSO_GCODE_FEED_MODE] == PASSO_GCODE_G(93, 0))
		return PASSO_GCODE_UNSUPPORTED;
	if (check->axis_words == 0)
		return PASSO_GCODE_NO_AXIS_WORDS;
	if (check->axis_words & ~passo_gcode_axis_words(0, LINEAR_AXES))
		return PASSO_GCODE_UNUSED;
	passo_gcode_copy(gcode, gcode->position, cycle->at);
	error = check_words(check, (char)('X' + letter), cycle);
	if (error == PASSO_GCODE_OK)
		error = check_holes(check, cycle);
	if (error == PASSO_GCODE_OK)
		error = check_levels(check, cycle);
	check->job->drills = true;
	return error;
}
