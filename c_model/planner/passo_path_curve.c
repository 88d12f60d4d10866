/* SPDX-License-Identifier: MIT
 * The acceleration that a curve leaves along the path.
 *
 * The limit of an axis is that of its acceleration in all: the part along the path, half the slope of the
 * square times the unit vector, plus the curvature times the square, both with their signs. So at a square w
 * an axis that the curve speeds up anyway leaves a slope upward of A - B w at most, with A = 2 a / |u| and B
 * = 2 |k| / |u|, and one that the curve slows down the same downward. The acceleration along the path alone
 * keeps all limits as well.
 *
 * Each corner turns over a length before and behind it, so each half of a line has the curvature of the
 * corner at its end. An image without room has one for both, the greater one.
 */
#include "passo_path_private.h"

/* Components of the unit vector below this share are left out: their limit is that of the corner. */
#define SHARE_MIN (UINT32_C(1) << (PASSO_PATH_UNIT_BITS - 8))
#define BEND_BITS 48u

#define PACKED_BITS 26u
#define EXPONENT_BITS (32u - PACKED_BITS)

static uint32_t packed(uint64_t value)
{
	const uint32_t bits = passo_bits((struct passo_u128){0, value});
	const uint32_t right = bits > PACKED_BITS ? bits - PACKED_BITS : 0;

	return (uint32_t)(value >> right << EXPONENT_BITS) | right;
}

static uint64_t unpacked(uint32_t value)
{
	return (uint64_t)(value >> EXPONENT_BITS) << (value % (1u << EXPONENT_BITS));
}

/* A - B w, not below 0 */
static uint64_t left_by(uint32_t most, uint32_t bend, uint64_t square)
{
	const uint64_t a = unpacked(most), taken = passo_mul_shift(square, unpacked(bend), BEND_BITS);

	return a > taken ? a - taken : 0;
}

void passo_path_add_slope(struct passo_path_item *item, uint32_t axis, uint32_t share, uint64_t slope)
{
	if (share >= SHARE_MIN)
		item->curve.slope[axis] = packed(slope);
}

void passo_path_straighten(struct passo_path_item *item, unsigned half)
{
	for (uint32_t axis = 0; axis < PASSO_PATH_AXES_MAX; axis++)
		item->curve.bend[half][axis] = 0;
	item->curve.helps[half] = item->curve.hinders[half] = 0;
}

void passo_path_bend(const struct passo_path_planner *path, const int64_t *curvature, const int32_t *unit,
    unsigned half, struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;

	if (passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return;
	curve->halved = passo_path_is_rounded(path);
	half = passo_path_halves(item) > 1 ? half : 0;
	for (uint32_t axis = 0; axis < passo_path_rows(path); axis++) {
		const uint32_t share = passo_path_size32(unit[axis]);

		if (curvature[axis] == 0 || share < SHARE_MIN)
			continue;
		const uint64_t bend =
		    passo_path_along(2 * passo_size64(curvature[axis]), passo_path_inverse(share));
		const bool helps = (curvature[axis] < 0) == (unit[axis] < 0);

		if (bend > unpacked(curve->bend[half][axis]))
			curve->bend[half][axis] = packed(bend);
		(helps ? curve->helps : curve->hinders)[half] |= (uint8_t)(1u << axis);
	}
}

/* A curve over a length. */
struct growth {
	uint64_t grows; /* B l, UQ.38 */
	uint32_t
	    reciprocal; /* of 1 + B l: by a divisor of 16 bits, rounded up, so that it is never too steep */
	uint32_t shift;
};

static struct growth growth_over(uint32_t bend, uint64_t length)
{
	const uint64_t grows =
	    passo_path_smaller(passo_mul_shift(unpacked(bend), length, 42), UINT64_C(1) << 63);
	const uint64_t divisor = (UINT64_C(1) << 38) + grows;
	const uint32_t right = passo_bits((struct passo_u128){0, divisor}) - 16;

	return (struct growth){grows, UINT32_MAX / ((uint32_t)(divisor >> right) + 1), right - 6};
}

uint64_t passo_path_slope(
    const struct passo_path_item *item, unsigned half, bool up, uint64_t low, uint64_t length)
{
	const struct passo_path_curve *curve = &item->curve;
	uint64_t slope = item->slope;

	for (uint32_t axis = 0, axes = (up ? curve->helps : curve->hinders)[half]; axes > 0;
	    axis++, axes /= 2) {
		if (axes % 2 == 0)
			continue;
		const uint32_t bend = curve->bend[half][axis];
		const struct growth growth = growth_over(bend, length);
		const uint64_t left = left_by(curve->slope[axis], bend, low);

		/* where more speed leaves less: with what is left at the upper end, (A - B w) / (1 + B l) */
		slope = passo_path_smaller(slope, passo_mul_shift(left, growth.reciprocal, growth.shift));
	}
	return passo_path_larger(slope, 1);
}

/* Whether what a half leaves changes by more than a third over it. */
static bool is_strong(const struct passo_path_item *item)
{
	const struct passo_path_curve *curve = &item->curve;
	const uint64_t length = (uint64_t)item->substeps << 31;

	for (unsigned half = 0; half < PASSO_PATH_HALVES; half++) {
		for (uint32_t axis = 0, axes = curve->helps[half] | curve->hinders[half]; axes > 0;
		    axis++, axes /= 2) {
			if (axes % 2 > 0
			    && growth_over(curve->bend[half][axis], length).grows > UINT64_C(1) << 37)
				return true;
		}
	}
	return false;
}

void passo_path_set_fall(struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;
	const uint64_t length = (uint64_t)item->substeps << 32;
	uint64_t fall = UINT64_MAX, loss = 0;

	if (passo_path_halves(item) > 1) {
		curve->strong = is_strong(item);
		return;
	}
	for (uint32_t axis = 0, axes = curve->hinders[0]; axes > 0; axis++, axes /= 2) {
		if (axes % 2 == 0)
			continue;
		const struct growth growth = growth_over(curve->bend[0][axis], length);
		const uint64_t slope =
		    passo_mul_shift(unpacked(curve->slope[axis]), growth.reciprocal, growth.shift);

		fall = passo_path_smaller(fall, passo_path_gain(passo_path_down(slope), length));
		loss = passo_path_larger(
		    loss, passo_mul_shift(growth.grows, growth.reciprocal, growth.shift + 6));
	}
	curve->fall = packed(fall);
	curve->loss = (uint32_t)passo_path_smaller(passo_path_down(loss) + 1, UINT32_MAX);
}

uint64_t passo_path_fall(const struct passo_path_item *item, uint64_t end)
{
	const uint64_t slope = passo_path_down(item->slope);
	const uint64_t high = passo_path_smaller((slope >> 32) * item->substeps, PASSO_PATH_SQUARE_MAX >> 32);
	const uint64_t straight =
	    passo_path_smaller((high << 32) + (slope & UINT32_MAX) * item->substeps, PASSO_PATH_SQUARE_MAX);

	if (item->curve.hinders[0] == 0)
		return straight;
	/* of several axes it takes the least and the greatest loss, so it is never too steep */
	const uint64_t fall = unpacked(item->curve.fall), lost = ((end >> 32) + 1) * item->curve.loss;
	return fall > lost ? passo_path_smaller(straight, fall - lost) : 0;
}

/* The square from which a part of a half comes down to one at its end, in a step. */
static uint64_t step_before(const struct passo_path_item *item, unsigned half, uint64_t end, uint64_t length)
{
	return end
	     + passo_path_gain(passo_path_down(passo_path_slope(item, half, false, end, length)), length);
}

uint64_t passo_path_half_before(
    const struct passo_path_item *item, unsigned half, uint64_t end, uint64_t length)
{
	const uint64_t longest = passo_path_longest_step(item);
	uint64_t passed = 0;

	if (!passo_path_is_strong(item))
		return step_before(item, half, end, length);
	for (uint64_t step = passo_path_shortest_step(item); step <= longest && step < length; step *= 2) {
		const uint64_t square = step_before(item, half, end, step - passed);

		end = passo_path_smaller(square, passo_path_larger(item->top, end));
		passed = step;
	}
	return step_before(item, half, end, length - passed);
}

uint64_t passo_path_before(const struct passo_path_item *item, uint64_t end, uint64_t length, uint64_t behind)
{
	const unsigned halves = passo_path_halves(item);
	const uint64_t half = (uint64_t)item->substeps << 31;
	const uint64_t second =
	    halves > 1 ? passo_path_smaller(half > behind ? half - behind : 0, length) : length;
	uint64_t square = passo_path_half_before(item, halves - 1, end, second);

	if (second < length) {
		square = passo_path_smaller(square, passo_path_larger(item->top, end));
		square = passo_path_half_before(item, 0, square, length - second);
	}
	return square;
}
