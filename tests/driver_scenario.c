/* SPDX-License-Identifier: MIT
 * The driver and the C model in one program, for the sanitizers: moves, streams, rotation, stops and resets
 * over a link that flips bits, drops words and dies. Prints "ok" if every position equals the sum of the
 * accepted moves.
 */
#include <stdio.h>
#include <string.h>

#include "passo.h"
#include "passo_engine.h"
#include "passo_goto.h"
#include "passo_motor.h"

#define CLOCK_HZ 72000000u
#define PASSO_CLOCK_HZ CLOCK_HZ
#define GAP 64u
#define MOVES 60u
#define LINES 400u
#define CHECK(condition)                                                                                     \
	do {                                                                                                 \
		if (!(condition)) {                                                                          \
			printf("line %d: %s\n", __LINE__, #condition);                                       \
			return false;                                                                        \
		}                                                                                            \
	} while (0)

struct wire {
	struct passo_engine *engine;
	uint32_t random, noise; /* one frame in `noise` is corrupted; 0: none */
	bool dead;
};

static const struct passo_engine_config config = {
    .core = {.channels = 1, .axes = 4, .tick_log2 = 7, .line_queue_log2 = 8, .ramp_queue_log2 = 4},
    .clock_hz = CLOCK_HZ,
    .spi_half_period = 2};

static uint32_t draw(struct wire *wire)
{
	wire->random = wire->random * 1664525u + 1013904223u;
	return wire->random >> 8;
}

static void damage(struct wire *wire, uint32_t *words, size_t count)
{
	if (wire->noise && draw(wire) % wire->noise == 0)
		words[draw(wire) % count] ^= UINT32_C(1) << draw(wire) % 32;
}

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct wire *wire = context;
	uint32_t sent[PASSO_FRAME_WORDS_MAX];
	struct passo_pin_event events[64];
	size_t count = words;

	while (passo_engine_drain(wire->engine, events, 64))
		;
	memset(receive, 0xFF, words * sizeof *receive);
	if (wire->dead)
		return true;
	memcpy(sent, send, words * sizeof *send);
	damage(wire, sent, words);
	if (wire->noise && draw(wire) % (4 * wire->noise) == 0)
		count = 1 + draw(wire) % words;
	passo_engine_transfer(wire->engine, sent, receive, count, GAP);
	damage(wire, receive, words);
	return true;
}

static uint32_t microseconds(void *context)
{
	return (uint32_t)(passo_engine_clock(((struct wire *)context)->engine) / (CLOCK_HZ / 1000000u));
}

static void wait(void *context, uint32_t time)
{
	struct passo_pin_event events[64];

	passo_engine_run(((struct wire *)context)->engine, (uint64_t)time * (CLOCK_HZ / 1000000u));
	while (passo_engine_drain(((struct wire *)context)->engine, events, 64))
		;
}

static bool random_moves(struct passo *passo, struct wire *wire)
{
	int32_t expected[PASSO_AXES_MAX], positions[PASSO_AXES_MAX];

	CHECK(passo_positions(passo, expected) == PASSO_OK);
	for (unsigned n = 0; n < MOVES; n++) {
		struct passo_move_jerk move = {.speed = 80000 * PASSO_UNIT_Q32,
		    .acceleration = 20000000 * PASSO_UNIT_Q32,
		    .jerk = 4000000000 * PASSO_UNIT_Q32};
		for (unsigned i = 0; i < 4; i++)
			move.steps[i] = (int32_t)(draw(wire) % 41u) - 20;
		enum passo_error error = passo_move_jerk(passo, &move);
		CHECK(error == PASSO_OK || error == PASSO_ERROR_FULL
		      || (unsigned)error == PASSO_ERROR_PLAN + PASSO_PLAN_NO_STEPS);
		for (unsigned i = 0; i < 4 && error == PASSO_OK; i++)
			expected[i] += move.steps[i];
		if (error == PASSO_ERROR_FULL || draw(wire) % 3u == 0)
			CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	}
	CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	CHECK(passo_positions(passo, positions) == PASSO_OK);
	CHECK(memcmp(expected, positions, 4 * sizeof positions[0]) == 0);
	return true;
}

struct supply {
	unsigned lines, ramps;
};

static bool next_line(void *context, struct passo_line *line)
{
	struct supply *supply = context;

	*line = (struct passo_line){.substeps = 32, .steps = {3, 1, 0, 1}, .directions = 2};
	line->last = ++supply->lines == LINES;
	return true;
}

/* 32 substeps at 1/64 are 16 ticks of 128 clocks */
static bool next_ramp(void *context, struct passo_ramp *ramp)
{
	struct supply *supply = context;

	*ramp = (struct passo_ramp){.velocity_end = PASSO_ONE_Q48 / 64, .progress_step = PASSO_ONE_Q48 / 256};
	ramp->ticks = supply->ramps == 0 ? 0 : 256;
	ramp->last = ++supply->ramps == LINES / 16 + 1;
	return true;
}

static bool stream(struct passo *passo)
{
	struct supply supply = {0, 0};
	const struct passo_source source = {next_line, next_ramp, &supply};
	int32_t before[PASSO_AXES_MAX], after[PASSO_AXES_MAX];

	CHECK(passo_positions(passo, before) == PASSO_OK);
	CHECK(passo_stream(passo, &source) == PASSO_OK);
	CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	CHECK(passo_positions(passo, after) == PASSO_OK);
	CHECK(after[0] - before[0] == 3 * (int32_t)LINES && after[1] - before[1] == -(int32_t)LINES);
	return true;
}

static bool turn_and_stop(struct passo *passo)
{
	struct passo_motor motor;
	int64_t degrees;
	uint64_t rpm;

	CHECK(passo_motor_init(&motor, passo, 3, 3200, PASSO_RPM(5), PASSO_RPM_PER_S(60000)) == PASSO_OK);
	CHECK(passo_motor_start_endless(&motor, true, PASSO_RPM(300), PASSO_RPM(600)) == PASSO_OK);
	CHECK(passo_wait(passo, PASSO_MS(20)) == PASSO_ERROR_TIMEOUT);
	CHECK(passo_motor_set_speed(&motor, PASSO_RPM(600)) == PASSO_OK);
	CHECK(passo_wait(passo, PASSO_MS(20)) == PASSO_ERROR_TIMEOUT);
	CHECK(passo_motor_speed(&motor, &rpm) == PASSO_OK && rpm > PASSO_RPM(599));
	CHECK(passo_motor_stop(&motor) == PASSO_OK);
	CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	CHECK(passo_motor_angle(&motor, &degrees) == PASSO_OK && degrees < 0);
	CHECK(passo_motor_set_target(&motor, PASSO_DEGREES(3600), PASSO_RPM(600)) == PASSO_OK);
	CHECK(passo_motor_start(&motor) == PASSO_OK);
	CHECK(passo_hold(passo) == PASSO_OK && passo_override(passo, 50) == PASSO_OK);
	CHECK(passo_resume(passo) == PASSO_OK && passo_override(passo, 100) == PASSO_OK);
	CHECK(passo_stop(passo) == PASSO_OK);
	CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	CHECK(passo_snapshot(passo)->state == PASSO_STATE_STOPPED);
	CHECK(passo_clear(passo) == PASSO_OK);
	return true;
}

/* On a wire that fails now and then a soft stop may replace a change. */
static bool chase(struct passo *passo, const struct wire *wire)
{
	struct passo_goto go = {.axis = 2,
	    .speed = PASSO_STEPS_PER_S(20000),
	    .top_speed = PASSO_STEPS_PER_S(80000),
	    .acceleration = PASSO_STEPS_PER_S2(2000000)};
	int32_t positions[PASSO_AXES_MAX];

	for (unsigned n = 0; n < 12u; n++) {
		go.target = n % 3u == 2u ? -100 : (int32_t)(300u * n);
		go.speed = n % 2u != 0u ? PASSO_STEPS_PER_S(80000) : PASSO_STEPS_PER_S(20000);
		const enum passo_error error = passo_goto(passo, &go);
		CHECK(error == PASSO_OK || (error == PASSO_ERROR_LATE && wire->noise));
		if (error != PASSO_OK)
			break;
		CHECK(passo_wait(passo, PASSO_MS(3)) != PASSO_ERROR_ARGUMENT);
	}
	CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	if (passo_snapshot(passo)->state == PASSO_STATE_STOPPED)
		return passo_clear(passo) == PASSO_OK;
	CHECK(passo_positions(passo, positions) == PASSO_OK && positions[2] == go.target);
	return true;
}

static bool tables(struct passo *passo)
{
	struct passo_move_sigmoid move = {.steps = {100},
	    .speed = 50000 * PASSO_UNIT_Q32,
	    .accelerate_clocks = CLOCK_HZ / 500,
	    .decelerate_clocks = CLOCK_HZ / 500,
	    .alpha = 3 * 4096};

	CHECK(passo_move_sigmoid(passo, &move) == PASSO_OK);
	CHECK(passo_wait(passo, PASSO_S(1)) == PASSO_OK);
	CHECK(passo_load_table(passo, PASSO_SHAPE_COSINE, NULL) == PASSO_OK);
	return true;
}

static bool open_and_configure(
    struct passo *passo, struct passo_host *host, const struct passo_hardware *hardware)
{
	const struct passo_options options = {.clock_hz = CLOCK_HZ, .axes = 4};
	const struct passo_axis_config pins = {.step_high_ns = 100};

	CHECK(passo_open(passo, host, hardware, &options) == PASSO_OK);
	for (uint8_t axis = 0; axis < 4; axis++) {
		CHECK(passo_configure_axis(passo, axis, &pins) == PASSO_OK);
		CHECK(passo_enable(passo, axis, true) == PASSO_OK);
	}
	return true;
}

static bool scenario(struct wire *wire)
{
	static struct passo_host host;
	static struct passo passo;
	const struct passo_hardware hardware = {
	    .transfer = transfer, .microseconds = microseconds, .wait = wait, .context = wire, .tries = 40};

	CHECK(open_and_configure(&passo, &host, &hardware));
	for (unsigned round = 0; round < 2; round++) {
		CHECK(random_moves(&passo, wire) && stream(&passo) && turn_and_stop(&passo) && tables(&passo)
		      && chase(&passo, wire));
		wire->noise = 6;
	}
	wire->noise = 0;
	wire->dead = true;
	CHECK(passo_hold(&passo) == PASSO_ERROR_STUCK_HIGH);
	wire->dead = false;
	passo_engine_destroy(wire->engine);
	wire->engine = passo_engine_create(&config);
	CHECK(passo_resume(&passo) == PASSO_ERROR_CORE_RESET);
	CHECK(open_and_configure(&passo, &host, &hardware));
	CHECK(random_moves(&passo, wire));

	struct passo_move_jerk move = {.steps = {9000},
	    .speed = 80000 * PASSO_UNIT_Q32,
	    .acceleration = 20000000 * PASSO_UNIT_Q32,
	    .jerk = 4000000000 * PASSO_UNIT_Q32};
	CHECK(passo_move_jerk(&passo, &move) == PASSO_OK);
	wire->dead = true;
	CHECK(passo_abort(&passo) == PASSO_ERROR_STUCK_HIGH);
	CHECK(passo_move_jerk(&passo, &move) == PASSO_ERROR_NOT_STOPPED);
	wire->dead = false;
	CHECK(passo_wait(&passo, PASSO_S(1)) == PASSO_OK);
	CHECK(passo_clear(&passo) == PASSO_OK);
	for (uint8_t axis = 0; axis < 4; axis++)
		CHECK(passo_enable(&passo, axis, false) == PASSO_OK);
	return random_moves(&passo, wire);
}

int main(void)
{
	struct wire wire = {.engine = passo_engine_create(&config), .random = 1};
	bool good = wire.engine && scenario(&wire);

	passo_engine_destroy(wire.engine);
	if (good)
		puts("ok");
	return !good;
}
