/* SPDX-License-Identifier: MIT */
#include "passo_csv.h"

static char *write_number(char *at, int64_t number)
{
	char digits[PASSO_CSV_CHARACTERS];
	unsigned count = 0;
	uint64_t rest = number < 0 ? 0u - (uint64_t)number : (uint64_t)number;

	if (number < 0)
		*at++ = '-';
	do {
		digits[count++] = (char)('0' + rest % 10u);
		rest /= 10u;
	} while (rest > 0u);
	while (count > 0u)
		*at++ = digits[--count];
	return at;
}

size_t passo_csv_write(char *text, const int64_t *numbers, size_t rows, size_t columns)
{
	char *at = text;

	for (size_t row = 0; row < rows; row++) {
		for (size_t column = 0; column < columns; column++) {
			at = write_number(at, *numbers++);
			*at++ = column + 1u < columns ? ',' : '\n';
		}
	}
	return (size_t)(at - text);
}
