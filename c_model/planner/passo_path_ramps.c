/* SPDX-License-Identifier: MIT
 * From the profile to ramps of whole ticks.
 *
 * A ramp follows one part of the profile, or several that are too short for a ramp each, from exactly where
 * the last one ended. It ends at the last tick within the part, so no limit is exceeded: what is left is
 * covered by the next ramp. The ramp that comes to rest is solved to end exactly at the end of its line.
 */
#include "passo_path_private.h"

/* While more lines may come, the reserve is divided into this number of ramps. */
#define RAMPS_PER_RESERVE 4u

/* The ramps have moved on by a distance; in a path that goes on they pass the ends of lines. A ramp can be
 * beyond the end of the path only if the path lasts less than a tick: then it rests immediately. */
static void advance(struct passo_path_planner *path, uint64_t distance)
{
	path->offset += (int64_t)distance;
	for (;;) {
		const int64_t whole = (int64_t)passo_path_item(path, path->planned)->substeps << 32;

		if (path->offset < whole)
			break;
		path->jump = passo_path_rests_after(path, path->planned);
		if (path->jump)
			break;
		path->offset -= whole;
		path->planned++;
	}
}

static void make(struct passo_path_planner *path, struct passo_ramp *ramp)
{
	const uint64_t distance = passo_path_distance(path, path->velocity, ramp);
	const uint32_t planned = path->planned;
	const uint64_t slowest = passo_path_smaller(path->velocity, ramp->velocity_end);

	path->velocity = ramp->velocity_end;
	advance(path, distance);
	if (path->planned != planned)
		passo_path_pass(path, slowest);
}

/* The path rests at the end of the item. */
static void come_to_rest(struct passo_path_planner *path, bool *last)
{
	const struct passo_path_item *item = passo_path_item(path, path->planned);

	if (path->planned + 1 == path->added && !item->last)
		passo_path_end(path);
	*last = item->last;
	path->offset = item->last ? 0 : path->offset - ((int64_t)item->substeps << 32);
	path->planned++;
	path->at_rest = true;
	path->started = false;
	path->ramps_end = item->last;
}

/* A ramp to a small velocity, which covers exactly what is left of the line; a ramp to 0 follows immediately.
 */
static void land(struct passo_path_planner *path, const struct passo_path_aim *aim, uint32_t ticks,
    struct passo_ramp *ramp)
{
	ramp->shape = passo_path_is_shaped(path, aim) ? passo_path_shape(path) : PASSO_SHAPE_LINEAR;
	passo_path_set_ticks(ramp, ticks);
	passo_path_land(path, path->velocity, aim->length, ramp);
	make(path, ramp);
	path->jump = ramp->velocity_end > 0;
	if (!path->jump)
		come_to_rest(path, &ramp->last);
}

static void follow(
    struct passo_path_planner *path, struct passo_path_aim *aim, uint32_t most, struct passo_ramp *ramp)
{
	const uint64_t begin = path->velocity, from = passo_path_square_of(begin);
	const uint64_t slope = aim->slope + aim->slope / PASSO_PATH_STEEPER;
	const uint64_t fall = passo_path_smaller(passo_path_gain(slope, aim->length), from);

	aim->square = passo_path_larger(aim->square, from - fall); /* where it cannot come down in time */
	const uint64_t end = passo_path_velocity_of(aim->square);
	const uint64_t ticks = passo_path_larger(passo_path_ticks_to(path, aim), 1);
	const bool shaped = passo_path_is_shaped(path, aim);
	const uint32_t used =
	    (uint32_t)passo_path_smaller(ticks, shaped ? PASSO_PATH_SHAPED_TICKS_MAX : most);
	const uint64_t limit = passo_path_change(path, slope, used);
	uint64_t change = begin < end ? end - begin : begin - end;

	/* from rest to a speed that takes no length to reach: a share of it may be none at all */
	if (used < ticks && (begin > 0 || aim->kind != PASSO_PATH_FLAT))
		change = passo_mul_div(change, used, ticks);
	change = passo_path_smaller(change, limit);
	ramp->shape = shaped ? passo_path_shape(path) : PASSO_SHAPE_LINEAR;
	passo_path_set_ticks(ramp, used);
	ramp->velocity_end = begin < end ? begin + change : begin - change;
	make(path, ramp);
}

/* From rest: the dwell, then the jump to the start speed, or again to rest where the last tick was beyond the
 * line. False: neither is due. */
static bool start(struct passo_path_planner *path, struct passo_ramp *ramp)
{
	struct passo_path_item *item = passo_path_item(path, path->planned);

	if (!path->started && item->dwell > 0) {
		passo_path_set_ticks(ramp, item->dwell);
		item->dwell = 0;
		return true;
	}
	if (path->offset >= (int64_t)item->substeps << 32) {
		come_to_rest(path, &ramp->last);
		return true;
	}
	path->started = true;
	path->at_rest = false;
	if (item->rest) /* not where the path has come to rest for want of lines that are known now */
		ramp->velocity_end = passo_path_velocity_of(passo_path_smaller(item->reach, item->top));
	path->velocity = ramp->velocity_end;
	return ramp->velocity_end > 0;
}

static bool next_ramp(struct passo_path_planner *path, uint32_t held, struct passo_ramp *ramp)
{
	if (path->ramps_end)
		return false;
	if (path->jump) {
		path->jump = false;
		path->velocity = 0;
		come_to_rest(path, &ramp->last);
		return true;
	}
	if (path->planned == path->added)
		return false;

	if (path->at_rest) {
		if (passo_path_is_held_back(path, path->planned)) {
			if (held >= path->reserve)
				return false;
			passo_path_end(path);
		}
		if (start(path, ramp))
			return true;
	}
	if (path->waits && held >= path->reserve)
		return false;
	struct passo_path_aim aim = passo_path_choose_aim(path, PASSO_PATH_NO_NEED);
	uint32_t most = PASSO_PATH_TICKS_MAX;
	const bool is_full = path->added - path->planned == path->capacity;

	/* the same ramps, whenever they are asked for: none that a further line would make longer */
	path->waits = aim.open && !is_full && held >= path->reserve;
	path->unsettled = aim.index;
	if (path->waits)
		return false;
	if (aim.open
	    && (aim.length == 0 || passo_path_ticks_to(path, &aim) < path->reserve / RAMPS_PER_RESERVE)) {
		if (!is_full)
			passo_path_close(path);
		if (!is_full && passo_path_is_held_back(path, path->planned))
			passo_path_end(path);
		aim = passo_path_choose_aim(path, is_full ? PASSO_PATH_FULL : PASSO_PATH_DRY);
		if (!is_full)
			most = path->reserve / RAMPS_PER_RESERVE + 1;
	}
	if (aim.rest) {
		const uint64_t landing =
		    passo_path_smaller(passo_path_larger(passo_path_velocity_of(aim.square),
					   passo_path_change(path, aim.slope, PASSO_PATH_LANDING_TICKS)),
			PASSO_VELOCITY_MAX);
		const uint64_t ticks = passo_path_ticks_over(path, aim.length, path->velocity + landing) + 1;

		if (ticks <= (passo_path_is_shaped(path, &aim) ? PASSO_PATH_SHAPED_TICKS_MAX : most)) {
			land(path, &aim, (uint32_t)ticks, ramp);
			return true;
		}
	}
	follow(path, &aim, most, ramp);
	return true;
}

bool passo_path_next_ramp(struct passo_path_planner *path, uint32_t held, struct passo_ramp *ramp)
{
	*ramp = (struct passo_ramp){.shape = PASSO_SHAPE_LINEAR};
	if (!next_ramp(path, held, ramp))
		return false;
	passo_path_pace_ramp(path, ramp->ticks);
	return true;
}
