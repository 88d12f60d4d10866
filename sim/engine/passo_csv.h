/* SPDX-License-Identifier: MIT
 * Rows of whole numbers as text, with commas and line feeds.
 */
#ifndef PASSO_CSV_H
#define PASSO_CSV_H

#include <stddef.h>
#include <stdint.h>

/* Most characters of a number, with the comma or line feed behind it. */
enum { PASSO_CSV_CHARACTERS = 21 };

/* Writes `rows` rows of `columns` numbers, row after row; `text` has room for PASSO_CSV_CHARACTERS each.
 * Returns the length. */
size_t passo_csv_write(char *text, const int64_t *numbers, size_t rows, size_t columns);

#endif
