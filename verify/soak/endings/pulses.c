/* SPDX-License-Identifier: MIT */
#include "pulses.h"

#include <math.h>

#define SPANS 8u /* 1, 2, 4 ... steps are compared with as many after them */

void pulses_begin(struct pulses *pulses)
{
	pulses->count = 0;
	pulses->lowest = pulses->highest = pulses->position;
}

bool pulses_add(struct pulses *pulses, uint64_t clock, int way)
{
	if (pulses->count == PULSES_MAX)
		return false;
	pulses->clock[pulses->count] = clock;
	pulses->way[pulses->count++] = (int8_t)way;
	pulses->position += way;
	if (pulses->position < pulses->lowest)
		pulses->lowest = pulses->position;
	if (pulses->position > pulses->highest)
		pulses->highest = pulses->position;
	return true;
}

static double seconds(const struct pulses *pulses, size_t from, size_t to, double clock_hz)
{
	return (double)(pulses->clock[to] - pulses->clock[from]) / clock_hz;
}

/* Steps from i on in one direction, up to a span. */
static bool is_one_way(const struct pulses *pulses, size_t from, size_t to)
{
	for (size_t n = from; n < to; n++)
		if (pulses->way[n] != pulses->way[to])
			return false;
	return true;
}

/* Mean speeds over (i, j) and (j, k) differ by at most acceleration (k - i) / 2, and by what whole clocks do
 * to either: one of the core, and one of the time scale, which lasts `top` / v of the core's. */
double pulses_slope(const struct pulses *pulses, double clock_hz, double limit, double top, bool scaled)
{
	double most = 0;

	for (size_t span = 1; span <= 1u << SPANS; span *= 2u) {
		for (size_t i = 0; i + 2u * span < pulses->count; i++) {
			const size_t j = i + span, k = j + span;
			if (!is_one_way(pulses, i, k))
				continue;
			const double v = (double)span / seconds(pulses, i, j, clock_hz);
			const double w = (double)span / seconds(pulses, j, k, clock_hz);
			const double clock =
			    (v * v + w * w + (scaled ? (v + w) * top : 0)) / (double)span / clock_hz;
			const double excess = fabs(w - v) - clock - 2 * limit * pulses->tick / clock_hz;
			most = fmax(most, excess / (limit * seconds(pulses, i, k, clock_hz) / 2));
		}
	}
	return most;
}

bool pulses_jump(const struct pulses *pulses, double clock_hz, double limit, bool ends)
{
	const double most = 1.75 * sqrt(limit) + 2 * limit * pulses->tick / clock_hz;

	for (size_t i = 0; i + 1u < pulses->count; i++) {
		const bool begins = i == 0u || pulses->way[i - 1u] != pulses->way[i];
		const bool is_end = i + 2u == pulses->count ? ends : pulses->way[i + 2u] != pulses->way[i];
		if (pulses->way[i] == pulses->way[i + 1u] && (begins || is_end)
		    && 1 / (seconds(pulses, i, i + 1u, clock_hz) + 1 / clock_hz) > most)
			return true;
	}
	return false;
}

double pulses_speed(const struct pulses *pulses, double clock_hz)
{
	double most = 0;

	for (size_t i = 0; i + 1u < pulses->count; i++)
		most = fmax(most, 1 / (seconds(pulses, i, i + 1u, clock_hz) + 2 / clock_hz));
	return most;
}
