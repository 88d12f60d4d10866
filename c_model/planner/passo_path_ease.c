/* SPDX-License-Identifier: MIT
 * Shaped ramps in curves. The limit of an axis is that of its acceleration in all, and a shaped ramp is
 * steepest in its middle, wherever on the curve that is. So by what a curve needs across it at the speed of
 * its lines, these have all of the slope, three quarters or half, and the curve is as fast as that leaves:
 * 0.93 of its speed with half, or more. One slope for the whole curve, so that a ramp may pass all of it.
 */
#include "passo_path_private.h"

#ifndef PASSO_LINEAR_PATHS

/* By this part a limit may be exceeded: lines that hardly bend are no curve. */
#define EXCESS 64u
/* The same of the jerk. */
#define JERK_EXCESS 32u
/* On an arc at a speed v, of a radius r, the ramp that is steepest at t takes 3 v t / r of the jerk: with
 * half of it along the arc, 0.7 are left. UQ0.16. */
#define ACROSS 15463u
/* In square_of_change(): 11, with a third of the jerk. */
#define JUMP 4u
/* In slow_before(): 4.5, by SOFTNESS in passo_path_jerk.c, with half of the jerk. */
#define REST 12u
/* A twentieth of the deviation (UQ32.16 substeps), UQ.8 substeps. */
#define OFF_PART (20u << 8)
/* With this change of the direction an axis has the ramp on one side of a lone corner, or little of both. */
#define SHARP (PASSO_PATH_ONE / 64 * 13)
/* An axis with less than this part of the direction, or of its change, is hardly one of the curve. */
#define SMALL 8u

/* The acceleration of an axis in the middle of a ramp with the slope of a line. */
static uint64_t peak_of(
    const struct passo_path_planner *path, uint64_t slope, const int32_t *unit, uint32_t axis)
{
	const uint64_t twice = passo_mul_div(slope, passo_path_size32(unit[axis]), PASSO_PATH_ONE);

	return passo_mul_div(twice, UINT32_C(1) << 15, path->gentleness);
}

/* What the ramps of the curved lines beside a corner leave of the acceleration of an axis. */
static uint64_t left_of(const struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, uint32_t axis, const struct passo_path_item *item)
{
	const struct passo_path_item *last = passo_path_item(path, path->added - 1);
	const uint64_t most = path->axis[axis].acceleration, excess = most + most / EXCESS;
	uint64_t peak = 0;

	if (corner->bends_before)
		peak = peak_of(path, last->slope, path->at.direction, axis);
	if (corner->bends_behind)
		peak = passo_path_larger(peak, peak_of(path, item->slope, unit, axis));
	return excess > peak ? passo_path_smaller(most, excess - peak) : 0;
}

static uint64_t square_by(const struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, const struct passo_path_item *item)
{
	uint64_t left[PASSO_AXES_MAX];

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++)
		left[axis] = left_of(path, corner, unit, axis, item);
	return passo_path_corner_square(path, corner, left);
}

static uint64_t wanted(const struct passo_path_item *item)
{
	return passo_path_speed_square(passo_path_smaller(item->feed, item->limit));
}

/* Radius, UQ.8 substeps, of an arc over a length (UQ.30 substeps). */
static uint64_t radius_of(uint64_t over, uint64_t turn)
{
	return passo_path_smaller(passo_mul_div(over, 256, passo_path_larger(turn, 1)), UINT32_MAX);
}

/* Of the weakest axis that turns; one with a small part of the turn is stronger. */
static uint64_t jerk_of(
    const struct passo_path_planner *path, const struct passo_path_corner *corner, uint64_t turn)
{
	const uint64_t part = turn / SMALL;
	uint64_t jerk = PASSO_PATH_SQUARE_MAX;

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const uint64_t change = corner->change[axis], most = passo_path_larger(change, part);

		if (change > 0)
			jerk = passo_path_smaller(jerk, passo_mul_div(path->axis[axis].jerk, most, change));
	}
	return jerk;
}

/* The square of a velocity whose cube is a jerk times an area, UQ.16 substeps^2. */
static uint64_t soft_square(uint64_t area, uint64_t jerk)
{
	const struct passo_u128 cube = passo_multiply(jerk, area);
	uint64_t velocity = 0;

	for (uint64_t bit = PASSO_PATH_SPEED_MAX / 2; bit > 0; bit /= 2) {
		const uint64_t tried = velocity | bit;

		if (!passo_u128_less(cube, passo_multiply(tried * tried, tried)))
			velocity = tried;
	}
	return passo_path_speed_square(velocity);
}

/* Quarters of the slope that a line lacks. */
static void ease(
    const struct passo_path_planner *path, struct passo_path_item *item, uint32_t quarters, uint64_t most)
{
	if (quarters > item->eased) {
		const uint32_t left = 4u - quarters, had = 4u - item->eased;

		item->slope = passo_path_larger(passo_mul_div(item->slope, left, had), 1);
#ifndef PASSO_WITHOUT_JERK_PATHS
		item->jerk = passo_path_larger(passo_mul_div(item->jerk, left, had), 1);
#endif
		item->eased = (uint8_t)quarters;
	}
	if (passo_path_is_soft(path))
		item->slope = passo_path_larger(passo_path_smaller(item->slope, most), 1);
}

/* The least acceleration of the axes that move along a curve. */
static uint64_t weakest_of(const struct passo_path_planner *path, const int32_t *unit)
{
	uint64_t weakest = PASSO_PATH_SQUARE_MAX >> 2;

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		if (passo_path_size32(unit[axis]) >= PASSO_PATH_ONE / SMALL)
			weakest = passo_path_smaller(weakest, path->axis[axis].acceleration);
	}
	return weakest;
}

/* What the lines of a curve lack, by the acceleration across them. With one slope for all directions, that of
 * the weakest axis, it may be 11 and 43; a little slower curve is worth more slope. */
static uint32_t lacking(uint64_t across, uint64_t weakest)
{
	return across <= weakest / 64 * 11 ? 0 : across <= weakest / 64 * 60 ? 1 : 2;
}

/* Greatest slope in a curve with profile jerk, of a radius, at a square. */
static uint64_t soft_slope(const struct passo_path_planner *path, uint64_t radius, uint64_t jerk,
    uint64_t square, uint64_t acceleration)
{
	const uint64_t velocity = passo_path_larger(passo_isqrt64(square), 1);
	const uint64_t most =
	    passo_mul_div(passo_mul_div(jerk, radius << 8, velocity), ACROSS, UINT32_C(1) << 16);

	return passo_mul_div(2 * passo_path_smaller(most, acceleration), path->gentleness, UINT32_C(1) << 16);
}

#ifndef PASSO_WITHOUT_JERK_PATHS
static int32_t half_turn(const struct passo_path_planner *path, const int32_t *unit, uint32_t axis)
{
	return unit[axis] / 2 - path->at.direction[axis] / 2;
}

/* Whether the path turns to the other side than at the corner before. */
static bool turns_back(const struct passo_path_planner *path, const int32_t *unit)
{
	int64_t product = 0;

	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		product += (int64_t)path->at.half_turn[axis] * half_turn(path, unit, axis) / 8;
	return product < 0;
}

/* Radius, UQ.8 substeps, of the change of the curvature at a corner: from that of the `curve` before it, and
 * to a straight behind it. */
static uint64_t radius_of_change(const struct passo_path_planner *path,
    const struct passo_path_corner *corner, const int32_t *unit, uint64_t turn, bool curve)
{
	const struct passo_path_place *at = &path->at;
	uint64_t over = corner->over, last = 0, sum = 0;

	if (!passo_path_is_rounded(path)) /* it turns back */
		return radius_of(over, turn + passo_mul_div(at->turn, over, at->over));
	if (curve) {
		over = passo_path_smaller(over, at->over);
		last = passo_mul_div(over, PASSO_PATH_ONE, at->over);
	}
	const uint64_t own = passo_mul_div(over, PASSO_PATH_ONE, corner->over);
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const int64_t change =
		    half_turn(path, unit, axis) * (int64_t)own - at->half_turn[axis] * (int64_t)last;

		sum += (uint64_t)(change / PASSO_PATH_ONE * (change / PASSO_PATH_ONE));
	}
	const uint64_t radius = radius_of(over, 2 * passo_isqrt64(sum));
	return corner->bends_behind ? radius : passo_path_smaller(radius, radius_of(corner->over, turn));
}

/* Highest square where the curvature changes: the acceleration jumps by `k v^2`, `k` the change. Steps that
 * are off by `e` show a jerk of `0.75 k v^2 / w - 8 e / w^3` over a time w, so `k v^3 sqrt(k / e) / 11` at
 * most; `e` is that of chords, and of lines that are merged. The rest of the jerk is for the ramps in the
 * curves, and for changes near each other, which add up. */
static uint64_t square_of_change(const struct passo_path_planner *path,
    const struct passo_path_corner *corner, const int32_t *unit, uint64_t turn, bool back, uint64_t jerk)
{
	const struct passo_path_place *at = &path->at;
	const bool curve = back || (corner->bends_before && at->bends);
	const uint64_t radius = radius_of_change(path, corner, unit, turn, curve);
	uint64_t off = passo_mul_shift(corner->over, turn, 56);

	if (curve)
		off = passo_path_larger(off, passo_mul_shift(at->over, at->turn, 56));
	off = passo_path_smaller(off + path->deviation / OFF_PART, UINT32_MAX);
	return soft_square(radius * passo_isqrt64(off * radius), JUMP * jerk);
}

/* The curve of the new line, for the next corner. */
static void keep_turn(struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, uint64_t turn)
{
	struct passo_path_place *at = &path->at;

	at->bends = corner->bends_behind;
	passo_path_keep_corner(corner, at);
	at->turn = turn;
	at->over = corner->over;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		at->half_turn[axis] = half_turn(path, unit, axis);
}

/* Of a lone corner at a square: what a ramp over it lacks of the slopes beside it, in 256ths. What it leaves
 * of the acceleration of an axis before and behind the corner, in all, is for the corner. */
static uint8_t lacking_over(const struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, const struct passo_path_item *item, uint64_t square)
{
	const struct passo_path_item *last = passo_path_item(path, path->added - 1);
	uint64_t lacks = 0;

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const uint64_t most = path->axis[axis].acceleration;
		const uint64_t along = passo_path_larger(peak_of(path, last->slope, path->at.direction, axis),
		    peak_of(path, item->slope, unit, axis));
		const uint64_t needed = along + passo_mul_div(square, corner->change[axis], corner->over) / 2;

		if (needed > most)
			lacks = passo_path_larger(lacks, passo_mul_div(needed - most, 255, along));
	}
	return (uint8_t)lacks;
}

/* The path is no faster at the corner before either, unless a ramp that comes to rest before the next one
 * may be: that has been planned, with half of the jerk (certain() in passo_path_jerk.c). It ends with
 * `v = j t^2 / 2` over a length `j t^3 / 6`, so `v^3 = 4.5 j l^2`. Returns the highest square there. */
static uint64_t slow_before(struct passo_path_planner *path, uint64_t square)
{
	const uint32_t index = passo_path_first(path);
	struct passo_path_item *item = passo_path_item(path, index);
	const uint64_t length = passo_path_smaller(passo_path_since_corner(path) >> 8, UINT32_MAX);

	if (item->rest)
		return 0;
	square = passo_path_larger(square, soft_square(length * length, REST * path->at.jerk));
	if (index > path->planned && square < item->bend) {
		item->bend = square;
		passo_path_limit(path, index);
		passo_path_changes(path, index);
	}
	return item->bend;
}

/* Highest square at a corner, where one limits the mean of the velocities there and at the corner before. */
static uint64_t slow_between(struct passo_path_planner *path, uint64_t square)
{
	const uint64_t before = slow_before(path, square), mean = passo_isqrt64(square);
	const uint64_t faster = passo_isqrt64(passo_path_larger(before, square)) - mean;

	return passo_path_speed_square(mean - passo_path_smaller(faster, mean / 2));
}

/* Of a lone corner behind one to the other side, the area as of radius^2. Both show a jerk of
 * `(c (3 w v - d) - 8 e) / w^3` over a time w, `c` the mean of both changes of the direction, `d` the way
 * between, so `4 c v^3 / (d + 8 e / c)^2` at most; `8 e / c` is the length of the rounding. */
static uint64_t area_between(const struct passo_path_planner *path, uint64_t over, uint64_t turn)
{
	over += passo_path_since_corner(path) << (PASSO_PATH_UNIT_BITS - 16);
	return radius_of(over, PASSO_PATH_ONE) * radius_of(over, path->at.turn + turn);
}

/* Highest square at a corner of a curve, or `back` to the other side than the one before. `part`: 32nds of
 * the jerk of a lone one; another may be part of a turn of several corners, and has a quarter of that, or
 * what the change of the curvature has. */
static uint64_t square_after(const struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, uint64_t turn, bool back, uint64_t jerk, uint32_t part)
{
	const bool lone = passo_path_was_lone(path) && !corner->bends_before && !corner->bends_behind;
	uint64_t square = 0;

	if (back && (lone || passo_path_is_rounded(path)))
		square = soft_square(area_between(path, corner->over, turn), jerk / (lone ? 32 : 128) * part);
	return lone ? square
	            : passo_path_larger(square, square_of_change(path, corner, unit, turn, back, jerk));
}

/* Radius, UQ.8 substeps, of a corner and the one before it, to the same side: outside of the line between
 * they have no more than the rounding of one corner with both turns. */
static uint64_t radius_of_pair(
    const struct passo_path_planner *path, const struct passo_path_corner *corner, uint64_t turn)
{
	const uint64_t both = turn + path->at.turn, length = path->at.length;
	const uint64_t arc = passo_mul_div(8 * path->deviation, PASSO_PATH_ONE, both);
	uint64_t outside = passo_path_ahead(path) + corner->rounding.behind;

	if (outside > length + length / 4)
		outside = passo_path_smaller(outside, passo_path_larger(arc, length - length / 4));
	return radius_of((length + outside) << (PASSO_PATH_UNIT_BITS - 16), both);
}
#endif

uint64_t passo_path_shaped_corner(struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, struct passo_path_item *item)
{
	/* 32nds for the turn: of a curve, by its quarters (of a sharp corner: 2), and of a lone corner */
	static const uint8_t JERK_PARTS[] = {32 / JERK_EXCESS, 8, 16, 12};
	struct passo_path_item *last = passo_path_item(path, path->added - 1);
	const bool soft = passo_path_is_soft(path), bends = corner->bends_before || corner->bends_behind;
	const uint64_t turn = passo_isqrt64(corner->turn);
	const uint64_t radius = radius_of(corner->over, turn), jerk = jerk_of(path, corner, turn);
	const uint64_t before = wanted(last), behind = wanted(item);
	const uint64_t needed =
	    passo_path_larger(corner->bends_before ? before : 0, corner->bends_behind ? behind : 0);
	const uint64_t weakest = weakest_of(path, unit);
	const uint64_t across = passo_mul_div(needed, turn, corner->over);
	uint32_t quarters = bends ? lacking(across, weakest) : turn < SHARP ? 3 : 2;
	uint64_t most = UINT64_MAX, fastest = UINT64_MAX, area = radius * radius;

#ifndef PASSO_WITHOUT_JERK_PATHS
	const bool back = turns_back(path, unit);
	const bool rounded = passo_path_is_rounded(path);
	const bool curved = corner->bends_behind || (corner->bends_before && path->at.bends);
	const bool pair = soft && rounded && !back && corner->bends_before && path->at.bends;

	if (pair) {
		const uint64_t both = radius_of_pair(path, corner, turn);

		area = passo_path_smaller(area, both * both);
	}
#endif
	if (soft) {
		while (
		    (fastest = soft_square(area, jerk / 32 * JERK_PARTS[quarters])) < needed && quarters < 2)
			quarters++;
		most = soft_slope(path, radius, jerk, passo_path_smaller(fastest, needed),
		    across > weakest / EXCESS ? weakest : PASSO_PATH_SQUARE_MAX >> 2);
	}
	if (corner->bends_before)
		ease(path, last, quarters, most);
	if (corner->bends_behind)
		ease(path, item, quarters, most);
	const uint64_t square = passo_path_smaller(square_by(path, corner, unit, item), fastest);
#ifndef PASSO_WITHOUT_JERK_PATHS
	if (soft) {
		uint64_t between = PASSO_PATH_SQUARE_MAX;

		if (back || (curved && rounded))
			between = square_after(path, corner, unit, turn, back, jerk, JERK_PARTS[quarters]);
		if (!bends) {
			const uint64_t passed =
			    passo_path_smaller(square, passo_path_smaller(before, behind));

			item->over = lacking_over(path, corner, unit, item, passed);
		}
		/* ramps that end or begin there have jerk at their ends */
		if (quarters == 3 || (rounded && between < square)) {
			if (!corner->bends_behind)
				item->jerk -= item->jerk / 4;
			if (!corner->bends_before && last->eased < 2) /* no more than certain() says */
				last->jerk -= last->jerk / 4;
		}
		if (rounded && back)
			between = slow_between(path, between);
		else if (pair && area < radius * radius)
			slow_before(path, fastest);
		keep_turn(path, corner, unit, turn);
		return passo_path_smaller(square, between);
	}
#endif
	return square;
}

#endif
