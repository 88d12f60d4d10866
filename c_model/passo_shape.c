/* SPDX-License-Identifier: MIT
 * Shape: how far the speed has come, for how far the ramp has come. See rtl/passo_shape.v.
 */
#include "passo_model.h"

static const uint32_t ONE = 1u << 24;

static uint32_t interpolate(const uint16_t points[PASSO_TABLE_POINTS], uint32_t x)
{
	if (x == ONE)
		return ONE;
	const uint32_t k = x >> 16;
	const int64_t fraction = (int64_t)(x & 0xFFFFu);
	const int64_t point = points[k];
	const int64_t point_next = k == PASSO_TABLE_POINTS - 1u ? 65536 : points[k + 1u];
	/* ties go up in the lower half of the table and down in the upper: a symmetric table stays symmetric
	 */
	const int64_t half = 128 - (int64_t)(k >> 7);
	/* the sum is never negative: it lies between two points */
	return (uint32_t)((point * 65536 + (point_next - point) * fraction + half) >> 8);
}

uint32_t passo_shape_value(
    const struct passo_tables *tables, enum passo_shape shape, bool mirror, uint64_t progress)
{
	const uint32_t x = (uint32_t)((progress + (UINT64_C(1) << 23)) >> 24);

	if (shape == PASSO_SHAPE_LINEAR)
		return x;
	const uint16_t *points = tables->points[shape - PASSO_SHAPE_COSINE];
	return mirror ? ONE - interpolate(points, ONE - x) : interpolate(points, x);
}
