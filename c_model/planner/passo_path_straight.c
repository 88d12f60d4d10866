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
	passo_path_set_fall(item);
	passo_path_changes(path, index);
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
		passo_path_changes(path, index);
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
			if (reach - passed >= reach / PASSO_PATH_HARDLY) {
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
	passo_path_changes(path, path->point[0]);
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
	passo_path_changes(path, index);
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
	const struct passo_path_place *at = &path->at;
	const uint64_t known = path->rounded_at == at->first ? path->rounded : at->straight;
	struct passo_path_corner corner;

	if (!passo_path_spans(path) || !at->cornered || at->first <= path->planned || path->jump
	    || straight == known || passo_path_smaller(straight, known) / 2 >= at->arc)
		return;
	struct passo_path_item *first = passo_path_item(path, at->first);
	const struct passo_path_meeting meeting = {
	    .index = at->first,
	    .from = at->came,
	    .to = at->direction,
	    .before = at->came_straight,
	    .behind = straight,
	    .last = at->came_last,
	    .next = at->first + 1 == path->added ? at->length : (uint64_t)first->substeps << 16,
	    .newest = newest,
	    .newest_length = length,
	    .end = newest == NULL ? path->added - 1 : path->added,
	};

	passo_path_find_turn(path, at->came, at->direction, &corner);
	corner.arc = at->arc;
	first->rest = false;
	first->bend = passo_path_round(path, &meeting, &corner, first);
	for (uint32_t index = at->first - 1; index <= at->first + 1 && index < path->added; index++)
		passo_path_limit(path, index);
	passo_path_rest_if_slow(path, first);
	path->rounded_at = at->first;
	path->rounded = straight;
	unsettle(path);
}

bool passo_path_goes_on(const struct passo_path_planner *path, uint64_t turn, uint64_t length, uint32_t feed)
{
	const bool spans = passo_path_spans(path) || passo_path_item(path, path->added - 1)->feed != feed;
	const uint64_t shorter = passo_path_smaller(length, path->at.length);
	const uint64_t off =
	    passo_mul_shift((uint64_t)passo_isqrt64(turn) << 8, shorter, PASSO_PATH_UNIT_BITS);

	return passo_path_is_rounded(path) && spans
	    && off <= path->substeps_per_mm >> 7; /* 2^-31 mm, in UQ.24 substeps */
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

void passo_path_begin(
    struct passo_path_planner *path, uint64_t length, const struct passo_path_meeting *meeting, uint64_t arc)
{
	struct passo_path_place *at = &path->at;

	at->first = path->added;
	at->straight = length;
	at->cornered = meeting != NULL;
	at->arc = arc;
	if (meeting == NULL)
		return;
	at->came_straight = meeting->before;
	at->came_last = meeting->last;
	for (uint32_t row = 0; row < passo_path_rows(path); row++)
		at->came[row] = meeting->from[row];
	path->rounded_at = path->added;
	path->rounded = length;
}

#endif
