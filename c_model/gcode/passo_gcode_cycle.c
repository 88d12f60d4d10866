/* SPDX-License-Identifier: MIT */
#include "passo_gcode_cycle.h"

#define CLEARANCE INT64_C(254000) /* nm: from the last depth, as in LinuxCNC */

enum { RISE, GO_TO, APPROACH, CUT, DWELL, LIFT, RETURN, FEED_OUT, RETRACT };

static int64_t lower(int64_t one, int64_t other)
{
	return one < other ? one : other;
}

static bool is_through(const struct passo_gcode_cycle *cycle)
{
	return cycle->depth == cycle->bottom;
}

static void begin_hole(struct passo_gcode_cycle *cycle)
{
	cycle->at[cycle->plane.first] = cycle->hole.x;
	cycle->at[cycle->plane.second] = cycle->hole.y;
	cycle->depth = cycle->level;
}

/* G85 feeds to the level, and clears from there. */
static enum passo_gcode_stroke feed_out(struct passo_gcode_cycle *cycle)
{
	if (cycle->kind == PASSO_GCODE_G(85, 0))
		cycle->at[cycle->axis] = cycle->level;
	return PASSO_GCODE_STROKE_FEED;
}

static enum passo_gcode_stroke retract(struct passo_gcode_cycle *cycle)
{
	cycle->at[cycle->axis] = cycle->clear;
	cycle->hole.x += cycle->increment.x;
	cycle->hole.y += cycle->increment.y;
	cycle->holes--;
	cycle->step = RISE;
	switch (cycle->kind) {
	case PASSO_GCODE_G(89, 0):
		return PASSO_GCODE_STROKE_FEED;
	case PASSO_GCODE_G(86, 0):
		return PASSO_GCODE_STROKE_RAPID_STOPPED;
	default:
		return PASSO_GCODE_STROKE_RAPID;
	}
}

/* The next step, which may turn out not to move. */
static enum passo_gcode_stroke take_step(struct passo_gcode_cycle *cycle)
{
	int64_t *height = &cycle->at[cycle->axis];

	switch (cycle->step++) {
	case RISE:
		if (*height < cycle->clear)
			*height = cycle->clear;
		return PASSO_GCODE_STROKE_RAPID;
	case GO_TO:
		begin_hole(cycle);
		return PASSO_GCODE_STROKE_RAPID;
	case APPROACH:
		*height = cycle->level;
		return PASSO_GCODE_STROKE_RAPID;
	case CUT:
		if (cycle->peck == 0 || cycle->depth - cycle->bottom <= cycle->peck)
			cycle->depth = cycle->bottom;
		else
			cycle->depth -= cycle->peck;
		*height = cycle->depth;
		return PASSO_GCODE_STROKE_FEED;
	case DWELL:
		return PASSO_GCODE_STROKE_DWELL;
	case LIFT:
		if (!is_through(cycle) && cycle->kind == PASSO_GCODE_G(83, 0))
			*height = cycle->level;
		return PASSO_GCODE_STROKE_RAPID;
	case RETURN:
		if (!is_through(cycle)) {
			*height = lower(cycle->depth + CLEARANCE, cycle->level);
			cycle->step = CUT;
		}
		return PASSO_GCODE_STROKE_RAPID;
	case FEED_OUT:
		return feed_out(cycle);
	default:
		return retract(cycle);
	}
}

static bool is_at(const struct passo_gcode_cycle *cycle, const int64_t *place)
{
	return cycle->at[0] == place[0] && cycle->at[1] == place[1] && cycle->at[2] == place[2];
}

enum passo_gcode_stroke passo_gcode_cycle_next(struct passo_gcode_cycle *cycle)
{
	while (cycle->holes > 0) {
		const int64_t before[] = {cycle->at[0], cycle->at[1], cycle->at[2]};
		const enum passo_gcode_stroke stroke = take_step(cycle);

		if (stroke == PASSO_GCODE_STROKE_DWELL) {
			if (is_through(cycle) && cycle->microseconds > 0)
				return stroke;
		} else if (!is_at(cycle, before)) {
			return stroke;
		}
	}
	return PASSO_GCODE_STROKE_NONE;
}
