/* SPDX-License-Identifier: MIT
 * A core with inputs, encoders and outputs at real constants, a host that may be late or die at any frame,
 * and the pins between them.
 */
#ifndef SOAK_ENDINGS_BENCH_H
#define SOAK_ENDINGS_BENCH_H

#include <setjmp.h>

#include "passo_encoder.h"
#include "passo_engine.h"
#include "passo_goto.h"
#include "passo_outputs.h"
#include "pulses.h"

#define CLOCK_HZ 8000000u
#define MICROSECOND (CLOCK_HZ / 1000000u)
#define MILLISECOND (CLOCK_HZ / 1000u)
#define AXES 3u
#define FINE_TICK_LOG2 7u
#define COARSE_TICK_LOG2 13u /* a millisecond: what a change of ramps does not plan ahead is many steps */
#define SPINDLE 2u           /* the axis of the encoder of a thread */

struct bench {
	struct passo_engine *engine;
	struct passo_host host;
	struct passo passo;
	struct pulses axis[AXES];
	struct passo_pin_event pins; /* the last ones */
	uint32_t random;
	uint64_t late;    /* clocks that the host loses before each frame */
	uint64_t in_time; /* clocks from a read of the state until a push is over: just so; 0: immediately */
	uint64_t looked;  /* clock of the last read of the state */
	unsigned frames;  /* so far */
	unsigned dies_in; /* frames until the host fails in one of them; 0: never */
	jmp_buf death;
	uint64_t spindle_period, spindle_next; /* clocks from count to count, 0: at rest */
	unsigned spindle;                      /* counts so far */
	uint64_t filter;                       /* of the inputs, clocks */
	unsigned compares;                     /* pulses of the compare pin */
	uint64_t powered;                      /* clock of the last rise of a power pin */
	const char *fault;                     /* what is wrong, or null */
	long values[2];                        /* that go with it */
};

uint32_t bench_draw(struct bench *bench, uint32_t below);
/* From low to high, log-uniform. */
double bench_between(struct bench *bench, double low, double high);
/* The first fault counts. */
void bench_blame(struct bench *bench, const char *what, long a, long b);
void bench_must(struct bench *bench, const char *what, enum passo_error error);

void bench_create(struct bench *bench, uint32_t seed);
/* The core begins; a tick has 2^tick_log2 clocks. */
void bench_power_up(struct bench *bench, uint8_t tick_log2);
void bench_destroy(struct bench *bench);
/* Opens the core as a host that has just started. */
enum passo_error bench_open(struct bench *bench);
/* Sets pins, times, switches and encoders of the machine, enables the drives. */
void bench_configure(struct bench *bench, uint64_t hold_clocks, uint64_t stop_clocks);

/* Draws a filter of the inputs, up to the longest one, and sets it. */
void bench_filter(struct bench *bench);

void bench_run(struct bench *bench, uint64_t clocks);
/* The longest time until the core knows an input that has changed, and a millisecond. */
uint64_t bench_settling(const struct bench *bench);
/* Polls, once in a while, until nothing moves; the first error. */
enum passo_error bench_finish(struct bench *bench, uint64_t clocks_between);
/* The positions of the driver are those of the pins. */
void bench_check_positions(struct bench *bench);
uint64_t bench_clock(const struct bench *bench);

#endif
