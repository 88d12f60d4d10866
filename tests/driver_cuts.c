/* SPDX-License-Identifier: MIT
 * The driver on a link that dies at any word of any frame of any call and recovers: afterwards the state
 * assumed by the driver matches the core, or the driver reports that it is unknown and a clear restores it.
 *
 * Checked by the pins and the state of the C model. Driver, link and model are plain structs: each case
 * starts with a copy of the state before the call. Prints the number of good cases.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo.h"
#include "passo_core.h"
#include "passo_driver.h"

#define CLOCK_HZ 16000000u
#define CLOCKS_PER_MICROSECOND (CLOCK_HZ / 1000000u)
#define AXES 2u
#define TRIES 2u
#define LINE_PLACES 16u
#define LOOKS 160u     /* until all motions have ended */
#define CALM_LOOKS 12u /* consecutive ones that show it */
#define LOOK_MICROSECONDS 250u
#define DEAD_LOOKS 5u
#define LINES 25u
#define FLIGHT_CALLS 2u /* of `finish` until an exchange is over */
#define WORTH_A_JUMP 5u /* clocks */
#define COMPLAINTS_MAX 10u
#define FRAMES_MAX 8u /* frames of a call that are cut */
/* What dies: both directions between two words or within one, only MISO, only MOSI and SCLK. The host then
 * sees a constant level; the core sees one too, or no clock. */
enum kind { BOTH, BOTH_INSIDE, REPLY, REQUEST };
/* For how long: one frame; until the call returns; some polls longer. */
enum patience { ONE_FRAME, CALL, POLLS };

struct death {
	enum kind kind;
	bool high; /* level of a dead line */
	enum patience patience;
};

static const struct death DEATHS[] = {
    {BOTH, false, ONE_FRAME},
    {BOTH, false, POLLS},
    {BOTH, true, POLLS},
    {BOTH_INSIDE, true, CALL},
    {REPLY, false, ONE_FRAME},
    {REPLY, false, POLLS},
    {REPLY, true, POLLS},
    {REQUEST, false, CALL},
    {REQUEST, true, POLLS},
};

struct cut {
	unsigned frame, word; /* the first of the call is 1; 0: none */
	struct death death;
};

struct world {
	struct passo_core core;
	struct passo_host host;
	struct passo passo;
	struct cut cut;
	bool dead;
	bool dma; /* exchanges in two halves */
	struct {
		const uint32_t *send;
		uint32_t *receive;
		size_t words;  /* 0: none is under way */
		unsigned left; /* calls until it is over */
	} flight;
	uint32_t spare[PASSO_FRAME_WORDS_MAX];
	unsigned frames;
	unsigned words[1024]; /* of each frame of the call */
	uint64_t clock, step;
	uint32_t pulses[AXES];
	int32_t net[AXES];     /* pulses by direction */
	int32_t zero[AXES];    /* net, when the core's positions were set to 0 */
	unsigned lines, ramps; /* given out by the source */
};

static struct world world;

static struct passo *const passo = &world.passo;

/* ------------------------------------------------------------------------------------------- the core ----
 */

static void watch(void)
{
	const struct passo_outputs *now = passo_core_outputs(&world.core);
	const struct passo_channel *channel = &world.core.channel[0];

	for (unsigned i = 0; i < AXES; i++) {
		if ((now->step & ~world.step) >> i & 1u) {
			world.pulses[i]++;
			world.net[i] += now->dir >> i & 1u ? -1 : 1;
		}
		if (channel->registers.command_zero)
			world.zero[i] = world.net[i];
	}
	world.step = now->step;
}

static void run(const struct passo_inputs *inputs, uint64_t clocks)
{
	world.clock += clocks;
	while (clocks != 0u) {
		const uint64_t quiet =
		    clocks < WORTH_A_JUMP ? 0u : passo_core_advance(&world.core, inputs, clocks);

		clocks -= quiet;
		if (quiet == 0u) {
			passo_core_clock(&world.core, inputs);
			watch();
			clocks--;
		}
	}
}

static void rest(uint64_t microseconds)
{
	const struct passo_inputs inputs = {.spi_cs_n = true};

	run(&inputs, microseconds * CLOCKS_PER_MICROSECOND);
}

/* One chip select of `bits` bits. */
static void exchange(const uint32_t *send, uint32_t *receive, size_t bits)
{
	struct passo_inputs inputs = {.spi_cs_n = bits == 0u};
	struct passo_shift shift = {.mosi = send, .miso = receive, .bits = bits, .half_period = 2};

	run(&inputs, 4);
	while (!passo_shift_done(&shift)) {
		const uint64_t clock = shift.clock;

		passo_core_exchange(&world.core, &inputs, &shift, UINT64_MAX);
		world.clock += shift.clock - clock;
		watch();
	}
	inputs.spi_sclk = false;
	run(&inputs, 4);
	rest(20);
}

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	const struct cut *cut = &world.cut;
	const enum kind kind = cut->death.kind;
	const uint32_t level = cut->death.high ? UINT32_MAX : 0u;
	uint32_t sent[PASSO_FRAME_WORDS_MAX];
	size_t alive = words, bits = 32u * words;

	(void)context;
	if (world.frames < sizeof world.words / sizeof world.words[0])
		world.words[world.frames] = (unsigned)words;
	world.frames++;
	if (world.dead)
		alive = 0;
	else if (world.frames == cut->frame)
		alive = cut->word;
	world.dead = alive != words && cut->death.patience != ONE_FRAME;

	memcpy(sent, send, words * sizeof *send);
	if (alive != words && (kind == BOTH || kind == BOTH_INSIDE))
		bits = 32u * alive + (kind == BOTH_INSIDE ? 16u : 0u);
	for (size_t i = alive; i < words && kind == REQUEST; i++)
		sent[i] = level;
	exchange(sent, receive, bits);
	for (size_t i = alive; i < words && kind != REQUEST; i++)
		receive[i] = level;
	return true;
}

static bool dma_start(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	(void)context;
	if (world.flight.words != 0u)
		return false;
	world.flight.send = send;
	world.flight.receive = receive;
	world.flight.words = words;
	world.flight.left = FLIGHT_CALLS;
	return true;
}

static enum passo_error dma_finish(void *context)
{
	const size_t words = world.flight.words;

	if (words == 0u)
		return PASSO_OK;
	if (--world.flight.left != 0u)
		return PASSO_PENDING;
	world.flight.words = 0;
	transfer(context, world.flight.send, world.flight.receive, words);
	return PASSO_OK;
}

static uint32_t microseconds(void *context)
{
	(void)context;
	return (uint32_t)(world.clock / CLOCKS_PER_MICROSECOND);
}

static void pause(void *context, uint32_t time)
{
	(void)context;
	rest(time);
}

static void look(unsigned times)
{
	for (unsigned i = 0; i < times; i++) {
		const unsigned before = world.frames;
		passo_poll(passo);
		if (world.frames > before + 1u) {
			printf("a poll of %u frames\n", world.frames - before);
			exit(1);
		}
		rest(LOOK_MICROSECONDS);
	}
}

static bool is_busy(void)
{
	const struct passo_channel *channel = &world.core.channel[0];

	return channel->motion.state != PASSO_STATE_STOPPED
	    && (channel->motion.state != PASSO_STATE_IDLE || channel->line_queue.room != LINE_PLACES);
}

/* Polls until all motions have ended, or for a long time. */
static void look_long(void)
{
	unsigned calm = 0;

	for (unsigned i = 0; i < LOOKS && calm < CALM_LOOKS; i++) {
		look(1);
		calm = is_busy() || passo_is_moving(passo) ? 0u : calm + 1u;
	}
}

/* ------------------------------------------------------------------------------------------ the calls ----
 */

static enum passo_error open_passo(void)
{
	struct passo_hardware hardware = {
	    .transfer = transfer, .microseconds = microseconds, .wait = pause, .tries = TRIES};

	if (world.dma) {
		hardware.start = dma_start;
		hardware.finish = dma_finish;
		hardware.spare = world.spare;
	}
	const struct passo_options options = {.clock_hz = CLOCK_HZ};

	return passo_open(&world.passo, &world.host, &hardware, &options);
}

static enum passo_error configure(void)
{
	const struct passo_axis_config pins = {
	    .step_high_ns = 2000, .step_low_ns = 2000, .dir_setup_ns = 1000};
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; axis < AXES && error == PASSO_OK; axis++)
		error = passo_configure_axis(passo, axis, &pins);
	return error;
}

static enum passo_error configure_slower(void)
{
	const struct passo_axis_config pins = {
	    .step_high_ns = 3000, .step_low_ns = 5000, .dir_setup_ns = 1000, .enable_inverted = true};

	return passo_configure_axis(passo, 1, &pins);
}

static enum passo_error enable(void)
{
	return passo_enable(passo, 0, true);
}

static enum passo_error disable(void)
{
	return passo_enable(passo, 1, false);
}

static enum passo_error configure_motion(void)
{
	return passo_configure_motion(passo, passo_clocks(passo, 3000), passo_clocks(passo, 1500), 12345);
}

static enum passo_error move_steps(int32_t first, int32_t second)
{
	const struct passo_move_by_speed move = {.steps = {first, second},
	    .speed = 20000 * PASSO_UNIT_Q32,
	    .acceleration = 20000000 * PASSO_UNIT_Q32};

	return passo_move_by_speed(passo, &move);
}

static enum passo_error move(void)
{
	return move_steps(40, -30);
}

static enum passo_error move_sigmoid(void)
{
	const struct passo_move_sigmoid sigmoid = {.steps = {60, 1},
	    .speed = 20000 * PASSO_UNIT_Q32,
	    .accelerate_clocks = CLOCK_HZ / 1000,
	    .decelerate_clocks = CLOCK_HZ / 1000,
	    .alpha = 3 * 4096};

	return passo_move_sigmoid(passo, &sigmoid);
}

static enum passo_error load_table(void)
{
	static uint16_t points[PASSO_TABLE_SIZE];

	for (unsigned k = 0; k < PASSO_TABLE_SIZE; k++)
		points[k] = (uint16_t)(k * 256u);
	return passo_load_table(passo, PASSO_SHAPE_COSINE, points);
}

static enum passo_error turn(void)
{
	const struct passo_turning turning = {.axis = 0,
	    .steps_per_turn = 1000,
	    .top_rpm = 1200 * PASSO_UNIT_Q32,
	    .acceleration = 20000000 * PASSO_UNIT_Q32};

	return passo_turn_start(passo, &turning, 600 * PASSO_UNIT_Q32);
}

static enum passo_error turn_faster(void)
{
	return passo_turn_speed(passo, 1100 * PASSO_UNIT_Q32);
}

static enum passo_error turn_stop(void)
{
	return passo_turn_stop(passo);
}

static bool next_line(void *context, struct passo_line *line)
{
	(void)context;
	*line = (struct passo_line){.substeps = 32, .steps = {4, 1}, .directions = 2};
	line->last = ++world.lines == LINES;
	return true;
}

/* 32 substeps at 1/256 are 64 ticks of 128 clocks */
static bool next_ramp(void *context, struct passo_ramp *ramp)
{
	(void)context;
	*ramp =
	    (struct passo_ramp){.velocity_end = PASSO_ONE_Q48 / 256, .progress_step = PASSO_ONE_Q48 / 320};
	ramp->ticks = world.ramps == 0u ? 0u : 320u;
	ramp->last = ++world.ramps == LINES / 5u + 1u;
	return true;
}

static enum passo_error stream(void)
{
	const struct passo_source source = {next_line, next_ramp, NULL};

	world.lines = world.ramps = 0;
	return passo_stream(passo, &source);
}

static enum passo_error poll_stream(void)
{
	enum passo_error error = PASSO_OK;

	for (unsigned i = 0; i < 100u && error == PASSO_OK && passo_is_streaming(passo); i++) {
		error = passo_poll(passo);
		rest(100);
	}
	return error;
}

static enum passo_error wait(void)
{
	return passo_wait(passo, passo_clocks(passo, 60000));
}

static enum passo_error stream_start(void)
{
	return passo_stream_start(passo);
}

static enum passo_error hold(void)
{
	return passo_hold(passo);
}

static enum passo_error resume(void)
{
	return passo_resume(passo);
}

static enum passo_error slower(void)
{
	return passo_override(passo, 60);
}

static enum passo_error faster(void)
{
	return passo_override(passo, 100);
}

static enum passo_error stop(void)
{
	return passo_stop(passo);
}

static enum passo_error hard_stop(void)
{
	return passo_abort(passo);
}

static enum passo_error clear(void)
{
	return passo_clear(passo);
}

static enum passo_error zero(void)
{
	return passo_zero(passo);
}

static enum passo_error sync_on(void)
{
	return passo_wait_for_sync(passo, true);
}

static enum passo_error sync_off(void)
{
	return passo_wait_for_sync(passo, false);
}

static enum passo_error read_all(void)
{
	struct passo_snapshot snapshot;
	int32_t positions[AXES];
	uint64_t rpm;
	enum passo_error error = passo_read_state(passo, &snapshot);

	if (error == PASSO_OK)
		error = passo_positions(passo, positions);
	return error == PASSO_OK ? passo_rpm(passo, 1000, &rpm) : error;
}

/* ------------------------------------------------------------------------------------- the situations ----
 */

static void start(void)
{
	const struct passo_parameters parameters = {
	    .channels = 1, .axes = AXES, .tick_log2 = 7, .line_queue_log2 = 4, .ramp_queue_log2 = 4};

	memset(&world, 0, sizeof world);
	passo_core_reset(&world.core, &parameters);
	rest(1);
}

static void must(enum passo_error error, const char *what)
{
	if (error == PASSO_OK)
		return;
	printf("%s: %s\n", what, passo_error_name(error));
	exit(1);
}

static void at_rest_by(bool dma)
{
	start();
	world.dma = dma;
	must(open_passo(), "open");
	must(configure(), "configure");
	for (uint8_t axis = 0; axis < AXES; axis++)
		must(passo_enable(passo, axis, axis == 1u), "enable");
	must(passo_configure_motion(passo, passo_clocks(passo, 300), passo_clocks(passo, 300), 0),
	    "configure motion");
	must(move_steps(3, 5), "first move");
	look(20);
}

static void at_rest(void)
{
	at_rest_by(false);
}

static void at_rest_dma(void)
{
	at_rest_by(true);
}

static void in_motion(void)
{
	at_rest();
	for (unsigned i = 0; i < 3u; i++)
		must(move_steps(90, -60), "move");
	rest(2000);
}

static void is_held(void)
{
	in_motion();
	must(hold(), "hold");
	rest(2000);
}

static void is_slow(void)
{
	in_motion();
	must(passo_override(passo, 40), "override");
	rest(2000);
}

static void turns(void)
{
	at_rest();
	must(turn(), "turn");
	rest(5000);
}

static void is_stopped(void)
{
	in_motion();
	must(hard_stop(), "abort");
	look(3);
}

static void is_stopped_and_held(void)
{
	is_held();
	must(stop(), "stop");
	look(10);
}

static void is_broken(void)
{
	at_rest();
	world.frames = 0;
	world.cut = (struct cut){3, 2, {BOTH, false, CALL}};
	move();
	world.dead = false;
}

static void waits_for_sync(void)
{
	at_rest();
	must(sync_on(), "sync");
	must(move(), "move");
	rest(1000);
}

static void fill(void)
{
	must(stream(), "stream");
	for (unsigned i = 0; i < 2u; i++)
		must(passo_poll(passo), "poll");
}

static void stream_fills(void)
{
	at_rest();
	fill();
}

/* A frame is on the wire, and the next one is prepared. */
static void stream_fills_dma(void)
{
	at_rest_dma();
	fill();
	must(world.flight.words != 0u && world.host.prepared != 0u ? PASSO_OK : PASSO_ERROR_NOT_PREPARED,
	    "a frame ahead");
}

static void go_on_streaming(void)
{
	must(stream(), "stream");
	for (unsigned i = 0; i < 12u; i++) {
		must(passo_poll(passo), "poll");
		rest(100);
	}
}

static void stream_runs(void)
{
	at_rest();
	go_on_streaming();
}

static void stream_runs_dma(void)
{
	at_rest_dma();
	go_on_streaming();
}

static const struct {
	const char *name;
	void (*before)(void);
	enum passo_error (*call)(void);
} CALLS[] = {
    {"open", start, open_passo},
    {"open at rest", at_rest, open_passo},
    {"open in motion", in_motion, open_passo},
    {"open stopped", is_stopped, open_passo},
    {"open while a stream fills", stream_fills, open_passo},
    {"configure_axis", at_rest, configure_slower},
    {"enable", at_rest, enable},
    {"disable", at_rest, disable},
    {"configure_motion", at_rest, configure_motion},
    {"move", at_rest, move},
    {"move in motion", in_motion, move},
    {"move held", is_held, move},
    {"move with table", at_rest, move_sigmoid},
    {"load_table", at_rest, load_table},
    {"turn_start", at_rest, turn},
    {"turn_speed", turns, turn_faster},
    {"turn_stop", turns, turn_stop},
    {"stream", at_rest, stream},
    {"stream fills", stream_fills, poll_stream},
    {"stream_start", stream_fills, stream_start},
    {"stream runs", stream_runs, poll_stream},
    {"wait", in_motion, wait},
    {"hold", in_motion, hold},
    {"hold while a stream runs", stream_runs, hold},
    {"hold while turning", turns, hold},
    {"resume", is_held, resume},
    {"override, slower", in_motion, slower},
    {"override, faster", is_slow, faster},
    {"override while held", is_held, slower},
    {"stop", in_motion, stop},
    {"stop at rest", at_rest, stop},
    {"stop while held", is_held, stop},
    {"stop while turning", turns, stop},
    {"stop while a stream fills", stream_fills, stop},
    {"stop while a stream runs", stream_runs, stop},
    {"abort", in_motion, hard_stop},
    {"abort while a stream runs", stream_runs, hard_stop},
    {"clear", is_stopped, clear},
    {"clear while held", is_stopped_and_held, clear},
    {"clear after a broken move", is_broken, clear},
    {"clear while a stream fills", stream_fills, clear},
    {"zero", at_rest, zero},
    {"wait_for_sync", in_motion, sync_on},
    {"wait_for_sync off", waits_for_sync, sync_off},
    {"read", in_motion, read_all},
    {"move by DMA", at_rest_dma, move},
    {"open while a stream fills by DMA", stream_fills_dma, open_passo},
    {"stream by DMA fills", stream_fills_dma, poll_stream},
    {"stream_start by DMA", stream_fills_dma, stream_start},
    {"stream by DMA runs", stream_runs_dma, poll_stream},
    {"hold while a stream runs by DMA", stream_runs_dma, hold},
    {"hold while a stream fills by DMA", stream_fills_dma, hold},
    {"stop while a stream fills by DMA", stream_fills_dma, stop},
    {"stop while a stream runs by DMA", stream_runs_dma, stop},
    {"abort while a stream fills by DMA", stream_fills_dma, hard_stop},
    {"clear while a stream fills by DMA", stream_fills_dma, clear},
};

/* ----------------------------------------------------------------------------------------- the judges ----
 */

/* State of the core that a call may change. */
struct effect {
	uint32_t rate_target, rate_slew, stop_slew, drain_velocity;
	uint8_t run, wait_sync;
	uint16_t times[AXES][4];
	uint8_t pins[AXES];
	uint64_t enable;
	uint16_t points[PASSO_BANKS][PASSO_BANK_POINTS];
	uint32_t held_tables[3]; /* as the host believes */
	uint32_t pulses[AXES];
	bool stopped;
};

static struct effect before, after;

static struct effect effect_now(void)
{
	const struct passo_channel *channel = &world.core.channel[0];
	struct effect effect;

	memset(&effect, 0, sizeof effect);
	effect.rate_target = channel->registers.rate_target;
	effect.rate_slew = channel->registers.rate_slew;
	effect.stop_slew = channel->registers.stop_slew;
	effect.drain_velocity = channel->registers.drain_velocity;
	effect.run = world.core.registers.run;
	effect.wait_sync = world.core.registers.wait_sync;
	for (unsigned i = 0; i < AXES; i++) {
		const struct passo_axis_settings *axis = &channel->axis[i].settings;
		const uint16_t times[] = {axis->step_high, axis->step_low, axis->dir_setup, axis->dir_hold};

		memcpy(effect.times[i], times, sizeof times);
		effect.pins[i] = (uint8_t)(axis->step_inverted | axis->direction_inverted << 1
		                           | axis->enable_inverted << 2 | axis->both_edges << 3);
		effect.pulses[i] = world.pulses[i];
	}
	effect.enable = passo_core_outputs(&world.core)->enable;
	memcpy(effect.points, world.core.tables.points, sizeof effect.points);
	memcpy(effect.held_tables, world.host.table, sizeof effect.held_tables);
	effect.stopped = channel->motion.state == PASSO_STATE_STOPPED;
	return effect;
}

static const char *bad; /* what was wrong, first */

static void judge(bool good, const char *what)
{
	if (!good && !bad)
		bad = what;
}

static bool is_known(void)
{
	return passo->assumed == PASSO_ASSUMED_READY;
}

/* Checks that the state assumed by the driver matches the core. */
static void judge_assumed(void)
{
	const struct passo_channel *channel = &world.core.channel[0];
	const struct effect now = effect_now();

	for (unsigned i = 0; i < AXES; i++)
		judge(world.net[i] - world.zero[i] == (int32_t)channel->axis[i].position,
		    "position is the pulses");
	for (unsigned bank = 0; bank < 3u; bank++) {
		if (now.held_tables[bank] == 0u)
			continue;
		judge(now.held_tables[bank] == before.held_tables[bank]
			  ? memcmp(now.points[bank], before.points[bank], sizeof now.points[bank]) == 0
			  : now.held_tables[bank] == after.held_tables[bank]
		                && memcmp(now.points[bank], after.points[bank], sizeof now.points[bank]) == 0,
		    "tables");
	}
	if (passo->assumed == PASSO_ASSUMED_NOT_OPEN)
		return;
	judge(passo_fault(passo) != PASSO_ERROR_NOT_STOPPED && passo_fault(passo) != PASSO_ERROR_NOT_HELD,
	    "all is acknowledged");
	judge((now.run | (uint32_t)now.wait_sync << 8) == (world.host.run & 0xFFFFu), "RUN");
	judge(!is_known() || !now.stopped, "a stop is known");
	judge(passo->assumed != PASSO_ASSUMED_STOPPED || now.stopped, "a stop was executed");
	if (passo_driver_is_broken(passo))
		return; /* nothing is claimed */
	judge(now.rate_target == passo_driver_rate(passo), "rate");
	judge(passo_is_moving(passo) == is_busy(), "is moving");
	for (unsigned i = 0; i < AXES; i++) {
		const struct passo_axis_memory *axis = &passo->axis[i];

		judge(axis->shortest_clocks == 0u
		          || axis->shortest_clocks == (uint32_t)(now.times[i][0] + now.times[i][1]),
		    "pin times");
		judge(passo_is_moving(passo) || passo_driver_is_stopped(passo)
		          || axis->expected == (int32_t)channel->axis[i].position,
		    "expected position");
	}
	judge(!is_known() || passo->stream != PASSO_STREAM_NONE || now.run == 1u || !is_busy(), "the gate");
}

/* Each item is as before or as after the call; as after it if the call succeeded. */
static void judge_effect(enum passo_error error, bool is_motion_free)
{
	const struct effect now = effect_now();

#define IS(member, as) (memcmp(&now.member, &(as).member, sizeof now.member) == 0)
#define JUDGE(member)                                                                                        \
	judge(IS(member, after) || (error != PASSO_OK && IS(member, before)), "effect on " #member)
	JUDGE(rate_slew);
	JUDGE(stop_slew);
	JUDGE(drain_velocity);
	JUDGE(times);
	JUDGE(pins);
	JUDGE(enable);
	if (error == PASSO_OK) {
		JUDGE(rate_target);
		JUDGE(wait_sync);
		JUDGE(points);
		/* a stream that could not be fed is stopped */
		if (!passo_driver_is_broken(passo))
			JUDGE(stopped);
	}
	/* restraining commands take effect late, others do not */
	if (error != PASSO_OK && passo->assumed != PASSO_ASSUMED_NOT_OPEN) {
		judge(
		    now.rate_target
		        == (before.rate_target < after.rate_target ? before.rate_target : after.rate_target),
		    "the slower rate");
		judge(now.wait_sync == (before.wait_sync | after.wait_sync), "sync");
	}
	if (is_motion_free)
		JUDGE(pulses);
#undef JUDGE
#undef IS
}

/* Recovery as in a program: in the end the driver makes a move with exactly its steps. */
static void judge_recovery(void)
{
	uint32_t pulses[AXES];
	int32_t net[AXES];
	enum passo_error error = PASSO_OK;

	if (passo->assumed == PASSO_ASSUMED_NOT_OPEN)
		error = open_passo();
	judge(error == PASSO_OK || error == PASSO_ERROR_MOVING, "open again");
	if (!is_known()) {
		if (passo_clear(passo) == PASSO_ERROR_MOVING) {
			judge(passo_stop(passo) == PASSO_OK, "stop");
			look_long();
		}
		judge(is_known() || passo_clear(passo) == PASSO_OK, "clear");
	}
	judge(sync_off() == PASSO_OK && faster() == PASSO_OK && resume() == PASSO_OK, "resume");
	if (passo_driver_is_turning(passo))
		passo_turn_stop(passo);
	if (passo->stream == PASSO_STREAM_FILLS)
		poll_stream();
	look_long();
	judge(!passo_is_moving(passo), "it ends");
	judge(configure() == PASSO_OK, "configure");
	memcpy(pulses, world.pulses, sizeof pulses);
	memcpy(net, world.net, sizeof net);
	judge(move_steps(7, -5) == PASSO_OK, "a move is taken");
	look_long();
	judge(!passo_is_moving(passo) && passo_fault(passo) < PASSO_ERROR_LINE_UNDERRUN, "the move ends");
	judge(world.pulses[0] == pulses[0] + 7u && world.pulses[1] == pulses[1] + 5u
	          && world.net[0] == net[0] + 7 && world.net[1] == net[1] - 5,
	    "the move is made");
	judge_assumed();
}

/* Plays a call and what follows it, for a long time. */
static enum passo_error play(enum passo_error (*call)(void), const struct cut *cut)
{
	world.cut = *cut;
	world.frames = 0;
	world.dead = false;
	enum passo_error error = call();
	judge(passo->assumed == PASSO_ASSUMED_NOT_OPEN || !is_busy() || passo_is_moving(passo),
	    "what moves is known");
	const unsigned frames = world.frames;
	if (world.dead && cut->death.patience == POLLS)
		look(DEAD_LOOKS);
	world.cut.frame = 0;
	world.dead = false;
	look_long();
	world.frames = frames;
	return error;
}

static unsigned cases, complaints;

static void complain(const char *name, const struct cut *cut, enum passo_error error)
{
	static const char *const KIND[] = {"both", "both, inside a word", "reply", "request"};
	static const char *const PATIENCE[] = {"one frame", "the call", "some polls"};

	if (++complaints <= COMPLAINTS_MAX)
		printf("%s: not so: %s; %s, frame %u, word %u, %s dies, level %u, for %s\n", name, bad,
		    passo_error_name(error), cut->frame, cut->word, KIND[cut->death.kind], cut->death.high,
		    PATIENCE[cut->death.patience]);
}

static void play_all(const char *name, void (*prepare)(void), enum passo_error (*call)(void))
{
	static struct world begin;
	static unsigned words[1024];
	struct cut cut = {0};

	prepare();
	world.cut = cut;
	begin = world;
	look_long(); /* as if there were no call */
	before = after = effect_now();
	world = begin;
	enum passo_error wanted = play(call, &cut);
	after = effect_now();
	const unsigned frames = world.frames < FRAMES_MAX ? world.frames : FRAMES_MAX;
	memcpy(words, world.words, sizeof words);

	for (cut.frame = 1; cut.frame <= frames; cut.frame++) {
		const unsigned count = words[cut.frame - 1u];
		for (cut.word = 0; cut.word < count; cut.word++) {
			/* of a long payload, its beginning and its end */
			if (cut.word > 3u && cut.word + 5u < count)
				continue;
			for (unsigned n = 0; n < sizeof DEATHS / sizeof DEATHS[0]; n++) {
				cut.death = DEATHS[n];
				bad = NULL;
				world = begin;
				enum passo_error error = play(call, &cut);
				judge_assumed();
				if (error != wanted)
					judge(passo_driver_is_link_error(error), "a link error");
				if (call == stop || call == hard_stop || call == turn_stop)
					judge(!is_busy(), "it stops");
				judge_effect(error == wanted ? PASSO_OK : error,
				    !is_busy() && !passo_driver_is_turning(&begin.passo)
				        && !passo_driver_is_stopped(passo) && !after.stopped
				        && !before.stopped);
				judge_recovery();
				cases++;
				if (bad)
					complain(name, &cut, error);
			}
		}
	}
}

/* Arguments: the name of a call; or n and m: the calls n, n + m, n + 2 m ...; none: all. */
int main(int count, char **arguments)
{
	const unsigned step = count > 2 ? (unsigned)atoi(arguments[2]) : 1u;

	for (unsigned i = count > 2 ? (unsigned)atoi(arguments[1]) : 0u; i < sizeof CALLS / sizeof CALLS[0];
	    i += step) {
		const unsigned before_this = cases;

		if (count == 2 && strcmp(arguments[1], CALLS[i].name) != 0)
			continue;
		play_all(CALLS[i].name, CALLS[i].before, CALLS[i].call);
		printf("%s: %u\n", CALLS[i].name, cases - before_this);
	}
	printf("%u of %u\n", cases - complaints, cases);
	return complaints != 0u;
}
