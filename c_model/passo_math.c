/* SPDX-License-Identifier: MIT
 * Unsigned 128-bit arithmetic and square roots: schoolbook methods in base 2^32.
 */
#include "passo_math.h"

#include <stddef.h>

static uint64_t high_half(uint64_t a)
{
	return a >> 32;
}

static uint64_t low_half(uint64_t a)
{
	return a & UINT32_MAX;
}

/* Zero bits above the highest one bit: 0 .. 63 for a > 0. */
static uint32_t leading_zeros(uint64_t a)
{
	uint32_t zeros = 0;
	for (uint32_t bits = 32; bits > 0; bits /= 2) {
		if (a >> (64 - bits) == 0) {
			a <<= bits;
			zeros += bits;
		}
	}
	return zeros;
}

struct passo_u128 passo_u128_add(struct passo_u128 a, struct passo_u128 b)
{
	uint64_t low = a.low + b.low;
	return (struct passo_u128){a.high + b.high + (low < a.low), low};
}

struct passo_u128 passo_u128_subtract(struct passo_u128 a, struct passo_u128 b)
{
	return (struct passo_u128){a.high - b.high - (a.low < b.low), a.low - b.low};
}

struct passo_u128 passo_u128_shift_left(struct passo_u128 a, uint32_t bits)
{
	if (bits >= 128)
		return (struct passo_u128){0, 0};
	if (bits >= 64)
		return (struct passo_u128){a.low << (bits - 64), 0};
	if (bits > 0)
		return (struct passo_u128){a.high << bits | a.low >> (64 - bits), a.low << bits};
	return a;
}

bool passo_u128_less(struct passo_u128 a, struct passo_u128 b)
{
	return a.high < b.high || (a.high == b.high && a.low < b.low);
}

struct passo_u128 passo_multiply(uint64_t a, uint64_t b)
{
	uint64_t low = low_half(a) * low_half(b);
	uint64_t middle = high_half(a) * low_half(b) + high_half(low);  /* at most 2^64 - 2^32 */
	uint64_t other = low_half(a) * high_half(b) + low_half(middle); /* likewise */
	return (struct passo_u128){
	    high_half(a) * high_half(b) + high_half(middle) + high_half(other),
	    other << 32 | low_half(low),
	};
}

/* One digit, base 2^32, of a long division: divides rest * 2^32 + next by a divisor whose highest bit is
 * set, where rest < divisor. The estimate from the divisor's upper half is at most 2 too large (Knuth,
 * TAOCP 4.3.1, D3). */
static uint64_t quotient_digit(uint64_t *rest, uint64_t next, uint64_t divisor)
{
	uint64_t upper = high_half(divisor);
	uint64_t digit = *rest / upper;
	uint64_t left = *rest - digit * upper;
	while (
	    left <= UINT32_MAX && (digit > UINT32_MAX || digit * low_half(divisor) > (left << 32 | next))) {
		digit--;
		left += upper;
	}
	*rest = (*rest << 32 | next) - digit * divisor; /* below the divisor, so right modulo 2^64 */
	return digit;
}

uint64_t passo_divide(struct passo_u128 a, uint64_t divisor, uint64_t *remainder)
{
	uint64_t quotient = UINT64_MAX;
	uint64_t rest = 0;
	if (a.high < divisor) {
		uint32_t shift = leading_zeros(divisor);
		a = passo_u128_shift_left(a, shift);
		divisor <<= shift;
		rest = a.high;
		quotient = quotient_digit(&rest, high_half(a.low), divisor) << 32;
		quotient |= quotient_digit(&rest, low_half(a.low), divisor);
		rest >>= shift;
	}
	if (remainder != NULL)
		*remainder = rest;
	return quotient;
}

uint64_t passo_mul_div(uint64_t a, uint64_t b, uint64_t divisor)
{
	return passo_divide(passo_multiply(a, b), divisor, NULL);
}

uint64_t passo_mul_div_ceil(uint64_t a, uint64_t b, uint64_t divisor)
{
	uint64_t remainder;
	uint64_t quotient = passo_divide(passo_multiply(a, b), divisor, &remainder);
	return remainder > 0 && quotient < UINT64_MAX ? quotient + 1 : quotient;
}

uint32_t passo_isqrt64(uint64_t a)
{
	uint64_t root = 0;
	for (uint64_t bit = UINT64_C(1) << 62; bit > 0; bit >>= 2) {
		uint64_t trial = root + bit;
		root >>= 1;
		if (a >= trial) {
			a -= trial;
			root += bit;
		}
	}
	return (uint32_t)root;
}

/* The upper half of the root from the upper half of a, the lower half by one division: with a's highest or
 * second highest bit set the result is at most 1 too large (Zimmermann, "Karatsuba Square Root"). */
uint64_t passo_isqrt128(struct passo_u128 a)
{
	if (a.high == 0)
		return passo_isqrt64(a.low);
	uint32_t shift = leading_zeros(a.high) & ~UINT32_C(1);
	a = passo_u128_shift_left(a, shift);
	uint64_t upper = passo_isqrt64(a.high);
	uint64_t rest = a.high - upper * upper;              /* 0 .. 2 * upper */
	uint64_t lower = (rest << 31 | a.low >> 33) / upper; /* 0 .. 2^32 */
	uint64_t root = upper << 32 | (lower > UINT32_MAX ? UINT32_MAX : lower);
	if (passo_u128_less(a, passo_multiply(root, root)))
		root--;
	return root >> (shift / 2);
}
