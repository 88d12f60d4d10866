/* SPDX-License-Identifier: MIT
 * Unsigned 128-bit arithmetic and square roots for targets that have neither.
 *
 * Plain C11: no compiler extensions, no floating point, no heap, no undefined behaviour for any argument.
 */
#ifndef PASSO_MATH_H
#define PASSO_MATH_H

#include <stdbool.h>
#include <stdint.h>

struct passo_u128 {
	uint64_t high, low;
};

/* Modulo 2^128, as C does it for the built-in unsigned types. */
struct passo_u128 passo_u128_add(struct passo_u128 a, struct passo_u128 b);
struct passo_u128 passo_u128_subtract(struct passo_u128 a, struct passo_u128 b);
struct passo_u128 passo_u128_shift_left(struct passo_u128 a, uint32_t bits);
bool passo_u128_less(struct passo_u128 a, struct passo_u128 b);

/* Bits of the number: 0 .. 128. */
uint32_t passo_bits(struct passo_u128 a);

/* a * b, all 128 bits of it. */
struct passo_u128 passo_multiply(uint64_t a, uint64_t b);

/* floor(a / divisor); the rest goes to *remainder unless that is null. A quotient that does not fit in 64
 * bits (division by 0 included) saturates to UINT64_MAX with remainder 0. */
uint64_t passo_divide(struct passo_u128 a, uint64_t divisor, uint64_t *remainder);

/* a * b / divisor with nothing lost in between, rounded down or up; saturates like passo_divide. */
uint64_t passo_mul_div(uint64_t a, uint64_t b, uint64_t divisor);
uint64_t passo_mul_div_ceil(uint64_t a, uint64_t b, uint64_t divisor);

/* floor(sqrt(a)) */
uint32_t passo_isqrt64(uint64_t a);
uint64_t passo_isqrt128(struct passo_u128 a);

#endif
