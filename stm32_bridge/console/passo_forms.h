/* SPDX-License-Identifier: MIT
 * The forms of a move, those of a move file: which keys each has, and which function of the driver makes it.
 */
#ifndef PASSO_FORMS_H
#define PASSO_FORMS_H

#include "passo.h"
#include "passo_keys.h"

/* A shape that was loaded line by line: bit i of `loaded` is for points 16 i to 16 i + 15. */
struct passo_loaded_table {
	uint16_t points[PASSO_TABLE_SIZE];
	uint16_t loaded;
};
#define PASSO_TABLE_LOADED 0xFFFFu

/* Read the words of a move, and queue it. False after a complaint. */
bool passo_forms_move(struct passo *passo, struct passo_reading *reading, struct passo_words *words,
    const struct passo_loaded_table *table);

/* Print each form with its keys. */
void passo_forms_help(const struct passo_sink *sink);

/* Complain about an error of the driver. Returns false. */
bool passo_complain_error(const struct passo_sink *sink, enum passo_error error);

#endif
