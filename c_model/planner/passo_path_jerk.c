/* SPDX-License-Identifier: MIT
 * Profile `jerk`: the path as cosine ramps between velocities, each as long as acceleration and jerk demand.
 *
 * Every ramp begins and ends without acceleration, so a point of the path and the velocity there say all. A
 * ramp of a change dv of the velocity takes the time T = max(2 dv / slope, sqrt(dv / jerk)), with the lowest
 * `slope` and `jerk` of the lines that it passes (passo_path_limits.c has their factors). So the square of
 * the velocity does not change evenly over the path, and two passes of additions are not enough: backward,
 * the highest velocity at the start of each line from which one ramp leads to a later start, its anchor, at
 * which the same holds; forward, the highest velocity from which one ramp still leads to some such start.
 */
#include "passo_path_jerk.h"

#ifndef PASSO_WITHOUT_JERK_PATHS

/* Velocities are found to one part in 2^12. */
#define PRECISION 12u
/* dv / T^2 of a cosine ramp by its highest jerk: 2 / pi^2, UQ0.16, less a 32nd for corners at its ends. */
#define SOFTNESS 12865u

void passo_path_soften(struct passo_path_item *item, uint64_t jerk)
{
	item->jerk = passo_path_larger(passo_mul_div(jerk, SOFTNESS, UINT32_C(1) << 16), 1);
}

uint64_t passo_path_ramp_length(
    const struct passo_path_planner *path, const struct passo_path_law *law, uint64_t a, uint64_t b)
{
	const uint64_t change = a < b ? b - a : a - b;
	const uint64_t even = passo_mul_div(change, UINT32_C(1) << 17, law->slope);
	const uint64_t soft = passo_isqrt64(passo_mul_div(change, PASSO_UNIT_Q32, law->jerk));
	uint64_t clocks = passo_path_larger(even, soft);

	if (change == 0)
		return 0;
	clocks += clocks / 128 + 1; /* ramps end at ticks */
	if (clocks >> path->machine.tick_log2 >= PASSO_PATH_SHAPED_TICKS_MAX)
		return UINT64_MAX;
	const struct passo_u128 length = passo_multiply(a + b, clocks);
	return length.high >> 17 > 0 ? UINT64_MAX : length.high << 47 | length.low >> 17;
}

uint64_t passo_path_detour(const struct passo_path_planner *path, const struct passo_path_law *law,
    uint64_t from, uint64_t top, uint64_t pause, uint64_t to)
{
	const uint64_t up = passo_path_ramp_length(path, law, from, top);
	const uint64_t down = top > to ? passo_path_ramp_length(path, law, top, to) : 0;
	const uint64_t level = passo_path_length_in(path, 2 * top, pause);

	if (up > UINT64_MAX - down || up + down > UINT64_MAX - level)
		return UINT64_MAX;
	return up + level + down;
}

uint64_t passo_path_highest(const struct passo_path_planner *path, const struct passo_path_law *law,
    uint64_t from, uint64_t pause, uint64_t to, uint64_t length, uint64_t most)
{
	uint64_t low = from, high = most;

	if (most <= from || passo_path_detour(path, law, from, most, pause, to) <= length)
		return passo_path_larger(from, most);
	while (high - low > (high >> PRECISION) + 1) {
		const uint64_t middle = low + (high - low) / 2;

		if (passo_path_detour(path, law, from, middle, pause, to) <= length)
			low = middle;
		else
			high = middle;
	}
	return low;
}

uint64_t passo_path_pass_slope(const struct passo_path_item *item, uint64_t slope)
{
	slope = passo_path_smaller(slope, item->slope);
	return passo_path_larger(slope - passo_mul_div(slope, item->over, 256), 1);
}

uint64_t passo_path_velocity_after(const struct passo_path_planner *path, uint32_t index)
{
	return passo_path_velocity_of(passo_path_end_square(path, index));
}

/* The highest velocity at the start of an item from which a ramp over `descent` leads to its anchor. */
static uint64_t highest_before(
    const struct passo_path_planner *path, const struct passo_path_descent *descent)
{
	const struct passo_path_law law = {descent->slope, descent->jerk};
	const uint64_t end = passo_path_velocity_after(path, descent->anchor - 1);

	if (descent->lowest <= end)
		return descent->lowest;
	return passo_path_highest(path, &law, end, 0, UINT64_MAX, descent->length, descent->lowest);
}

/* Of a limit of an item, what is certain: the newest one may become part of a curve by the next one. */
static uint64_t certain(const struct passo_path_planner *path, uint32_t index, uint64_t limit)
{
	const struct passo_path_item *item = passo_path_item(path, index);

	if (index + 1 < path->added || item->last || path->rest || item->eased >= 2)
		return limit;
	return passo_path_larger(limit / (4u - item->eased) * 2, 1);
}

uint64_t passo_path_soft_reach(struct passo_path_planner *path, uint32_t index)
{
	struct passo_path_item *item = passo_path_item(path, index);
	struct passo_path_descent best = {
	    .slope = certain(path, index, item->slope),
	    .jerk = certain(path, index, item->jerk),
	    .length = (uint64_t)item->substeps << 32,
	    .lowest = passo_path_velocity_of(item->corner),
	    .anchor = index + 1,
	};
	uint64_t reach = passo_path_square_of(highest_before(path, &best));

	if (!passo_path_rests_after(path, index) && reach < item->corner) {
		const struct passo_path_item *behind = passo_path_item(path, index + 1);
		const struct passo_path_descent *next = &behind->descent;
		const struct passo_path_descent over = {
		    .slope = passo_path_smaller(passo_path_pass_slope(behind, best.slope), next->slope),
		    .jerk = passo_path_smaller(best.jerk, next->jerk),
		    .length = best.length + next->length,
		    .lowest = passo_path_smaller(best.lowest, next->lowest),
		    .anchor = next->anchor,
		};
		const uint64_t farther = passo_path_square_of(highest_before(path, &over));

		if (farther > reach) {
			reach = farther;
			best = over;
		}
	}
	/* what was possible with fewer lines still is */
	if (!path->anew && reach < item->reach)
		return item->reach;
	item->descent = best;
	return reach;
}

#endif
