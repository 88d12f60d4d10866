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

/* 0 .. 31 for a > 0; one instruction of many processors. */
static uint32_t leading_zeros32(uint32_t a)
{
#if defined(__GNUC__)
	return (uint32_t)__builtin_clz(a);
#else
	uint32_t zeros = 0;
	for (uint32_t bits = 16; bits > 0; bits /= 2) {
		if (a >> (32 - bits) == 0) {
			a <<= bits;
			zeros += bits;
		}
	}
	return zeros;
#endif
}

/* 0 .. 63 for a > 0. */
static uint32_t leading_zeros(uint64_t a)
{
	uint32_t upper = (uint32_t)high_half(a);
	return upper > 0 ? leading_zeros32(upper) : 32 + leading_zeros32((uint32_t)a);
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

/* One digit of a long division in base 2^16: divides rest * 2^16 + next by a normalized divisor, with rest <
 * divisor. The estimate from the divisor's upper half is at most 2 too large (Knuth, TAOCP 4.3.1, step D3).
 * Uses 32-bit operations only. */
static inline uint32_t quotient_half_digit(uint32_t *rest, uint32_t next, uint32_t divisor)
{
	uint32_t upper = divisor >> 16, lower = divisor & UINT16_MAX;
	uint32_t digit = *rest / upper;
	uint32_t left = *rest - digit * upper;
	while (left <= UINT16_MAX && (digit > UINT16_MAX || digit * lower > (left << 16 | next))) {
		digit--;
		left += upper;
	}
	*rest = (*rest << 16 | next) - digit * divisor; /* below the divisor, so exact modulo 2^32 */
	return digit;
}

/* floor((2^96 - 1) / divisor) - 2^32 of a normalized divisor: what its digits are estimated with, by
 * multiplications (Moeller and Granlund, "Improved division by invariant integers", algorithm 6). */
static inline uint32_t reciprocal(uint64_t divisor)
{
	uint32_t upper = (uint32_t)high_half(divisor), lower = (uint32_t)divisor;
	uint32_t rest = ~upper;
	uint32_t found = quotient_half_digit(&rest, UINT16_MAX, upper) << 16;
	found += quotient_half_digit(&rest, UINT16_MAX, upper);

	uint32_t left = upper * found + lower;
	if (left < lower) {
		found--;
		if (left >= upper) {
			found--;
			left -= upper;
		}
		left -= upper;
	}
	uint64_t product = (uint64_t)found * lower;
	left += (uint32_t)high_half(product);
	if (left < high_half(product)) {
		found--;
		found -= ((uint64_t)left << 32 | low_half(product)) >= divisor;
	}
	return found;
}

/* One digit in base 2^32, of rest * 2^32 + next with rest < divisor (the same, algorithm 5). */
static inline uint32_t quotient_digit(uint64_t *rest, uint32_t next, uint64_t divisor, uint32_t inverse)
{
	uint32_t upper = (uint32_t)high_half(divisor), lower = (uint32_t)divisor;
	uint64_t estimate = (uint64_t)inverse * (uint32_t)high_half(*rest) + *rest;
	uint32_t digit = (uint32_t)high_half(estimate);
	uint64_t left = (uint64_t)((uint32_t)*rest - digit * upper) << 32 | next;

	left -= (uint64_t)lower * digit + divisor;
	digit++;
	if (high_half(left) >= low_half(estimate)) {
		digit--;
		left += divisor;
	}
	if (left >= divisor) {
		digit++;
		left -= divisor;
	}
	*rest = left;
	return digit;
}

/* 64 by 32 bits, of a quotient of any size. */
static uint64_t divide_short(uint64_t a, uint32_t divisor, uint64_t *remainder)
{
	uint32_t upper = (uint32_t)high_half(a) / divisor;
	uint32_t shift = leading_zeros32(divisor);
	uint64_t left = ((high_half(a) - (uint64_t)upper * divisor) << 32 | low_half(a)) << shift;
	uint32_t rest = (uint32_t)high_half(left);
	uint32_t lower = quotient_half_digit(&rest, (uint32_t)left >> 16, divisor << shift) << 16;

	lower += quotient_half_digit(&rest, (uint32_t)left & UINT16_MAX, divisor << shift);
	if (remainder != NULL)
		*remainder = rest >> shift;
	return (uint64_t)upper << 32 | lower;
}

uint64_t passo_divide(struct passo_u128 a, uint64_t divisor, uint64_t *remainder)
{
	uint64_t quotient = UINT64_MAX;
	uint64_t rest = 0;
	if (a.high == 0 && high_half(divisor) == 0 && divisor > 0)
		return divide_short(a.low, (uint32_t)divisor, remainder);
	if (a.high < divisor) {
		uint32_t shift = leading_zeros(divisor);
		divisor <<= shift;
		rest = a.high << shift | a.low >> 1 >> (63 - shift);
		a.low <<= shift;
		uint32_t inverse = reciprocal(divisor);
		quotient = (uint64_t)quotient_digit(&rest, (uint32_t)high_half(a.low), divisor, inverse)
		        << 32;
		quotient |= quotient_digit(&rest, (uint32_t)a.low, divisor, inverse);
		rest >>= shift;
	}
	if (remainder != NULL)
		*remainder = rest;
	return quotient;
}

uint32_t passo_bits(struct passo_u128 a)
{
	if (a.high > 0)
		return 128 - leading_zeros(a.high);
	return a.low > 0 ? 64 - leading_zeros(a.low) : 0;
}

uint64_t passo_mul_div(uint64_t a, uint64_t b, uint64_t divisor)
{
	return a == 0 && divisor > 0 ? 0 : passo_divide(passo_multiply(a, b), divisor, NULL);
}

uint64_t passo_mul_div_ceil(uint64_t a, uint64_t b, uint64_t divisor)
{
	if (a == 0 && divisor > 0)
		return 0;
	uint64_t remainder;
	uint64_t quotient = passo_divide(passo_multiply(a, b), divisor, &remainder);
	return remainder > 0 && quotient < UINT64_MAX ? quotient + 1 : quotient;
}

uint64_t passo_mul_shift(uint64_t a, uint64_t b, uint32_t bits)
{
	const struct passo_u128 product = passo_multiply(a, b);

	return product.high >> bits > 0 ? UINT64_MAX : product.high << 1 << (63 - bits) | product.low >> bits;
}

/* Of 2^30 or more: each step doubles the digits, and the last one is at most 1 too large. */
static inline uint32_t isqrt32(uint32_t a)
{
	uint32_t root = 1 + (a >> 30);
	root = (root << 1) + (a >> 27) / root;
	root = (root << 3) + (a >> 21) / root;
	root = (root << 7) + (a >> 9) / root;
	return root - (root > UINT16_MAX || root * root > a);
}

/* The upper half of the root comes from the upper half of a, the lower half from one division. With one of
 * the two highest bits of a set, the result is at most 1 too large (Zimmermann, "Karatsuba Square Root"). */
uint32_t passo_isqrt64(uint64_t a)
{
	if (a == 0)
		return 0;
	uint32_t shift = leading_zeros(a) & ~UINT32_C(1);
	a <<= shift;
	uint32_t upper = isqrt32((uint32_t)high_half(a));
	uint32_t rest = (uint32_t)high_half(a) - upper * upper;    /* 0 .. 2 * upper */
	uint32_t lower = (rest << 15 | (uint32_t)a >> 17) / upper; /* 0 .. 2^16 */
	uint32_t root = upper << 16 | (lower > UINT16_MAX ? UINT16_MAX : lower);
	if (a < (uint64_t)root * root)
		root--;
	return root >> (shift / 2);
}
