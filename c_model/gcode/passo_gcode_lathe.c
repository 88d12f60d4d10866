/* SPDX-License-Identifier: MIT
 * The words of a lathe: speeds of the spindle that depend on X, and feeds that depend on the speed.
 */
#include "passo_gcode_private.h"
#include "passo_math.h"

#ifndef PASSO_PLAIN_GCODE

#define PIECES_PER_RADIUS 32 /* of a line at a constant surface speed: the speed changes by 3 % in each */
#define X 0u
#define TWO_PI UINT64_C(6283185307) /* in 10^-9 */
#define BILLION UINT64_C(1000000000)

static int64_t size_of(int64_t value)
{
	return (int64_t)passo_size64(value);
}

/* nm/min of millionths of m/min or ft/min. */
static int64_t surface_of(const struct passo_gcode_check *check)
{
	const int64_t value = check->block.value['S' - 'A'];

	return check->mode[PASSO_GCODE_UNITS] == PASSO_GCODE_G(20, 0) ? value * 1524 / 5 : value * 1000;
}

/* S is rpm or, after G96, the surface speed, with D as the highest rpm. G97 without S keeps the speed. */
enum passo_gcode_error passo_gcode_check_spindle(struct passo_gcode_check *check)
{
	const struct passo_gcode *gcode = check->gcode;
	const passo_gcode_command given = check->block.command[PASSO_GCODE_SURFACE];
	const bool by_surface = check->mode[PASSO_GCODE_SURFACE] == PASSO_GCODE_G(96, 0);

	check->spindle = gcode->spindle;
	check->surface = gcode->surface;
	check->fastest = gcode->fastest;
	if (given == PASSO_GCODE_G(97, 0))
		check->spindle = passo_gcode_wanted_speed(gcode, gcode->position[X]);
	if (passo_gcode_has_word(check, 'S') && by_surface)
		check->surface = surface_of(check);
	else if (passo_gcode_has_word(check, 'S'))
		check->spindle = check->block.value['S' - 'A'];
	if (given != PASSO_GCODE_G(96, 0))
		return PASSO_GCODE_OK;
	check->fastest = passo_gcode_take(check, 'D') ? check->block.value['D' - 'A'] : 0;
	return passo_gcode_has_word(check, 'S') ? PASSO_GCODE_OK : PASSO_GCODE_NO_VALUE;
}

/* A feed per revolution needs a spindle that turns. */
enum passo_gcode_error passo_gcode_check_turning(const struct passo_gcode_check *check)
{
	const bool by_surface = check->mode[PASSO_GCODE_SURFACE] == PASSO_GCODE_G(96, 0);
	const int64_t speed = by_surface ? check->surface : check->spindle;

	return check->mode[PASSO_GCODE_SPINDLE] == PASSO_GCODE_M(5) || speed == 0
	         ? PASSO_GCODE_SPINDLE_STOPPED
	         : PASSO_GCODE_OK;
}

/* The radius in nm below which a limit, in millionths of rpm, holds; without one 0. */
static int64_t radius_of(const struct passo_gcode *gcode, int64_t limit)
{
	return limit > 0 ? (int64_t)passo_mul_div(
			       passo_mul_div((uint64_t)gcode->surface, PASSO_GCODE_MILLION, (uint64_t)limit),
			       BILLION, TWO_PI)
	                 : 0;
}

int64_t passo_gcode_wanted_speed(const struct passo_gcode *gcode, int64_t x)
{
	const int64_t highest = (int64_t)BILLION * PASSO_GCODE_MILLION - 1;
	const int64_t limit = gcode->fastest > 0 ? gcode->fastest : highest;
	const int64_t radius = size_of(x - passo_gcode_offset(gcode, X));

	if (gcode->mode[PASSO_GCODE_SURFACE] != PASSO_GCODE_G(96, 0))
		return gcode->spindle;
	if (radius <= radius_of(gcode, limit))
		return limit;
	const uint64_t turns =
	    passo_mul_div((uint64_t)gcode->surface, BILLION, TWO_PI); /* per min, at 1 nm */
	return (int64_t)passo_mul_div(turns, PASSO_GCODE_MILLION, (uint64_t)radius);
}

/* Where the next piece of a line ends, in nm from the axis of the lathe: X goes from `at` to `goal`. */
static int64_t next_radius(int64_t at, int64_t goal, int64_t limited)
{
	const int64_t radius = size_of(at), step = radius / PIECES_PER_RADIUS + 1;
	const bool same_side = (at >= 0) == (goal >= 0);
	int64_t next;

	if (same_side && size_of(goal) >= radius) { /* outward */
		next = radius < limited ? limited : radius + step;
		next = next < size_of(goal) ? next : size_of(goal);
		return goal < 0 ? -next : next;
	}
	if (radius > limited) {
		next = radius - step > limited ? radius - step : limited;
		next = same_side && next < size_of(goal) ? size_of(goal) : next;
		return at < 0 ? -next : next;
	}
	if (size_of(goal) <= limited)
		return goal;
	return goal < 0 ? -limited : limited; /* through the middle */
}

/* Part of a way, to nearest. */
static int64_t part_of(int64_t way, uint64_t part, uint64_t whole)
{
	const int64_t size = (int64_t)passo_mul_div(passo_size64(way), part, whole);

	return way < 0 ? -size : size;
}

/* The end of the next piece of a line: its destination, unless the speed changes before. */
static void next_piece(struct passo_gcode *gcode, int64_t *target)
{
	struct passo_gcode_job *job = &gcode->job;
	const struct passo_gcode_settings *settings = &gcode->settings;
	const int64_t offset = passo_gcode_offset(gcode, X), goal = job->destination[X] - offset;
	const int64_t top = (int64_t)settings->spindle_maximum * PASSO_GCODE_MILLION;
	const int64_t limit = top > 0 && (gcode->fastest == 0 || top < gcode->fastest) ? top : gcode->fastest;
	const int64_t way = job->destination[X] - job->from[X];
	const int64_t limited = radius_of(gcode, limit);
	const int64_t next = next_radius(job->at - offset, goal, limited > 0 ? limited : 1);

	passo_gcode_copy(gcode, job->destination, target);
	job->motion = next != goal;
	if (!job->motion)
		return;
	for (unsigned axis = 0; axis < settings->axes; axis++) {
		target[axis] = job->from[axis]
		             + part_of(job->destination[axis] - job->from[axis],
				 passo_size64(next + offset - job->from[X]), passo_size64(way));
	}
	target[X] = next + offset;
}

/* Whether the motion is a line whose speed changes along it. */
static bool is_in_pieces(const struct passo_gcode *gcode)
{
	const struct passo_gcode_job *job = &gcode->job;

	return gcode->mode[PASSO_GCODE_SURFACE] == PASSO_GCODE_G(96, 0) && gcode->surface > 0
	    && job->feed != PASSO_PATH_RAPID && !job->turns && !job->drills && job->probe == PASSO_GCODE_NONE
	    && job->from[X] != job->destination[X];
}

void passo_gcode_turn(struct passo_gcode *gcode, struct passo_gcode_action *action)
{
	struct passo_gcode_job *job = &gcode->job;

	if (action->kind != PASSO_GCODE_LINE && action->kind != PASSO_GCODE_PROBE)
		return;
	if (is_in_pieces(gcode)) {
		next_piece(gcode, action->target);
		action->stops = action->stops && !job->motion;
	}
	const int64_t offset = passo_gcode_offset(gcode, X);
	const int64_t end = size_of(action->target[X] - offset);
	const int64_t middle = action->feed == PASSO_PATH_RAPID ? end : (size_of(job->at - offset) + end) / 2;
	const int64_t wanted = passo_gcode_wanted_speed(gcode, offset + middle);

	job->at = action->target[X];
	if (gcode->mode[PASSO_GCODE_SURFACE] == PASSO_GCODE_G(96, 0) && !job->drills)
		action->output = passo_gcode_output_at(gcode, wanted);
	if (job->per_turn && action->feed != PASSO_PATH_RAPID)
		action->feed = passo_gcode_feed(passo_mul_div(
		    (uint64_t)gcode->feed, (uint64_t)passo_gcode_speed(gcode, wanted), PASSO_GCODE_MILLION));
}

#endif
