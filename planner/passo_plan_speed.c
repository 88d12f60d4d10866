/* SPDX-License-Identifier: MIT
 * Moves by speed: slope of the ramps, reachable speed, and cruise phase.
 */
#include <stddef.h>

#include "passo_math.h"
#include "passo_plan_draft.h"

/* Longest ramp from rest to the full speed. Keeps the sums in reachable_speed() below 2^128. */
#define SLOPE_CLOCKS_MAX (UINT64_C(1) << 62)

/* Slope of a ramp: the speed changes by `speed` (UQ32.32 steps/s) in `clocks`. With a jerk limit, the
 * acceleration takes up to `ease` clocks to build up, and again to fall, which makes the ramp longer. */
struct slope {
	uint64_t clocks, speed, ease, jerk;
};

/* Any change of speed at once. */
static const struct slope VERTICAL = {0, 1, 0, 0};

static uint64_t clocks_floor(struct slope slope, uint64_t change)
{
	return passo_mul_div(change, slope.clocks, slope.speed);
}

static uint64_t clocks_ceil(struct slope slope, uint64_t change)
{
	return passo_mul_div_ceil(change, slope.clocks, slope.speed);
}

/* Duration of each curve in a change of speed that takes `clocks` without a jerk limit: sqrt(change / jerk)
 * if the full acceleration is not reached. */
static uint64_t curve_clocks(struct slope slope, uint64_t change, uint64_t clocks)
{
	if (slope.ease == 0 || clocks >= slope.ease)
		return slope.ease;
	uint64_t square = passo_mul_div_ceil(change, slope.clocks * slope.clocks, slope.jerk);
	uint64_t root =
	    square < UINT64_MAX ? passo_isqrt64(square) : passo_isqrt128(passo_multiply(clocks, slope.ease));
	return passo_smaller(slope.ease, root + 1);
}

/* Rounded up, so the ramp is never steeper than its slope. */
static struct passo_phase ramp_phase(
    const struct passo_draft *draft, struct slope slope, uint64_t low, uint64_t high)
{
	uint64_t clocks = low < high ? clocks_ceil(slope, high - low) : 0;
	uint64_t ticks = passo_ticks_ceil(draft->machine, clocks);
	if (slope.ease == 0 || clocks == 0)
		return (struct passo_phase){passo_draft_halvable(draft, ticks), 0, 0};
	uint64_t curve = passo_ticks_ceil(draft->machine, curve_clocks(slope, high - low, clocks));
	uint64_t straight = ticks > curve ? ticks - curve : 0;
	return (struct passo_phase){2 * curve + straight, straight, 0};
}

static enum passo_plan_error find_slope(struct slope *slope, const struct passo_draft *draft,
    const struct passo_rise *rise, uint64_t end_speed, uint64_t speed)
{
	uint32_t clock_hz = draft->machine->clock_hz;
	if (speed == end_speed)
		*slope = VERTICAL;
	else if (rise->acceleration > 0)
		*slope = (struct slope){clock_hz, rise->acceleration, 0, 0};
	else if (rise->ramp_clocks > 0)
		*slope = (struct slope){rise->ramp_clocks, speed - end_speed, 0, 0};
	else
		return PASSO_PLAN_NO_ACCELERATION;
	if (rise->jerk > 0 && speed > end_speed) {
		slope->ease = passo_mul_div_ceil(rise->acceleration, clock_hz, rise->jerk);
		slope->jerk = rise->jerk;
	}
	bool too_long = slope->ease > SLOPE_CLOCKS_MAX || clocks_floor(*slope, speed) > SLOPE_CLOCKS_MAX;
	return too_long ? PASSO_PLAN_TOO_LONG : PASSO_PLAN_OK;
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
static uint64_t reachable_speed(const struct passo_draft *draft, uint64_t limit, struct slope up,
    uint64_t start, struct slope down, uint64_t stop)
{
	uint64_t length = (uint64_t)draft->longest * draft->machine->clock_hz;
	struct passo_u128 sum = passo_multiply(length, 2 * PASSO_UNIT_Q32);
	sum = passo_u128_add(
	    sum, passo_multiply(start, passo_smaller(clocks_ceil(up, start), SLOPE_CLOCKS_MAX)));
	sum = passo_u128_add(
	    sum, passo_multiply(stop, passo_smaller(clocks_ceil(down, stop), SLOPE_CLOCKS_MAX)));

	uint64_t clocks = weighted(passo_smaller(clocks_floor(up, limit), SLOPE_CLOCKS_MAX), draft, false)
	                + weighted(passo_smaller(clocks_floor(down, limit), SLOPE_CLOCKS_MAX), draft, true);
	uint64_t quotient = passo_divide(sum, clocks, NULL);
	if (quotient >= limit)
		return limit;
	return passo_smaller(limit, passo_isqrt128(passo_multiply(quotient + 1, limit)) + 1);
}

/* The slope of constant acceleration that takes equally long between these speeds. */
static struct slope mean_slope(struct slope slope, uint64_t low, uint64_t high)
{
	if (low >= high)
		return VERTICAL;
	uint64_t clocks = clocks_ceil(slope, high - low);
	uint64_t curve = curve_clocks(slope, high - low, clocks);
	return (struct slope){(clocks < curve ? curve : clocks) + curve, high - low, 0, 0};
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
static uint64_t reachable_with_ease(const struct passo_draft *draft, uint64_t limit, struct slope up,
    uint64_t start, struct slope down, uint64_t stop)
{
	if (up.ease == 0 && down.ease == 0)
		return reachable_speed(draft, limit, up, start, down, stop);

	const bool both = up.ease > 0 && down.ease > 0;
	const bool alike = both && start == stop && up.speed == down.speed;
	const uint64_t higher = start > stop ? start : stop;
	const uint64_t end = both ? higher : up.ease > 0 ? start : stop;
	const uint64_t jerk = up.ease > 0 ? up.jerk : down.jerk;
	uint64_t next = highest_with_ease(draft, limit, jerk, end, both);
	uint64_t peak, step = 0;
	int rounds = 12;
	do {
		peak = next;
		struct slope mean_up = mean_slope(up, start, peak);
		struct slope mean_down = alike ? mean_up : mean_slope(down, stop, peak);
		next = reachable_speed(draft, peak, mean_up, start, mean_down, stop);
		uint64_t step_before = step;
		step = peak - next;
		if (next > higher && step < step_before)
			next -=
			    passo_smaller(passo_mul_div(step, step, step_before - step), next - higher - 1);
	} while (next > higher && step > (next - higher) >> 14 && --rounds > 0);
	return next;
}

/* Ticks of the cruise phase: the distance that the ramps do not cover, at the highest velocity allowed;
 * rounded up. */
static uint64_t cruise_ticks(const struct passo_draft *draft, uint64_t velocity)
{
	uint64_t remainder;
	uint64_t weight = passo_divide(passo_draft_distance(draft), velocity, &remainder);
	uint64_t ramps = passo_draft_weight(draft);
	if (weight < ramps)
		return 0;
	uint64_t missing = weight - ramps;
	uint64_t ticks = missing >> PASSO_WEIGHT_BITS;
	bool needs_more = ticks << PASSO_WEIGHT_BITS < missing || remainder > 0;
	bool weightless =
	    ramps == 0 && ticks == 0; /* a user-defined shape may be 0 in the middle of its only tick */
	return ticks + (needs_more || weightless);
}

/* In moves of a few ticks, rounding up can make the peak lower than the start or stop velocity. That ramp
 * then becomes part of the cruise phase. This raises the peak, but not above the velocity it was below, so no
 * limit is exceeded if the higher velocity is handled first. Returns true if the peak has to be solved
 * again. */
static bool flatten_ramp(struct passo_draft *draft)
{
	bool below_start = draft->accelerate.ticks > 0 && draft->peak < draft->start;
	bool below_stop = draft->decelerate.ticks > 0 && draft->peak < draft->stop;
	struct passo_phase *ramp;
	if (below_start && (!below_stop || draft->start >= draft->stop))
		ramp = &draft->accelerate;
	else if (below_stop)
		ramp = &draft->decelerate;
	else
		return false;
	draft->cruise += ramp->ticks;
	*ramp = (struct passo_phase){0, 0, 0};
	return true;
}

enum passo_plan_error passo_draft_by_speed(
    struct passo_draft *draft, const struct passo_limits *limits, struct passo_plan *plan)
{
	uint64_t start = limits->start_speed, speed = limits->speed, stop = limits->stop_speed;
	if (speed == 0)
		return PASSO_PLAN_NO_SPEED;
	if (passo_oversampling_at(draft->machine, speed) == 0)
		return PASSO_PLAN_TOO_FAST;
	if (start > speed)
		return PASSO_PLAN_START_ABOVE_SPEED;
	if (stop > speed)
		return PASSO_PLAN_STOP_ABOVE_SPEED;

	struct slope up, down;
	enum passo_plan_error error = find_slope(&up, draft, &limits->up, start, speed);
	if (error == PASSO_PLAN_OK)
		error = find_slope(&down, draft, &limits->down, stop, speed);
	if (error != PASSO_PLAN_OK)
		return error;

	/* A move too short for its start or stop speed omits that ramp and starts or stops at the peak. It
	 * cannot be too short for both: the peak is above the lower of the two. */
	uint64_t peak = reachable_with_ease(draft, speed, up, start, down, stop);
	if (peak < start) {
		up = VERTICAL;
		peak = reachable_with_ease(draft, start, up, 0, down, stop);
	} else if (peak < stop) {
		down = VERTICAL;
		peak = reachable_with_ease(draft, stop, up, start, down, 0);
	}
	draft->accelerate = ramp_phase(draft, up, start, peak);
	draft->decelerate = ramp_phase(draft, down, stop, peak);
	if (passo_draft_is_too_long(draft))
		return PASSO_PLAN_TOO_LONG;
	passo_draft_weigh(draft);

	passo_draft_oversample(draft, peak);
	draft->start = passo_draft_velocity(draft, start);
	draft->stop = passo_draft_velocity(draft, stop);
	draft->cruise = cruise_ticks(draft, passo_draft_velocity(draft, peak));
	do {
		if (passo_draft_is_too_long(draft))
			return PASSO_PLAN_TOO_LONG;
		passo_draft_solve(draft);
	} while (flatten_ramp(draft));

	passo_draft_finish(draft, plan);
	return PASSO_PLAN_OK;
}

struct passo_limits passo_limits_of(const struct passo_move_by_speed *move)
{
	uint64_t deceleration = move->deceleration > 0 ? move->deceleration : move->acceleration;
	return (struct passo_limits){
	    .start_speed = move->start_speed,
	    .speed = move->speed,
	    .stop_speed = move->stop_speed,
	    .up = {.acceleration = move->acceleration, .ramp_clocks = move->ramp_clocks},
	    .down = {.acceleration = deceleration, .ramp_clocks = move->ramp_clocks},
	};
}

enum passo_plan_error passo_plan_by_speed(
    const struct passo_machine *machine, const struct passo_move_by_speed *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	const struct passo_limits limits = passo_limits_of(move);
	return passo_draft_by_speed(&draft, &limits, plan);
}
