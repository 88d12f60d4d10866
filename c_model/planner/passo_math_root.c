/* SPDX-License-Identifier: MIT
 * The square root of 128 bits: rare, so it has a file of its own, which is made small, not quick.
 */
#include "passo_math.h"

/* The method of passo_isqrt64(). */
uint64_t passo_isqrt128(struct passo_u128 a)
{
	if (a.high == 0)
		return passo_isqrt64(a.low);
	uint32_t shift = (128 - passo_bits(a)) & ~UINT32_C(1);
	a = passo_u128_shift_left(a, shift);
	uint64_t upper = passo_isqrt64(a.high);
	uint64_t rest = a.high - upper * upper;              /* 0 .. 2 * upper */
	uint64_t lower = (rest << 31 | a.low >> 33) / upper; /* 0 .. 2^32 */
	uint64_t root = upper << 32 | (lower > UINT32_MAX ? UINT32_MAX : lower);
	if (passo_u128_less(a, passo_multiply(root, root)))
		root--;
	return root >> (shift / 2);
}
