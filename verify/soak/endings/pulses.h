/* SPDX-License-Identifier: MIT
 * What an axis did, as seen at its pins: the clock and the way of each step, and what they show of its speed.
 */
#ifndef SOAK_ENDINGS_PULSES_H
#define SOAK_ENDINGS_PULSES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PULSES_MAX 60000u

struct pulses {
	uint64_t clock[PULSES_MAX];
	int8_t way[PULSES_MAX];
	size_t count;
	int32_t position;
	int32_t lowest, highest; /* since pulses_begin() */
	double tick;             /* of the core, clocks: its speed changes once in a tick */
};

/* Forgets the steps, not the position. */
void pulses_begin(struct pulses *pulses);
/* False if there are too many. */
bool pulses_add(struct pulses *pulses, uint64_t clock, int way);

/* The acceleration of the steps as a share of `limit`, steps/s^2, beyond what whole clocks and two ticks of
 * it explain: above 1 it was exceeded. `scaled`: the speed before the time scale is up to `top`, so that
 * steps are whole clocks of a slower clock. */
double pulses_slope(const struct pulses *pulses, double clock_hz, double limit, double top, bool scaled);
/* Whether a run of steps begins or ends at a speed that no ramp from or to rest has. `ends`: also the last
 * one. */
bool pulses_jump(const struct pulses *pulses, double clock_hz, double limit, bool ends);
/* The highest speed, steps/s, as far as whole clocks tell. */
double pulses_speed(const struct pulses *pulses, double clock_hz);

#endif
