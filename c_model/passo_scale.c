/* SPDX-License-Identifier: MIT
 * Scale: the velocity between two velocities. See rtl/passo_scale.v.
 */
#include "passo_model.h"

/* floor(difference * s / 2^24) for difference < 2^48, s < 2^24, without a 128-bit product */
static uint64_t scaled(uint64_t difference, uint32_t s, uint32_t *remainder)
{
	const uint64_t low = (difference & 0xFFFFFFu) * s;
	*remainder = (uint32_t)(low & 0xFFFFFFu);
	return (difference >> 24) * s + (low >> 24);
}

uint64_t passo_scale_velocity(uint64_t v_start, uint64_t v_end, uint32_t s)
{
	uint32_t remainder;

	if (s >> 24 != 0u)
		return v_end;
	if (v_end >= v_start)
		return v_start + scaled(v_end - v_start, s, &remainder);
	const uint64_t drop = scaled(v_start - v_end, s, &remainder);
	return v_start - drop - (remainder != 0u ? 1u : 0u);
}
