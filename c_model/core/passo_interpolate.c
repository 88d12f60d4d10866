/* SPDX-License-Identifier: MIT
 * Interpolation: the shape of a ramp, and the velocity between two velocities. See rtl/passo_interpolate.v.
 */
#include "passo_model.h"

/* The RTL is bit-serial over a and b; here the product is computed in two halves to avoid 128 bits. */
uint64_t passo_interpolate(uint64_t a, uint64_t b, uint32_t f)
{
	const uint32_t not_f = (1u << 24) - f;
	const uint64_t low = (a & 0xFFFFFFu) * not_f + (b & 0xFFFFFFu) * f;

	return (a >> 24) * not_f + (b >> 24) * f + (low >> 24);
}

uint32_t passo_shape(const struct passo_tables *tables, enum passo_shape shape, uint64_t progress)
{
	if (shape == PASSO_SHAPE_LINEAR)
		return (uint32_t)((progress + (1u << 24)) >> 25);

	const uint16_t *points = tables->points[shape - PASSO_SHAPE_COSINE];
	const uint32_t k = (uint32_t)(progress >> 41);
	const uint64_t f = ((progress & ((UINT64_C(1) << 41) - 1u)) + (1u << 16)) >> 17;
	const uint64_t point = points[k];
	const uint64_t point_next = k == PASSO_BANK_POINTS - 1u ? 65536u : points[k + 1u];
	/* UQ1.40, exact */
	const uint64_t s = point * ((UINT64_C(1) << 24) - f) + point_next * f;

	return (uint32_t)((s + (1u << 15)) >> 16);
}
