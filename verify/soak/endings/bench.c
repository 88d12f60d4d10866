/* SPDX-License-Identifier: MIT */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "passo_words.h"

#define EVENTS 256u
#define PATIENCE_S 20u
#define HALF_PERIOD 2u
#define GAP 64u
#define BITS 32u
#define FRAME_MARGIN 100u
#define COUNT_CLOCKS 8u

static const struct passo_engine_config machine = {.core = {.channels = 1,
						       .axes = AXES,
						       .line_queue_log2 = 5,
						       .ramp_queue_log2 = 5,
						       .inputs = 1,
						       .encoders = 1,
						       .outputs = 1,
						       .raster = 1,
						       .compare = 1},
    .clock_hz = CLOCK_HZ,
    .spi_half_period = HALF_PERIOD};

uint32_t bench_draw(struct bench *bench, uint32_t below)
{
	bench->random = bench->random * 1664525u + 1013904223u;
	return (uint32_t)((uint64_t)(bench->random >> 4) * below >> 28);
}

double bench_between(struct bench *bench, double low, double high)
{
	return low * pow(high / low, bench_draw(bench, 1u << 16) / 65536.0);
}

void bench_blame(struct bench *bench, const char *what, long a, long b)
{
	if (bench->fault)
		return;
	bench->fault = what;
	bench->values[0] = a;
	bench->values[1] = b;
}

void bench_must(struct bench *bench, const char *what, enum passo_error error)
{
	if (error != PASSO_OK) {
		bench_blame(bench, what, (long)error, 0);
		bench_blame(bench, passo_error_name(error), 0, 0);
	}
}

uint64_t bench_clock(const struct bench *bench)
{
	return passo_engine_clock(bench->engine);
}

static void see(struct bench *bench, const struct passo_pin_event *now)
{
	for (unsigned a = 0; a < AXES; a++) {
		const int way = (now->dir >> a & 1u) != 0u ? -1 : 1;
		if (((now->step & ~bench->pins.step) >> a & 1u) != 0u
		    && !pulses_add(&bench->axis[a], now->clock, way))
			bench_blame(bench, "too many steps for the judge", (long)a, 0);
	}
	bench->compares += (now->compare & ~bench->pins.compare & 1u) != 0u;
	if ((now->power & ~bench->pins.power & 1u) != 0u)
		bench->powered = now->clock;
	bench->pins = *now;
}

static void collect(struct bench *bench)
{
	struct passo_pin_event events[EVENTS];
	size_t count;

	while ((count = passo_engine_drain(bench->engine, events, EVENTS)) != 0u)
		for (size_t i = 0; i < count; i++)
			see(bench, &events[i]);
}

/* The spindle turns by a count. */
static void turn(struct bench *bench)
{
	static const uint64_t a[] = {0, 1, 1, 0}, b[] = {0, 0, 1, 1};
	const unsigned phase = ++bench->spindle % 4u;

	passo_engine_set(bench->engine, PASSO_INPUT_ENCODER_A, a[phase] << SPINDLE);
	passo_engine_set(bench->engine, PASSO_INPUT_ENCODER_B, b[phase] << SPINDLE);
	bench->spindle_next += bench->spindle_period;
}

void bench_run(struct bench *bench, uint64_t clocks)
{
	const uint64_t end = bench_clock(bench) + clocks;

	while (bench_clock(bench) < end) {
		uint64_t left = end - bench_clock(bench);

		if (bench->spindle_period != 0u) {
			if (bench->spindle_next <= bench_clock(bench)) {
				turn(bench);
				left = COUNT_CLOCKS; /* those that are late come one by one */
			} else if (bench->spindle_next - bench_clock(bench) < left) {
				left = bench->spindle_next - bench_clock(bench);
			}
		}
		passo_engine_run(bench->engine, left);
		collect(bench);
	}
}

/* A push that ends as late as the driver allows. */
static void wait_until_late(struct bench *bench, uint32_t word, size_t words)
{
	const struct passo_header header = passo_unpack_header(word);
	const uint64_t end = bench->looked + bench->in_time, now = bench_clock(bench);
	const uint64_t takes = words * BITS * 2u * HALF_PERIOD + FRAME_MARGIN;

	if (header.operation == PASSO_OPERATION_READ
	    && header.address == PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_STATE)
		bench->looked = now;
	if (bench->in_time != 0u && header.operation == PASSO_OPERATION_PUSH && now + takes < end)
		bench_run(bench, end - now - takes);
}

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct bench *bench = context;

	bench->frames++;
	if (bench->dies_in != 0u && --bench->dies_in == 0u) {
		const uint32_t some = bench_draw(bench, (uint32_t)words + 1u);
		if (some != 0u)
			passo_engine_transfer(bench->engine, send, receive, some, GAP);
		collect(bench);
		longjmp(bench->death, 1);
	}
	if (bench->late != 0u)
		bench_run(bench, bench->late);
	wait_until_late(bench, send[0], words);
	passo_engine_transfer(bench->engine, send, receive, words, GAP);
	collect(bench);
	if (bench->spindle_period != 0u) /* it turns during the frame as well */
		bench_run(bench, 1);
	return true;
}

static uint32_t microseconds(void *context)
{
	return (uint32_t)(bench_clock(context) / MICROSECOND);
}

void bench_create(struct bench *bench, uint32_t seed)
{
	memset(bench, 0, sizeof *bench);
	bench->random = seed * 2654435761u + 1u;
}

void bench_power_up(struct bench *bench, uint8_t tick_log2)
{
	struct passo_engine_config config = machine;

	config.core.tick_log2 = tick_log2;
	for (unsigned a = 0; a < AXES; a++)
		bench->axis[a].tick = (double)(UINT32_C(1) << tick_log2);
	bench->engine = passo_engine_create(&config);
	if (!bench->engine)
		abort();
	passo_engine_set(bench->engine, PASSO_INPUT_ESTOP_N, 1);
}

void bench_destroy(struct bench *bench)
{
	passo_engine_destroy(bench->engine);
}

enum passo_error bench_open(struct bench *bench)
{
	const struct passo_hardware hardware = {
	    .transfer = transfer, .microseconds = microseconds, .context = bench};
	const struct passo_options options = {.clock_hz = CLOCK_HZ};

	return passo_open(&bench->passo, &bench->host, &hardware, &options);
}

void bench_configure(struct bench *bench, uint64_t hold_clocks, uint64_t stop_clocks)
{
	const struct passo_axis_config pins = {16, 16, 10, 10, .in_clocks = true};
	struct passo *passo = &bench->passo;

	for (uint8_t a = 0; a < AXES; a++) {
		bench_must(bench, "axis", passo_configure_axis(passo, a, &pins));
		bench_must(bench, "enable", passo_enable(passo, a, true));
	}
	bench_must(bench, "motion", passo_configure_motion(passo, hold_clocks, stop_clocks, 0));
}

void bench_filter(struct bench *bench)
{
	static const uint32_t filters[] = {0, 20u * MICROSECOND, MILLISECOND, 4u * MILLISECOND, 65535};

	bench->filter = filters[bench_draw(bench, 5)];
	bench_must(bench, "filter", passo_configure_filter(&bench->passo, bench->filter));
}

uint64_t bench_settling(const struct bench *bench)
{
	return 2u * bench->filter + MILLISECOND;
}

enum passo_error bench_finish(struct bench *bench, uint64_t clocks_between)
{
	const uint64_t end = bench_clock(bench) + (uint64_t)PATIENCE_S * CLOCK_HZ;

	while (passo_is_moving(&bench->passo)) {
		const enum passo_error error = passo_poll(&bench->passo);

		if (error != PASSO_OK)
			return error;
		bench_run(bench, clocks_between);
		if (bench_clock(bench) > end)
			return PASSO_ERROR_TIMEOUT;
	}
	return PASSO_OK;
}

void bench_check_positions(struct bench *bench)
{
	int32_t positions[PASSO_AXES_MAX];

	bench_must(bench, "positions", passo_positions(&bench->passo, positions));
	for (unsigned a = 0; a < AXES; a++)
		if (positions[a] != bench->axis[a].position)
			bench_blame(bench, "the position is not that of the pins", positions[a],
			    bench->axis[a].position);
}
