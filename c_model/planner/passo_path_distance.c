/* SPDX-License-Identifier: MIT
 * The distance under a ramp, by the recurrence of the core, in closed form.
 *
 * In tick k of T the velocity is v_start + floor((v_end - v_start) * s_k), where s_k is the progress (2k + 1)
 * du, rounded to 24 bits. Rounding is symmetric about the middle of the ramp, so that the s_k have exactly
 * the mean 1/2, except in ramps of 2^12 ticks or more: there some differ, and they are counted.
 */
#include "passo_path_private.h"

/* Up to here no s_k differs. */
#define SYMMETRIC_TICKS (UINT32_C(1) << 12)
#define ROUND (UINT64_C(1) << 24)
#define DIVISOR_BITS 25u

void passo_path_set_ticks(struct passo_ramp *ramp, uint32_t ticks)
{
	ramp->ticks = ticks;
	ramp->progress_step =
	    ticks > 0 ? passo_path_smaller((PASSO_ONE_Q48 + ticks / 2) / ticks, PASSO_PROGRESS_STEP_MAX) : 0;
}

/* Sum of floor((factor * k + addend) / divisor) for k = 0 .. count - 1: points below a line, turned by a
 * quarter in each round. All arguments are below 2^26. */
static uint64_t floor_sum(uint64_t count, uint64_t divisor, uint64_t factor, uint64_t addend)
{
	uint64_t sum = 0;

	while (count > 0) {
		sum += factor / divisor * (count * (count - 1) / 2) + addend / divisor * count;
		factor %= divisor;
		addend %= divisor;
		const uint64_t most = factor * count + addend;
		const uint64_t turned = factor;

		count = most / divisor;
		addend = most % divisor;
		factor = divisor;
		divisor = turned;
	}
	return sum;
}

/* Sum of all s_k - 1/2, in units of 2^-24. */
static int64_t excess(uint32_t ticks, uint64_t progress_step)
{
	if (ticks < SYMMETRIC_TICKS)
		return 0;
	/* the whole parts of du are summed apart, to keep the numbers small */
	const uint64_t divisor = UINT64_C(1) << DIVISOR_BITS;
	const uint64_t first = progress_step + ROUND, step = 2 * progress_step;
	const uint64_t whole =
	    (step >> DIVISOR_BITS) * ((uint64_t)ticks * (ticks - 1) / 2) + (first >> DIVISOR_BITS) * ticks;
	const uint64_t rest = floor_sum(ticks, divisor, step % divisor, first % divisor);

	return (int64_t)(whole + rest) - ((int64_t)ticks << 23);
}

uint64_t passo_path_distance(
    const struct passo_path_planner *path, uint64_t velocity, const struct passo_ramp *ramp)
{
	struct passo_u128 sum = passo_multiply(velocity + ramp->velocity_end, ramp->ticks); /* twice */
	const uint32_t surplus = 17u - path->machine.tick_log2;

	if (ramp->velocity_end != velocity) {
		const int64_t more =
		    ramp->shape == PASSO_SHAPE_LINEAR ? excess(ramp->ticks, ramp->progress_step) * 2 : 0;
		const bool falls = ramp->velocity_end < velocity;
		const uint64_t change = falls ? velocity - ramp->velocity_end : ramp->velocity_end - velocity;
		const uint64_t size = passo_mul_div(change, (uint64_t)(more < 0 ? -more : more), ROUND);

		if ((more < 0) != falls)
			sum = passo_u128_subtract(sum, (struct passo_u128){0, size});
		else
			sum = passo_u128_add(sum, (struct passo_u128){0, size});
		sum = passo_u128_subtract(sum, (struct passo_u128){0, ramp->ticks});
	}
	return sum.high << (64u - surplus) | sum.low >> surplus;
}

void passo_path_land(
    const struct passo_path_planner *path, uint64_t velocity, uint64_t distance, struct passo_ramp *ramp)
{
	const uint64_t units = UINT64_C(1) << (17u - path->machine.tick_log2);
	const uint64_t mean_twice = passo_mul_div(distance, units, ramp->ticks);

	ramp->velocity_end =
	    passo_path_smaller(mean_twice > velocity ? mean_twice - velocity : 0, PASSO_VELOCITY_MAX);
	/* one correction makes good what rounding adds */
	const uint64_t covered = passo_path_distance(path, velocity, ramp);
	if (covered > distance)
		ramp->velocity_end -= passo_path_smaller(
		    passo_mul_div(covered - distance, units, ramp->ticks), ramp->velocity_end);
	else
		ramp->velocity_end = passo_path_smaller(
		    ramp->velocity_end + passo_mul_div(distance - covered, units, ramp->ticks),
		    PASSO_VELOCITY_MAX);
}
