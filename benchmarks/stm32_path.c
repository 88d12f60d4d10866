/* SPDX-License-Identifier: MIT
 * Plans a path on an STM32F103, for `make path`: as many lines as fit into RAM at a time.
 *
 * The bench writes `path_moves`, `path_count` and `path_ends`, then `path_go`; path_batch() plans them.
 * `path_check` is a hash of all lines and ramps, to compare with those of a PC.
 */
#include "board.h"
#include "passo_path.h"

#define AXES 3u
#define LOOK_AHEAD 48u
#define BATCH 32u
#define MICROMETERS_PER_MM 1000u

struct move {
	int32_t target[AXES]; /* micrometers */
	uint32_t feed;        /* mm/s; 0: rapid */
};

volatile uint32_t path_go, path_count, path_ends, path_error, path_check, path_lines, path_ramps;
struct move path_moves[BATCH];
struct passo_path_settings path_settings;
static struct passo_path_planner path;
static struct passo_path_item items[LOOK_AHEAD];

static void hash(uint32_t word)
{
	path_check = (path_check ^ word) * UINT32_C(16777619);
}

static void take(void)
{
	struct passo_line line;
	struct passo_ramp ramp;

	while (passo_path_next_line(&path, &line)) {
		path_lines++;
		hash(line.substeps);
		hash(line.directions);
		for (unsigned axis = 0; axis < AXES; axis++)
			hash(line.steps[axis]);
	}
	while (passo_path_next_ramp(&path, UINT32_MAX, &ramp)) {
		path_ramps++;
		hash(ramp.ticks);
		hash((uint32_t)ramp.velocity_end);
		hash((uint32_t)(ramp.velocity_end >> 32));
	}
}

static int64_t millimetres(int32_t micrometers)
{
	const uint32_t size = micrometers < 0 ? 0u - (uint32_t)micrometers : (uint32_t)micrometers;
	const uint64_t mm = (((uint64_t)size << 32) + MICROMETERS_PER_MM / 2) / MICROMETERS_PER_MM;

	return micrometers < 0 ? -(int64_t)mm : (int64_t)mm;
}

void path_batch(void);
__attribute__((noinline)) void path_batch(void)
{
	for (uint32_t i = 0; i < path_count; i++) {
		struct passo_path_move move = {
		    .feed = path_moves[i].feed ? path_moves[i].feed * PASSO_UNIT_Q32 : PASSO_PATH_RAPID};

		for (unsigned axis = 0; axis < AXES; axis++)
			move.target[axis] = millimetres(path_moves[i].target[axis]);
		if (passo_path_room(&path) == 0)
			take();
		path_error |= passo_path_add(&path, &move);
	}
	if (path_ends) {
		passo_path_end(&path);
		take();
	}
}

int main(void)
{
	board_start();
	path_check = UINT32_C(2166136261);
	while (!path_go)
		continue;
	path_error = passo_path_open(&path, &path_settings, items, LOOK_AHEAD);
	for (;;) {
		path_go = 0;
		while (!path_go)
			continue;
		path_batch();
	}
}
