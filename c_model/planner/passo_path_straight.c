/* SPDX-License-Identifier: MIT
 * Straights of several lines: with other feeds or outputs they stay lines of their own, but the rounding of a
 * corner may span them. That of a lone corner needs no curvature: each line within it is passed as the one
 * beside the corner is. Others bend halves of the lines. A line that goes straight on makes more of the
 * straight known, and the corner at its start faster.
 */
#include <stddef.h>
#include <string.h>

#include "passo_path_private.h"

#ifndef PASSO_WITHOUT_ROUNDING

/* A line that is covered by this part of it, or less, does not bend: beside a corner whose rounding is part
 * of a longer curve, and beside another one. */
#define CURVE_PARTS 4u
#define CORNER_PARTS 2u
/* All of it bends, unless so much is not covered. */
#define FAR_PARTS 3u
/* Less of a rounding in a line is none. */
#define HARDLY 16u
/* Of the junction deviation: by so much an axis may be off a straight where the feed changes. */
#define OFF 2u
/* Where it stays the same: no more than what rounding to 0.001 mm makes, so that a curve stays one. */
#define SAME_OFF 8u
/* Several axes, and both lines beside an end, hide no more of what it is off than this. */
#define SEEN 8u
/* Both of a hundredth of a millimeter at most: it is rounded coordinates that make no corner, not a shape. */
#define OFF_PER_MM 100u
/* As the straight may be off, so may what the corner at its start is rounded to: by this part of that it may
 * become sharper, of its turn, squared. */
#define SHARPER 4u

static struct passo_path_item *item_at(
    const struct passo_path_planner *path, const struct passo_path_meeting *meeting, uint32_t index)
{
	return index == path->added ? meeting->newest : passo_path_item(path, index);
}

static uint64_t length_of(
    const struct passo_path_planner *path, const struct passo_path_meeting *meeting, uint32_t index)
{
	return index == path->added ? meeting->newest_length
	                            : (uint64_t)passo_path_item(path, index)->substeps << 16;
}

/* The limits of an item have changed. */
static void changes(struct passo_path_planner *path, uint32_t index)
{
	path->bent = index < path->bent ? index : path->bent;
}

/* The line beside the corner on one side, its length, and the line that is one farther away than another. */
static uint32_t first_of(const struct passo_path_meeting *meeting, bool behind)
{
	return behind ? meeting->index : meeting->index - 1;
}

static uint64_t first_length(const struct passo_path_meeting *meeting, bool behind)
{
	return behind ? meeting->next : meeting->last;
}

static uint32_t farther(uint32_t index, bool behind)
{
	return behind ? index + 1 : index - 1;
}

/* Adds a curvature, unless that is null. */
static void bend_half(struct passo_path_planner *path, const struct passo_path_meeting *meeting, bool behind,
    uint32_t index, unsigned half, const int64_t *curvature)
{
	struct passo_path_item *item = item_at(path, meeting, index);

	if (curvature == NULL)
		return;
	if (behind)
		item->begun |= half > 0 ? 2u : 1u;
	passo_path_bend(path, curvature, behind ? meeting->to : meeting->from, half, item);
	/* a short line that is off the direction of its straight may have axes that hardly move in it */
	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const uint8_t others = (uint8_t)~(item->curve.slope[axis] > 0 ? 0u : 1u << axis);

		item->curve.helps[half] &= others;
		item->curve.hinders[half] &= others;
	}
	passo_path_set_fall(item);
	changes(path, index);
}

void passo_path_unbend(
    struct passo_path_planner *path, const struct passo_path_meeting *meeting, bool behind, uint64_t reach)
{
	uint32_t index = first_of(meeting, behind);
	uint64_t passed = 0, length = first_length(meeting, behind);

	for (;;) {
		struct passo_path_item *item = item_at(path, meeting, index);

		for (unsigned half = 0; half < PASSO_PATH_HALVES; half++) {
			if (behind || ((uint32_t)item->begun >> half & 1u) == 0)
				passo_path_straighten(item, half);
		}
		passo_path_set_fall(item);
		changes(path, index);
		passed += length;
		if (passed >= reach || index == (behind ? meeting->end : path->planned))
			return;
		index = farther(index, behind);
		length = length_of(path, meeting, index);
	}
}

uint64_t passo_path_spread(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    struct passo_path_corner *corner, bool behind, uint64_t reach, const int64_t *curvature)
{
	const unsigned near = behind ? 0 : 1;
	const uint32_t parts = reach < corner->arc ? CURVE_PARTS : CORNER_PARTS;
	uint32_t index = first_of(meeting, behind);
	uint64_t passed = 0, length = first_length(meeting, behind);

	corner->point[behind].index = 0;
	if (reach < length / 2)
		return reach;
	for (;;) {
		bend_half(path, meeting, behind, index, near, curvature);
		if (reach < passed + length - length / FAR_PARTS)
			return reach < passed + length / 2 ? reach : passed + length / 2;
		bend_half(path, meeting, behind, index, 1 - near, curvature);
		if (reach < passed + length)
			return reach;
		passed += length;
		if (behind ? index == meeting->end : index <= path->planned)
			return passed; /* the ramps are there */
		index = farther(index, behind);
		length = length_of(path, meeting, index);
		if (reach < passed + length / parts) {
			if (reach - passed >= reach / HARDLY) {
				corner->point[behind].index = behind ? index : index + 1;
				corner->point[behind].left = reach - passed;
			}
			return reach;
		}
	}
}

bool passo_path_is_known(
    const struct passo_path_planner *path, const struct passo_path_meeting *meeting, uint64_t reach)
{
	uint32_t index = meeting->index - 1;

	for (uint64_t passed = meeting->last; passed < reach; passed += length_of(path, meeting, index)) {
		if (index-- <= path->planned)
			return false;
	}
	return true;
}

/* Forgets which items are within the rounding of the corner at the start of an item. */
static void clear_points(struct passo_path_planner *path, uint32_t corner)
{
	if (path->pointed != corner)
		return;
	for (uint32_t index = path->point[0]; index <= path->point[1]; index++) {
		struct passo_path_item *item = passo_path_item(path, index);

		if (index <= path->planned || index >= path->added || item->point == PASSO_PATH_CORNER)
			continue;
		item->point = PASSO_PATH_CORNER;
		item->turn = item->away = 0;
		item->bend = PASSO_PATH_SQUARE_MAX;
	}
	changes(path, path->point[0]);
	path->pointed = 0;
}

/* A corner is rounded to beyond the start of an item. */
static void set_point(struct passo_path_planner *path, const struct passo_path_meeting *meeting, bool behind,
    uint32_t index, const struct passo_path_item *corner)
{
	struct passo_path_item *point = item_at(path, meeting, index);

	memcpy(point->lone, corner->lone, sizeof point->lone);
	point->point = behind ? PASSO_PATH_BEHIND : PASSO_PATH_BEFORE;
	point->whole = corner->whole;
	point->turn = corner->turn;
	point->valley = corner->valley;
	point->bend = corner->bend;
	path->point[behind] = index;
	changes(path, index);
}

/* On one side of a lone corner. */
static void set_lone(struct passo_path_planner *path, const struct passo_path_meeting *meeting, bool behind,
    uint64_t reach, const struct passo_path_item *corner)
{
	uint32_t index = first_of(meeting, behind);

	for (uint64_t passed = first_length(meeting, behind); passed < reach;) {
		const uint32_t at = behind ? index + 1 : index;

		set_point(path, meeting, behind, at, corner);
		item_at(path, meeting, at)->away = (uint16_t)passo_mul_div(passed, UINT16_MAX, reach);
		index = farther(index, behind);
		passed += length_of(path, meeting, index);
	}
}

void passo_path_set_points(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    const struct passo_path_corner *corner, const struct passo_path_item *item)
{
	clear_points(path, meeting->index);
	path->pointed = meeting->index;
	path->point[0] = path->point[1] = meeting->index;
	for (unsigned behind = 0; behind < 2; behind++) {
		const struct passo_path_part_covered *end = &corner->point[behind];

		if (corner->whole) {
			set_lone(path, meeting, behind, corner->arc, item);
		} else if (end->index > 0) {
			set_point(path, meeting, behind, end->index, item);
			item_at(path, meeting, end->index)->turn = (uint32_t)(end->left >> 16);
		}
	}
}

/* What is behind the last corner that the path reaches, before what has changed, can become faster. */
static void unsettle(struct passo_path_planner *path)
{
	uint32_t index = path->bent;

	while (index > path->planned) {
		const struct passo_path_item *item = passo_path_item(path, --index);

		if (item->rest || item->reach == item->corner)
			break;
	}
	path->final = index < path->final ? index : path->final;
}

/* Rounds the corner at the start of the straight of the last line, which is known to be so long, unless a
 * ramp is there. */
static void round_start(
    struct passo_path_planner *path, uint64_t straight, struct passo_path_item *newest, uint64_t length)
{
	struct passo_path_place *at = &path->at;
	const uint64_t known = path->rounded_at == at->first ? path->rounded : at->straight;
	struct passo_path_corner corner;

	if (!passo_path_spans(path) || !at->cornered || at->first <= path->planned || path->jump
	    || straight == known || passo_path_smaller(straight, known) / 2 >= at->arc)
		return;
	struct passo_path_item *first = passo_path_item(path, at->first);
	const struct passo_path_meeting meeting = {
	    .index = at->first,
	    .from = at->came,
	    .to = at->mean,
	    .before = at->came_straight,
	    .behind = straight,
	    .last = at->came_last,
	    .next = at->first + 1 == path->added ? at->length : (uint64_t)first->substeps << 16,
	    .newest = newest,
	    .newest_length = length,
	    .end = newest == NULL ? path->added - 1 : path->added,
	};

	passo_path_find_turn(path, at->came, at->mean, &corner);
	if (corner.turn < PASSO_PATH_NO_TURN)
		return;
	first->rest = false;
	first->bend = passo_path_round(path, &meeting, &corner, first);
	at->arc = corner.arc;
	for (uint32_t index = at->first - 1; index <= at->first + 1 && index < path->added; index++)
		passo_path_limit(path, index);
	passo_path_rest_if_slow(path, first);
	path->rounded_at = at->first;
	path->rounded = straight;
	unsettle(path);
}

static uint64_t permitted(const struct passo_path_planner *path)
{
	return passo_path_smaller(path->deviation, ((uint64_t)path->substeps_per_mm << 16) / OFF_PER_MM);
}

/* By how much an axis may be off the straight at the start of an item, UQ32.16 substeps; a little is what the
 * last bits of targets in 2^-32 mm are. */
static uint64_t may_be_off(const struct passo_path_planner *path, const struct passo_path_item *item)
{
	const struct passo_path_item *last = passo_path_item(path, path->added - 1);
	const bool same = last->feed == item->feed && last->rapid == item->rapid;

	return permitted(path) / (same ? SAME_OFF : OFF) + (path->substeps_per_mm >> 14); /* 2^-30 mm */
}

/* Each end p of the straight, at the length s of it, limits the direction m of the whole, from its start to
 * its end: it is off by no more than what it may be, |p - s m|. */
static void limit_mean(struct passo_path_planner *path, uint64_t off)
{
	struct passo_path_place *at = &path->at;
	const uint64_t part = passo_mul_div(off, PASSO_PATH_ONE, passo_path_larger(at->straight, 1));
	const int32_t wide = (int32_t)passo_path_smaller(part + 2, PASSO_PATH_ONE - 1);

	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		if (at->mean[axis] - wide > at->least[axis])
			at->least[axis] = at->mean[axis] - wide;
		if (at->mean[axis] + wide < at->most[axis])
			at->most[axis] = at->mean[axis] + wide;
	}
}

bool passo_path_goes_on(struct passo_path_planner *path, const struct passo_path_item *item,
    const int32_t *unit, uint64_t length, uint64_t turn)
{
	struct passo_path_place *at = &path->at;
	struct passo_path_corner corner;
	int32_t mean[PASSO_AXES_MAX];

	if (!passo_path_spans(path))
		return turn < PASSO_PATH_NO_TURN;
	const uint64_t off = may_be_off(path, item);
	const uint64_t least = passo_mul_shift(
	    passo_isqrt64(turn), passo_path_smaller(length, at->straight), PASSO_PATH_UNIT_BITS);
	if (least > SEEN * off || turn > UINT64_C(2) << (2 * PASSO_PATH_UNIT_BITS)) /* or it goes back */
		return false;
	const int64_t share = (int64_t)passo_mul_div(length, PASSO_PATH_ONE, at->straight + length);

	limit_mean(path, off);
	for (uint32_t row = 0; row < passo_path_rows(path); row++) {
		const int64_t change = (int64_t)unit[row] - at->mean[row];

		mean[row] = (int32_t)(at->mean[row] + change * share / PASSO_PATH_ONE);
		if (row < path->machine.axes && (mean[row] < at->least[row] || mean[row] > at->most[row]))
			return false;
	}
	if (at->cornered) {
		passo_path_find_turn(path, at->came, mean, &corner);
		const uint64_t sharper = passo_mul_div(
		    at->turn_known, permitted(path) / SHARPER, passo_path_larger(path->deviation, 1));

		if (corner.turn > at->turn_known + sharper)
			return false;
		at->turn_known = passo_path_smaller(at->turn_known, corner.turn);
	}
	for (uint32_t row = 0; row < passo_path_rows(path); row++)
		at->mean[row] = mean[row];
	return true;
}

void passo_path_end_straight(struct passo_path_planner *path)
{
	round_start(path, path->at.straight, NULL, 0);
}

void passo_path_prolong(struct passo_path_planner *path, struct passo_path_item *newest, uint64_t length)
{
	clear_points(path, path->added); /* of a corner that has become this line */
	round_start(path, path->at.straight + length, newest, length);
	path->at.straight += length;
}

void passo_path_begin(struct passo_path_planner *path, const int32_t *unit, uint64_t length,
    const struct passo_path_meeting *meeting, const struct passo_path_corner *corner)
{
	struct passo_path_place *at = &path->at;

	at->first = path->added;
	at->straight = length;
	at->cornered = meeting != NULL;
	for (uint32_t row = 0; row < passo_path_rows(path); row++) {
		at->came[row] = at->mean[row];
		at->mean[row] = unit[row];
		at->least[row] = -INT32_MAX;
		at->most[row] = INT32_MAX;
	}
	if (meeting == NULL)
		return;
	at->arc = corner->arc;
	at->turn_known = corner->turn;
	at->came_straight = meeting->before;
	at->came_last = meeting->last;
	path->rounded_at = path->added;
	path->rounded = length;
}

#endif
