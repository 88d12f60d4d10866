/* SPDX-License-Identifier: MIT
 * The corner between two lines: the highest speed there, and what its turn takes of the acceleration beside
 * it. docs/path.md has the rules.
 */
#include <stddef.h>
#include <string.h>

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

/* On one side alone a rounding leaves the line for good, and corners near each other, to one side, are
 * rounded as one: so it reaches little farther there than on the other side. */
static struct passo_path_rounding rounding_of(
    const struct passo_path_planner *path, uint64_t arc, uint64_t before, uint64_t behind)
{
	before = passo_path_smaller(before / 2, arc);
	behind = passo_path_smaller(behind / 2, arc);
	const uint64_t least = passo_path_smaller(before, behind);
	uint64_t most = (arc + least) / 2;

	if (passo_path_is_rounded(path))
		most = passo_path_larger(least + least / 16, arc / 8 * 3 + least / 2);
	return (struct passo_path_rounding){
	    passo_path_smaller(before, most), passo_path_smaller(behind, most)};
}

/* The halves of the lines beside a corner; where the rounding ends before the middle of a line, it belongs to
 * the corner alone. */
static void bend_lines(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    struct passo_path_corner *corner)
{
	const struct passo_path_rounding *rounding = &corner->rounding;
	const uint64_t inverse = passo_divide(
	    (struct passo_u128){1, 0}, passo_path_larger(rounding->before + rounding->behind, 1), NULL);
	int64_t curvature[PASSO_AXES_MAX];

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const int64_t turn = (int64_t)meeting->to[axis] - meeting->from[axis];
		const int64_t size = (int64_t)passo_path_smaller(
		    passo_mul_shift(passo_size64(turn), inverse, 30), PASSO_PATH_SQUARE_MAX / 2);

		curvature[axis] = turn < 0 ? -size : size;
	}
#ifdef PASSO_WITHOUT_ROUNDING
	struct passo_path_item *last = passo_path_item(path, meeting->index - 1);

	if (corner->bends_before)
		passo_path_bend(path, curvature, meeting->from, 0, last);
	passo_path_set_fall(last);
	if (corner->bends_behind)
		passo_path_bend(path, curvature, meeting->to, 0, meeting->newest);
#else
	passo_path_spread(path, meeting, corner, false, rounding->before, curvature);
	passo_path_spread(path, meeting, corner, true, rounding->behind, curvature);
#endif
}

#ifndef PASSO_WITHOUT_ROUNDING
/* What an axis has of its acceleration when a line has its slope, Q1.15. */
static int32_t part_of(
    const struct passo_path_planner *path, uint64_t slope, const int32_t *unit, uint32_t axis)
{
	const uint64_t part =
	    passo_mul_div(slope, passo_path_size32(unit[axis]), 2 * path->axis[axis].acceleration);
	const int32_t size = (int32_t)passo_path_smaller(part >> (PASSO_PATH_UNIT_BITS - 15), INT16_MAX);

	return unit[axis] < 0 ? -size : size;
}

static uint8_t packed(uint32_t share)
{
	return (uint8_t)passo_path_smaller((share + 255) >> 8, UINT8_MAX);
}

static void add_share(uint32_t lost, uint32_t needed, struct passo_path_share *shares)
{
	const struct passo_path_share share = {packed(lost), packed(needed)};

	if (share.lost + share.needed > shares[0].lost + shares[0].needed)
		shares[0] = share;
	if (share.lost > shares[1].lost) /* at a lower speed this axis needs more */
		shares[1] = share;
}

/* What the lines beside a lone corner, at their slopes, and its rounding have of the accelerations of the
 * axes. Those along the path and across it add up where they are the way that the axis turns. Where one of
 * the lines is short, the other one leaves all that is needed there. */
static void find_rounding(const struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    const struct passo_path_corner *corner, uint64_t square, struct passo_path_item *item)
{
	const uint64_t slope = passo_path_item(path, meeting->index - 1)->slope;
	const struct passo_path_rounding *rounding = &corner->rounding;
	const bool before = !corner->bends_before || corner->point[0].index > 0;
	const bool behind = !corner->bends_behind || corner->point[1].index > 0;
	const bool lone = passo_path_smaller(rounding->before, rounding->behind) >= corner->arc;
	const uint32_t sides = before && behind && lone ? 1 : 2;

	memset(item->lone, 0, sizeof item->lone);
	item->valley = false;
	item->turn = 0;
	if (!before && !behind)
		return;
	item->valley = before && behind;
	item->turn = (uint32_t)((corner->bends_before ? rounding->behind : rounding->before) >> 16);
	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const int64_t turn = (int64_t)meeting->to[axis] - meeting->from[axis];
		const uint64_t change = passo_size64(turn);
		if (change == 0)
			continue;
		const uint64_t bend = passo_mul_div(path->axis[axis].acceleration, corner->over, change);
		const uint32_t needed = (uint32_t)passo_mul_div(
		    passo_path_smaller(square, bend), sides * INT16_MAX, passo_path_larger(bend, 1));
		const int32_t way = turn < 0 ? -1 : 1;
		const int32_t first = before ? way * part_of(path, slope, meeting->from, axis) : 0;
		const int32_t second = behind ? way * part_of(path, item->slope, meeting->to, axis) : 0;
		const uint32_t lost = sides * (passo_path_size32(first) + passo_path_size32(second));

		/* down before it and up behind it, the axis has the difference the way that it turns */
		if (second - first + (int32_t)needed > 2 * INT16_MAX)
			item->valley = false;
		if (first < 0 || second < 0)
			add_share(lost, needed, item->lone[0]);
		if (first > 0 || second > 0)
			add_share(lost, needed, item->lone[1]);
	}
}
#endif

uint64_t passo_path_corner_square(
    const struct passo_path_planner *path, const struct passo_path_corner *corner, const uint64_t *left)
{
	uint64_t square = PASSO_PATH_SQUARE_MAX;

	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const struct passo_path_scale *own = &path->axis[axis];
		const uint32_t change = corner->change[axis];

		if (change == 0)
			continue;
		const uint64_t acceleration = left == NULL ? own->acceleration : left[axis];
		square = passo_path_smaller(square, passo_mul_div(acceleration, corner->over, change));
		if (own->jump > 0)
			square = passo_path_smaller(square,
			    passo_path_speed_square(((uint64_t)own->jump << PASSO_PATH_UNIT_BITS) / change));
	}
	return square;
}

bool passo_path_find_turn(const struct passo_path_planner *path, const int32_t *from, const int32_t *to,
    struct passo_path_corner *corner)
{
	corner->turn = 0;
	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const uint32_t change = (uint32_t)passo_size64((int64_t)to[axis] - from[axis]);

		corner->change[axis] = change;
		corner->turn += axis < path->machine.axes ? (uint64_t)change * change : 0;
	}
	return corner->turn >= 4;
}

static bool is_whole(const struct passo_path_corner *corner)
{
#ifdef PASSO_WITHOUT_ROUNDING
	(void)corner;
	return false;
#else
	return corner->whole;
#endif
}

/* How far the rounding reaches over lines that go straight on. */
static void span_lines(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    struct passo_path_corner *corner, struct passo_path_item *item)
{
#ifdef PASSO_WITHOUT_ROUNDING
	(void)path, (void)meeting, (void)corner, (void)item;
#else
	struct passo_path_rounding *rounding = &corner->rounding;

	corner->point[0].index = corner->point[1].index = 0;
	corner->whole = false;
	if (passo_path_spans(path)) {
		passo_path_unbend(path, meeting, false, rounding->before);
		passo_path_unbend(path, meeting, true, rounding->behind);
		corner->whole = passo_path_smaller(rounding->before, rounding->behind) >= corner->arc
		             && passo_path_is_known(path, meeting, rounding->before);
	}
	item->whole = corner->whole;
	item->point = PASSO_PATH_CORNER;
	item->away = 0;
	for (unsigned i = 0; passo_path_spans(path) && !corner->whole && i < 2; i++) {
		rounding->before = passo_path_spread(path, meeting, corner, false, rounding->before, NULL);
		rounding->behind = passo_path_spread(path, meeting, corner, true, rounding->behind, NULL);
		if (i == 0)
			*rounding =
			    rounding_of(path, corner->arc, 2 * rounding->before, 2 * rounding->behind);
	}
#endif
}

uint64_t passo_path_round(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    struct passo_path_corner *corner, struct passo_path_item *item)
{
	struct passo_path_rounding *rounding = &corner->rounding;

	*rounding = rounding_of(path, corner->arc, meeting->before, meeting->behind);
	span_lines(path, meeting, corner, item);
	const uint64_t both = rounding->before + rounding->behind;
	corner->over = passo_path_smaller(corner->arc, both) << (PASSO_PATH_UNIT_BITS - 16);
	corner->bends_before = !is_whole(corner) && rounding->before >= meeting->last / 2;
	corner->bends_behind = !is_whole(corner) && rounding->behind >= meeting->next / 2;
	if (!is_whole(corner))
		bend_lines(path, meeting, corner);
	item->arc = 0;
	if (both < corner->arc)
		item->arc = (corner->bends_before ? PASSO_PATH_ARC_BEFORE : 0)
		          | (corner->bends_behind ? PASSO_PATH_ARC_BEHIND : 0);
	if (passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return passo_path_shaped_corner(path, corner, meeting->to, item);
	const uint64_t square = passo_path_corner_square(path, corner, NULL);
#ifndef PASSO_WITHOUT_ROUNDING
	if (passo_path_is_rounded(path))
		find_rounding(path, meeting, corner, square, item);
	item->bend = square;
	passo_path_set_points(path, meeting, corner, item);
#endif
	return square;
}

/* The same direction on both sides, so no curvature. */
static void go_on(struct passo_path_planner *path, const int32_t *unit, struct passo_path_item *item)
{
	static const int64_t STRAIGHT[PASSO_AXES_MAX];
	struct passo_path_item *last = passo_path_item(path, path->added - 1);

	item->arc = PASSO_PATH_ARC_BEFORE | PASSO_PATH_ARC_BEHIND;
	passo_path_begin_straight(path);
	if (passo_path_is_rounded(path)) {
		passo_path_bend(path, STRAIGHT, path->at.direction, 1, last);
		passo_path_bend(path, STRAIGHT, unit, 0, item);
	}
	passo_path_set_fall(last);
}

uint64_t passo_path_limit_corner(
    struct passo_path_planner *path, const int32_t *unit, uint64_t length, struct passo_path_item *item)
{
	struct passo_path_corner corner;

	passo_path_restore_start(path);
	if (!passo_path_find_turn(path, path->at.direction, unit, &corner)
	    || passo_path_goes_on(path, corner.turn, length, item->feed)) {
		go_on(path, unit, item);
		item->bend = PASSO_PATH_SQUARE_MAX;
		passo_path_prolong(path, item, length);
		return item->bend;
	}
	passo_path_end_straight(path);
	corner.arc = half_arc(path, corner.turn);
	const struct passo_path_meeting meeting = {
	    .index = path->added,
	    .from = path->at.direction,
	    .to = unit,
	    .before = passo_path_straight(path),
	    .behind = length,
	    .last = path->at.length,
	    .next = length,
	    .newest = item,
#ifndef PASSO_WITHOUT_ROUNDING
	    .newest_length = length,
	    .end = path->added,
#endif
	};
	const uint64_t square = passo_path_round(path, &meeting, &corner, item);

	passo_path_begin(path, length, &meeting, corner.arc);
	return square;
}
