/* SPDX-License-Identifier: MIT
 * The rest of a path after a stop: the line on which it stopped becomes shorter, and is the first of a
 * motion.
 */
#include "passo_path_private.h"

/* Steps by which the axes may be off the line: an abort drops those that wait for their pins. */
#define TOLERANCE 5

static int64_t steps_of(const struct passo_path_item *item, uint32_t motor)
{
	const int64_t steps = item->steps[motor];

	return item->directions >> motor & 1u ? -steps : steps;
}

static int64_t magnitude(int64_t value)
{
	return value < 0 ? -value : value;
}

/* The motor with the most steps. */
static uint32_t leader(const struct passo_path_planner *path, const struct passo_path_item *item)
{
	uint32_t found = 0;

	for (uint32_t motor = 1; motor < passo_path_motors(path); motor++) {
		if (item->steps[motor] > item->steps[found])
			found = motor;
	}
	return found;
}

/* Whether the steps made since the start of a line are on it. */
static bool is_on(
    const struct passo_path_planner *path, const struct passo_path_item *item, const int64_t *made)
{
	const uint32_t lead = leader(path, item);
	const int64_t most = steps_of(item, lead);

	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++) {
		const int64_t all = steps_of(item, motor);

		if (magnitude(made[motor]) + magnitude(all - made[motor]) - magnitude(all) > 2 * TOLERANCE)
			return false;
	}
	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++) {
		if (magnitude(made[motor] * most - made[lead] * steps_of(item, motor))
		    > TOLERANCE * magnitude(most))
			return false;
	}
	return most != 0;
}

/* Takes the steps that were made off a line. */
static void shorten(const struct passo_path_planner *path, struct passo_path_item *item, const int64_t *made)
{
	const uint32_t lead = leader(path, item);
	const uint32_t all = item->steps[lead];
	uint32_t most = 1;

	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++) {
		const int64_t left = steps_of(item, motor) - made[motor];

		item->steps[motor] = (uint32_t)magnitude(left);
		item->directions =
		    (uint8_t)((item->directions & ~(1u << motor)) | (left < 0 ? 1u << motor : 0u));
		most = item->steps[motor] > most ? item->steps[motor] : most;
	}
	const uint64_t left = passo_mul_div(item->substeps, item->steps[lead], all);
	item->substeps = (uint32_t)passo_path_smaller(passo_path_larger(left, most), PASSO_SUBSTEPS_MAX);
	passo_path_set_fall(item);
}

static void begin_at(struct passo_path_planner *path, uint32_t index)
{
	struct passo_path_item *item = passo_path_item(path, index);

	item->rest = true;
	item->arc = 0;
	item->dwell = 0;
	item->corner = (uint64_t)item->halt * item->halt;
	path->sent = path->planned = path->final = index;
	path->offset = 0;
	path->velocity = 0;
	path->at_rest = true;
	path->started = path->jump = path->lines_end = path->ramps_end = path->open = false;
	path->anew = true;
	passo_path_pace_begin(path);
	passo_path_look_back(path);
	if (path->rest)
		path->final = path->added;
}

bool passo_path_recover(struct passo_path_planner *path, const int32_t *positions, uint32_t done)
{
	const uint32_t oldest = path->added > path->capacity ? path->added - path->capacity : 0;
	const uint32_t first = done > oldest ? done : oldest;
	int64_t made[PASSO_AXES_MAX];

	for (uint32_t motor = 0; motor < passo_path_motors(path); motor++) {
		made[motor] = positions[motor] - path->at.steps[motor];
		for (uint32_t index = first; index < path->added; index++)
			made[motor] += steps_of(passo_path_item(path, index), motor);
	}
	for (uint32_t index = first; index < path->added; index++) {
		struct passo_path_item *item = passo_path_item(path, index);

		if (is_on(path, item, made)) {
			shorten(path, item, made);
			begin_at(path, index);
			return true;
		}
		for (uint32_t motor = 0; motor < passo_path_motors(path); motor++)
			made[motor] -= steps_of(item, motor);
	}
	return false;
}
