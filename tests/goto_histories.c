/* SPDX-License-Identifier: MIT
 * Random histories of passo_goto() on the C model: changes at random times by a host that is late, that is
 * interrupted within a call, or that sends nothing anymore, between two words of a frame too.
 *
 * The judge sees the pulses and the calls, nothing of planner, driver or model: between two calls the axis
 * stays between where it was and the target, or where it can just come to rest; three steps never show more
 * acceleration than allowed; it ends on the target, or rests on the way without a fault if no frame
 * comes. Prints the number of good histories and the worst that was seen.
 */
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo.h"
#include "passo_engine.h"
#include "passo_goto.h"

#define CLOCK_HZ 16000000u
#define MICROSECOND (CLOCK_HZ / 1000000u)
#define AXIS 1u
#define STEPS_MAX 400000u
#define SPANS 8u /* the judge compares 1, 2, 4 ... steps with as many after them */
#define TICK (128.0 / CLOCK_HZ)

static const struct passo_engine_config config = {
    .core = {.channels = 1, .axes = 2, .tick_log2 = 7, .line_queue_log2 = 4, .ramp_queue_log2 = 4},
    .clock_hz = CLOCK_HZ,
    .spi_half_period = 2};

static struct {
	struct passo_engine *engine;
	struct passo_host host;
	struct passo passo;
	struct passo_goto go;
	uint32_t random;
	uint64_t step_before;
	double time[STEPS_MAX]; /* of each step, seconds */
	signed char way[STEPS_MAX];
	unsigned steps;
	int32_t position, low, high; /* the axis has to stay from low to high */
	double limit;                /* steps/s^2, with what hold and override add */
	double late, top;
	int32_t pins_wait;   /* steps that may wait for the pins */
	unsigned interrupts; /* one in this number of frames waits; 0: none */
	bool covered;        /* none of them is longer than late_clocks */
	unsigned cut;        /* frames until the host fails in one of them; 0: never */
	jmp_buf death;
} world;

static struct {
	double acceleration, reaction;
	unsigned changes, kept, late, silent, deaths;
} seen;

static const char *fault;

static uint32_t draw(uint32_t most)
{
	world.random = world.random * 1664525u + 1013904223u;
	return (uint32_t)((uint64_t)(world.random >> 4) * most >> 28);
}

static double between(double low, double high)
{
	return low * pow(high / low, draw(1u << 16) / 65536.0);
}

static void blame(const char *what)
{
	if (!fault)
		fault = what;
}

static void collect(void)
{
	struct passo_pin_event events[256];
	size_t count;

	while ((count = passo_engine_drain(world.engine, events, 256)) != 0u) {
		for (size_t i = 0; i < count; i++) {
			if ((events[i].step & ~world.step_before) >> AXIS & 1u) {
				const int way = (events[i].dir >> AXIS & 1u) != 0u ? -1 : 1;
				if (world.steps == STEPS_MAX)
					exit(printf("too many steps\n"));
				world.time[world.steps] = (double)events[i].clock / CLOCK_HZ;
				world.way[world.steps++] = (signed char)way;
				world.position += way;
				if (world.position < world.low || world.position > world.high)
					blame("beyond the target");
			}
			world.step_before = events[i].step;
		}
	}
}

static void pass(double seconds)
{
	uint64_t left = (uint64_t)(seconds * CLOCK_HZ);

	while (left != 0u) {
		left -= passo_engine_run(world.engine, left);
		collect();
	}
}

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	(void)context;
	if (world.cut != 0u && --world.cut == 0u) {
		passo_engine_transfer(world.engine, send, receive, draw((uint32_t)words + 1u), 64);
		collect();
		longjmp(world.death, 1);
	}
	if (world.interrupts != 0u && draw(world.interrupts) == 0u)
		pass(between(1e-5, 0.01));
	passo_engine_transfer(world.engine, send, receive, words, 64);
	collect();
	return true;
}

static uint32_t microseconds(void *context)
{
	(void)context;
	return (uint32_t)(passo_engine_clock(world.engine) / MICROSECOND);
}

static double now(void)
{
	return (double)passo_engine_clock(world.engine) / CLOCK_HZ;
}

/* -------------------------------------------------------------------------------------------- judge ---- */

/* What the axis needs to come to rest from a speed that keeps rising until the core has the command. */
static int32_t way_to_rest(double speed, double acceleration)
{
	const double high = fmin(speed + acceleration * world.late, world.top * 1.001);

	return (int32_t)(high * high / acceleration / 2 + high * (world.late + 8 * TICK)) + 6;
}

/* The axis has been told to go somewhere, or to rest. What it needs to come to rest is allowed, toward where
 * it goes; on both sides while that cannot be seen. */
static void allow(int32_t target, double acceleration)
{
	const double *t = world.time + world.steps;
	const signed char *way = world.way + world.steps;
	const int32_t at = world.position;
	int32_t below = way_to_rest(5 * sqrt(acceleration), acceleration), above = below;

	const double interval = world.steps > 1u ? t[-1] - t[-2] : 1;
	if (world.steps > 1u && way[-1] == way[-2] && now() - t[-1] < 2 * interval
	    && 1 / interval > 4 * sqrt(acceleration)) {
		const double speed = 1 / interval + acceleration * (interval + now() - t[-1]);
		/* with hold and override the speed before the time scale is unknown */
		const int32_t most =
		    way_to_rest(world.limit > acceleration ? world.top : speed, acceleration);
		below = way[-1] < 0 ? most : world.pins_wait;
		above = way[-1] > 0 ? most : world.pins_wait;
	} else if (world.limit > acceleration) {
		below = above = way_to_rest(world.top, acceleration);
	}
	world.low = target < at - below ? target : at - below;
	world.high = target > at + above ? target : at + above;
}

/* Steps that wait for the pins do not show the speed, and a host that is later than it has told may be too
 * quick. Otherwise: mean speeds over (i, j) and (j, k) differ by at most acceleration (k - i) / 2. Edges are
 * on whole clocks, the speed changes once in a tick. */
static void judge_speeds(void)
{
	double most = 0;

	if (world.pins_wait != 0 || (world.interrupts != 0u && !world.covered))
		return;
	for (unsigned i = 0; i + 1u < world.steps; i++) {
		const double *t = world.time;
		const bool begins = i == 0u || world.way[i - 1u] != world.way[i];
		const bool ends = i + 2u == world.steps || world.way[i + 2u] != world.way[i];
		if (world.way[i] == world.way[i + 1u] && (begins || ends)
		    && 1 / (t[i + 1u] - t[i] + 1.0 / CLOCK_HZ)
		           > 1.75 * sqrt(world.limit) + 2 * world.limit * TICK)
			blame("starts or ends at speed");
		for (unsigned span = 1; span <= 1u << SPANS && i + 2u * span < world.steps; span *= 2u) {
			const unsigned j = i + span, k = j + span;
			unsigned n = i;
			while (n < k && world.way[n] == world.way[k])
				n++;
			if (n != k)
				break;
			const double v = span / (t[j] - t[i]), w = span / (t[k] - t[j]);
			/* with a rate r edges are 1 / r clocks apart, at most top / v */
			const bool scaled = world.limit > (double)(world.go.acceleration >> 32);
			const double clock = (scaled ? (v + w) * world.top : v * v + w * w) / span / CLOCK_HZ;
			const double excess = fabs(w - v) - clock - 2 * world.limit * TICK;
			most = fmax(most, excess / (world.limit * (t[k] - t[i]) / 2));
		}
	}
	if (most > 1.0)
		blame("accelerates too much");
	seen.acceleration = fmax(seen.acceleration, most);
}

/* Where the way is long, the axis goes on at its speed, or at the new one if that is lower. */
static double speed_to_keep(const struct passo_goto *wanted, double acceleration)
{
	const double *t = world.time + world.steps;
	const signed char *way = world.way + world.steps;
	const double far = fabs((double)wanted->target - world.position);

	if (world.steps < 3u || way[-1] != way[-2] || (wanted->target > world.position) != (way[-1] > 0))
		return 0;
	const double interval = t[-1] - t[-2];
	if (now() - t[-1] > 2 * interval || 1 / interval < 4 * sqrt(acceleration)
	    || far < 2 * world.top * world.top / acceleration + 0.03 * world.top)
		return 0;
	return fmin(1 / interval, (double)(wanted->speed >> 32));
}

static void judge_keeping(double speed)
{
	const int32_t before = world.position;

	pass(0.01);
	if (abs(world.position - before) < speed * 0.01 * 0.97 - 2)
		blame("stops on the way");
	seen.kept++;
}

/* ---------------------------------------------------------------------------------------- histories ---- */

static int32_t some_target(void)
{
	const int32_t at = world.position, far = (int32_t)between(1, world.top * 0.3);
	const int32_t stop = (int32_t)(world.top * world.top / (double)(world.go.acceleration >> 32) / 2);

	switch (draw(7)) {
	case 0:
		return world.go.target; /* the same */
	case 1:
		return at; /* where it is */
	case 2:
		return world.go.target + (int32_t)draw(61) - 30;
	case 3:
		return at + (draw(2) != 0u ? stop : -stop) + (int32_t)draw(81) - 40;
	case 4:
		return at + (world.go.target > at ? 5 : -5) * stop; /* far ahead */
	default:
		return at + (draw(2) != 0u ? far : -far);
	}
}

/* The host was too slow: it stopped on its path. */
static void begin_again(void)
{
	struct passo *passo = &world.passo;

	for (unsigned polls = 0; polls < 5000u && passo_is_moving(passo); polls++) {
		passo_poll(passo);
		pass(0.001);
	}
	if (passo_clear(passo) != PASSO_OK)
		blame("cannot be cleared");
}

static void command(void)
{
	struct passo_goto wanted = world.go;
	const double began = now(), acceleration = (double)(wanted.acceleration >> 32);
	const int32_t low = world.low, high = world.high;

	wanted.target = some_target();
	if (draw(2) == 0u)
		wanted.speed = (uint64_t)between(world.top / 8, world.top) << 32;
	allow(wanted.target, acceleration);
	const int32_t new_low = world.low, new_high = world.high;
	world.low = low < new_low ? low : new_low; /* until the call returns */
	world.high = high > new_high ? high : new_high;
	const double kept = world.limit > acceleration ? 0 : speed_to_keep(&wanted, acceleration);
	const enum passo_error error = passo_goto(&world.passo, &wanted);
	if (error == PASSO_OK) {
		world.go = wanted;
		world.low = new_low;
		world.high = new_high;
		seen.changes++;
		if (world.interrupts == 0u)
			seen.reaction = fmax(seen.reaction, now() - began);
		if (kept > 0)
			judge_keeping(kept);
	} else if (error == PASSO_ERROR_LATE && world.interrupts != 0u && !world.covered) {
		seen.late++;
		if (passo_fault(&world.passo) != PASSO_OK || !passo_is_moving(&world.passo)
		    || world.passo.assumed != PASSO_ASSUMED_READY)
			begin_again();
	} else {
		blame(passo_error_name(error));
	}
}

static void full_rate(void)
{
	passo_resume(&world.passo);
	passo_override(&world.passo, 100);
}

static void cancel(void)
{
	const double acceleration = (double)(world.go.acceleration >> 32);

	allow(world.position, acceleration);
	if (passo_jog_cancel(&world.passo) != PASSO_OK)
		blame("cannot be canceled");
	full_rate();
	for (unsigned polls = 0; polls < 5000u && passo_is_moving(&world.passo); polls++) {
		passo_poll(&world.passo);
		pass(0.001);
	}
	world.go.target = world.position;
}

/* The influences of other calls; they add the same acceleration once more. */
static void influence(void)
{
	struct passo *passo = &world.passo;

	switch (draw(8)) {
	case 0:
		passo_hold(passo);
		break;
	case 1:
		passo_override(passo, 1u + draw(100));
		break;
	case 2:
		cancel();
		break;
	default:
		passo_resume(passo);
	}
}

static void until_rest(void)
{
	unsigned steps;

	do {
		steps = world.steps;
		pass(0.1);
	} while (steps != world.steps);
	if (passo_engine_running(world.engine) != 0u)
		blame("does not come to rest");
}

static void open_core(bool first)
{
	const struct passo_hardware hardware = {.transfer = transfer, .microseconds = microseconds};
	/* in some, three steps wait for the pins */
	const double acceleration = (double)(world.go.acceleration >> 32);
	const uint32_t setup =
	    draw(8) == 0u ? (uint32_t)fmin(60000, sqrt(2 * 2.5 / acceleration) * CLOCK_HZ) : 10u;
	const struct passo_axis_config pins = {16, 16, setup, 10, .in_clocks = true};
	struct passo *passo = &world.passo;
	const uint64_t slew = (uint64_t)(world.top / acceleration * CLOCK_HZ);

	if (passo_open(passo, &world.host, &hardware, &(struct passo_options){.clock_hz = CLOCK_HZ})
	        != PASSO_OK
	    || passo_snapshot(passo)->cause != PASSO_CAUSE_NONE)
		blame("does not open");
	if (!first)
		return;
	world.pins_wait = setup > 10u ? 5 : 0;
	passo_configure_axis(passo, AXIS, &pins);
	passo_enable(passo, AXIS, true);
	passo_configure_motion(passo, slew, slew, 0);
}

static void go_on(unsigned events, bool influences)
{
	static const double patience[] = {1e-4, 1e-3, 1e-2, 0.2};
	const double lateness = patience[draw(4)];

	for (unsigned n = 0; n < events; n++) {
		if (!fault)
			command();
		for (unsigned polls = draw(40); polls > 0u && !fault; polls--) {
			pass(between(2e-5, lateness));
			if (influences && draw(20) == 0u)
				influence();
			const enum passo_error error = passo_poll(&world.passo);
			if (error != PASSO_OK)
				blame(passo_error_name(error));
		}
	}
}

static void arrive(void)
{
	full_rate();
	for (unsigned polls = 0; passo_is_moving(&world.passo) && !fault; polls++) {
		if (passo_poll(&world.passo) != PASSO_OK || polls > 100000u)
			blame("does not arrive");
		pass(0.0005);
	}
	if (world.position != world.go.target)
		blame("rests elsewhere");
}

static void fall_silent(void)
{
	struct passo_snapshot snapshot;

	full_rate();
	until_rest();
	if (passo_read_state(&world.passo, &snapshot) != PASSO_OK || snapshot.state != PASSO_STATE_IDLE
	    || snapshot.cause != PASSO_CAUSE_NONE)
		blame("stopped with a fault");
	seen.silent++;
}

static bool history(uint32_t seed)
{
	const volatile unsigned kind = seed % 5u;

	memset(&world, 0, sizeof world);
	fault = NULL;
	world.random = seed * 2654435761u + 1u;
	world.engine = passo_engine_create(&config);
	world.top = floor(between(2000, 100000));
	world.late = 0.001;
	const double acceleration = floor(between(5, 100) * world.top);
	world.go = (struct passo_goto){.axis = AXIS,
	    .speed = (uint64_t)world.top << 32,
	    .top_speed = (uint64_t)world.top << 32,
	    .acceleration = (uint64_t)acceleration << 32};
	world.limit = kind == 1u || kind == 2u ? 2 * acceleration : acceleration;
	open_core(true);
	if (kind == 2u) {
		world.interrupts = 2u + draw(30);
		world.late = 0.1;
		world.covered = draw(2) == 0u;
		if (world.covered)
			world.go.late_clocks = CLOCK_HZ / 10u;
	}
	if (kind == 3u)
		world.cut = 1u + draw(60);
	if (setjmp(world.death) == 0) {
		go_on(1u + draw(12), kind == 1u);
		if (!fault && draw(3) == 0u)
			fall_silent();
		if (!fault)
			arrive();
	} else {
		until_rest();
		open_core(false);
		seen.deaths++;
	}
	judge_speeds();
	passo_engine_destroy(world.engine);
	if (fault)
		printf("history %u: %s; at %d from %d to %d\n", (unsigned)seed, fault, (int)world.position,
		    (int)world.low, (int)world.high);
	return fault == NULL;
}

int main(int count, char **arguments)
{
	const unsigned first = count > 1 ? (unsigned)atoi(arguments[1]) : 0u;
	const unsigned histories = count > 2 ? (unsigned)atoi(arguments[2]) : 100u;
	unsigned good = 0;

	for (unsigned seed = first; seed < first + histories; seed++)
		good += history(seed) ? 1u : 0u;
	printf("%u good, %u changes, %u at speed, %u late, %u silent, %u deaths, acceleration %.4f, reaction "
	       "%.3f ms\n",
	    good, seen.changes, seen.kept, seen.late, seen.silent, seen.deaths, seen.acceleration,
	    seen.reaction * 1000);
	return good != histories;
}
