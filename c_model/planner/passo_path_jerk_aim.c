/* SPDX-License-Identifier: MIT
 * Profile `jerk`, forward: what the next ramp aims at. See passo_path_jerk.c.
 */
#include "passo_path_jerk.h"

#ifndef PASSO_WITHOUT_JERK_PATHS

/* Shorter ramps are not worth a change of the velocity. */
#define TICKS_MIN 64u
/* A higher velocity must be higher by one part in 2^12. */
#define PRECISION 12u

static void narrow(struct passo_path_law *law, uint64_t slope, uint64_t jerk)
{
	law->slope = passo_path_smaller(law->slope, slope);
	law->jerk = passo_path_smaller(law->jerk, jerk);
}

/* What was found for the next ramp: up to `top`; or level for a length, then down to `end` within `length`.
 */
struct choice {
	uint64_t top;
	struct passo_path_law law;    /* of the ramps up to there and down again */
	struct passo_path_law behind; /* without the first line */
	uint64_t level, length, end;
	uint64_t lacks; /* of the length to come down without a level part */
	bool found, rest;
	/* what further lines may change */
	bool top_settled, settled;
};

/* The lines passed so far. */
struct reach {
	struct passo_path_law law, behind;
	uint64_t length;
	uint64_t lowest; /* velocity that their limits and corners allow */
	uint64_t rise;   /* length from which on more is allowed than before, no less than `least`; 0: none */
	uint64_t open;   /* `lowest` at the first end of a line that is not settled; 0: none */
	uint64_t least;  /* length of a ramp that keeps the speed */
	uint64_t pause;  /* ticks for which the path goes on at the top of a ramp up, at least */
};

static void consider(const struct passo_path_planner *path, const struct reach *reach, uint64_t end,
    bool rest, struct choice *choice)
{
	const uint64_t from = path->velocity;
	const uint64_t down = from > end ? passo_path_ramp_length(path, &reach->law, from, end) : 0;
	const uint64_t level = down < reach->length ? reach->length - down : 0;
	const uint64_t lacks = down < reach->length ? 0 : down - reach->length;
	const uint64_t better = choice->top + (choice->top >> PRECISION) + 1;

	if (better <= reach->lowest
	    && passo_path_detour(path, &reach->law, from, better, reach->pause, end) <= reach->length) {
		choice->top = passo_path_highest(
		    path, &reach->law, from, reach->pause, end, reach->length, reach->lowest);
		choice->law = reach->law;
		choice->behind = reach->behind;
	}
	if (choice->found && (level > 0 ? level <= choice->level : lacks >= choice->lacks))
		return;
	choice->found = true;
	choice->level = level;
	choice->lacks = lacks;
	choice->length = reach->length;
	choice->end = end;
	choice->rest = rest;
}

static void pass(const struct passo_path_planner *path, uint32_t index, struct reach *reach)
{
	const struct passo_path_item *item = passo_path_item(path, index);
	const uint64_t from = path->velocity,
		       top = passo_path_larger(passo_path_velocity_of(item->top), from);

	if (top > from && reach->lowest <= from && reach->rise == 0)
		reach->rise = passo_path_larger(reach->length, reach->least);
	reach->lowest = passo_path_smaller(reach->lowest, top);
	reach->length += (uint64_t)item->substeps << 32;
	if (index == path->planned)
		reach->length -= (uint64_t)path->offset;
	/* what a ramp of whole ticks has left of the first line has no say: the next one begins gently */
	if (index == path->planned && passo_path_ticks_over(path, reach->length, 2 * from) < TICKS_MIN / 8
	    && !passo_path_rests_after(path, index))
		item = passo_path_item(path, index + 1);
	narrow(&reach->law, item->slope, item->jerk);
	if (index > path->planned)
		narrow(&reach->behind, item->slope, item->jerk);
	if (!passo_path_is_settled(path, index) && reach->open == 0)
		reach->open = reach->lowest;
}

/* Whether lines further on are of no use: nothing faster is possible, and what is level is long. */
static bool is_enough(
    const struct passo_path_planner *path, const struct reach *reach, const struct choice *choice)
{
	if (reach->lowest > choice->top)
		return false;
	return choice->top > path->velocity || (reach->rise > 0 && choice->level >= reach->rise)
	    || passo_path_ticks_over(path, choice->level, 2 * path->velocity) >= PASSO_PATH_TICKS_MAX;
}

/* Looks at the starts of all lines that matter as the place to which a ramp down may lead. */
static struct choice choose(const struct passo_path_planner *path, uint32_t least, struct reach *reach)
{
	const uint64_t from = path->velocity;
	struct choice choice = {.top = from};

	*reach = (struct reach){.law = {UINT64_MAX, UINT64_MAX},
	    .behind = {UINT64_MAX, UINT64_MAX},
	    .lowest = UINT64_MAX,
	    .least = passo_path_length_in(path, 2 * from, least),
	    .pause = passo_path_pace_need(path, least, 2)};
	for (uint32_t index = path->planned;; index++) {
		if (passo_path_is_held_back(path, index)) {
			reach->open = passo_path_larger(reach->open, reach->lowest);
			break;
		}
		const bool rests = passo_path_rests_after(path, index);

		pass(path, index, reach);
		consider(path, reach, passo_path_velocity_after(path, index), rests, &choice);
		if (rests)
			break;
		const struct passo_path_item *next = passo_path_item(path, index + 1);
		const uint64_t corner = passo_path_velocity_of(next->corner);
		if (corner + passo_path_change(path, next->slope, PASSO_PATH_LANDING_TICKS) < from)
			break;
		reach->lowest = passo_path_smaller(reach->lowest, passo_path_larger(corner, from));
		reach->law.slope = passo_path_pass_slope(next, reach->law.slope);
		if (index > path->planned)
			reach->behind.slope = passo_path_pass_slope(next, reach->behind.slope);
		if (is_enough(path, reach, &choice))
			break;
	}
	if (reach->rise > 0)
		choice.level = passo_path_smaller(choice.level, reach->rise);
	choice.top_settled = reach->open <= choice.top;
	choice.settled = reach->open == 0;
	return choice;
}

static struct passo_path_aim aim_at(
    const struct passo_path_planner *path, enum passo_path_kind kind, uint64_t length, uint64_t end)
{
	const uint64_t square = passo_path_square_of(end), from = passo_path_square_of(path->velocity);
	const uint64_t change = square < from ? from - square : square - from;
	const uint64_t slope = passo_mul_div_ceil(change, PASSO_UNIT_Q32, passo_path_larger(length, 1));

	return (struct passo_path_aim){kind, length, square, .slope = slope + slope / 64 + 1};
}

/* Whether the path goes on at its speed before it goes down: both last long enough. */
static bool is_worth(const struct passo_path_planner *path, const struct choice *choice, uint32_t least)
{
	const uint64_t from = path->velocity, down = choice->length - choice->level;
	const uint64_t ticks = passo_path_ticks_over(path, choice->level, 2 * from);

	return ticks >= least
	    && passo_path_ticks_over(path, down, from + choice->end) >= passo_path_pace_need(path, ticks, 2);
}

/* A ramp up to the top, of a length; where the first line, a small part of it, makes it gentle, a ramp within
 * that line, or if that is too short, none before its end. */
static struct passo_path_aim rise(
    const struct passo_path_planner *path, const struct choice *choice, uint32_t least, uint64_t up)
{
	const struct passo_path_item *item = passo_path_item(path, path->planned);
	const struct passo_path_law law = {item->slope, item->jerk};
	const uint64_t from = path->velocity, top = choice->top;
	const uint64_t left = ((uint64_t)item->substeps << 32) - (uint64_t)path->offset;
	const struct passo_path_aim whole = aim_at(path, PASSO_PATH_UP, up, top);

	if (left >= up / 4 || choice->behind.slope / 2 < choice->law.slope)
		return whole;
	const uint64_t first = passo_path_highest(path, &law, from, 0, UINT64_MAX, left, top);
	const uint64_t way = passo_path_ramp_length(path, &law, from, first);
	if (passo_path_ticks_over(path, way, from + first) >= least)
		return aim_at(path, PASSO_PATH_UP, way, first);
	const uint64_t level = passo_path_larger(left, passo_path_length_in(path, 2 * from, least));
	return from > 0 && level <= choice->level ? aim_at(path, PASSO_PATH_FLAT, level, from) : whole;
}

struct passo_path_aim passo_path_soft_aim(const struct passo_path_planner *path, bool needed)
{
	const uint64_t from = path->velocity;
	struct reach reach;
	const uint32_t least = passo_path_pace_need(path, 0, 1) + TICKS_MIN;
	const struct choice choice = choose(path, least, &reach);
	const uint64_t up =
	    choice.top > from ? passo_path_ramp_length(path, &choice.law, from, choice.top) : 0;
	struct passo_path_aim aim;

	if (!choice.found || (!needed && !choice.top_settled))
		return (struct passo_path_aim){
		    PASSO_PATH_FLAT, .square = passo_path_square_of(from), .open = true};
	if (choice.rest
	    && passo_path_ticks_over(path, choice.length, from + choice.top + 1) < 2 * TICKS_MIN) {
		aim = aim_at(path, PASSO_PATH_DOWN, choice.length, choice.end);
		aim.slope = reach.law.slope;
		aim.rest = true;
		return aim;
	}
	if (choice.top > from && (from == 0 || passo_path_ticks_over(path, up, from + choice.top) >= least))
		return rise(path, &choice, least, up);
	if (is_worth(path, &choice, least) || choice.end >= from
	    || (reach.rise > 0 && choice.level == reach.rise))
		return aim_at(path, PASSO_PATH_FLAT, choice.level, from);
	aim = aim_at(path, PASSO_PATH_DOWN, choice.length, choice.end);
	aim.rest = choice.rest;
	if (!needed && !choice.settled)
		return (struct passo_path_aim){
		    PASSO_PATH_FLAT, .square = passo_path_square_of(from), .open = true};
	return aim;
}

#endif
