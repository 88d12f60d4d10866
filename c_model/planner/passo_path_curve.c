/* SPDX-License-Identifier: MIT
 * The acceleration that a curve leaves along the path.
 *
 * The limit of an axis is that of its acceleration in all: the part along the path, half the slope of the
 * square times the unit vector, plus the curvature times the square, both with their signs. So at a square w
 * an axis that the curve speeds up anyway leaves a slope upward of A - B w at most, with A = 2 a / |u| and B
 * = 2 |k| / |u|, and one that the curve slows down the same downward. The acceleration along the path alone
 * keeps all limits as well.
 *
 * Each corner turns over a length, half of it before and half behind it; a line has the mean curvature of the
 * two at its ends.
 */
#include "passo_path_private.h"

/* Components of the unit vector below this share are left out: their limit is that of the corner. */
#define SHARE_MIN (UINT32_C(1) << (PASSO_PATH_UNIT_BITS - 8))
#define BEND_BITS 48u

static uint32_t packed(uint64_t value)
{
	const uint32_t bits = passo_bits((struct passo_u128){0, value});
	const uint32_t right = bits > PASSO_PATH_PACKED_BITS ? bits - PASSO_PATH_PACKED_BITS : 0;

	return (uint32_t)(value >> right << (32 - PASSO_PATH_PACKED_BITS)) | right;
}

/* B w */
static uint64_t taken(uint64_t bend, uint64_t square)
{
	const struct passo_u128 product = passo_multiply(bend, square);

	return product.high >> (BEND_BITS - 2) > 0
	         ? PASSO_PATH_SQUARE_MAX
	         : product.high << (64 - BEND_BITS) | product.low >> BEND_BITS;
}

void passo_path_add_slope(struct passo_path_item *item, uint32_t axis, uint32_t share, uint64_t slope)
{
	if (share >= SHARE_MIN)
		item->curve.slope[axis] = packed(slope);
}

void passo_path_add_curve(const struct passo_path_planner *path, const int64_t *curvature,
    const int32_t *unit, struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;

	curve->up = curve->down = 0;
	if (passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint32_t share = passo_path_size32(unit[axis]);

		if (curvature[axis] == 0 || share < SHARE_MIN)
			continue;
		curve->bend[axis] = packed(
		    passo_path_along(2 * passo_path_size(curvature[axis]), passo_path_inverse(share)));
		if ((curvature[axis] < 0) == (unit[axis] < 0))
			curve->up |= (uint8_t)(1u << axis);
		else
			curve->down |= (uint8_t)(1u << axis);
	}
}

/* What a curve takes of a square over a length, by its bend. */
struct taking {
	uint64_t grows;      /* B l, UQ.38 */
	uint32_t reciprocal; /* of 1 + B l, by a divisor of 16 bits, rounded up: never too steep */
	uint32_t bits;       /* after the point of `reciprocal`, less 6 */
};

static struct taking taking_over(uint64_t bend, uint64_t length)
{
	const struct passo_u128 product = passo_multiply(bend, length); /* UQ.80 */
	struct taking taking = {
	    .grows = product.high >= UINT64_C(1) << 40 ? UINT64_C(1) << 63
	                                               : product.high << 22 | product.low >> 42,
	};
	const uint64_t divisor = (UINT64_C(1) << 38) + taking.grows;

	taking.bits = passo_bits((struct passo_u128){0, divisor}) - 16;
	taking.reciprocal = UINT32_MAX / ((uint32_t)(divisor >> taking.bits) + 1);
	return taking;
}

/* Where more speed leaves less: the slope with what is left at the upper end, (A - B w) / (1 + B l). */
static uint64_t less_slope(uint64_t most, uint64_t bend, uint64_t low, uint64_t length)
{
	const struct taking taking = taking_over(bend, length);

	return passo_mul_shift(passo_path_less(most, taken(bend, low)), taking.reciprocal, taking.bits - 6);
}

uint64_t passo_path_slope(const struct passo_path_item *item, bool up, uint64_t low, uint64_t length)
{
	const struct passo_path_curve *curve = &item->curve;
	uint32_t axes = up ? curve->up : curve->down;
	uint64_t slope = item->slope;

	for (uint32_t axis = 0; axes > 0; axis++, axes /= 2) {
		if (axes % 2 > 0)
			slope = passo_path_smaller(slope, less_slope(passo_path_unpacked(curve->slope[axis]),
							      passo_path_unpacked(curve->bend[axis]), low, length));
	}
	return passo_path_larger(slope, 1);
}

void passo_path_set_gain(struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;
	const uint64_t length = (uint64_t)item->substeps << 32;

	item->gain = passo_path_gain(passo_path_down(item->slope), length);
	for (uint32_t axis = 0, axes = curve->down; axes > 0; axis++, axes /= 2) {
		if (axes % 2 == 0)
			continue;
		const struct taking taking = taking_over(passo_path_unpacked(curve->bend[axis]), length);
		const uint64_t slope =
		    passo_mul_shift(passo_path_unpacked(curve->slope[axis]), taking.reciprocal, taking.bits - 6);
		const uint64_t loss = passo_mul_shift(taking.grows, taking.reciprocal, taking.bits);

		curve->gain[axis] = packed(passo_path_gain(passo_path_down(slope), length));
		curve->loss[axis] = (uint32_t)passo_path_smaller(passo_path_down(loss) + 1, UINT32_MAX);
	}
}
