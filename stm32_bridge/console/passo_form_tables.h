/* SPDX-License-Identifier: MIT
 * Internal: the move forms as key tables. The tables are generated.
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

/* Rules between keys, checked after all of them are read. */
enum passo_rule_kind {
	PASSO_RULE_EXCLUDES,  /* at most one of the two keys may be given */
	PASSO_RULE_NEEDS,     /* the key requires the other one */
	PASSO_RULE_ABOVE_ZERO /* the key must be above 0 if given */
};

struct passo_rule {
	uint8_t kind;
	uint8_t key, other; /* indices of the form's keys */
};

struct passo_form_table {
	const char *name;
	const char *told_by; /* the key that identifies this form when `method` is missing; or null */
	const struct passo_key *keys;
	const struct passo_rule *rules;
	uint8_t count, rule_count;
};

extern const struct passo_form_table passo_form_tables[PASSO_FORM_COUNT];

/* All keys of the forms that are identified by a key. */
extern const struct passo_key passo_form_told_keys[];
extern const unsigned passo_form_told_count;

#endif
