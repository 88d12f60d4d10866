/* SPDX-License-Identifier: MIT
 * Geometry and limits of a line: unit vector, substeps, steps, and the highest speed within it. docs/path.md
 * has the rules.
 */
#include <stddef.h>
#include <string.h>

#include "passo_path_private.h"

/* Bits of the longest component before the length is computed: the sum of eight squares has 64. */
#define COMPONENT_BITS 30u

/* Behind the axes, the parts of a unit vector along the motors that move two. */
static void find_rows(const struct passo_path_planner *path, int32_t *unit)
{
#ifdef PASSO_CARTESIAN
	(void)path, (void)unit;
#else
	int64_t axes[PASSO_AXES_MAX];

	if (path->rows == path->machine.axes)
		return;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		axes[axis] = unit[axis];
	for (uint32_t motor = 0, row = path->machine.axes; row < path->rows; motor++) {
		if (passo_motor_is_mixed(&path->motors, motor))
			unit[row++] = (int32_t)(passo_motor_place(&path->motors, motor, axes)
			                        * PASSO_PATH_HALF_ROOT / PASSO_PATH_ONE);
	}
#endif
}

/* Unit vector and length (UQ32.16 substeps; saturates) of a line between two targets; false: it has no
 * length.
 */
static bool find_direction(const struct passo_path_planner *path, const int64_t *from, const int64_t *target,
    int32_t *unit, uint64_t *length)
{
	uint64_t longest = 0, sum = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		longest = passo_path_larger(longest, passo_size64(target[axis] - from[axis]));
	if (longest == 0)
		return false;
	const uint32_t bits = passo_bits((struct passo_u128){0, longest});
	const uint32_t right = bits > COMPONENT_BITS ? bits - COMPONENT_BITS : 0;
	const uint32_t left = bits < COMPONENT_BITS ? COMPONENT_BITS - bits : 0;
	uint32_t size[PASSO_AXES_MAX];

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		size[axis] = (uint32_t)(passo_size64(target[axis] - from[axis]) >> right << left);
		sum += (uint64_t)size[axis] * size[axis];
	}
	const uint32_t root = passo_isqrt64(sum);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const int32_t share =
		    size[axis] > 0 ? (int32_t)(((uint64_t)size[axis] << PASSO_PATH_UNIT_BITS) / root) : 0;

		unit[axis] = target[axis] < from[axis] ? -share : share;
	}
	find_rows(path, unit);
	/* Q31.32 mm times substeps per mm, less 16 bits */
	const uint64_t product = (uint64_t)root * path->substeps_per_mm;
	if (right <= 16)
		*length = product >> (16 - right + left);
	else
		*length = product >> (64 - (right - 16)) > 0 ? UINT64_MAX : product << (right - 16);
	return true;
}

#ifndef PASSO_WITHOUT_ROUNDING
/* Narrows the directions to those that pass the end of the last line, which becomes an omitted one, within
 * the tolerance; tells whether the new one is among them. The end is off by less than its distance times the
 * difference of the unit vectors: at most the greatest component, times the root of the number of axes that
 * move. */
static bool narrow(
    const struct passo_path_planner *path, const int32_t *unit, struct passo_path_merged *merged)
{
	const struct passo_path_place *end = &path->at;
	uint64_t axes = 0;
	bool within = path->tolerance > 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		axes += unit[axis] != 0 || end->direction[axis] != 0;
	const uint64_t root = (uint64_t)passo_isqrt64(axes << 32) + 1;
	const int64_t most =
	    (int64_t)passo_path_smaller(passo_mul_div(passo_mul_div(path->tolerance, UINT32_C(1) << 16, root),
					    PASSO_PATH_ONE, end->length),
		PASSO_PATH_ONE / 2);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const int32_t moves = unit[axis] != 0 || end->direction[axis] != 0 ? (int32_t)most : 0;
		int32_t low = end->direction[axis] - moves, high = end->direction[axis] + moves;

		if (merged->narrowed) {
			low = low > merged->low[axis] ? low : merged->low[axis];
			high = high < merged->high[axis] ? high : merged->high[axis];
		}
		within = within && unit[axis] >= low && unit[axis] <= high;
		merged->low[axis] = low;
		merged->high[axis] = high;
	}
	merged->narrowed = true;
	return within;
}
#endif

/* Two bounds, of which the smaller one holds. The last line is off the new one by no more than its end, which
 * adds up. And the path that a line replaces is below a parabola over it, `bulge` x (l - x): if that is so of
 * the last line, it is of the new one, for a parabola that is also above the end of the last one: so it is
 * above the line from there to the new end. */
struct passo_path_merged passo_path_off(const struct passo_path_planner *path, const int64_t *target)
{
	struct passo_path_merged merged = path->merged;
	const struct passo_path_place *end = &path->at;
	int32_t unit[PASSO_AXES_MAX];
	uint64_t length = 0, turn = 0;

	if (!find_direction(path, path->before.target, target, unit, &length) || length <= end->length)
		return (struct passo_path_merged){.off = UINT64_MAX};
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint64_t change = passo_size64((int64_t)unit[axis] - end->direction[axis]);

		turn += change * change;
	}
	turn = (uint64_t)passo_isqrt64(turn) + 1;
	merged.off += passo_mul_shift(turn, end->length, PASSO_PATH_UNIT_BITS);
	turn <<= 32;
	merged.bulge = passo_path_larger(
	    turn / (length - end->length), passo_mul_div(merged.bulge, end->length, length) + turn / length);
	const uint64_t top =
	    passo_mul_shift(passo_mul_shift(merged.bulge, length, PASSO_PATH_UNIT_BITS), length, 34);
	merged.off = passo_path_smaller(merged.off, top);
#ifndef PASSO_WITHOUT_ROUNDING
	if (passo_path_is_rounded(path) && narrow(path, unit, &merged))
		merged.off = passo_path_smaller(merged.off, path->tolerance - 1);
#endif
	merged.longer = length - end->length;
	return merged;
}

/* Steps of each motor, by rounding its target; returns the most. */
static uint64_t find_steps(const struct passo_path_planner *path, const struct passo_path_place *from,
    const int64_t *target, int64_t *steps)
{
	uint64_t most = 0;

	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++) {
		const int64_t place = passo_path_motor_place(path, motor, target);
		const struct passo_u128 product =
		    passo_multiply(passo_size64(place), path->steps_per_mm[motor]);
		const int64_t rounded = (int64_t)(product.high + (product.low >> 63)); /* below 2^63 */

		steps[motor] = place < 0 ? -rounded : rounded;
		most = passo_path_larger(most, passo_size64(steps[motor] - from->steps[motor]));
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

/* Limits within the line, and where it begins or ends at rest. */
static void limit_line(
    const struct passo_path_planner *path, const int32_t *unit, uint64_t feed, struct passo_path_item *item)
{
	uint64_t wanted = PASSO_PATH_SPEED_MAX;

	if (feed == path->feed && feed < PASSO_PATH_RAPID)
		wanted = path->wanted;
	else if (feed < PASSO_PATH_RAPID)
		wanted = passo_path_larger(1, passo_path_velocity(path, feed));
	uint64_t speed = PASSO_PATH_SPEED_MAX;
	uint64_t slope = 2 * path->acceleration, weakest = slope, jump = PASSO_PATH_SPEED_MAX,
		 jerk = UINT64_MAX;

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const struct passo_path_scale *own = &path->axis[axis];
		const uint32_t share = passo_path_size32(unit[axis]);

		if (share == 0)
			continue;
		const uint64_t inverse = passo_path_inverse(share);
		const uint64_t most = passo_path_along(2 * own->acceleration, inverse);
		passo_path_add_slope(item, axis, share, most);
		slope = passo_path_smaller(slope, most);
		weakest = passo_path_smaller(weakest, 2 * own->acceleration);
		speed = passo_path_smaller(speed, passo_path_along(own->speed, inverse));
		jump = own->jump > 0 ? passo_path_smaller(jump, passo_path_along(own->jump, inverse)) : 0;
		if (passo_path_is_soft(path))
			jerk = passo_path_smaller(jerk, passo_path_along(own->jerk, inverse));
	}
	item->feed = (uint32_t)passo_path_smaller(wanted, PASSO_PATH_SPEED_MAX);
	item->rapid = feed == PASSO_PATH_RAPID;
	item->limit = (uint32_t)passo_path_smaller(speed, PASSO_PATH_SPEED_MAX);
	if (passo_path_is_soft(path))
		slope = passo_mul_div(slope, path->gentleness, UINT32_C(1) << 16);
	else if (passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		slope = shaped_slope(path, slope, weakest);
	item->slope = passo_path_larger(slope, 1);
	if (passo_path_is_soft(path))
		passo_path_soften(item, jerk);
	item->halt = (uint32_t)passo_path_smaller(jump, passo_path_smaller(item->feed, item->limit));
}

static void step_to(
    struct passo_path_planner *path, uint32_t motor, int64_t steps, struct passo_path_item *item)
{
	item->steps[motor] = (uint32_t)passo_size64(steps - path->at.steps[motor]);
	if (steps < path->at.steps[motor])
		item->directions |= (uint8_t)(1u << motor);
	path->at.steps[motor] = steps;
}

enum passo_plan_error passo_path_measure(struct passo_path_planner *path, const struct passo_path_move *move,
    bool instead, struct passo_path_item *item)
{
	const struct passo_path_place *from = instead ? &path->before : &path->at;
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
	if (!find_direction(path, from->target, move->target, unit, &length))
		return PASSO_PLAN_OK;
	const uint64_t most = find_steps(path, from, move->target, steps);
	if (length >> 16 > PASSO_SUBSTEPS_MAX)
		return PASSO_PLAN_TOO_LONG;
	const int64_t whole = from->carry + (int64_t)length + (1 << 15);
	uint64_t substeps = whole > 0 ? (uint64_t)whole >> 16 : 0;
	if (substeps < 1 && most == 0)
		return PASSO_PLAN_OK;
	const bool stretched = substeps < most;
	substeps = stretched ? most : substeps;
	if (substeps > PASSO_SUBSTEPS_MAX)
		return PASSO_PLAN_TOO_LONG;

	if (instead)
		path->at = path->before;
	else
		path->before = path->at;
	item->substeps = (uint32_t)substeps;
	limit_line(path, unit, move->feed, item);
	if (path->rest) {
		passo_path_begin_straight(path);
#ifndef PASSO_WITHOUT_JERK_PATHS
		memset(path->at.half_turn, 0, sizeof path->at.half_turn);
#endif
		passo_path_begin(path, length, NULL, 0);
	} else {
		item->bend = passo_path_limit_corner(path, unit, length, item);
	}
	passo_path_keep_start(item, &path->at);
	passo_path_set_fall(item);
	path->at.carry =
	    stretched ? 0 : (int32_t)(path->at.carry + (int64_t)length - (int64_t)(substeps << 16));
	path->at.length = length;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		step_to(path, axis, steps[axis], item);
		path->at.target[axis] = move->target[axis];
		path->at.direction[axis] = unit[axis];
	}
	for (uint32_t motor = path->machine.axes; motor < passo_path_motors(path); motor++)
		step_to(path, motor, steps[motor], item);
	for (uint32_t row = path->machine.axes; row < passo_path_rows(path); row++)
		path->at.direction[row] = unit[row];
	return PASSO_PLAN_OK;
}
