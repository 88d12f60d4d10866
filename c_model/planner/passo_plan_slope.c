/* SPDX-License-Identifier: MIT
 * The highest speed that a move reaches on the slopes of its ramps.
 */
#include "passo_plan_slope.h"

#include <stddef.h>

/* sqrt(change / jerk) if the full acceleration is not reached. */
uint64_t passo_slope_curve(struct passo_slope slope, uint64_t change, uint64_t clocks)
{
	if (slope.ease == 0 || clocks >= slope.ease)
		return slope.ease;
	uint64_t square = passo_mul_div_ceil(change, slope.clocks * slope.clocks, slope.jerk);
	uint64_t root =
	    square < UINT64_MAX ? passo_isqrt64(square) : passo_isqrt128(passo_multiply(clocks, slope.ease));
	return passo_smaller(slope.ease, root + 1);
}

/* Scales a ramp time by twice the weight of the peak in the ramp: the mean of a user-defined shape, or, for a
 * deceleration that is not mirrored, what it lacks to 1. */
static uint64_t weighted(uint64_t clocks, const struct passo_draft *draft, bool falls)
{
	const bool rest = falls && draft->table && !draft->mirrors;
	const uint32_t mean = rest ? 2 * PASSO_MEAN_HALF - draft->mean : draft->mean;

	return mean == PASSO_MEAN_HALF ? clocks : passo_mul_div(clocks, mean, PASSO_MEAN_HALF);
}

/* The highest speed, up to a limit, that a move of this length can reach. With acceleration a and
 * deceleration d:
 *
 *   length = (peak^2 - start^2) / 2a + (peak^2 - stop^2) / 2d
 *   peak^2 = (2 length + start * start/a + stop * stop/d) / (1/a + 1/d)
 * A speed divided by an acceleration is a number of clocks. Numerator and denominator are multiplied by the
 * limit, which turns 1/a and 1/d into numbers of clocks as well. Rounded up: a peak that is slightly too high
 * only costs a little time. */
static uint64_t reachable_speed(const struct passo_draft *draft, uint64_t limit, struct passo_slope up,
    uint64_t start, struct passo_slope down, uint64_t stop)
{
	uint64_t length = (uint64_t)draft->longest * draft->machine->clock_hz;
	struct passo_u128 sum = passo_multiply(length, 2 * PASSO_UNIT_Q32);
	sum = passo_u128_add(sum,
	    passo_multiply(start, passo_smaller(passo_slope_clocks_ceil(up, start), PASSO_SLOPE_CLOCKS_MAX)));
	sum = passo_u128_add(sum,
	    passo_multiply(stop, passo_smaller(passo_slope_clocks_ceil(down, stop), PASSO_SLOPE_CLOCKS_MAX)));

	uint64_t clocks =
	    weighted(passo_smaller(passo_slope_clocks(up, limit), PASSO_SLOPE_CLOCKS_MAX), draft, false)
	    + weighted(passo_smaller(passo_slope_clocks(down, limit), PASSO_SLOPE_CLOCKS_MAX), draft, true);
	uint64_t quotient = passo_divide(sum, clocks, NULL);
	if (quotient >= limit)
		return limit;
	return passo_smaller(limit, passo_isqrt128(passo_multiply(quotient + 1, limit)) + 1);
}

/* The slope of constant acceleration that takes equally long between these speeds. */
static struct passo_slope mean_slope(struct passo_slope slope, uint64_t low, uint64_t high)
{
	if (low >= high)
		return PASSO_VERTICAL;
	uint64_t clocks = passo_slope_clocks_ceil(slope, high - low);
	uint64_t curve = passo_slope_curve(slope, high - low, clocks);
	return (struct passo_slope){(clocks < curve ? curve : clocks) + curve, high - low, 0, 0};
}

/* Upper bound of the peak: a change of speed takes at least 2 sqrt(change / jerk). For a ramp from `end`,
 * with x^2 = peak - end:
 *
 *   length >= (peak + end) / 2 * 2 sqrt((peak - end) / jerk)
 *   x^3 + 2 end x <= length sqrt(jerk)
 * Two ramps have half the length each, with `end` the higher of their ends: the other ramp can be shorter,
 * but only by a factor of up to 1.09. Solved by Newton's method from above. Speeds are UQ32.32, so x is
 * UQ16.16. */
static uint64_t highest_with_ease(
    const struct passo_draft *draft, uint64_t limit, uint64_t jerk, uint64_t end, bool two_ramps)
{
	if (limit <= end)
		return limit;
	uint64_t half_root = passo_isqrt128((struct passo_u128){jerk, 0}) / 2 + 1;
	if (two_ramps)
		half_root = half_root / 2 + half_root / 32 + 1;
	struct passo_u128 half_right = passo_multiply(half_root, draft->longest);
	uint32_t bits = (passo_bits(half_right) + 3) / 3;
	uint64_t x = passo_isqrt64(limit - end) + UINT64_C(1);
	if (bits < 32)
		x = passo_smaller(x, UINT64_C(1) << bits);
	for (int round = 0; round < 6; round++) {
		uint64_t slope = x * x + x * x / 2 + end;
		struct passo_u128 sum = passo_u128_add(passo_multiply(x * x, x), half_right);
		uint64_t next = passo_divide(sum, slope, NULL);
		if (next >= x - 1)
			break;
		x = next + 1;
	}
	return passo_smaller(limit, end + x * x);
}

/* With a jerk limit the mean slope grows with the peak. A peak that is too high gives a slope that is too
 * steep, and that gives a peak that is closer: each iteration reduces the excess factor to its square root or
 * less. Convergence slows down as the excess shrinks, so extrapolation by the ratio of the last two steps
 * (Aitken) does not overshoot. */
uint64_t passo_slope_reach(const struct passo_draft *draft, uint64_t limit, const struct passo_slope *up,
    uint64_t start, const struct passo_slope *down, uint64_t stop)
{
	if (!passo_slope_is_eased(up) && !passo_slope_is_eased(down))
		return reachable_speed(draft, limit, *up, start, *down, stop);

	const bool both = up->ease > 0 && down->ease > 0;
	const bool alike = both && start == stop && up->speed == down->speed;
	const uint64_t higher = start > stop ? start : stop;
	const uint64_t end = both ? higher : up->ease > 0 ? start : stop;
	const uint64_t jerk = up->ease > 0 ? up->jerk : down->jerk;
	uint64_t next = highest_with_ease(draft, limit, jerk, end, both);
	uint64_t peak, step = 0;
	int rounds = 12;
	do {
		peak = next;
		struct passo_slope mean_up = mean_slope(*up, start, peak);
		struct passo_slope mean_down = alike ? mean_up : mean_slope(*down, stop, peak);
		next = reachable_speed(draft, peak, mean_up, start, mean_down, stop);
		uint64_t step_before = step;
		step = peak - next;
		if (next > higher && step < step_before)
			next -=
			    passo_smaller(passo_mul_div(step, step, step_before - step), next - higher - 1);
	} while (next > higher && step > (next - higher) >> 14 && --rounds > 0);
	return next;
}
