/* SPDX-License-Identifier: MIT
 * Sigmoid S-curves, and the table of the logistic function for any alpha.
 */
#include "passo_math.h"
#include "passo_plan_draft.h"

#define ALPHA_MIN (PASSO_ALPHA_MIN * PASSO_ALPHA_ONE)
#define ALPHA_MAX (PASSO_ALPHA_MAX * PASSO_ALPHA_ONE)

/* UQ1.62 */
#define ONE_Q62 (UINT64_C(1) << 62)
/* Half of the last point, UQ32.32 */
#define HALF_Q32 (UINT64_C(32768) << 32)

static const uint32_t MIDDLE = PASSO_TABLE_SIZE / 2;

static uint64_t multiply_q62(uint64_t a, uint64_t b)
{
	struct passo_u128 product = passo_multiply(a, b);
	return product.high << 2 | product.low >> 62;
}

/* exp(-x) for a small x, all in UQ1.62, from its series. */
static uint64_t exp_minus(uint64_t x)
{
	uint64_t sum = ONE_Q62, term = ONE_Q62;
	for (uint32_t n = 1; term > 0; n++) {
		term = multiply_q62(term, x) / n;
		sum = n % 2 > 0 ? sum - term : sum + term;
	}
	return sum;
}

/* (1 - e) / (1 + e) with e = exp(-y), which is tanh(y / 2). */
static uint64_t tanh_of_half(uint64_t e)
{
	return passo_mul_div(ONE_Q62 - e, ONE_Q62, ONE_Q62 + e);
}

/* With the middle as the origin and d points from it the scaled logistic function is
 *
 *   1/2 - t / (2 t0),  t = tanh(alpha d / 256),  t0 = tanh(alpha / 2)
 *
 * The points keep the area from the start to each of them as close to that of the curve as integers can, as
 * in spec/generate_shapes.py. By Euler and Maclaurin the area below the curve is that below its exact
 * points, less 1/12 of what its slope has grown. Only the lower half is computed; the upper half is its exact
 * mirror image. */
enum passo_plan_error passo_sigmoid_table(uint32_t alpha, uint16_t table[PASSO_TABLE_SIZE])
{
	if (alpha < ALPHA_MIN || alpha > ALPHA_MAX)
		return PASSO_PLAN_BAD_ALPHA;

	/* exp(-alpha / 128), once for each point from the middle */
	const uint64_t step = exp_minus(ONE_Q62 / ((uint64_t)PASSO_ALPHA_ONE * MIDDLE) * alpha);
	const uint64_t back = passo_mul_div(ONE_Q62, ONE_Q62, step);
	uint64_t e = ONE_Q62;
	for (uint32_t d = 0; d < MIDDLE; d++)
		e = multiply_q62(e, step);
	const uint64_t t0 = tanh_of_half(e);

	uint64_t exact = 0, given = 0; /* sums of points, UQ32.32 */
	for (uint32_t k = 0; k < MIDDLE; k++) {
		const uint64_t t = tanh_of_half(e);
		const uint64_t value = passo_mul_div(t0 - t, HALF_Q32, t0);
		const uint64_t slope =
		    passo_mul_div(multiply_q62(value, t0 + t), alpha, UINT64_C(3072) * PASSO_ALPHA_ONE);

		exact += value;
		const uint64_t point = (exact - slope - given + (1u << 31)) >> 32;
		given += point << 32;
		table[k] = (uint16_t)point;
		if (k > 0)
			table[PASSO_TABLE_SIZE - k] = (uint16_t)(65536u - point);
		e = multiply_q62(e, back);
	}
	table[MIDDLE] = 65536u / 2;
	return PASSO_PLAN_OK;
}

enum passo_plan_error passo_plan_sigmoid(
    const struct passo_machine *machine, const struct passo_move_sigmoid *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, PASSO_PROFILE_SIGMOID);
	if (error != PASSO_PLAN_OK)
		return error;
	if (move->alpha < ALPHA_MIN || move->alpha > ALPHA_MAX)
		return PASSO_PLAN_BAD_ALPHA;
	draft.sigmoid_alpha = move->alpha;

	const struct passo_limits limits = {
	    .start_speed = move->start_speed,
	    .speed = move->speed,
	    .stop_speed = move->stop_speed,
	    .up = {.ramp_clocks = move->accelerate_clocks},
	    .down = {.ramp_clocks = move->decelerate_clocks},
	};
	return passo_draft_by_speed(&draft, &limits, plan);
}
