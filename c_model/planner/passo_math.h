/* SPDX-License-Identifier: MIT
 * Unsigned 128-bit arithmetic and square roots for targets that have neither.
 *
 * Plain C11: no compiler extensions, no floating point, no heap, no undefined behavior for any argument.
 */
#ifndef PASSO_MATH_H
#define PASSO_MATH_H

#include <stdbool.h>
#include <stdint.h>

struct passo_u128 {
	uint64_t high, low;
};

/* Modulo 2^128, like the built-in unsigned types. A shift by 128 or more gives 0. */
struct passo_u128 passo_u128_add(struct passo_u128 a, struct passo_u128 b);
struct passo_u128 passo_u128_subtract(struct passo_u128 a, struct passo_u128 b);
struct passo_u128 passo_u128_shift_left(struct passo_u128 a, uint32_t bits);
bool passo_u128_less(struct passo_u128 a, struct passo_u128 b);

/* Bit length: position of the highest one bit plus 1; 0 .. 128. */
uint32_t passo_bits(struct passo_u128 a);

static inline uint64_t passo_size64(int64_t value)
{
	return value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
}

/* The full 128-bit product a * b. */
struct passo_u128 passo_multiply(uint64_t a, uint64_t b);

/* floor(a / divisor); stores the remainder in *remainder unless that is null. A quotient above 64 bits
 * (division by 0 included) saturates to UINT64_MAX with remainder 0. */
uint64_t passo_divide(struct passo_u128 a, uint64_t divisor, uint64_t *remainder);

/* a * b / divisor with a 128-bit product, rounded down or up; saturates like passo_divide(). */
uint64_t passo_mul_div(uint64_t a, uint64_t b, uint64_t divisor);
uint64_t passo_mul_div_ceil(uint64_t a, uint64_t b, uint64_t divisor);

/* a * b / 2^bits, rounded down, without a division; bits below 64; saturates likewise. */
uint64_t passo_mul_shift(uint64_t a, uint64_t b, uint32_t bits);

/* floor(sqrt(a)) */
uint32_t passo_isqrt64(uint64_t a);
uint64_t passo_isqrt128(struct passo_u128 a);

#endif
