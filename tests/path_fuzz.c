/* SPDX-License-Identifier: MIT
 * Fuzzes the path planner with settings and lines of all sizes: path_fuzz SEED SECONDS.
 *
 * Whatever the arguments, lines and ramps are such that the core takes them, the path moves on, and its last
 * ramp ends at rest.
 */
#include <stdio.h>
#include <stdlib.h>

#include "fuzz.h"
#include "passo_path_private.h"

#define CAPACITY_MAX 64u
#define RAMPS_MAX 3000u

/* Any number of bits up to `most`, all equally likely. */
static uint64_t any(uint32_t most)
{
	const uint32_t bits = below(most + 1);

	return bits == 0 ? 0 : random_bits() >> (64 - bits);
}

static void must(bool holds, const char *what)
{
	if (!holds) {
		fprintf(stderr, "%s\n", what);
		abort();
	}
}

static struct passo_path_settings any_settings(void)
{
	static const enum passo_profile PROFILES[] = {
	    PASSO_PROFILE_LINEAR, PASSO_PROFILE_COSINE, PASSO_PROFILE_SIGMOID, PASSO_PROFILE_JERK};
	struct passo_path_settings settings = {
	    .machine = {below(8) ? 16000000u + below(200000000u) : (uint32_t)any(32),
		(uint8_t)(below(8) ? 7 : below(20)), (uint8_t)(below(30) ? 1 + below(8) : below(12))},
	    .acceleration = below(2) ? 0 : any(64),
	    .junction_deviation = below(3) ? PASSO_UNIT_Q32 / 100 : any(64),
	    .profile = PROFILES[below(4)],
	    .reserve_clocks = below(2) ? 0 : (uint32_t)any(32),
	};

	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		const bool wild = below(12) == 0;

		settings.axis[axis] = (struct passo_path_axis){
		    .steps_per_mm = wild ? any(64) : (1 + below(1000)) * PASSO_UNIT_Q32,
		    .speed = wild ? any(64) : (1 + below(1000)) * PASSO_UNIT_Q32,
		    .acceleration = wild ? any(64) : (1 + below(20000)) * PASSO_UNIT_Q32,
		    .jerk = wild ? any(64) : (1 + below(1000000)) * PASSO_UNIT_Q32,
		    .jump = below(3) ? 0
		          : wild     ? any(64)
		                     : below(20) * PASSO_UNIT_Q32,
		};
	}
	return settings;
}

static struct passo_path_move any_move(const int64_t *from, uint32_t most)
{
	struct passo_path_move move = {.feed = below(4) ? (1 + below(300)) * PASSO_UNIT_Q32 : any(64)};

	if (below(10) == 0)
		move.feed = PASSO_PATH_RAPID;
	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		const int64_t by = (int64_t)any(below(30) ? most : 62);

		move.target[axis] = from[axis];
		if (from[axis] > -PASSO_PATH_TARGET_MAX / 2 && from[axis] < PASSO_PATH_TARGET_MAX / 2
		    && below(3))
			move.target[axis] += below(2) ? by : -by;
	}
	return move;
}

/* A chord of a finely divided curve on the first two axes, whose direction is (x, y). */
static struct passo_path_move next_chord(const int64_t *from, int64_t *x, int64_t *y, int64_t turn)
{
	struct passo_path_move move = {
	    .feed = below(2) ? PASSO_PATH_RAPID : (1 + below(300)) * PASSO_UNIT_Q32};

	*x -= *y / 4096 * turn;
	*y += *x / 4096 * turn;
	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++)
		move.target[axis] = from[axis] + (axis == 0 ? *x : axis == 1 ? *y : 0);
	return move;
}

/* What has been handed out. */
struct taken {
	uint64_t substeps, distance; /* of the motion; UQ32.32 */
	uint64_t velocity, fastest;  /* UQ0.48 */
	uint32_t ramps, lines;
};

static void take_lines(struct passo_path_planner *path, struct taken *taken)
{
	struct passo_line line;

	while (passo_path_next_line(path, &line)) {
		must(line.substeps > 0 && line.substeps <= PASSO_SUBSTEPS_MAX && !line.endless, "substeps");
		must(line.directions >> path->machine.axes == 0, "directions");
		for (uint32_t axis = 0; axis < path->machine.axes; axis++)
			must(line.steps[axis] <= line.substeps, "more steps than substeps");
		taken->substeps += line.substeps;
		taken->lines++;
	}
}

static void take_ramps(struct passo_path_planner *path, struct taken *taken, uint32_t held)
{
	struct passo_ramp ramp;

	while (taken->ramps < RAMPS_MAX && passo_path_next_ramp(path, held, &ramp)) {
		must(ramp.velocity_end <= PASSO_VELOCITY_MAX && !ramp.now && !ramp.mirror, "velocity");
		must(ramp.progress_step <= PASSO_PROGRESS_STEP_MAX, "progress step");
		must((ramp.ticks == 0) == (ramp.progress_step == 0), "ticks");
		must(!ramp.last || ramp.velocity_end == 0, "the last ramp does not end at rest");
		taken->distance += passo_path_distance(path, taken->velocity, &ramp);
		taken->velocity = ramp.velocity_end;
		taken->fastest = taken->velocity > taken->fastest ? taken->velocity : taken->fastest;
		taken->ramps++;
		if (held < UINT32_MAX)
			break;
	}
}

/* The ramps of a motion cover its lines, but for what the path makes in a tick. */
static bool next_motion(struct passo_path_planner *path, struct taken *taken)
{
	if (!passo_path_next_motion(path))
		return false;
	const uint64_t most = (UINT64_C(2) << 32) + (taken->fastest >> 16 << path->machine.tick_log2);
	const uint64_t whole = taken->substeps << 32;

	must(taken->distance <= whole + most && whole <= taken->distance + most, "ramps and lines differ");
	*taken = (struct taken){.ramps = taken->ramps, .lines = taken->lines};
	return true;
}

/* While there is no room, a line or a ramp can be taken. */
static void make_room(struct passo_path_planner *path, struct taken *taken)
{
	while (taken->ramps < RAMPS_MAX && passo_path_room(path) == 0) {
		const uint32_t done = taken->ramps + taken->lines;

		take_lines(path, taken);
		take_ramps(path, taken, UINT32_MAX);
		must(next_motion(path, taken) || taken->ramps + taken->lines > done,
		    "it has no room for good");
	}
}

static void fuzz(struct passo_path_item *items)
{
	struct passo_path_planner path;
	const struct passo_path_settings settings = any_settings();
	const uint32_t capacity = below(20) ? 4 + below(CAPACITY_MAX - 3) : below(4);
	int64_t at[PASSO_AXES_MAX] = {0};
	struct taken taken = {.ramps = 0};
	const uint32_t most = 20 + below(24);
	int64_t x = (int64_t)any(32), y = (int64_t)any(32), turn = (int64_t)below(600) - 300;
	bool chords = below(2);

	if (passo_path_open(&path, &settings, items, capacity) != PASSO_PLAN_OK)
		return;
	for (uint32_t count = below(chords ? 2000 : 300); count > 0 && taken.ramps < RAMPS_MAX; count--) {
		const struct passo_path_move move =
		    chords ? next_chord(at, &x, &y, turn) : any_move(at, most);
		const enum passo_plan_error error = passo_path_add(&path, &move);

		if (error == PASSO_PLAN_OK) {
			for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++)
				at[axis] = move.target[axis];
		}
		if (error == PASSO_PLAN_PATH_FULL)
			make_room(&path, &taken);
		if (below(chords ? 600 : 6) == 0) {
			take_lines(&path, &taken);
			take_ramps(&path, &taken, below(3) ? UINT32_MAX : below(100));
			next_motion(&path, &taken);
		}
		chords ^= below(300) == 0;
		if (below(20) == 0)
			passo_path_dwell(&path, below(2) ? 0 : any(below(8) ? 20 : 64));
		if (below(40) == 0)
			passo_path_end(&path);
		if (below(50) == 0)
			passo_path_override(&path, (uint32_t)any(22));
		if (below(300) == 0) {
			const int32_t positions[PASSO_AXES_MAX] = {(int32_t)any(32), -(int32_t)any(30)};

			if (!passo_path_recover(&path, positions, below(path.added + 1)))
				passo_path_restart(&path, positions);
			taken = (struct taken){.ramps = taken.ramps};
		}
		if (below(60) == 0 && path.added > path.sent) {
			int32_t positions[PASSO_AXES_MAX];

			for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++)
				positions[axis] = (int32_t)path.at.steps[axis];
			if (passo_path_recover(&path, positions, path.sent))
				taken = (struct taken){.ramps = taken.ramps};
		}
	}
	passo_path_end(&path);
	while (taken.ramps < RAMPS_MAX && !passo_path_is_empty(&path)) {
		const uint32_t done = taken.ramps + taken.lines;

		take_lines(&path, &taken);
		take_ramps(&path, &taken, UINT32_MAX);
		must(next_motion(&path, &taken) || taken.ramps + taken.lines > done, "it is stuck");
	}
	must(taken.ramps == RAMPS_MAX || taken.velocity == 0, "it does not end at rest");
}

int main(int count, char **words)
{
	static struct passo_path_item items[CAPACITY_MAX];
	uint64_t rounds = 0;

	for (fuzz_begin(count, words); rounds == 0 || fuzz_goes_on(); rounds++)
		fuzz(items);
	printf("%llu paths\n", (unsigned long long)rounds);
	return 0;
}
