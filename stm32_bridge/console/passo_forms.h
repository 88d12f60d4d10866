/* SPDX-License-Identifier: MIT
 * Internal: the move forms on the console: their keys, and the functions of the driver that execute them.
 */
#ifndef PASSO_FORMS_H
#define PASSO_FORMS_H

#include "passo.h"
#include "passo_keys.h"

/* A shape that is loaded line by line. Bit i of `loaded`: points 16 i to 16 i + 15 are present. */
struct passo_loaded_table {
	uint16_t points[PASSO_TABLE_SIZE];
	uint16_t loaded;
};
#define PASSO_TABLE_LOADED 0xFFFFu

/* Reads the words of a move and queues it. Returns false after printing an error. */
bool passo_forms_move(struct passo *passo, struct passo_reading *reading, struct passo_words *words,
    const struct passo_loaded_table *table);

/* Prints each form with its keys. */
void passo_forms_help(const struct passo_sink *sink);

/* Prints an error of the driver. Returns false. */
bool passo_complain_error(const struct passo_sink *sink, enum passo_error error);

#endif
