/* SPDX-License-Identifier: MIT
 * Internal: the move forms on the console: their keys, and the functions of the driver that execute them.
 */
#ifndef PASSO_FORMS_H
#define PASSO_FORMS_H

#include "passo.h"
#include "passo_form_tables.h"

/* A shape that is loaded line by line. Bit i of `loaded`: points 16 i to 16 i + 15 are present. */
struct passo_loaded_table {
	uint16_t points[PASSO_TABLE_SIZE];
	uint16_t loaded;
};
#define PASSO_TABLE_LOADED 0xFFFFu

/* A move that was read. */
struct passo_form_move {
	enum passo_form form;
	const struct passo_loaded_table *table; /* of a user-defined shape; null: a built-in one */
	union passo_form_values {
#define MEMBER(name, NAME) struct passo_move_##name name;
		PASSO_MOVES(MEMBER)
#undef MEMBER
	} values;
};

/* Reads the words of a move. Returns false after printing an error. */
bool passo_forms_read(struct passo_reading *reading, struct passo_words *words,
    const struct passo_loaded_table *table, struct passo_form_move *move);

/* Bit i: the move names axis i. */
uint8_t passo_forms_axes(const struct passo_form_move *move);

#ifndef PASSO_WITHOUT_PARTS
/* Plans it as passo_forms_queue() does, and queues nothing. */
enum passo_plan_error passo_forms_plan(
    const struct passo *passo, const struct passo_form_move *move, struct passo_plan *plan);
#endif

enum passo_error passo_forms_queue(struct passo *passo, const struct passo_form_move *move);

/* Prints each form with its keys. */
void passo_forms_help(const struct passo_sink *sink);

/* Prints an error of the driver. Returns false. */
bool passo_complain_error(const struct passo_sink *sink, enum passo_error error);

#endif
