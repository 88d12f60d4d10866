/* SPDX-License-Identifier: MIT
 * Geometry and limits of a line: unit vector, substeps, steps, and the highest speeds within it and at the
 * corner before it. docs/path.md has the rules.
 */
#include <stddef.h>

#include "passo_path_private.h"

#define ONE (UINT32_C(1) << PASSO_PATH_UNIT_BITS)
/* Bits of the longest component before the length is computed: the sum of eight squares has 64. */
#define COMPONENT_BITS 30u
/* Speeds up to half a substep per clock. */
#define SPEED_MAX (UINT64_C(1) << 31)

static uint64_t magnitude(int64_t value)
{
	return value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
}

static uint32_t magnitude32(int32_t value)
{
	return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

static uint64_t square_of(uint64_t speed)
{
	speed = passo_path_smaller(speed, SPEED_MAX);
	return speed * speed;
}

/* Unit vector and length (UQ32.16 substeps; saturates) of a line; false: it has no length. */
static bool find_direction(
    const struct passo_path_planner *path, const int64_t *target, int32_t *unit, uint64_t *length)
{
	uint64_t longest = 0, sum = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		longest = passo_path_larger(longest, magnitude(target[axis] - path->at.target[axis]));
	if (longest == 0)
		return false;
	const uint32_t bits = passo_bits((struct passo_u128){0, longest});
	const uint32_t right = bits > COMPONENT_BITS ? bits - COMPONENT_BITS : 0;
	const uint32_t left = bits < COMPONENT_BITS ? COMPONENT_BITS - bits : 0;
	uint32_t size[PASSO_AXES_MAX];

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		size[axis] = (uint32_t)(magnitude(target[axis] - path->at.target[axis]) >> right << left);
		sum += (uint64_t)size[axis] * size[axis];
	}
	const uint32_t root = passo_isqrt64(sum);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const int32_t share = (int32_t)(((uint64_t)size[axis] << PASSO_PATH_UNIT_BITS) / root);

		unit[axis] = target[axis] < path->at.target[axis] ? -share : share;
	}
	/* Q31.32 mm times substeps per mm, less 16 bits */
	const uint64_t product = (uint64_t)root * path->substeps_per_mm;
	if (right <= 16)
		*length = product >> (16 - right + left);
	else
		*length = product >> (64 - (right - 16)) > 0 ? UINT64_MAX : product << (right - 16);
	return true;
}

uint64_t passo_path_off(
    const struct passo_path_planner *path, const int64_t *target, const struct passo_path_place *end)
{
	int32_t unit[PASSO_AXES_MAX];
	uint64_t length = 0, turn = 0;

	if (!find_direction(path, target, unit, &length) || length <= end->length)
		return UINT64_MAX / 2;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint64_t change = magnitude((int64_t)unit[axis] - end->direction[axis]);

		turn += change * change;
	}
	return passo_mul_div(end->length, (uint64_t)passo_isqrt64(turn) + 1, ONE);
}

/* Steps of each axis, by rounding the target; returns the most. */
static uint64_t find_steps(const struct passo_path_planner *path, const int64_t *target, int64_t *steps)
{
	uint64_t most = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const struct passo_u128 product =
		    passo_multiply(magnitude(target[axis]), path->steps_per_mm[axis]);
		const int64_t rounded = (int64_t)(product.high + (product.low >> 63)); /* below 2^63 */

		steps[axis] = target[axis] < 0 ? -rounded : rounded;
		most = passo_path_larger(most, magnitude(steps[axis] - path->at.steps[axis]));
	}
	return most;
}

/* What a shape leaves of the slope of a line. A ramp over several lines needs one slope: the acceleration of
 * the weakest axis that moves, doubled as often as possible. */
static uint64_t shaped_slope(const struct passo_path_planner *path, uint64_t slope, uint64_t weakest)
{
	while (weakest <= slope / 2)
		weakest *= 2;
	return passo_mul_div(weakest, path->gentleness, UINT32_C(1) << 16);
}

/* Limits within the line, and where it begins or ends at rest. Returns the square of the latter. */
static uint64_t limit_line(
    const struct passo_path_planner *path, const int32_t *unit, uint64_t feed, struct passo_path_item *item)
{
	const uint64_t wanted =
	    feed < PASSO_PATH_RAPID
		? passo_path_larger(1, passo_mul_div(feed, path->substeps_per_mm, path->machine.clock_hz))
		: SPEED_MAX;
	uint64_t speed = SPEED_MAX;
	uint64_t slope = 2 * path->acceleration, weakest = slope, jump = SPEED_MAX, jerk = UINT64_MAX;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const struct passo_path_scale *own = &path->axis[axis];
		const uint32_t share = magnitude32(unit[axis]);

		if (share == 0)
			continue;
		speed = passo_path_smaller(speed, ((uint64_t)own->speed << PASSO_PATH_UNIT_BITS) / share);
		slope = passo_path_smaller(slope, passo_mul_div(2 * own->acceleration, ONE, share));
		weakest = passo_path_smaller(weakest, 2 * own->acceleration);
		jump = passo_path_smaller(jump, ((uint64_t)own->jump << PASSO_PATH_UNIT_BITS) / share);
		jerk = passo_path_smaller(jerk, passo_mul_div(own->jerk, ONE, share));
	}
	item->feed = square_of(wanted);
	item->rapid = feed == PASSO_PATH_RAPID;
	item->limit = square_of(speed);
	if (passo_path_is_soft(path))
		slope = passo_mul_div(slope, path->gentleness, UINT32_C(1) << 16);
	else if (passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		slope = shaped_slope(path, slope, weakest);
	item->slope = passo_path_larger(slope, 1);
	if (passo_path_is_soft(path))
		passo_path_soften(item, jerk);
	return passo_path_smaller(square_of(jump), passo_path_smaller(item->feed, item->limit));
}

/* Of the arc with the deviation from a corner whose directions differ by `turn` (UQ2.60, squared): half its
 * length, UQ32.16 substeps. */
static uint64_t half_arc(const struct passo_path_planner *path, uint64_t turn)
{
	const uint64_t one = UINT64_C(1) << (2 * PASSO_PATH_UNIT_BITS);
	const uint64_t cosine = passo_isqrt64(turn / 4); /* of half the angle between the lines */
	const uint64_t sine = passo_isqrt64(one - passo_path_smaller(turn / 4, one));

	return passo_mul_div(path->deviation, 2 * sine * (ONE + sine) / cosine, ONE);
}

/* Highest velocity (UQ0.32) on an arc that makes this turn over this length (UQ.30 substeps), by the jerk of
 * the weakest axis: its cube is the jerk times the square of the radius. */
static uint64_t soft_corner(
    const struct passo_path_planner *path, const uint32_t *change, uint64_t turn, uint64_t over)
{
	const uint64_t radius = passo_path_smaller(
	    passo_mul_div(over, 256, passo_path_larger(passo_isqrt64(turn), 1)), UINT32_MAX); /* UQ.8 */
	uint64_t jerk = PASSO_PATH_SQUARE_MAX, velocity = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		if (change[axis] > 0)
			jerk = passo_path_smaller(jerk, path->axis[axis].jerk);
	}
	const struct passo_u128 cube = passo_multiply(jerk, radius * radius);
	for (uint64_t bit = SPEED_MAX / 2; bit > 0; bit /= 2) {
		const uint64_t tried = velocity | bit;

		if (!passo_u128_less(cube, passo_multiply(tried * tried, tried)))
			velocity = tried;
	}
	return velocity;
}

/* Mean curvature of a line, Q15.48 per substep, that makes half of a turn (Q1.30). The turn takes place over
 * a length (both UQ32.16 substeps) on either side of the corner: if that is much shorter than the line, it
 * belongs to the corner alone. */
static int64_t curvature_of(int64_t turn, uint64_t over, uint64_t length)
{
	if (over < length / 2)
		return 0;
	const uint64_t size =
	    passo_mul_div(magnitude(turn), UINT64_C(1) << 33, passo_path_larger(over, length));

	return turn < 0 ? -(int64_t)size : (int64_t)size;
}

/* Half of a turn is made by the line before the corner, whose curvature is complete then, and half by the one
 * behind it. */
static void share_turn(struct passo_path_planner *path, const int32_t *unit, uint64_t length, uint64_t over)
{
	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		path->at.curvature[axis] +=
		    curvature_of((int64_t)unit[axis] - path->at.direction[axis], over, path->at.length);
	passo_path_add_curve(
	    path, path->at.curvature, path->at.direction, passo_path_item(path, path->added - 1));
	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		path->at.curvature[axis] =
		    curvature_of((int64_t)unit[axis] - path->at.direction[axis], over, length);
}

#ifndef PASSO_WITHOUT_ROUNDING
/* What an axis has of its acceleration when a line has its slope, UQ0.16. */
static uint32_t part_of(
    const struct passo_path_planner *path, uint64_t slope, const int32_t *unit, uint32_t axis)
{
	const uint64_t part =
	    passo_mul_div(slope, magnitude32(unit[axis]), 2 * path->axis[axis].acceleration);

	return (uint32_t)passo_path_smaller(part >> (PASSO_PATH_UNIT_BITS - 16), UINT32_C(1) << 16);
}

/* Of the axis of which the lines beside a lone corner, at their slopes, and its rounding have the most. */
static void find_rounding(const struct passo_path_planner *path, const int32_t *unit, uint64_t over,
    uint64_t square, struct passo_path_item *item)
{
	const uint64_t slope = passo_path_item(path, path->added - 1)->slope;

	item->turn = (uint32_t)(over >> PASSO_PATH_UNIT_BITS);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint64_t change = magnitude((int64_t)unit[axis] - path->at.direction[axis]);
		if (change == 0)
			continue;
		const uint64_t bend = passo_mul_div(path->axis[axis].acceleration, over, change);
		const uint32_t needed = (uint32_t)passo_mul_div(
		    passo_path_smaller(square, bend), UINT32_C(1) << 16, passo_path_larger(bend, 1));
		const uint32_t lost =
		    part_of(path, slope, path->at.direction, axis) + part_of(path, item->slope, unit, axis);

		if (lost + needed > item->lost + item->needed) {
			item->lost = lost;
			item->needed = needed;
		}
	}
}
#endif

/* Square at the corner between the last line and this one. The change of direction of an axis takes place
 * over a certain length: half the sum of the two lines, if they stand for an arc, or the arc that deviates by
 * the junction deviation. */
static uint64_t limit_corner(
    struct passo_path_planner *path, const int32_t *unit, uint64_t length, struct passo_path_item *item)
{
	uint32_t change[PASSO_AXES_MAX];
	uint64_t turn = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		change[axis] = (uint32_t)magnitude((int64_t)unit[axis] - path->at.direction[axis]);
		turn += (uint64_t)change[axis] * change[axis];
	}
	item->arc = turn < 4;
	if (turn < 4) {
		share_turn(path, path->at.direction, length, length);
		return PASSO_PATH_SQUARE_MAX;
	}
	const uint64_t rounded = half_arc(path, turn), mean = (path->at.length + length) / 2;
	const uint64_t over = passo_path_smaller(rounded, mean) << (PASSO_PATH_UNIT_BITS - 16);
	share_turn(path, unit, length, passo_path_smaller(rounded, mean));
	uint64_t square = PASSO_PATH_SQUARE_MAX;

	item->arc = mean < rounded;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const struct passo_path_scale *own = &path->axis[axis];

		if (change[axis] == 0)
			continue;
		square = passo_path_smaller(square, passo_mul_div(own->acceleration, over, change[axis]));
		if (own->jump > 0)
			square = passo_path_smaller(
			    square, square_of(((uint64_t)own->jump << PASSO_PATH_UNIT_BITS) / change[axis]));
	}
#ifndef PASSO_WITHOUT_ROUNDING
	if (rounded < passo_path_smaller(path->at.length, length) / 2)
		find_rounding(path, unit, over, square, item);
#endif
	if (passo_path_is_soft(path))
		square = passo_path_smaller(square, square_of(soft_corner(path, change, turn, over)));
	return square;
}

enum passo_plan_error passo_path_measure(
    struct passo_path_planner *path, const struct passo_path_move *move, struct passo_path_item *item)
{
	int32_t unit[PASSO_AXES_MAX];
	int64_t steps[PASSO_AXES_MAX];
	uint64_t length = 0;

	item->substeps = 0;
	if (move->feed == 0)
		return PASSO_PLAN_NO_FEED;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		if (move->target[axis] >= PASSO_PATH_TARGET_MAX
		    || move->target[axis] <= -PASSO_PATH_TARGET_MAX)
			return PASSO_PLAN_TOO_FAR;
	}
	if (!find_direction(path, move->target, unit, &length))
		return PASSO_PLAN_OK;
	const uint64_t most = find_steps(path, move->target, steps);
	if (length >> 16 > PASSO_SUBSTEPS_MAX)
		return PASSO_PLAN_TOO_LONG;
	const int64_t whole = path->at.carry + (int64_t)length + (1 << 15);
	uint64_t substeps = whole > 0 ? (uint64_t)whole >> 16 : 0;
	if (substeps < 1 && most == 0)
		return PASSO_PLAN_OK;
	const bool stretched = substeps < most;
	substeps = stretched ? most : substeps;
	if (substeps > PASSO_SUBSTEPS_MAX)
		return PASSO_PLAN_TOO_LONG;

	item->halt = limit_line(path, unit, move->feed, item);
	if (path->rest) {
		for (uint32_t axis = 0; axis < path->machine.axes; axis++)
			path->at.curvature[axis] = 0;
	} else {
		item->bend = limit_corner(path, unit, length, item);
	}
	passo_path_add_curve(path, path->at.curvature, unit, item);
	item->substeps = (uint32_t)substeps;
	path->at.carry =
	    stretched ? 0 : (int32_t)(path->at.carry + (int64_t)length - (int64_t)(substeps << 16));
	path->at.length = length;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		item->steps[axis] = (uint32_t)magnitude(steps[axis] - path->at.steps[axis]);
		if (steps[axis] < path->at.steps[axis])
			item->directions |= (uint8_t)(1u << axis);
		path->at.steps[axis] = steps[axis];
		path->at.target[axis] = move->target[axis];
		path->at.direction[axis] = unit[axis];
	}
	return PASSO_PLAN_OK;
}
