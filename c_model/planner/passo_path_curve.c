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
#define PACKED_BITS 26u

static uint32_t packed(uint64_t value)
{
	const uint32_t bits = passo_bits((struct passo_u128){0, value});
	const uint32_t right = bits > PACKED_BITS ? bits - PACKED_BITS : 0;

	return (uint32_t)(value >> right << (32 - PACKED_BITS)) | right;
}

static uint64_t unpacked(uint32_t value)
{
	return (uint64_t)(value >> (32 - PACKED_BITS)) << (value % (1u << (32 - PACKED_BITS)));
}

/* B w */
static uint64_t taken(uint64_t bend, uint64_t square)
{
	const struct passo_u128 product = passo_multiply(bend, square);

	return product.high >> (BEND_BITS - 2) > 0
	         ? PASSO_PATH_SQUARE_MAX
	         : product.high << (64 - BEND_BITS) | product.low >> BEND_BITS;
}

static uint64_t less(uint64_t a, uint64_t b)
{
	return a > b ? a - b : 0;
}

void passo_path_add_curve(const struct passo_path_planner *path, const int64_t *curvature,
    const int32_t *unit, struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;

	uint64_t any = 0;

	*curve = (struct passo_path_curve){.helps = 0};
	for (uint32_t axis = 0; axis < path->machine.axes; axis++)
		any |= passo_path_size(curvature[axis]);
	if (any == 0 || passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint64_t share = passo_path_size(unit[axis]);

		if (share < SHARE_MIN)
			continue;
		const uint64_t slope =
		    passo_mul_div(2 * path->axis[axis].acceleration, PASSO_PATH_ONE, share);
		const uint64_t bend =
		    passo_mul_div(2 * passo_path_size(curvature[axis]), PASSO_PATH_ONE, share);
		const bool helps = (curvature[axis] < 0) == (unit[axis] < 0);

		curve->slope[axis] = packed(slope);
		curve->bend[axis] = packed(bend);
		if (helps)
			curve->helps |= (uint8_t)(1u << axis);
	}
}

/* Where more speed leaves less: the slope with what is left at the upper end, (A - B w) / (1 + B l). */
static uint64_t less_slope(uint64_t most, uint64_t bend, uint64_t low, uint64_t length)
{
	const struct passo_u128 product = passo_multiply(bend, length); /* UQ.80 */
	const uint64_t grows =
	    product.high >= UINT64_C(1) << 40 ? UINT64_C(1) << 63 : product.high << 22 | product.low >> 42;

	/* by a divisor of 16 bits, rounded up: a division of 32 bits, and never too steep */
	const uint64_t divisor = (UINT64_C(1) << 38) + grows;
	const uint32_t right = passo_bits((struct passo_u128){0, divisor}) - 16;
	const uint32_t reciprocal = UINT32_MAX / ((uint32_t)(divisor >> right) + 1);
	const struct passo_u128 quotient = passo_multiply(less(most, taken(bend, low)), reciprocal);

	return quotient.high << (64 - (right - 6)) | quotient.low >> (right - 6);
}

uint64_t passo_path_slope(const struct passo_path_item *item, bool up, uint64_t low, uint64_t length)
{
	const struct passo_path_curve *curve = &item->curve;
	uint64_t slope = item->slope;

	for (uint32_t axis = 0; axis < PASSO_PATH_AXES_MAX; axis++) {
		if (curve->bend[axis] > 0 && (curve->helps >> axis & 1u) == up)
			slope = passo_path_smaller(slope, less_slope(unpacked(curve->slope[axis]),
							      unpacked(curve->bend[axis]), low, length));
	}
	slope = passo_path_larger(slope, 1);
	return up ? slope : slope - slope / 256;
}
