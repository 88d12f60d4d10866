/* SPDX-License-Identifier: MIT
 * Exact decimal numbers: no floating point, a single rounding at the end.
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
	bool is_whole;    /* written with only sign and digits */
	bool too_fine;    /* more than PASSO_DECIMALS_MAX decimal places; the rest is dropped */
	uint64_t whole;   /* saturates */
	uint8_t decimals; /* number of valid digits */
	uint8_t digits[PASSO_DECIMALS_MAX];
};

/* Parses [+-]digits[.digits][e[+-]digits], with at least one digit before the exponent, times 10^power.
 * Digits may be separated by underscores (20_000). Returns false for any other text. */
bool passo_decimal_read(struct passo_decimal *number, const char *text, size_t length, int power);

bool passo_decimal_is_zero(const struct passo_decimal *number);

/* Whether the absolute value is above a limit. */
bool passo_decimal_exceeds(const struct passo_decimal *number, uint64_t limit);

/* The absolute value times a factor of 1 .. 2^32, rounded to nearest (ties to even), or up. The whole part
 * times the factor must be below 2^64 - 2^33. */
uint64_t passo_decimal_times(const struct passo_decimal *number, uint64_t factor);
uint64_t passo_decimal_times_ceil(const struct passo_decimal *number, uint64_t factor);

#endif
