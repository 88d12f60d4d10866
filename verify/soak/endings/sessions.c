/* SPDX-License-Identifier: MIT
 * A host fails in a frame of what it does, another one opens the core and moves: nothing of the first acts.
 */
#include "sessions.h"

#include <string.h>

#define FRAMES 48u /* of a session, most of them of its beginning */
#define STEPS 60

/* `follows`: an encoder that does not turn may stop the first of several moves before the last is sent. */
static enum passo_error no_error(enum passo_error error, bool follows)
{
	return error == PASSO_ERROR_UNDER_WAY || (follows && error == PASSO_ERROR_STOPPED) ? PASSO_OK : error;
}

/* What outlives a motion; whether an axis follows an encoder. */
static bool arm(struct bench *bench, const struct scene *scene)
{
	static const uint8_t values[] = {255, 128, 255, 128, 255, 128, 255, 128};
	const struct passo_trigger_config trigger = {
	    .source = PASSO_TRIGGER_SOURCE_PROBE, .action = 1u + bench_draw(bench, 3)};
	const struct passo_compare_config compare = {
	    .position = bench->axis[0].position + 5, .interval = 1, .width = 20};
	const struct passo_encoder_config encoder = {
	    .ratio = 1u << 16, .limit = 1, .stop = PASSO_FOLLOWING_SOFT};
	struct passo *passo = &bench->passo;
	size_t taken;

	if (scene->operation != OP_HOME && scene->operation != OP_PROBE && bench_draw(bench, 2) != 0u)
		bench_must(bench, "trigger", passo_arm_trigger(passo, &trigger));
	if (bench_draw(bench, 2) != 0u)
		bench_must(bench, "compare", passo_arm_compare(passo, &compare));
	if (bench_draw(bench, 2) != 0u)
		bench_must(bench, "raster", passo_push_raster(passo, values, sizeof values, &taken));
	const bool follows = bench_draw(bench, 8) == 0u;
	if (follows)
		bench_must(bench, "encoder", passo_configure_encoder(passo, 1, &encoder));
	if (bench_draw(bench, 4) == 0u)
		bench_must(bench, "override", passo_override(passo, 1u + bench_draw(bench, 100)));
	if (bench_draw(bench, 6) == 0u)
		bench_must(bench, "sync", passo_wait_for_sync(passo, true));
	return follows;
}

/* The first host: until it dies, or there is nothing left to do. */
static void live(struct bench *bench, struct scene *scene)
{
	bench_must(bench, "open", bench_open(bench));
	bench_configure(bench, scene->hold_clocks, scene->stop_clocks);
	for (uint8_t a = 0; a < AXES; a++)
		bench_must(bench, "inputs",
		    passo_configure_inputs(
			&bench->passo, a, &(struct passo_input_config){.home = true, .limit_low = true}));
	bench_must(bench, "probe", passo_configure_probe(&bench->passo, false));
	bench_filter(bench);
	operation_draw(bench, scene);
	for (unsigned a = 0; a < AXES; a++)
		pulses_begin(&bench->axis[a]);
	bench->dies_in = 1u + bench_draw(bench, FRAMES);
	const bool follows = arm(bench, scene);
	bench_must(bench, "operation", no_error(operation_begin(bench, scene), follows));
	if (bench_draw(bench, 4) == 0u)
		bench_must(bench, "hold", passo_hold(&bench->passo));
	while (!bench->fault) {
		operation_poll(bench, scene); /* an armed encoder may stop it */
		bench_run(bench, (uint64_t)(bench_between(bench, 1e-4, 1e-2) * CLOCK_HZ));
		if (!passo_is_moving(&bench->passo))
			bench->dies_in = bench->dies_in != 0u ? 1u : 0u;
	}
}

/* A motion that continues is ended, or ends. */
static void take_over(struct bench *bench, const struct scene *scene)
{
	struct passo *passo = &bench->passo;
	enum passo_error error = bench_open(bench);

	if (error == PASSO_ERROR_MOVING) {
		if (scene->operation == OP_ENDLESS || scene->operation == OP_THREAD
		    || bench_draw(bench, 2) != 0u)
			bench_must(bench, "stop",
			    bench_draw(bench, 2) != 0u ? passo_stop(passo) : passo_abort(passo));
		else
			bench_must(bench, "resume", passo_resume(passo));
		bench_finish(bench, 2u * MILLISECOND); /* a stop by its own trigger is none of ours */
		bench_finish(bench, 2u * MILLISECOND);
		error = passo_clear(passo);
	}
	bench_must(bench, "the second open", error);
}

/* Everything that could wake what is left. */
static void provoke(struct bench *bench, bool on)
{
	const uint64_t levels = on ? 7u : 0u;

	passo_engine_set(bench->engine, PASSO_INPUT_PROBE, on ? 1u : 0u);
	passo_engine_set(bench->engine, PASSO_INPUT_HOME, levels);
	passo_engine_set(bench->engine, PASSO_INPUT_SYNC, on ? 1u : 0u);
	passo_engine_set(bench->engine, PASSO_INPUT_ENCODER_INDEX, levels);
	bench_run(bench, MILLISECOND / 4u + bench_draw(bench, 2) * 2u * (uint32_t)bench->filter);
}

static void expect_rest(struct bench *bench)
{
	int32_t there[AXES];

	for (unsigned a = 0; a < AXES; a++)
		there[a] = bench->axis[a].position;
	for (unsigned times = 0; times < 6u; times++)
		provoke(bench, times % 2u == 0u);
	for (unsigned a = 0; a < AXES; a++)
		if (bench->axis[a].position != there[a])
			bench_blame(bench, "moves by itself", there[a], bench->axis[a].position);
	bench_must(bench, "poll", passo_poll(&bench->passo));
	bench_check_positions(bench);
}

static void move(struct bench *bench, int32_t steps)
{
	struct passo *passo = &bench->passo;
	struct passo_move_by_speed move = {
	    .speed = 8000u * PASSO_UNIT_Q32, .acceleration = 2000000u * PASSO_UNIT_Q32};
	const int32_t wanted = bench->axis[0].position + steps;
	const unsigned compares = bench->compares;
	const uint64_t powered = bench->powered;

	move.steps[0] = steps;
	bench_must(bench, "move", passo_move_by_speed(passo, &move));
	for (unsigned times = 0; times < 8u; times++)
		provoke(bench, times % 2u == 0u);
	bench_must(bench, "the end of the move", bench_finish(bench, MILLISECOND));
	if (bench->axis[0].position != wanted)
		bench_blame(bench, "ends elsewhere", bench->axis[0].position, wanted);
	if (bench->compares != compares)
		bench_blame(bench, "old compare pulses", (long)(bench->compares - compares), 0);
	if (bench->powered != powered)
		bench_blame(bench, "power of the old session", 0, 0);
	bench_check_positions(bench);
}

/* A raster line has the values of this session. */
static void raster(struct bench *bench)
{
	struct passo_outputs_state state;

	bench_must(bench, "outputs", passo_read_outputs(&bench->passo, &state));
	if (state.raster_room != 1024u)
		bench_blame(bench, "old raster values", (long)state.raster_room, 0);
}

bool session_play(struct bench *bench, uint32_t seed, struct scene *scene)
{
	struct passo_trigger_report report;

	memset(scene, 0, sizeof *scene);
	bench_create(bench, seed);
	bench_power_up(bench, FINE_TICK_LOG2);
	scene->operation = (enum operation)bench_draw(bench, OPERATIONS);
	scene->hold_clocks = scene->stop_clocks = 10u * MILLISECOND;
	if (setjmp(bench->death) == 0)
		live(bench, scene);
	bench->dies_in = 0;
	bench_run(bench, (uint64_t)(bench_between(bench, 1e-5, 0.1) * CLOCK_HZ));
	if (!bench->fault)
		take_over(bench, scene);
	if (!bench->fault) {
		expect_rest(bench);
		bench_must(bench, "trigger", passo_read_trigger(&bench->passo, &report));
		if (report.armed || report.fired || report.arming)
			bench_blame(bench, "an old trigger", report.armed, report.fired);
		raster(bench);
		bench_configure(bench, scene->hold_clocks, scene->stop_clocks);
		move(bench, STEPS);
		move(bench, -STEPS);
	}
	bench_destroy(bench);
	return !bench->fault;
}
