/* SPDX-License-Identifier: MIT
 * Checks of a motion: target, feed, and the geometry of an arc.
 */
#include "passo_gcode_private.h"
#include "passo_math.h"

#define MICROSECONDS_PER_MINUTE 60000000u

static uint64_t magnitude(int64_t value)
{
	return value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
}

enum passo_gcode_error passo_gcode_find_target(const struct passo_gcode_check *check, int64_t *target)
{
	const struct passo_gcode *gcode = check->gcode;
	const bool machine = check->block.command[PASSO_GCODE_COMMAND] == PASSO_GCODE_G(53, 0);
	const bool incremental = check->mode[PASSO_GCODE_DISTANCE] == PASSO_GCODE_G(91, 0);

	for (unsigned axis = 0; axis < gcode->settings.axes; axis++) {
		target[axis] = gcode->position[axis];
		if (!passo_gcode_has_axis(check, axis))
			continue;
		const int64_t value = passo_gcode_axis_value(check, axis);
		if (machine)
			target[axis] = value;
		else if (incremental)
			target[axis] += value;
		else
			target[axis] = value + passo_gcode_offset_of(check, axis);
		if (!passo_gcode_in_range(target[axis]))
			return PASSO_GCODE_TARGET;
	}
	return PASSO_GCODE_OK;
}

struct passo_gcode_plane passo_gcode_plane_of(const struct passo_gcode_check *check)
{
	switch (check->mode[PASSO_GCODE_PLANE]) {
	case PASSO_GCODE_G(18, 0):
		return (struct passo_gcode_plane){2, 0};
	case PASSO_GCODE_G(19, 0):
		return (struct passo_gcode_plane){1, 2};
	default:
		return (struct passo_gcode_plane){0, 1};
	}
}

/* I, J or K of X, Y or Z. */
static int64_t offset_along(const struct passo_gcode_check *check, unsigned letter)
{
	const int64_t offset = passo_gcode_length_of(check, (char)('I' + letter));

	return passo_gcode_in_range(offset) ? offset : PASSO_GCODE_COORDINATE_MAX + 1;
}

bool passo_gcode_is_arc(passo_gcode_command motion)
{
	return motion == PASSO_GCODE_G(2, 0) || motion == PASSO_GCODE_G(3, 0);
}

static enum passo_gcode_error find_center(struct passo_gcode_check *check, struct passo_gcode_plane letters,
    const struct passo_gcode_arc *arc, struct passo_gcode_vector *offset)
{
	const unsigned first = arc->plane.first, second = arc->plane.second;
	const struct passo_gcode_vector chord = {
	    arc->target[first] - arc->start[first], arc->target[second] - arc->start[second]};

	if (passo_gcode_take(check, 'R')) {
		const int64_t radius = passo_gcode_length_of(check, 'R');

		if (check->axis_words == 0)
			return PASSO_GCODE_NO_AXIS_WORDS;
		if (!passo_gcode_has_axis(check, first) && !passo_gcode_has_axis(check, second))
			return PASSO_GCODE_NO_PLANE_WORDS;
		if (!passo_gcode_in_range(radius))
			return PASSO_GCODE_RADIUS;
		return passo_gcode_arc_center(chord, radius, arc->clockwise, offset);
	}
	const bool given = passo_gcode_has_word(check, (char)('I' + letters.first))
	                || passo_gcode_has_word(check, (char)('I' + letters.second));
	passo_gcode_take(check, 'I');
	passo_gcode_take(check, 'J');
	passo_gcode_take(check, 'K');
	if (!given)
		return PASSO_GCODE_NO_OFFSETS;
	*offset = (struct passo_gcode_vector){
	    offset_along(check, letters.first), offset_along(check, letters.second)};
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_arc(struct passo_gcode_check *check)
{
	const struct passo_gcode_plane letters = passo_gcode_plane_of(check);
	struct passo_gcode_arc *arc = &check->job->arc;
	struct passo_gcode_vector offset;

	if (!passo_gcode_is_linear(check->gcode, letters.first)
	    || !passo_gcode_is_linear(check->gcode, letters.second))
		return PASSO_GCODE_UNSUPPORTED;
	*arc = (struct passo_gcode_arc){
	    .plane = {(uint8_t)passo_gcode_linear(check->gcode, letters.first),
		(uint8_t)passo_gcode_linear(check->gcode, letters.second)},
	    .clockwise = check->mode[PASSO_GCODE_MOTION] == PASSO_GCODE_G(2, 0),
	    .axes = check->gcode->settings.axes,
	};
	for (unsigned axis = 0; axis < arc->axes; axis++) {
		arc->start[axis] = check->gcode->position[axis];
		arc->target[axis] = check->job->destination[axis];
	}
	const enum passo_gcode_error error = find_center(check, letters, arc, &offset);
	if (error != PASSO_GCODE_OK)
		return error;
	check->job->turns = true;
	return passo_gcode_arc_begin(arc, offset, check->gcode->settings.arc_tolerance);
}

static enum passo_gcode_error check_probe(struct passo_gcode_check *check)
{
	bool moves = false;

	if (check->axis_words == 0)
		return PASSO_GCODE_NO_AXIS_WORDS;
	for (unsigned axis = 0; axis < check->gcode->settings.axes; axis++)
		moves = moves || check->job->destination[axis] != check->gcode->position[axis];
	check->job->probe = check->mode[PASSO_GCODE_MOTION];
	return moves ? PASSO_GCODE_OK : PASSO_GCODE_TARGET;
}

static uint64_t length_of(const struct passo_gcode_check *check)
{
	struct passo_u128 sum = {0, 0};

	if (check->job->turns)
		return check->job->arc.length;
	for (unsigned axis = 0; axis < check->gcode->settings.axes; axis++) {
		const uint64_t way = magnitude(check->job->destination[axis] - check->gcode->position[axis]);

		sum = passo_u128_add(sum, passo_multiply(way, way));
	}
	return passo_isqrt128(sum);
}

uint64_t passo_gcode_feed(uint64_t per_minute)
{
	const uint64_t feed = passo_mul_div(per_minute, UINT64_C(1) << 32, MICROSECONDS_PER_MINUTE);

	return feed == 0 ? 1 : feed == PASSO_PATH_RAPID ? feed - 1 : feed;
}

/* Of nm/min or, in G93, of the whole length in 1 / F minutes. */
static uint64_t feed_of(const struct passo_gcode_check *check)
{
	uint64_t per_minute = (uint64_t)check->feed;

	if (check->mode[PASSO_GCODE_FEED_MODE] == PASSO_GCODE_G(93, 0))
		per_minute = passo_mul_div(length_of(check), (uint64_t)check->inverse, PASSO_GCODE_MILLION);
	return passo_gcode_feed(per_minute);
}

enum passo_gcode_error passo_gcode_check_motion(struct passo_gcode_check *check)
{
	const passo_gcode_command motion = check->mode[PASSO_GCODE_MOTION];
	struct passo_gcode_job *job = check->job;
	enum passo_gcode_error error = PASSO_GCODE_OK;

	if (check->block.command[PASSO_GCODE_COMMAND] == PASSO_GCODE_G(53, 0) && motion != PASSO_GCODE_G(0, 0)
	    && motion != PASSO_GCODE_G(1, 0))
		return PASSO_GCODE_G53;
	if (motion == PASSO_GCODE_G(80, 0) && check->axis_words) /* those of G92, G28, G10, G43.1 as well */
		return PASSO_GCODE_AXIS_WORDS;
	if (!check->moves)
		return PASSO_GCODE_OK;
#ifndef PASSO_WITHOUT_THREADS
	job->pitch = 0;
	if (passo_gcode_is_thread(motion))
		return passo_gcode_check_thread(check);
#endif
	if (motion != 0 && check->feed == 0 && check->inverse == 0)
		return PASSO_GCODE_NO_FEED;
#ifndef PASSO_PLAIN_GCODE
	passo_gcode_copy(check->gcode, check->gcode->position, job->from);
	job->at = job->from[0];
	job->per_turn = motion != 0 && check->mode[PASSO_GCODE_FEED_MODE] == PASSO_GCODE_G(95, 0);
	if (job->per_turn)
		error = passo_gcode_check_turning(check);
	if (error != PASSO_GCODE_OK)
		return error;
#endif
	error = passo_gcode_find_target(check, job->destination);
	if (error != PASSO_GCODE_OK)
		return error;
	job->motion = check->axis_words != 0 || passo_gcode_is_arc(motion);
	if (passo_gcode_is_arc(motion))
		error = check_arc(check);
	else if (passo_gcode_is_cycle(motion))
		error = passo_gcode_check_cycle(check);
	else if (motion > 380)
		error = check_probe(check);
	job->feed = motion == 0 ? PASSO_PATH_RAPID : feed_of(check);
	return error;
}
