/* SPDX-License-Identifier: MIT
 * The acceleration that a curve leaves along the path.
 *
 * The limit of an axis is that of its acceleration in all: the part along the path, half the slope of the
 * square times the unit vector, plus the curvature times the square, both with their signs. So at a square w
 * an axis that the curve speeds up anyway leaves a slope upward of A - B w at most, with A = 2 a / |u| and B
 * = 2 |k| / |u|, and one that the curve slows down the same downward. The acceleration along the path alone
 * keeps all limits as well.
 *
 * Each corner turns over a length before and behind it, so each half of a line has the curvature of the corner
 * at its end. An image without room has one for both, the greater one.
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

static uint32_t exponent_of(uint32_t value)
{
	return value % (1u << EXPONENT_BITS);
}

static uint64_t unpacked(uint32_t value)
{
	return (uint64_t)(value >> EXPONENT_BITS) << exponent_of(value);
}

/* a * b / 2^bits, of a product below 2^96 and bits below 64; saturates. */
static inline uint64_t scaled(uint64_t a, uint32_t b, uint32_t bits)
{
	const uint64_t low = (a & UINT32_MAX) * b, high = (a >> 32) * b + (low >> 32);

	if (bits >= 32)
		return high >> (bits - 32);
	return high >> 32 >> bits > 0 ? UINT64_MAX : high << (32 - bits) | (low & UINT32_MAX) >> bits;
}

/* A - B w, not below 0 */
static uint64_t left_by(uint32_t most, uint32_t bend, uint64_t square)
{
	const uint32_t exponent = exponent_of(bend);
	const uint64_t a = unpacked(most);
	const uint64_t taken = exponent <= BEND_BITS
	                         ? scaled(square, bend >> EXPONENT_BITS, BEND_BITS - exponent)
	                         : passo_mul_shift(square, unpacked(bend), BEND_BITS);

	return a > taken ? a - taken : 0;
}

void passo_path_add_slope(struct passo_path_item *item, uint32_t axis, uint32_t share, uint64_t slope)
{
	if (share >= SHARE_MIN)
		item->curve.slope[axis] = packed(slope);
}

void passo_path_bend(const struct passo_path_planner *path, const int64_t *curvature, const int32_t *unit,
    unsigned half, struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;

	if (passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return;
	curve->halved = !path->unrounded;
	half = passo_path_halves(item) > 1 ? half : 0;
	for (uint32_t axis = 0; axis < path->machine.axes; axis++) {
		const uint32_t share = passo_path_size32(unit[axis]);

		if (curvature[axis] == 0 || share < SHARE_MIN)
			continue;
		const uint64_t bend =
		    passo_path_along(2 * passo_path_size(curvature[axis]), passo_path_inverse(share));
		const bool helps = (curvature[axis] < 0) == (unit[axis] < 0);

		if (bend > unpacked(curve->bend[half][axis]))
			curve->bend[half][axis] = packed(bend);
		(helps ? curve->helps : curve->hinders)[half] |= (uint8_t)(1u << axis);
	}
}

/* Of 1 + B l the highest 16 bits, and the bits below them, less 22. */
struct growth {
	uint32_t divisor, shift;
};

static struct growth growth_over(uint32_t bend, uint64_t length)
{
	const struct passo_u128 product = passo_multiply(unpacked(bend), length); /* UQ.80 */
	const uint64_t grows =
	    product.high >= UINT64_C(1) << 40 ? UINT64_C(1) << 63 : product.high << 22 | product.low >> 42;
	const uint64_t sum = (UINT64_C(1) << 38) + grows;
	const uint32_t right = passo_bits((struct passo_u128){0, sum}) - 16;

	return (struct growth){(uint32_t)(sum >> right), right - 6};
}

/* Where more speed leaves less: the slope with what is left at the upper end, (A - B w) / (1 + B l). The
 * divisor is rounded up, so that it is never too steep. */
static uint64_t less_slope(uint64_t left, uint32_t divisor, uint32_t shift)
{
	return scaled(left, UINT32_MAX / (divisor + 1), shift);
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

		slope = passo_path_smaller(slope, less_slope(left, growth.divisor, growth.shift));
	}
	return passo_path_larger(slope, 1);
}

void passo_path_set_fall(struct passo_path_item *item)
{
	struct passo_path_curve *curve = &item->curve;

	if (passo_path_halves(item) > 1)
		return;
	for (uint32_t axis = 0, axes = curve->hinders[0]; axes > 0; axis++, axes /= 2) {
		if (axes % 2 == 0)
			continue;
		const struct growth growth =
		    growth_over(curve->bend[0][axis], (uint64_t)item->substeps << 32);

		curve->divisor[axis] = (uint16_t)growth.divisor;
		curve->shift[axis] = (uint8_t)growth.shift;
	}
}

uint64_t passo_path_fall(const struct passo_path_item *item, uint64_t end)
{
	const struct passo_path_curve *curve = &item->curve;
	uint64_t slope = item->slope;

	for (uint32_t axis = 0, axes = curve->hinders[0]; axes > 0; axis++, axes /= 2) {
		if (axes % 2 == 0)
			continue;
		const uint64_t left = left_by(curve->slope[axis], curve->bend[0][axis], end);

		slope = passo_path_smaller(slope, less_slope(left, curve->divisor[axis], curve->shift[axis]));
	}
	return passo_path_smaller(
	    scaled(passo_path_down(passo_path_larger(slope, 1)), item->substeps, 0), PASSO_PATH_SQUARE_MAX);
}

uint64_t passo_path_before(
    const struct passo_path_item *item, uint64_t end, uint64_t length, uint64_t behind, uint64_t *slope)
{
	const unsigned halves = passo_path_halves(item);
	const uint64_t half = (uint64_t)item->substeps << 31;
	const uint64_t second = halves > 1 ? passo_path_smaller(half > behind ? half - behind : 0, length) : length;
	const uint64_t slower = passo_path_down(passo_path_slope(item, halves - 1, false, end, second));
	uint64_t square = end + passo_path_gain(slower, second);

	*slope = slower;
	if (second < length) {
		square = passo_path_smaller(square, passo_path_larger(item->top, end));
		*slope = passo_path_down(passo_path_slope(item, 0, false, square, length - second));
		square += passo_path_gain(*slope, length - second);
		*slope = passo_path_smaller(*slope, slower);
	}
	return square;
}
