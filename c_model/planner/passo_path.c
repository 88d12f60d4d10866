/* SPDX-License-Identifier: MIT
 * The lines of a path: a ring of items, with three places in it. Items before `planned` have been passed by
 * the ramps, those before `sent` have been handed out as lines; `added` is the number of those known.
 */
#include <stddef.h>

#include "passo_path_private.h"

/* Half the arc of a corner of a radian, by the junction deviation: sharper ones have less. */
#define SHARP 4u
/* A line that takes longer than this part of a second is not merged. */
#define MERGED_PER_SECOND 128u
/* Steps of the search for the square at which a corner is passed. */
#define SEARCHED 8u

static struct passo_path_item *newest(const struct passo_path_planner *path)
{
	return passo_path_item(path, path->added - 1);
}

uint32_t passo_path_room(const struct passo_path_planner *path)
{
	const uint32_t oldest = path->sent < path->planned ? path->sent : path->planned;

	return path->capacity - (path->added - oldest);
}

bool passo_path_is_empty(const struct passo_path_planner *path)
{
	return path->sent == path->added && path->planned == path->added;
}

/* The next line is the first of a motion. */
static bool is_first(const struct passo_path_planner *path)
{
	return path->added == 0 || newest(path)->last;
}

/* The square below which the path rests at a corner: what the acceleration makes in a few ticks. */
static uint64_t slowest(const struct passo_path_planner *path, const struct passo_path_item *item)
{
	const uint64_t velocity =
	    passo_path_change(path, item->slope, PASSO_PATH_LANDING_TICKS) >> PASSO_PATH_VELOCITY_SHIFT;

	return velocity * velocity + 1;
}

void passo_path_rest_if_slow(const struct passo_path_planner *path, struct passo_path_item *item)
{
	item->rest = item->corner < slowest(path, item);
	if (item->rest)
		item->corner = 0;
}

/* Adds a line, or replaces the newest one, which has been taken off. */
static enum passo_plan_error add(
    struct passo_path_planner *path, const struct passo_path_move *move, bool instead)
{
	struct passo_path_item *item = passo_path_item(path, path->added);
	struct passo_path_item made = {.output = move->output, .dwell = path->dwell, .rest = path->rest};
	const enum passo_plan_error error = passo_path_measure(path, move, instead, &made);

	if (error != PASSO_PLAN_OK || made.substeps == 0)
		return error;
	*item = made;
	path->begins = path->rest;
	path->feed = move->feed;
	path->wanted = item->feed;
	path->merged = (struct passo_path_merged){.off = 0};
	passo_path_pace_line(path, item);
	passo_path_limit(path, path->added);
	if (item->rest)
		item->corner = item->dwell > 0 || is_first(path) ? passo_path_halt(item) : 0;
	else
		passo_path_rest_if_slow(path, item);
	path->rest = false;
	path->dwell = 0;
	path->added++;
	path->open = true;
	path->waits = path->waits && path->unsettled > 0 && path->added - path->planned < path->capacity;
	if (path->tolerance == 0 || passo_path_clocks(item) >= path->machine.clock_hz / MERGED_PER_SECOND)
		passo_path_close(path); /* too long for that to be of use */
	return PASSO_PLAN_OK;
}

void passo_path_close(struct passo_path_planner *path)
{
	if (path->open)
		passo_path_look_back(path);
	path->open = false;
}

/* Whether the newest line can still become another one. */
static bool is_open(const struct passo_path_planner *path, const struct passo_path_move *move)
{
	return !path->rest && (path->planned + 1 != path->added || !path->started)
	    && newest(path)->output == move->output && path->feed == move->feed;
}

/* Whether the newest line goes straight on from one of another feed: that is where a corner behind it stays.
 */
static bool ends_straight(const struct passo_path_planner *path)
{
#ifdef PASSO_WITHOUT_ROUNDING
	(void)path;
	return false;
#else
	return passo_path_is_rounded(path) && path->at.first + 1 != path->added;
#endif
}

/* Whether the new line is short: it may become part of one that is too long to be held back. */
static bool is_short(const struct passo_path_planner *path, const struct passo_path_merged *merged)
{
	return passo_mul_div(passo_path_clocks(newest(path)), merged->longer, path->at.length)
	     < path->machine.clock_hz / MERGED_PER_SECOND;
}

/* Replaces the newest line by one to a new target, if that is not farther off than the tolerance. */
static bool merge(struct passo_path_planner *path, const struct passo_path_move *move)
{
	if (!is_open(path, move))
		return false;
	const struct passo_path_merged merged = passo_path_off(path, move->target);
	if (ends_straight(path) && merged.off > path->substeps_per_mm >> 10) /* 2^-26 mm, in UQ.16 substeps */
		return false;
	if (merged.off >= path->tolerance || (!path->open && !is_short(path, &merged)))
		return false;
	const uint32_t dwell = path->dwell;

	path->added--;
	path->rest = path->begins;
	path->dwell = passo_path_item(path, path->added)->dwell;
	if (add(path, move, true) == PASSO_PLAN_OK) {
		path->merged = merged;
		return true;
	}
	path->added++;
	path->rest = false;
	path->dwell = dwell;
	return false;
}

enum passo_plan_error passo_path_add(struct passo_path_planner *path, const struct passo_path_move *move)
{
	if (merge(path, move))
		return PASSO_PLAN_OK;
	if (passo_path_room(path) == 0)
		return PASSO_PLAN_PATH_FULL;
	passo_path_close(path);
	return add(path, move, false);
}

void passo_path_tolerance(struct passo_path_planner *path, uint64_t tolerance)
{
	path->tolerance = path->own_tolerance;
	if (tolerance > 0)
		path->tolerance = tolerance == PASSO_PATH_UNMERGED
		                    ? 0
		                    : passo_mul_div(tolerance, path->substeps_per_mm, UINT32_C(1) << 16);
}

void passo_path_dwell(struct passo_path_planner *path, uint64_t clocks)
{
	path->rest = true;
	/* with profile jerk the newest line is more now that it is straight to its end */
	path->open = path->open || passo_path_is_soft(path);
	passo_path_close(path);
	const uint32_t round = (UINT32_C(1) << path->machine.tick_log2) - 1u;
	const uint64_t ticks = path->dwell + ((clocks >> path->machine.tick_log2) + ((clocks & round) > 0));

	path->dwell = (uint32_t)passo_path_smaller(ticks, UINT32_MAX);
	path->waits = false;
	path->final = path->added;
}

void passo_path_end(struct passo_path_planner *path)
{
	passo_path_dwell(path, 0);
	if (path->planned < path->added)
		newest(path)->last = true;
}

bool passo_path_rests_after(const struct passo_path_planner *path, uint32_t index)
{
	return index + 1 == path->added || passo_path_item(path, index)->last
	    || passo_path_item(path, index + 1)->rest;
}

/* At the end of an item, which `next` follows, unless it is the newest one. */
static uint64_t end_square(const struct passo_path_item *item, const struct passo_path_item *next)
{
	if (!item->last && next != NULL && !next->rest)
		return next->reach;
	return item->last || (next != NULL && next->dwell > 0) ? passo_path_halt(item) : 0;
}

uint64_t passo_path_end_square(const struct passo_path_planner *path, uint32_t index)
{
	return end_square(
	    passo_path_item(path, index), index + 1 == path->added ? NULL : passo_path_item(path, index + 1));
}

bool passo_path_is_settled(const struct passo_path_planner *path, uint32_t index)
{
	return index < path->final;
}

/* The square from which an item comes down to one at its end, with flat ends of a length in all. */
static uint64_t reach_over(const struct passo_path_item *item, uint64_t end, uint64_t flat, uint64_t behind)
{
	const uint64_t length = (uint64_t)item->substeps << 32;

	if (flat == 0 && passo_path_halves(item) == 1)
		return end + passo_path_fall(item, end);
	return passo_path_before(item, end, length - passo_path_smaller(flat, length), behind);
}

/* Highest square at the start of an item from which the path can come down to one at its end. */
static uint64_t reach_from(const struct passo_path_planner *path, uint32_t index,
    const struct passo_path_item *item, uint64_t end, uint64_t sharp)
{
	const uint64_t behind =
	    passo_path_larger(passo_path_flat(path, index + 1, index, false, end, true), sharp);
	/* its flat end is that of a square which it cannot exceed */
	const uint64_t plain = reach_over(item, end, behind, behind);
	const uint64_t before =
	    passo_path_flat(path, index, index, false, passo_path_smaller(item->corner, plain), false);
	const uint64_t most = before == 0 ? plain : reach_over(item, end, before + behind, behind);

	return passo_path_smaller(item->corner, most);
}

/* Highest square at the start of an item from which the path can come to rest. What was possible with fewer
 * lines still is, when the path could pass the `next` one's start at a square `was`. But a corner that is
 * passed faster leaves less for coming down to it: then it is passed more slowly. */
static uint64_t reach_of(const struct passo_path_planner *path, uint32_t index,
    const struct passo_path_item *item, struct passo_path_item *next, uint64_t was, uint64_t sharp)
{
	const uint64_t kept = path->anew ? 0 : passo_path_smaller(item->reach, item->corner);
	const uint64_t reach = reach_from(path, index, item, end_square(item, next), sharp);

	if (reach >= kept)
		return reach;
#ifndef PASSO_WITHOUT_ROUNDING
	if (next == NULL || next->rest || item->last || was >= next->reach)
		return kept;
	uint64_t low = was, high = next->reach;

	next->reach = low;
	if (reach_from(path, index, item, low, sharp) < kept) {
		next->reach = high; /* that is not why */
		return kept;
	}
	for (unsigned i = 0; i < SEARCHED; i++) {
		next->reach = low + (high - low) / 2;
		if (reach_from(path, index, item, next->reach, sharp) >= kept)
			low = next->reach;
		else
			high = next->reach;
	}
	next->reach = high; /* not 0, which would be a rest */
#else
	(void)was;
#endif
	return kept;
}

/* At the end of the newest line a sharp corner may follow, whose arc leaves no slope over this length. */
static uint64_t sharp_end(const struct passo_path_planner *path)
{
	const struct passo_path_item *item = newest(path);

	if (item->last || path->rest || passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return 0;
	const uint64_t half =
	    ends_straight(path) ? passo_path_straight(path) / 2 << 16 : (uint64_t)item->substeps << 31;
	return passo_path_smaller(half, path->deviation * SHARP << 16);
}

/* What of such a length is in an item, and the rest of it before that. */
static uint64_t within(const struct passo_path_item *item, uint64_t *length)
{
#ifdef PASSO_WITHOUT_ROUNDING
	const uint64_t found = *length;

	(void)item;
	*length = 0;
#else
	const uint64_t found = passo_path_smaller(*length, (uint64_t)item->substeps << 31);

	*length -= passo_path_smaller(*length, (uint64_t)item->substeps << 32);
#endif
	return found;
}

/* Whether the limits of an item have changed. */
static bool is_changed(const struct passo_path_planner *path, uint32_t index)
{
#ifdef PASSO_WITHOUT_ROUNDING
	return path->anew || index + 1 == path->added;
#else
	return path->anew || index + 1 == path->added || index >= path->bent;
#endif
}

/* Goes back from the newest line as long as anything changes. */
void passo_path_look_back(struct passo_path_planner *path)
{
	uint32_t final = path->final;
	uint64_t sharp = path->added > path->planned ? sharp_end(path) : 0;
	uint64_t was = 0;
	struct passo_path_item *next = NULL, *item = passo_path_item(path, path->added);

	for (uint32_t index = path->added; index-- > path->planned && index >= path->final;) {
		item = (item == path->items ? item + path->capacity : item) - 1;
		const uint64_t over = within(item, &sharp);
		const uint64_t reach = passo_path_is_soft(path)
		                         ? passo_path_soft_reach(path, index)
		                         : reach_of(path, index, item, next, was, over);

		if ((reach == item->corner || item->rest) && final < index)
			final = index;
		if (reach == item->reach && over == 0 && !is_changed(path, index))
			break;
		was = item->reach;
		item->reach = reach;
		next = item;
	}
	path->final = final;
	path->waits = path->waits && !path->anew && path->unsettled >= path->final;
	path->anew = false;
#ifndef PASSO_WITHOUT_ROUNDING
	path->bent = UINT32_MAX;
#endif
}

bool passo_path_next_line(struct passo_path_planner *path, struct passo_line *line)
{
	if (path->lines_end || path->sent == path->added)
		return false;
	const struct passo_path_item *item = passo_path_item(path, path->sent);
	if (path->sent + 1 == path->added && !item->last)
		return false;
	*line = (struct passo_line){
	    .last = item->last,
	    .directions = item->directions,
	    .substeps = item->substeps,
	    .output = item->output,
	};
	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++)
		line->steps[motor] = item->steps[motor];
	path->sent++;
	path->lines_end = item->last;
	return true;
}

uint32_t passo_path_velocity(const struct passo_path_planner *path, uint64_t speed)
{
	const uint64_t velocity = passo_mul_div(speed, path->substeps_per_mm, path->machine.clock_hz);

	return (uint32_t)passo_path_smaller(velocity, UINT32_MAX);
}

uint32_t passo_path_substeps(const struct passo_path_planner *path, uint64_t length)
{
	const uint64_t halves = passo_mul_div(length, path->substeps_per_mm, PASSO_UNIT_Q32 / 2);

	return (uint32_t)passo_path_smaller(halves / 2 + halves % 2, UINT32_MAX);
}

bool passo_path_next_motion(struct passo_path_planner *path)
{
	if (!path->lines_end || !path->ramps_end)
		return false;
	path->lines_end = path->ramps_end = false;
	passo_path_pace_begin(path);
	return true;
}
