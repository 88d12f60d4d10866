/* SPDX-License-Identifier: MIT
 * The operations of the driver, with random numbers.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "endings.h"
#include "passo_path_feed.h"

#define ITEMS 8u
#define FAST 4
#define STREAM_LINES 12u
#define THREAD_COUNTS 4000u
#define Q32(number) ((uint64_t)((number) * 4294967296.0))

static const char *const names[OPERATIONS] = {"move", "queue", "path", "stream", "jog", "endless", "goto",
    "home", "probe", "thread", "raster", "compare", "together"};

static struct {
	struct passo_path_item items[ITEMS];
	struct passo_path_planner path;
	struct passo_path_feed feed;
	struct passo_home home;
	unsigned lines, ramps;
	struct passo_line line;
	uint64_t velocity;
} at;

const char *operation_name(enum operation operation)
{
	return names[operation];
}

bool operation_is_jog(enum operation operation)
{
	return operation == OP_JOG || operation == OP_ENDLESS || operation == OP_GOTO;
}

void operation_draw(struct bench *bench, struct scene *scene)
{
	static const double bends[] = {1.0, 1.58, 2.6, 2.02};
	const unsigned profile = scene->operation == OP_MOVE ? bench_draw(bench, 4) : 0u;

	scene->speed = floor(bench_between(bench, 3000, 60000));
	scene->acceleration = floor(scene->speed * bench_between(bench, 40, 400));
	scene->bend = bends[profile];
	if (scene->operation == OP_GOTO && bench_draw(bench, 2) != 0u) {
		scene->speed *= FAST; /* so that a tick is many steps */
		scene->acceleration *= FAST;
	}
	const double ramp = scene->speed / scene->acceleration;
	const double far = scene->speed * ramp * bench_between(bench, 0.1, 4);
	const int32_t steps = (int32_t)fmin(6000, fmax(3, far)) * (bench_draw(bench, 2) != 0u ? 1 : -1);

	for (unsigned a = 0; a < AXES; a++) {
		scene->start[a] = bench->axis[a].position;
		scene->target[a] = scene->low[a] = scene->high[a] = scene->start[a];
	}
	scene->target[0] += steps;
	scene->lines = scene->operation == OP_MOVE || scene->operation == OP_RASTER
	            || scene->operation == OP_COMPARE || scene->operation == OP_TOGETHER
	            || scene->operation == OP_STREAM;
	if (scene->lines || scene->operation == OP_QUEUE || scene->operation == OP_PATH)
		scene->target[1] += (int32_t)((double)steps * (0.2 + bench_draw(bench, 60) / 100.0));
	scene->seconds = fabs((double)steps) / scene->speed + ramp;
}

static void bound(struct scene *scene)
{
	for (unsigned a = 0; a < AXES; a++) {
		scene->low[a] = scene->start[a] < scene->target[a] ? scene->start[a] : scene->target[a];
		scene->high[a] = scene->start[a] > scene->target[a] ? scene->start[a] : scene->target[a];
	}
}

static struct passo_move_by_speed move_of(const struct scene *scene)
{
	struct passo_move_by_speed move = {
	    .speed = Q32(scene->speed), .acceleration = Q32(scene->acceleration)};

	for (unsigned a = 0; a < AXES; a++)
		move.steps[a] = scene->target[a] - scene->start[a];
	if (scene->bend > 2.5)
		move.profile = PASSO_PROFILE_SIGMOID;
	else if (scene->bend > 2.0)
		move.profile = PASSO_PROFILE_JERK;
	else if (scene->bend > 1.5)
		move.profile = PASSO_PROFILE_COSINE;
	return move;
}

/* There, on, and back to the middle. */
static enum passo_error begin_queue(struct bench *bench, struct scene *scene)
{
	struct passo_move_by_speed move = move_of(scene);
	enum passo_error error = passo_move_by_speed(&bench->passo, &move);

	if (error == PASSO_OK)
		error = passo_move_by_speed(&bench->passo, &move);
	bound(scene);
	for (unsigned a = 0; a < AXES; a++) {
		const int32_t way = move.steps[a];
		scene->low[a] += way < 0 ? way : 0;
		scene->high[a] += way > 0 ? way : 0;
		move.steps[a] = -way;
	}
	scene->seconds *= 3;
	return error == PASSO_OK ? passo_move_by_speed(&bench->passo, &move) : error;
}

/* Half the way, a bend, and the other half; 100 steps/mm. */
static enum passo_error begin_path(struct bench *bench, struct scene *scene)
{
	struct passo_path_settings settings = {.machine = *passo_machine(&bench->passo),
	    .junction_deviation = PASSO_UNIT_Q32 / 20u,
	    .profile = PASSO_PROFILE_LINEAR};

	for (unsigned a = 0; a < AXES; a++)
		settings.axis[a] = (struct passo_path_axis){.steps_per_mm = 100u * PASSO_UNIT_Q32,
		    .speed = Q32(scene->speed / 100),
		    .acceleration = Q32(scene->acceleration / 100)};
	if (passo_path_open(&at.path, &settings, at.items, ITEMS) != PASSO_PLAN_OK)
		return PASSO_ERROR_ARGUMENT_PLAN;
	for (unsigned part = 1; part <= 4u; part++) {
		struct passo_path_move move = {.feed = Q32(scene->speed / 100)};
		for (unsigned a = 0; a < 2u; a++) {
			const int64_t way = scene->target[a] - scene->start[a];
			const int64_t steps = a == 0u ? way * part / 4 : way * (part / 2u) / 2;
			move.target[a] = steps * (int64_t)PASSO_UNIT_Q32 / 100;
		}
		if (passo_path_add(&at.path, &move) != PASSO_PLAN_OK)
			return PASSO_ERROR_ARGUMENT_PLAN;
	}
	passo_path_end(&at.path);
	passo_path_feed_open(&at.feed, &bench->passo, &at.path);
	bound(scene);
	for (unsigned polls = 0; polls < 200u && !passo_is_moving(&bench->passo); polls++) {
		const enum passo_error error = passo_path_feed_poll(&at.feed);
		if (error != PASSO_OK)
			return error;
	}
	return PASSO_OK;
}

static bool next_line(void *context, struct passo_line *line)
{
	(void)context;
	*line = at.line;
	line->last = ++at.lines == STREAM_LINES;
	return true;
}

/* Up in one ramp, along, down. */
static bool next_ramp(void *context, struct passo_ramp *ramp)
{
	const struct passo_ramp *ramps = context;

	*ramp = ramps[at.ramps++];
	return true;
}

/* Equal lines under the ramps of one move of their length. */
static enum passo_error begin_stream(struct bench *bench, struct scene *scene)
{
	static struct passo_plan plan;
	const struct passo_source source = {next_line, next_ramp, plan.ramps};

	for (unsigned a = 0; a < AXES; a++) {
		const int32_t way = (scene->target[a] - scene->start[a]) / (int32_t)STREAM_LINES;
		scene->target[a] = scene->start[a] + (way != 0 || a != 0u ? way : 1) * (int32_t)STREAM_LINES;
	}
	const struct passo_move_by_speed move = move_of(scene);
	if (passo_plan_by_speed(passo_machine(&bench->passo), &move, &plan) != PASSO_PLAN_OK)
		return PASSO_ERROR_ARGUMENT_PLAN;
	at.line = plan.line;
	at.line.substeps /= STREAM_LINES;
	for (unsigned a = 0; a < AXES; a++)
		at.line.steps[a] /= STREAM_LINES;
	at.lines = at.ramps = 0;
	bound(scene);
	return passo_stream(&bench->passo, &source);
}

static enum passo_error begin_jog(struct bench *bench, struct scene *scene, bool endless)
{
	const int32_t steps = scene->target[0] - scene->start[0];
	const struct passo_jog jog = {.steps = endless ? 0 : steps,
	    .backward = steps < 0,
	    .speed = Q32(scene->speed),
	    .acceleration = Q32(scene->acceleration)};

	bound(scene);
	if (endless) {
		scene->low[0] = steps < 0 ? INT32_MIN : scene->start[0];
		scene->high[0] = steps < 0 ? scene->start[0] : INT32_MAX;
	}
	return passo_jog(&bench->passo, &jog);
}

static enum passo_error begin_goto(struct bench *bench, struct scene *scene)
{
	const struct passo_goto to = {
	    .target = scene->target[0], .speed = Q32(scene->speed), .acceleration = Q32(scene->acceleration)};

	bound(scene);
	return passo_goto(&bench->passo, &to);
}

/* The switch is at the target. */
static void mount(struct bench *bench, const struct scene *scene, enum passo_input input)
{
	const bool above = scene->target[0] > scene->start[0];
	struct passo_rig_config rig = {.axes = AXES, .wires = 1};

	rig.wire[0] = (struct passo_rig_wire){
	    .input = (uint8_t)input, .is_switch = true, .above = above, .at = scene->target[0]};
	for (unsigned a = 0; a < AXES; a++)
		rig.start[a] = bench->axis[a].position;
	if (!passo_engine_attach(bench->engine, &rig))
		abort();
}

static int32_t steps_in(const struct scene *scene, uint64_t clocks)
{
	return (int32_t)(scene->speed * (double)clocks / CLOCK_HZ);
}

/* A task may stop softly behind the switch, which the filter shows later. */
static void bound_task(const struct bench *bench, struct scene *scene)
{
	const int32_t past = steps_in(scene, scene->stop_clocks + bench->filter) + 60;

	bound(scene);
	scene->low[0] -= past;
	scene->high[0] += past;
	scene->seconds *= 2;
}

static enum passo_error begin_home(struct bench *bench, struct scene *scene)
{
	const int32_t way = scene->target[0] - scene->start[0];

	mount(bench, scene, PASSO_INPUT_HOME);
	bound_task(bench, scene);
	at.home = (struct passo_home){.source = PASSO_TRIGGER_SOURCE_HOME,
	    .distance = 2 * way,
	    .back_off = 20,
	    .speed = Q32(scene->speed),
	    .slow_speed = Q32(scene->speed / 10),
	    .acceleration = Q32(scene->acceleration),
	    .position = scene->target[0]};
	return passo_home(&bench->passo, &at.home, 1);
}

static enum passo_error begin_probe(struct bench *bench, struct scene *scene)
{
	struct passo_probe probe = {.speed = Q32(scene->speed), .acceleration = Q32(scene->acceleration)};

	mount(bench, scene, PASSO_INPUT_PROBE);
	bound_task(bench, scene);
	const int32_t way = scene->target[0] - scene->start[0], late = steps_in(scene, bench->filter);
	probe.steps[0] = 2 * (way + (way < 0 ? -late : late));
	return passo_probe(&bench->passo, &probe);
}

/* A step in two counts. */
static enum passo_error begin_thread(struct bench *bench, struct scene *scene)
{
	const int32_t steps = scene->target[0] - scene->start[0];
	struct passo_thread thread = {
	    .encoder = SPINDLE, .counts = 2u * (uint32_t)abs(steps), .top_speed = Q32(8 * scene->speed)};

	thread.steps[0] = steps;
	bound(scene);
	bench->spindle_period = (uint64_t)(CLOCK_HZ / scene->speed / 2);
	bench->spindle_next = bench_clock(bench);
	return passo_thread(&bench->passo, &thread);
}

static enum passo_error begin_move(struct bench *bench, struct scene *scene)
{
	const struct passo_move_by_speed move = move_of(scene);

	bound(scene);
	return passo_move_by_speed(&bench->passo, &move);
}

static enum passo_error begin_raster(struct bench *bench, struct scene *scene)
{
	static const uint8_t values[] = {255, 128, 64, 255, 128, 64, 255, 255};
	struct passo *passo = &bench->passo;
	size_t taken;

	bench_must(bench, "outputs",
	    passo_configure_outputs(passo, &(struct passo_outputs_config){.pwm_hz = 20000}));
	bench_must(bench, "pitch", passo_set_pitch(passo, 50));
	bench_must(bench, "values", passo_push_raster(passo, values, sizeof values, &taken));
	bench_must(
	    bench, "output", passo_set_output(passo, &(struct passo_output){.levels = 3, .raster = true}));
	return begin_move(bench, scene);
}

static enum passo_error begin_compare(struct bench *bench, struct scene *scene)
{
	const int32_t way = scene->target[0] - scene->start[0];
	const struct passo_compare_config compare = {
	    .position = scene->start[0] + (way > 0 ? 1 : -1), .interval = way > 0 ? 1 : -1, .width = 10};

	bench_must(bench, "compare", passo_arm_compare(&bench->passo, &compare));
	return begin_move(bench, scene);
}

static enum passo_error begin_together(struct bench *bench, struct scene *scene)
{
	struct passo *const channels[] = {&bench->passo};
	enum passo_error error = passo_wait_for_sync(&bench->passo, true);

	if (error == PASSO_OK)
		error = begin_move(bench, scene);
	return error == PASSO_OK ? passo_start_together(channels, 1) : error;
}

enum passo_error operation_begin(struct bench *bench, struct scene *scene)
{
	switch (scene->operation) {
	case OP_QUEUE:
		return begin_queue(bench, scene);
	case OP_PATH:
		return begin_path(bench, scene);
	case OP_STREAM:
		return begin_stream(bench, scene);
	case OP_JOG:
	case OP_ENDLESS:
		return begin_jog(bench, scene, scene->operation == OP_ENDLESS);
	case OP_GOTO:
		return begin_goto(bench, scene);
	case OP_HOME:
		return begin_home(bench, scene);
	case OP_PROBE:
		return begin_probe(bench, scene);
	case OP_THREAD:
		return begin_thread(bench, scene);
	case OP_RASTER:
		return begin_raster(bench, scene);
	case OP_COMPARE:
		return begin_compare(bench, scene);
	case OP_TOGETHER:
		return begin_together(bench, scene);
	default:
		return begin_move(bench, scene);
	}
}

enum passo_error operation_poll(struct bench *bench, const struct scene *scene)
{
	return scene->operation == OP_PATH ? passo_path_feed_poll(&at.feed) : passo_poll(&bench->passo);
}
