/* SPDX-License-Identifier: MIT
 * The corner between two lines: the highest speed there, and what its turn takes of the acceleration beside
 * it. docs/path.md has the rules.
 */
#include <stddef.h>

#include "passo_path_private.h"

/* Of the arc with the deviation from a corner whose directions differ by `turn` (UQ2.60, squared): half its
 * length, UQ32.16 substeps. */
static uint64_t half_arc(const struct passo_path_planner *path, uint64_t turn)
{
	const uint64_t one = UINT64_C(1) << (2 * PASSO_PATH_UNIT_BITS);
	const uint64_t cosine = passo_isqrt64(turn / 4); /* of half the angle between the lines */
	const uint64_t sine = passo_isqrt64(one - passo_path_smaller(turn / 4, one));

	return passo_mul_shift(
	    path->deviation, 2 * sine * (PASSO_PATH_ONE + sine) / cosine, PASSO_PATH_UNIT_BITS);
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
	for (uint64_t bit = PASSO_PATH_SPEED_MAX / 2; bit > 0; bit /= 2) {
		const uint64_t tried = velocity | bit;

		if (!passo_u128_less(cube, passo_multiply(tried * tried, tried)))
			velocity = tried;
	}
	return velocity;
}

/* A turn takes place over a length (both UQ32.16 substeps) on either side of the corner: if that is much
 * shorter than a line, it belongs to the corner alone, 0. */
static uint64_t reciprocal(uint64_t over, uint64_t length)
{
	return over < length / 2 ? 0 : passo_divide((struct passo_u128){1, 0}, passo_path_larger(over, length), NULL);
}

/* Mean curvature of a line, Q15.48 per substep, that makes half of a turn (Q1.30). */
static int64_t curvature_of(int64_t turn, uint64_t reciprocal)
{
	const uint64_t size = passo_path_smaller(
	    passo_mul_shift(passo_path_size(turn), reciprocal, 31), PASSO_PATH_SQUARE_MAX / 2);

	return turn < 0 ? -(int64_t)size : (int64_t)size;
}

/* Half of a turn is made by the line before the corner, whose curvature is complete then, and half by the one
 * behind it. */
static void share_turn(struct passo_path_planner *path, const int32_t *unit, uint64_t length, uint64_t over)
{
	const uint64_t before = reciprocal(over, path->at.length), behind = reciprocal(over, length);
	struct passo_path_item *last = passo_path_item(path, path->added - 1);

	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		path->at.curvature[axis] +=
		    curvature_of((int64_t)unit[axis] - path->at.direction[axis], before);
	passo_path_add_curve(path, path->at.curvature, path->at.direction, last);
	passo_path_set_fall(last);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		path->at.curvature[axis] =
		    curvature_of((int64_t)unit[axis] - path->at.direction[axis], behind);
}

#ifndef PASSO_WITHOUT_ROUNDING
/* What an axis has of its acceleration when a line has its slope, UQ0.16. */
static uint32_t part_of(
    const struct passo_path_planner *path, uint64_t slope, const int32_t *unit, uint32_t axis)
{
	const uint64_t part =
	    passo_mul_div(slope, passo_path_size32(unit[axis]), 2 * path->axis[axis].acceleration);

	return (uint32_t)passo_path_smaller(part >> (PASSO_PATH_UNIT_BITS - 15), INT16_MAX);
}

/* Of the axis of which the lines beside a lone corner, at their slopes, and its rounding have the most. */
static void find_rounding(const struct passo_path_planner *path, const int32_t *unit, uint64_t over,
    uint64_t square, struct passo_path_item *item)
{
	const uint64_t slope = passo_path_item(path, path->added - 1)->slope;

	item->turn = (uint32_t)(over >> PASSO_PATH_UNIT_BITS);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint64_t change = passo_path_size((int64_t)unit[axis] - path->at.direction[axis]);
		if (change == 0)
			continue;
		const uint64_t bend = passo_mul_div(path->axis[axis].acceleration, over, change);
		const uint32_t needed = (uint32_t)passo_mul_div(
		    passo_path_smaller(square, bend), UINT32_C(1) << 15, passo_path_larger(bend, 1));
		const uint32_t lost =
		    part_of(path, slope, path->at.direction, axis) + part_of(path, item->slope, unit, axis);

		if (lost + needed > (uint32_t)item->lost + item->needed) {
			item->lost = (uint16_t)lost;
			item->needed = (uint16_t)needed;
		}
	}
}
#endif

uint64_t passo_path_limit_corner(
    struct passo_path_planner *path, const int32_t *unit, uint64_t length, struct passo_path_item *item)
{
	uint32_t change[PASSO_AXES_MAX];
	uint64_t turn = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		change[axis] = (uint32_t)passo_path_size((int64_t)unit[axis] - path->at.direction[axis]);
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
			    square, passo_path_speed_square(
					((uint64_t)own->jump << PASSO_PATH_UNIT_BITS) / change[axis]));
	}
#ifndef PASSO_WITHOUT_ROUNDING
	if (!path->unrounded && rounded < passo_path_smaller(path->at.length, length) / 2)
		find_rounding(path, unit, over, square, item);
#endif
	if (passo_path_is_soft(path))
		square = passo_path_smaller(
		    square, passo_path_speed_square(soft_corner(path, change, turn, over)));
	return square;
}
