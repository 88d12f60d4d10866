/* SPDX-License-Identifier: MIT
 * Decimal numbers, read exactly as they are written: no floating point, one rounding at the very end.
 */
#ifndef PASSO_DECIMAL_H
#define PASSO_DECIMAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_limits.h"

/* The absolute value is whole + 0.digits. */
struct passo_decimal {
	bool negative;
	bool is_whole;    /* written with nothing but sign and digits */
	bool too_fine;    /* it has more than PASSO_DECIMALS_MAX decimals; those are left out */
	uint64_t whole;   /* saturates */
	uint8_t decimals; /* how many digits count */
	uint8_t digits[PASSO_DECIMALS_MAX];
};

/* Read [+-]digits[.digits][e[+-]digits], with at least one digit before the exponent, times 10^power. Digits
 * may be joined by underscores (20_000). False if the text is anything else. */
bool passo_decimal_read(struct passo_decimal *number, const char *text, size_t length, int power);

bool passo_decimal_is_zero(const struct passo_decimal *number);

/* Is its absolute value above a limit? */
bool passo_decimal_exceeds(const struct passo_decimal *number, uint64_t limit);

/* The absolute value times a factor of 1 .. 2^32: the nearest integer, ties to even; or the next one up.
 * The whole part times the factor must stay below 2^64 - 2^33. */
uint64_t passo_decimal_times(const struct passo_decimal *number, uint64_t factor);
uint64_t passo_decimal_times_ceil(const struct passo_decimal *number, uint64_t factor);

#endif
