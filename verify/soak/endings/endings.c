/* SPDX-License-Identifier: MIT
 * The judge of an ending sees the pins, and what the driver says afterwards.
 */
#include "endings.h"

#include <math.h>
#include <string.h>

#define WATCHDOG_CLOCKS (UINT64_C(25) << 16) /* 0.1 s */
#define SETTLED (5u * MILLISECOND)
#define SECOND_STEPS 5

static const char *const names[ENDINGS] = {"cancel", "stop", "hold", "abort", "limit", "soft limit", "alarm",
    "e-stop", "trigger", "hard trigger", "silence", "second call"};

const char *ending_name(enum ending ending)
{
	return names[ending];
}

static bool is_hard(enum ending ending)
{
	return ending == END_ABORT || ending == END_LIMIT || ending == END_ALARM || ending == END_ESTOP
	    || ending == END_HARD_TRIGGER;
}

/* It slows down by the time scale. */
static bool is_scaled(enum ending ending)
{
	return ending == END_STOP || ending == END_HOLD || ending == END_SOFT_LIMIT || ending == END_TRIGGER
	    || ending == END_SILENCE;
}

static bool is_task(enum operation operation)
{
	return operation == OP_HOME || operation == OP_PROBE;
}

/* Home and probe have the trigger for themselves. */
static bool is_possible(enum operation operation, enum ending ending)
{
	return !is_task(operation) || (ending != END_TRIGGER && ending != END_HARD_TRIGGER);
}

static void set_up(struct bench *bench, const struct scene *scene)
{
	struct passo *passo = &bench->passo;

	bench_configure(bench, scene->hold_clocks, scene->stop_clocks);
	for (uint8_t a = 0; a < AXES; a++) {
		const struct passo_input_config inputs = {.limit_low = true,
		    .limit_high = true,
		    .home = true,
		    .limit_soft = scene->ending == END_SOFT_LIMIT};
		bench_must(bench, "inputs", passo_configure_inputs(passo, a, &inputs));
	}
	bench_must(bench, "probe", passo_configure_probe(passo, false));
	bench_must(bench, "watchdog", passo_configure_watchdog(passo, WATCHDOG_CLOCKS, 0));
	if (scene->operation != OP_HOME) /* its switch is exact to the step */
		bench_filter(bench);
	bench_run(bench, bench_settling(bench));
}

/* A random one, often around where it slows down, and at its end. */
static uint64_t some_moment(struct bench *bench, const struct scene *scene)
{
	const double ramp = scene->speed / scene->acceleration, all = scene->seconds;
	const double share = bench_draw(bench, 1u << 16) / 65536.0;
	double at = 1.05 * all * share;

	switch (bench_draw(bench, 5)) {
	case 0:
		at = all - ramp + (share - 0.5) * 0.1 * ramp;
		break;
	case 1:
		at = all - ramp * share;
		break;
	case 2:
		at = all - 0.004 * share;
		break;
	default:
		break;
	}
	return at > 0 ? (uint64_t)(at * CLOCK_HZ) : 0u;
}

static void pass(struct bench *bench, const struct scene *scene, uint64_t clocks)
{
	const double interval = fmax(scene->seconds / 40, 1e-4);
	const uint64_t end = bench_clock(bench) + clocks;

	while (bench_clock(bench) < end && !bench->fault) {
		const uint64_t left = end - bench_clock(bench);
		const uint64_t next = (uint64_t)(bench_between(bench, interval / 8, interval) * CLOCK_HZ);
		bench_run(bench, left < next ? left : next);
		bench_must(bench, "poll", operation_poll(bench, scene));
	}
}

/* -------------------------------------------------------------------------------------- the endings ---- */

static enum passo_error finish(struct bench *bench, const struct scene *scene)
{
	const uint64_t end = bench_clock(bench) + UINT64_C(30) * CLOCK_HZ;

	while (passo_is_moving(&bench->passo)) {
		const enum passo_error error = operation_poll(bench, scene);
		if (error != PASSO_OK)
			return error;
		bench_run(bench, 2u * MILLISECOND);
		if (bench_clock(bench) > end)
			return PASSO_ERROR_TIMEOUT;
	}
	return PASSO_OK;
}

/* The error of the poll that sees it. */
static enum passo_error await(struct bench *bench, const struct scene *scene)
{
	enum passo_error error = PASSO_OK;

	for (unsigned polls = 0; polls < 200u && error == PASSO_OK; polls++) {
		bench_run(bench, MILLISECOND);
		error = operation_poll(bench, scene);
	}
	return error;
}

static void cancel(struct bench *bench, struct scene *scene)
{
	const bool moves = passo_is_moving(&bench->passo);
	const enum passo_error error = passo_jog_cancel(&bench->passo);

	if (operation_is_jog(scene->operation))
		bench_must(bench, "cancel", error);
	else if (error != PASSO_ERROR_NOT_TURNING && (moves || error != PASSO_OK))
		bench_blame(bench, "cancel of what is no jog", (long)error, 0);
}

static void hold(struct bench *bench, struct scene *scene)
{
	struct passo *passo = &bench->passo;

	bench_must(bench, "hold", passo_hold(passo));
	/* on its way down it may meet its switch, and stops from there */
	pass(bench, scene,
	    scene->hold_clocks + (is_task(scene->operation) ? scene->stop_clocks + bench->filter : 0u)
	        + SETTLED);
	const int32_t there = bench->axis[0].position;
	pass(bench, scene, 10u * MILLISECOND);
	if (bench->axis[0].position != there && scene->operation != OP_HOME)
		bench_blame(bench, "moves during a hold", there, bench->axis[0].position);
	bench_must(bench, "resume", passo_resume(passo));
	if (scene->operation == OP_ENDLESS) {
		pass(bench, scene, scene->hold_clocks + SETTLED);
		bench_must(bench, "cancel", passo_jog_cancel(passo));
	}
}

/* Its target goes away a bit: never beyond the new one. */
static void go_further(struct bench *bench, struct scene *scene)
{
	struct passo_goto to = {
	    .speed = (uint64_t)scene->speed << 32, .acceleration = (uint64_t)scene->acceleration << 32};
	const int32_t more = (int32_t)bench_between(bench, 1, 2000);
	const int32_t way = scene->target[0] > scene->start[0] ? more : -more;

	to.target = scene->target[0] + way;
	const enum passo_error error = passo_goto(&bench->passo, &to);
	if (error == PASSO_ERROR_LATE)
		return;
	bench_must(bench, "goto", error);
	scene->target[0] += way;
	scene->low[0] += way < 0 ? way : 0;
	scene->high[0] += way > 0 ? way : 0;
}

/* Another motion: refused, or made behind this one. */
static void second(struct bench *bench, struct scene *scene)
{
	if (scene->operation == OP_GOTO && bench->late == 0u) {
		go_further(bench, scene);
		return;
	}
	struct passo *passo = &bench->passo;
	const struct passo_jog jog = {.steps = SECOND_STEPS,
	    .speed = (uint64_t)scene->speed << 32,
	    .acceleration = (uint64_t)scene->acceleration << 32};
	const enum passo_error error = passo_jog(passo, &jog);

	if (error == PASSO_OK) {
		scene->target[0] += SECOND_STEPS;
		scene->high[0] += SECOND_STEPS;
	} else if (error != PASSO_ERROR_MOVING && error != PASSO_ERROR_UNDER_WAY
	           && error != PASSO_ERROR_STREAMING) {
		bench_blame(bench, passo_error_name(error), 0, 0);
	}
	if (scene->operation == OP_ENDLESS)
		bench_must(bench, "cancel", passo_jog_cancel(passo));
}

static void silence(struct bench *bench)
{
	int32_t before;

	do {
		before = bench->axis[0].position;
		bench_run(bench, WATCHDOG_CLOCKS + (1u << 16));
	} while (bench->axis[0].position != before);
}

/* Ends it; returns the error that a poll must return, PASSO_OK: none, and whether a clear is needed. */
static enum passo_error end(struct bench *bench, struct scene *scene, bool *stopped)
{
	struct passo *passo = &bench->passo;

	*stopped = true;
	switch (scene->ending) {
	case END_CANCEL:
		cancel(bench, scene);
		*stopped = false;
		return PASSO_OK;
	case END_STOP:
		bench_must(bench, "stop", passo_stop(passo));
		return PASSO_OK;
	case END_HOLD:
		hold(bench, scene);
		*stopped = false;
		return PASSO_OK;
	case END_ABORT:
		bench_must(bench, "abort", passo_abort(passo));
		return PASSO_OK;
	case END_LIMIT:
	case END_SOFT_LIMIT:
		passo_engine_set(bench->engine, PASSO_INPUT_LIMIT_LOW, 1);
		passo_engine_set(bench->engine, PASSO_INPUT_LIMIT_HIGH, 1);
		return PASSO_ERROR_LIMIT;
	case END_ALARM:
		passo_engine_set(bench->engine, PASSO_INPUT_ALARM, 1);
		return PASSO_ERROR_ALARM;
	case END_ESTOP:
		passo_engine_set(bench->engine, PASSO_INPUT_ESTOP_N, 0);
		return PASSO_ERROR_ESTOP;
	case END_TRIGGER:
	case END_HARD_TRIGGER:
		passo_engine_set(bench->engine, PASSO_INPUT_PROBE, 1);
		return PASSO_ERROR_TRIGGER;
	case END_SILENCE:
		silence(bench);
		return PASSO_ERROR_WATCHDOG;
	default:
		second(bench, scene);
		*stopped = false;
		return PASSO_OK;
	}
}

/* -------------------------------------------------------------------------------------------- judge ---- */

static void judge_place(struct bench *bench, const struct scene *scene)
{
	for (unsigned a = 0; a < AXES; a++) {
		const struct pulses *pulses = &bench->axis[a];
		if (pulses->lowest < scene->low[a])
			bench_blame(bench, "below its lower bound", pulses->lowest, scene->low[a]);
		if (pulses->highest > scene->high[a])
			bench_blame(bench, "above its upper bound", pulses->highest, scene->high[a]);
	}
	const double made = bench->axis[0].position - scene->start[0];
	const double share =
	    (double)(scene->target[1] - scene->start[1]) / (double)(scene->target[0] - scene->start[0]);
	if (scene->lines
	    && fabs(bench->axis[1].position - scene->start[1] - made * share) > 1.01 + fabs(share))
		bench_blame(bench, "beside its path", bench->axis[0].position, bench->axis[1].position);
}

static void judge_speeds(struct bench *bench, const struct scene *scene)
{
	double limit = scene->acceleration * scene->bend;

	/* a thread has the speed of its spindle, and a path jumps in its corners */
	if (scene->operation == OP_THREAD || scene->operation == OP_PATH)
		return;
	if (is_scaled(scene->ending))
		limit += scene->speed * CLOCK_HZ
		       / (double)(scene->ending == END_HOLD ? scene->hold_clocks : scene->stop_clocks);
	if (is_task(scene->operation))
		limit += scene->speed * CLOCK_HZ / (double)scene->stop_clocks;
	const bool scaled = is_scaled(scene->ending) || is_task(scene->operation);
	/* axis 1 never has more steps than axis 0 on a line, whose shape it has, but for a substep */
	const unsigned axes = scene->lines || scene->operation == OP_QUEUE ? 1u : 2u;
	for (unsigned a = 0; a < axes; a++) {
		const struct pulses *pulses = &bench->axis[a];
		const double slope = pulses_slope(pulses, CLOCK_HZ, limit, scene->speed, scaled);
		if (slope > 1)
			bench_blame(bench, "steeper than asked, in percent", (long)(slope * 100), (long)a);
		if (a == 0u && pulses_jump(pulses, CLOCK_HZ, limit, !is_hard(scene->ending)))
			bench_blame(bench, "starts or ends at speed", 0, 0);
		if (pulses_speed(pulses, CLOCK_HZ) > scene->speed * 1.002)
			bench_blame(bench, "faster than asked", (long)pulses_speed(pulses, CLOCK_HZ),
			    (long)scene->speed);
	}
}

/* Nothing more comes, and the driver knows where it is. */
static void judge_rest(struct bench *bench)
{
	const int32_t there = bench->axis[0].position;

	bench_run(bench, 20u * MILLISECOND);
	if (bench->axis[0].position != there)
		bench_blame(bench, "moves on", there, bench->axis[0].position);
	if ((bench->pins.power & 1u) != 0u)
		bench_blame(bench, "has power at rest", 0, 0);
	bench_check_positions(bench);
}

/* Once more, by one move. */
static void judge_next(struct bench *bench, const struct scene *scene)
{
	struct passo *passo = &bench->passo;
	struct passo_move_by_speed move = {
	    .speed = (uint64_t)scene->speed << 32, .acceleration = (uint64_t)scene->acceleration << 32};
	const int32_t wanted = bench->axis[0].position - 50;

	move.steps[0] = -50;
	bench_must(bench, "the next move", passo_move_by_speed(passo, &move));
	bench_must(bench, "the end of the next move", bench_finish(bench, MILLISECOND));
	if (bench->axis[0].position != wanted)
		bench_blame(bench, "the next move ends elsewhere", bench->axis[0].position, wanted);
	bench_check_positions(bench);
}

/* The inputs are as before. */
static void release(struct bench *bench)
{
	passo_engine_set(bench->engine, PASSO_INPUT_LIMIT_LOW, 0);
	passo_engine_set(bench->engine, PASSO_INPUT_LIMIT_HIGH, 0);
	passo_engine_set(bench->engine, PASSO_INPUT_ALARM, 0);
	passo_engine_set(bench->engine, PASSO_INPUT_ESTOP_N, 1);
	bench->spindle_period = 0;
	bench_run(bench, bench_settling(bench));
}

static void clear(struct bench *bench, const struct scene *scene)
{
	struct passo *passo = &bench->passo;

	if (scene->ending == END_ESTOP || scene->ending == END_ALARM) {
		if (passo_clear(passo) == PASSO_OK)
			bench_blame(bench, "cleared while the input is active", 0, 0);
	}
	release(bench);
	if (scene->ending == END_ESTOP) {
		bench_must(bench, "clear e-stop", passo_clear_estop(passo));
		for (uint8_t a = 0; a < AXES; a++)
			bench_must(bench, "enable", passo_enable(passo, a, true));
	}
	bench_must(bench, "clear", passo_clear(passo));
	if (passo_fault(passo) != PASSO_OK)
		bench_blame(bench, "a fault after clear", (long)passo_fault(passo), 0);
}

/* A stop at speed may lose steps; any other keeps them. Of several axes a soft limit may stop some dead. */
static bool keeps_home(const struct scene *scene)
{
	const bool several = scene->target[1] != scene->start[1];

	return !is_hard(scene->ending) && scene->ending != END_SILENCE
	    && !(scene->ending == END_SOFT_LIMIT && several);
}

/* A hard limit, pressed while a probe or home that has found may still be stopping softly, overrides that
 * stop: "What stays homed" of docs/machine.md. At rest it does nothing. */
static bool may_override(const struct bench *bench, const struct scene *scene)
{
	const struct pulses *pulses = &bench->axis[0];

	return scene->ending == END_LIMIT && is_task(scene->operation) && pulses->count != 0u
	    && scene->ended
	           < pulses->clock[pulses->count - 1u] + scene->stop_clocks + bench->filter + SETTLED;
}

/* The motion was over before it was stopped. */
static bool is_there(const struct bench *bench, const struct scene *scene)
{
	return bench->axis[0].position == scene->target[0] && bench->axis[1].position == scene->target[1];
}

static void judge_state(
    struct bench *bench, const struct scene *scene, enum passo_error wanted, bool stopped, bool moved)
{
	struct passo *passo = &bench->passo;
	struct passo_snapshot now;
	const bool may_have_ended =
	    scene->ending == END_LIMIT || scene->ending == END_SOFT_LIMIT || scene->ending == END_SILENCE;
	/* an alarm, e-stop or trigger acts at rest as well */
	const bool comes = wanted != PASSO_OK && !may_have_ended;
	const enum passo_error error = comes ? await(bench, scene) : finish(bench, scene);

	/* the switch that it seeks may have come first */
	const bool is_sought = error == PASSO_ERROR_TRIGGER && is_task(scene->operation);
	if (error != wanted && !is_sought && !(may_have_ended && error == PASSO_OK))
		bench_blame(bench, passo_error_name(error), (long)error, (long)wanted);
	if (!is_sought && error != PASSO_OK && passo_fault(passo) != error)
		bench_blame(
		    bench, "the fault is not that of the poll", (long)passo_fault(passo), (long)error);
	if (may_have_ended && error == PASSO_OK)
		stopped = false;
	if (bench_finish(bench, MILLISECOND) != PASSO_OK)
		bench_blame(bench, "a second error", 0, 0);
	judge_rest(bench);
	bench_must(bench, "state", passo_read_state(passo, &now));
	if (stopped && now.state != PASSO_STATE_STOPPED)
		bench_blame(bench, "is not stopped", now.state, 0);
	if (!stopped && now.state != PASSO_STATE_IDLE)
		bench_blame(bench, "is not idle", now.state, 0);
	if ((keeps_home(scene) || (!stopped && !may_override(bench, scene))) && scene->operation != OP_HOME
	    && !passo_is_homed(passo, 0))
		bench_blame(bench, "forgets its home", 0, 0);
	if (!keeps_home(scene) && stopped && moved && !is_there(bench, scene) && passo_is_homed(passo, 0))
		bench_blame(
		    bench, "is homed after a stop at speed", bench->axis[0].position, scene->target[0]);
	if (stopped)
		clear(bench, scene);
	release(bench);
}

/* What is left undisturbed ends at its target. */
static void judge_end(struct bench *bench, const struct scene *scene)
{
	const bool undisturbed = scene->ending == END_HOLD || scene->ending == END_SECOND
	                      || (scene->ending == END_CANCEL && !operation_is_jog(scene->operation));

	if (!undisturbed || scene->operation == OP_ENDLESS || is_task(scene->operation))
		return;
	const bool is_queue = scene->operation == OP_QUEUE;
	for (unsigned a = 0; a < 2u; a++)
		if (bench->axis[a].position != scene->target[a] && !(is_queue && scene->ending == END_SECOND))
			bench_blame(bench, "ends elsewhere", bench->axis[a].position, scene->target[a]);
}

static void arm_trigger(struct bench *bench, const struct scene *scene)
{
	const struct passo_trigger_config trigger = {.source = PASSO_TRIGGER_SOURCE_PROBE,
	    .action = scene->ending == END_TRIGGER ? PASSO_TRIGGER_ACTION_SOFT_STOP
	                                           : PASSO_TRIGGER_ACTION_HARD_STOP};

	if (scene->ending == END_TRIGGER || scene->ending == END_HARD_TRIGGER)
		bench_must(bench, "trigger", passo_arm_trigger(&bench->passo, &trigger));
}

static void play(struct bench *bench, struct scene *scene)
{
	static const uint64_t lateness[] = {
	    0, 0, 0, 0, MILLISECOND, MILLISECOND, 10u * MILLISECOND, 100u * MILLISECOND};
	bool stopped = false;

	set_up(bench, scene);
	operation_draw(bench, scene);
	arm_trigger(bench, scene);
	bench_run(bench, bench_settling(bench));
	for (unsigned a = 0; a < AXES; a++) {
		bench->passo.axis[a].homed = true;
		pulses_begin(&bench->axis[a]);
	}
	const unsigned compares = bench->compares;
	bench_must(bench, operation_name(scene->operation), operation_begin(bench, scene));
	pass(bench, scene, some_moment(bench, scene));
	bench->late = scene->coarse ? 0u : lateness[bench_draw(bench, 8)];
	bench->in_time =
	    scene->coarse || (bench->late == 0u && bench_draw(bench, 2) != 0u) ? MILLISECOND : 0u;
	const size_t before = bench->axis[0].count;
	const bool moving = passo_is_moving(&bench->passo);
	scene->ended = bench_clock(bench);
	const enum passo_error wanted = end(bench, scene, &stopped);
	bench->late = bench->in_time = 0;
	if (bench->fault)
		return;
	judge_state(bench, scene, wanted, stopped, moving && before != 0u);
	judge_place(bench, scene);
	judge_speeds(bench, scene);
	judge_end(bench, scene);
	if (scene->operation == OP_COMPARE && scene->ending != END_SECOND
	    && bench->compares - compares != bench->axis[0].count)
		bench_blame(bench, "compare pulses and steps", (long)(bench->compares - compares),
		    (long)bench->axis[0].count);
	if (!bench->fault)
		judge_next(bench, scene);
}

bool ending_play(
    struct bench *bench, uint32_t seed, enum operation operation, enum ending ending, struct scene *scene)
{
	memset(scene, 0, sizeof *scene);
	bench_create(bench, seed);
	/* the ramps on the way are worth more than one in thirteen */
	if (operation == OPERATIONS && ending == ENDINGS && bench_draw(bench, 3) == 0u) {
		operation = (enum operation)((unsigned)OP_JOG + bench_draw(bench, 3));
		ending = operation == OP_GOTO && bench_draw(bench, 2) != 0u ? END_SECOND : END_CANCEL;
	}
	do {
		scene->operation =
		    operation < OPERATIONS ? operation : (enum operation)bench_draw(bench, OPERATIONS);
		scene->ending = ending < ENDINGS ? ending : (enum ending)bench_draw(bench, ENDINGS);
	} while (
	    !is_possible(scene->operation, scene->ending) && (operation == OPERATIONS || ending == ENDINGS));
	scene->coarse = operation_is_jog(scene->operation) && bench_draw(bench, 3) != 0u;
	bench_power_up(bench, scene->coarse ? COARSE_TICK_LOG2 : FINE_TICK_LOG2);
	scene->hold_clocks = (uint64_t)(bench_between(bench, 0.002, 0.05) * CLOCK_HZ);
	scene->stop_clocks = (uint64_t)(bench_between(bench, 0.002, 0.05) * CLOCK_HZ);
	bench_must(bench, "open", bench_open(bench));
	play(bench, scene);
	bench_destroy(bench);
	return !bench->fault;
}
