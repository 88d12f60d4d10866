/* SPDX-License-Identifier: MIT
 * The forms of a move as tables of keys. The tables themselves are generated.
 */
#ifndef PASSO_FORM_TABLES_H
#define PASSO_FORM_TABLES_H

#include "passo_keys.h"
#include "passo_plan.h"

enum passo_form {
#define FORM(name, NAME) PASSO_FORM_##NAME,
	PASSO_MOVES(FORM)
#undef FORM
	    PASSO_FORM_COUNT
};

/* What is checked when all keys are read. */
enum passo_rule_kind {
	PASSO_RULE_EXCLUDES,  /* only one of the two keys is given */
	PASSO_RULE_NEEDS,     /* the key is given with the other one */
	PASSO_RULE_ABOVE_ZERO /* the key, a number, is above 0 if it is given */
};

struct passo_rule {
	uint8_t kind;
	uint8_t key, other; /* places in the form's keys */
};

struct passo_form_table {
	const char *name;
	const char *told_by; /* the key that tells this form when `method` does not; or null */
	const struct passo_key *keys;
	const struct passo_rule *rules;
	uint8_t count, rule_count;
};

extern const struct passo_form_table passo_form_tables[PASSO_FORM_COUNT];

/* The names of all keys of the forms that are told by a key. */
extern const struct passo_key passo_form_told_keys[];
extern const unsigned passo_form_told_count;

#endif
