/* SPDX-License-Identifier: MIT
 * Integer digits go into `whole`, the others are stored one by one. Multiplication is schoolbook, starting
 * with the last digit: the carry out of the first one is added to the whole part of the product.
 */
#include "passo_decimal.h"

#include <string.h>

#define EXPONENT_MAX 10000

static bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

/* whole = whole * 10 + digit, saturating. */
static void append(struct passo_decimal *number, uint8_t digit)
{
	if (number->whole > (UINT64_MAX - 9u) / 10u)
		number->whole = UINT64_MAX;
	else
		number->whole = number->whole * 10u + digit;
}

/* Parses the exponent after its `e`; false if it is invalid. */
static bool read_exponent(const char *text, const char *end, int *exponent)
{
	bool negative = text < end && *text == '-';

	if (text < end && (*text == '-' || *text == '+'))
		text++;
	if (text == end)
		return false;
	for (*exponent = 0; text < end; text++) {
		if (!is_digit(*text))
			return false;
		if (*exponent < EXPONENT_MAX)
			*exponent = *exponent * 10 + (*text - '0');
	}
	if (negative)
		*exponent = -*exponent;
	return true;
}

/* Stores the digits of a mantissa; `point` is the position of the decimal point, in digits from the first
 * one. */
static void place_digits(struct passo_decimal *number, const char *text, const char *end, int point)
{
	int place = 0;

	for (; text < end; text++) {
		if (!is_digit(*text))
			continue;
		uint8_t digit = (uint8_t)(*text - '0');

		if (place < point)
			append(number, digit);
		else if (place - point < (int)PASSO_DECIMALS_MAX)
			number->digits[place - point] = digit;
		place++;
	}
	for (; place < point && number->whole != 0u && number->whole != UINT64_MAX; place++)
		append(number, 0);
	if (place > point) {
		number->too_fine = place - point > (int)PASSO_DECIMALS_MAX;
		number->decimals =
		    (uint8_t)(number->too_fine ? PASSO_DECIMALS_MAX : (unsigned)(place - point));
	}
}

/* An underscore between two digits. */
static bool joins_digits(const char *at, const char *start, const char *end)
{
	return *at == '_' && at > start && is_digit(at[-1]) && at + 1 < end && is_digit(at[1]);
}

bool passo_decimal_read(struct passo_decimal *number, const char *text, size_t length, int power)
{
	const char *end = text + length, *mantissa, *scan;
	int exponent = 0, digits = 0, point = -1;

	memset(number, 0, sizeof *number);
	number->negative = text < end && *text == '-';
	if (text < end && (*text == '-' || *text == '+'))
		text++;
	mantissa = text;
	for (scan = text; scan < end; scan++) {
		if (*scan == '.' && point < 0)
			point = digits;
		else if (is_digit(*scan))
			digits++;
		else if (!joins_digits(scan, mantissa, end))
			break;
	}
	number->is_whole = scan == end && point < 0;
	if (digits == 0)
		return false;
	if (scan < end && ((*scan != 'e' && *scan != 'E') || !read_exponent(scan + 1, end, &exponent)))
		return false;
	place_digits(number, mantissa, scan, (point < 0 ? digits : point) + exponent + power);
	return true;
}

static bool has_fraction(const uint8_t *digits, unsigned from, unsigned count)
{
	for (unsigned i = from; i < count; i++) {
		if (digits[i] != 0u)
			return true;
	}
	return false;
}

bool passo_decimal_is_zero(const struct passo_decimal *number)
{
	return number->whole == 0u && !has_fraction(number->digits, 0, number->decimals);
}

bool passo_decimal_exceeds(const struct passo_decimal *number, uint64_t limit)
{
	return number->whole > limit
	    || (number->whole == limit && has_fraction(number->digits, 0, number->decimals));
}

/* The product rounded down; its decimal digits go to *rest. */
static uint64_t multiply(const struct passo_decimal *number, uint64_t factor, uint8_t *rest)
{
	uint64_t carry = 0;

	for (unsigned i = number->decimals; i-- > 0u;) {
		uint64_t sum = number->digits[i] * factor + carry;

		rest[i] = (uint8_t)(sum % 10u);
		carry = sum / 10u;
	}
	return number->whole * factor + carry;
}

uint64_t passo_decimal_times(const struct passo_decimal *number, uint64_t factor)
{
	uint8_t rest[PASSO_DECIMALS_MAX] = {0};
	uint64_t product = multiply(number, factor, rest);
	bool above = rest[0] > 5u || (rest[0] == 5u && has_fraction(rest, 1, number->decimals));
	bool tie = rest[0] == 5u && !above;

	return product + (above || (tie && (product & 1u) != 0u));
}

uint64_t passo_decimal_times_ceil(const struct passo_decimal *number, uint64_t factor)
{
	uint8_t rest[PASSO_DECIMALS_MAX] = {0};
	uint64_t product = multiply(number, factor, rest);

	return product + has_fraction(rest, 0, number->decimals);
}
