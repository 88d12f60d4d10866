/* SPDX-License-Identifier: MIT
 * The limits of an item under the present overrides.
 */
#include "passo_path_private.h"

#define OVERRIDE_BITS 16u
#define RAPID_MIN (PASSO_PATH_RAPID_FULL / 100u)

/* Highest square at its start, by geometry. */
static uint64_t bend_of(const struct passo_path_item *item)
{
#ifndef PASSO_WITHOUT_ROUNDING
	if (item->point != PASSO_PATH_CORNER)
		return PASSO_PATH_SQUARE_MAX;
#endif
	return item->bend;
}

void passo_path_limit(struct passo_path_planner *path, uint32_t index)
{
	struct passo_path_item *item = passo_path_item(path, index);
	const uint32_t override = item->rapid ? path->rapid : path->override;
	const uint64_t limit = (uint64_t)item->limit * item->limit;
	const uint64_t base = item->rapid ? limit : (uint64_t)item->feed * item->feed;

	item->top = passo_path_smaller(
	    limit, passo_mul_shift(base, (uint64_t) override * override, 2 * OVERRIDE_BITS));
	if (item->rest)
		return;
	item->corner = passo_path_smaller(bend_of(item), item->top);
	if (index == path->planned)
		return;
	struct passo_path_item *before = passo_path_item(path, index - 1);

	item->corner = passo_path_smaller(item->corner, before->top);
	/* an arc is limited along its lines, not only at its corners; by their bends, not by the feeds that
	 * meet there */
	if ((before->arc & PASSO_PATH_ARC_BEHIND) > 0 && (item->arc & PASSO_PATH_ARC_BEFORE) > 0)
		before->top =
		    passo_path_smaller(before->top, passo_path_larger(bend_of(before), bend_of(item)));
}

/* Replans the lines that no ramp has passed. */
static void plan_anew(struct passo_path_planner *path)
{
	path->open = false;
	for (uint32_t index = path->planned; index < path->added; index++)
		passo_path_limit(path, index);
	path->final = path->planned;
	path->anew = true;
	if (path->planned < path->added)
		passo_path_look_back(path);
	if (path->rest)
		path->final = path->added;
}

void passo_path_override(struct passo_path_planner *path, uint32_t override)
{
	path->override = (uint32_t)passo_path_smaller(
	    passo_path_larger(override, PASSO_PATH_OVERRIDE_MIN), PASSO_PATH_OVERRIDE_MAX);
	plan_anew(path);
}

void passo_path_rapid(struct passo_path_planner *path, uint32_t rapid)
{
	path->rapid =
	    (uint32_t)passo_path_smaller(passo_path_larger(rapid, RAPID_MIN), PASSO_PATH_RAPID_FULL);
	plan_anew(path);
}
