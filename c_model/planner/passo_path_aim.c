/* SPDX-License-Identifier: MIT
 * What the next ramp aims at: the end of one part of the profile, or of several that are too short for a ramp
 * each.
 */
#include "passo_path_private.h"

/* Parts that are shorter share a ramp, unless the speed is lowest between them. */
#define TICKS_MIN 32u
/* Unless it is level in a line that cannot be as steep as the next one. */
#define LEVEL_TICKS_MIN 8u
/* A rise by less than this part of the square is not worth a ramp. */
#define LEVEL 128u
/* Shorter ramps are linear whatever the shape. */
#define SHAPED_TICKS_MIN 64u

uint64_t passo_path_ticks_over(const struct passo_path_planner *path, uint64_t length, uint64_t speeds)
{
	return passo_mul_div(length, UINT64_C(1) << (17u - path->machine.tick_log2), speeds);
}

uint64_t passo_path_ticks_to(const struct passo_path_planner *path, const struct passo_path_aim *aim)
{
	const uint64_t speeds = path->velocity + passo_path_velocity_of(aim->square);

	return speeds > 0 ? passo_path_ticks_over(path, aim->length, speeds) : UINT32_MAX;
}

bool passo_path_is_held_back(const struct passo_path_planner *path, uint32_t index)
{
	return index + 1 + path->open >= path->added && !passo_path_item(path, index)->last;
}

/* Whether a part may be made already. */
static bool is_due(const struct passo_path_planner *path, const struct passo_path_aim *aim, uint32_t index,
    const struct passo_path_part *part, enum passo_path_need need)
{
	if (passo_path_is_held_back(path, index))
		return false;
	if (need == PASSO_PATH_DRY || passo_path_is_settled(path, index))
		return true;
	if (part->kind != PASSO_PATH_DOWN && (need == PASSO_PATH_FULL || !part->early))
		return true;
	return need == PASSO_PATH_FULL
	    && (index == path->planned || passo_path_ticks_to(path, aim) < TICKS_MIN);
}

/* Whether a part deserves its own ramp: one that it shares with a short one has the mean of both. What a ramp
 * of whole ticks has left is no reason. */
static bool is_long(
    const struct passo_path_planner *path, uint64_t square, const struct passo_path_part *part)
{
	const uint64_t velocity = passo_path_velocity_of(square);
	const uint64_t speeds = velocity + passo_path_velocity_of(part->square);
	const uint64_t change =
	    passo_path_larger(velocity, path->velocity) - passo_path_smaller(velocity, path->velocity);

	return speeds > 0 && change > velocity / 256
	    && passo_path_ticks_over(path, part->length, speeds) >= TICKS_MIN;
}

/* Whether two slopes can share a ramp. */
static bool is_similar(uint64_t a, uint64_t b)
{
	return passo_path_larger(a, b) - passo_path_smaller(a, b) <= a / 32;
}

/* Whether the ramp has to end before this part. */
static bool is_enough(const struct passo_path_planner *path, const struct passo_path_aim *aim,
    const struct passo_path_part *part)
{
	if (aim->length == 0)
		return false;
	if (aim->kind == part->kind
	    && (part->kind == PASSO_PATH_FLAT ? aim->square == part->square
	                                      : is_similar(aim->first, part->slope)))
		return false;
	const uint64_t ticks = passo_path_ticks_to(path, aim);
	return ticks >= TICKS_MIN
	    || (ticks >= LEVEL_TICKS_MIN && aim->kind == PASSO_PATH_FLAT && part->slope > aim->slope
	        && !is_similar(aim->slope, part->slope))
	    || (ticks > 1 && aim->kind == PASSO_PATH_DOWN && part->kind != PASSO_PATH_DOWN)
	    || is_long(path, aim->square, part);
}

static bool is_near(uint64_t square, uint64_t higher)
{
	return higher >= square && higher - square <= square / LEVEL;
}

/* Whether the path may as well keep its speed over an item: it never has to be slower there, and can hardly
 * be faster at its end or anywhere before. */
static bool is_level(uint64_t square, uint64_t end, const struct passo_path_part *parts, unsigned count)
{
	for (unsigned i = 0; i < count; i++) {
		if (!is_near(square, parts[i].square))
			return false;
	}
	return is_near(square, end);
}

/* Follows the profile, at most to the start of item `before`. */
static struct passo_path_aim find_aim(
    const struct passo_path_planner *path, enum passo_path_need need, uint32_t before)
{
	struct passo_path_aim aim = {.square = passo_path_square_of(path->velocity)};
	uint32_t index = path->planned;
	uint64_t left = ((uint64_t)passo_path_item(path, index)->substeps << 32) - (uint64_t)path->offset;

	for (;; index++, left = (uint64_t)passo_path_item(path, index)->substeps << 32) {
		struct passo_path_part parts[PASSO_PATH_PARTS];

		if (index == before)
			return aim;
		unsigned count = passo_path_parts(
		    path, index, left, aim.square, need == PASSO_PATH_FULL && index == path->planned, parts);

		if ((aim.length == 0 || aim.kind == PASSO_PATH_FLAT)
		    && is_level(aim.square, passo_path_end_square(path, index), parts, count)) {
			parts[0] = (struct passo_path_part){
			    PASSO_PATH_FLAT, left, aim.square, parts[0].slope, .early = parts[0].early};
			count = 1;
		}
		for (unsigned i = 0; i < count; i++) {
			if (!is_due(path, &aim, index, &parts[i], need)) {
				aim.open = true;
				aim.index = passo_path_is_held_back(path, index) ? 0 : index;
				return aim;
			}
			if (is_enough(path, &aim, &parts[i]))
				return aim;
			/* what a ramp of whole ticks has left of the line before has no say */
			if (aim.kind != parts[i].kind || aim.length <= parts[i].length / 64)
				aim.first = aim.slope = parts[i].slope;
			aim.slope = passo_path_larger(aim.slope, parts[i].slope);
			aim.kind = parts[i].kind;
			aim.length += parts[i].length;
			aim.square = parts[i].square;
		}
		if (passo_path_rests_after(path, index)) {
			aim.rest = true;
			return aim;
		}
	}
}

bool passo_path_is_shaped(const struct passo_path_planner *path, const struct passo_path_aim *aim)
{
	return passo_path_shape(path) != PASSO_SHAPE_LINEAR && !aim->plain && aim->kind != PASSO_PATH_FLAT
	    && passo_path_ticks_to(path, aim) >= SHAPED_TICKS_MIN;
}

/* The shape of a ramp must keep the limits of all corners that it passes: otherwise it ends at the first of
 * them. */
struct passo_path_aim passo_path_choose_aim(const struct passo_path_planner *path, enum passo_path_need need)
{
	if (passo_path_is_soft(path))
		return passo_path_soft_aim(path, need != PASSO_PATH_NO_NEED);
	struct passo_path_aim aim = find_aim(path, need, path->added);
#ifndef PASSO_LINEAR_PATHS
	uint32_t before;

	while (passo_path_is_shaped(path, &aim) && (before = passo_path_too_fast(path, &aim)) < path->added)
		aim = find_aim(path, need, before);
#endif
	return passo_path_at_pace(path, &aim, need);
}
