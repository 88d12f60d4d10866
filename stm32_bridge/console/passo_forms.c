/* SPDX-License-Identifier: MIT */
#include "passo_forms.h"

#include <string.h>

static const struct passo_form_table *const IN_TIME = &passo_form_tables[PASSO_FORM_IN_TIME];
static const struct passo_form_table *const BY_SPEED = &passo_form_tables[PASSO_FORM_BY_SPEED];

static bool has_key(const struct passo_form_table *form, const char *name)
{
	return passo_key_find(form->keys, form->count, name) >= 0;
}

/* Finds a form by its name; null after printing an error. */
static const struct passo_form_table *form_by_name(const struct passo_sink *sink, const char *name)
{
	for (unsigned form = 0; form < PASSO_FORM_COUNT; form++) {
		if (strcmp(passo_form_tables[form].name, name) == 0)
			return &passo_form_tables[form];
	}
	passo_say(sink, "error: method must be one of ");
	for (unsigned form = 0; form < PASSO_FORM_COUNT; form++)
		passo_say(sink, "%s%s", form == 0u ? "" : ", ", passo_form_tables[form].name);
	passo_say(sink, ", not %q\n", name);
	return NULL;
}

/* Finds the form without a method, in time or by speed, from the keys given. */
static const struct passo_form_table *form_by_keys(
    const struct passo_reading *reading, struct passo_words *words)
{
	const char *of_time = NULL, *of_speed = NULL;

	if (!passo_keys_check(reading, passo_form_told_keys, passo_form_told_count, 0, words))
		return NULL;
	for (unsigned i = 0; i < words->count; i++) {
		const char *key = words->word[i].key;

		if (of_time == NULL && !has_key(BY_SPEED, key))
			of_time = key;
		if (of_speed == NULL && !has_key(IN_TIME, key))
			of_speed = key;
	}
	if (of_time != NULL && of_speed != NULL) {
		passo_complain(
		    reading->sink, "%s and %s are mutually exclusive: set time or speed", of_time, of_speed);
		return NULL;
	}
	if (of_time == NULL && passo_words_find(words, BY_SPEED->told_by) == NULL) {
		passo_complain(reading->sink, "%s or %s is missing", IN_TIME->told_by, BY_SPEED->told_by);
		return NULL;
	}
	return of_time != NULL ? IN_TIME : BY_SPEED;
}

static bool is_zero(const union passo_form_values *values, const struct passo_key *key)
{
	uint64_t value;

	memcpy(&value, (const char *)values + key->offset, sizeof value);
	return value == 0u;
}

static bool check_rules(const struct passo_reading *reading, const struct passo_form_table *form,
    const union passo_form_values *values)
{
	for (const struct passo_rule *rule = form->rules; rule < form->rules + form->rule_count; rule++) {
		const struct passo_key *key = &form->keys[rule->key], *other = &form->keys[rule->other];
		bool other_given = (reading->given >> rule->other & 1u) != 0u;

		if ((reading->given >> rule->key & 1u) == 0u)
			continue;
		if (rule->kind == PASSO_RULE_EXCLUDES && other_given)
			return passo_complain(
			    reading->sink, "%s and %s are mutually exclusive", key->name, other->name);
		if (rule->kind == PASSO_RULE_NEEDS && !other_given)
			return passo_complain(reading->sink, "%s needs %s", key->name, other->name);
		if (rule->kind == PASSO_RULE_ABOVE_ZERO && is_zero(values, key))
			return passo_complain(reading->sink, "%s must be greater than 0", key->name);
	}
	return true;
}

bool passo_forms_read(struct passo_reading *reading, struct passo_words *words,
    const struct passo_loaded_table *table, struct passo_form_move *move)
{
	const char *name = passo_words_find(words, "method");
	const struct passo_form_table *form =
	    name != NULL ? form_by_name(reading->sink, name) : form_by_keys(reading, words);

	if (form == NULL)
		return false;
	memset(move, 0, sizeof *move);
	if (!passo_keys_check(reading, form->keys, form->count, 0, words)
	    || !passo_keys_read(reading, form->keys, form->count, words, &move->values)
	    || !check_rules(reading, form, &move->values))
		return false;
	if (reading->user_shape && table->loaded != PASSO_TABLE_LOADED)
		return passo_complain(reading->sink, "table is missing");
	move->form = (enum passo_form)(form - passo_form_tables);
	move->table = reading->user_shape ? table : NULL;
	return true;
}

/* Bit i: item i of a list is not 0. */
static uint8_t axes_of_list(const char *list, size_t size)
{
	static const char ZERO[sizeof(int64_t)];
	uint8_t axes = 0;

	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++) {
		if (memcmp(list + axis * size, ZERO, size) != 0)
			axes |= (uint8_t)(1u << axis);
	}
	return axes;
}

uint8_t passo_forms_axes(const struct passo_form_move *move)
{
	const struct passo_form_table *form = &passo_form_tables[move->form];
	uint8_t axes = 0;

	for (const struct passo_key *key = form->keys; key < form->keys + form->count; key++) {
		const char *place = (const char *)&move->values + key->offset;

		if (key->reader == PASSO_READ_STEPS)
			axes |= axes_of_list(place, sizeof(int32_t));
		else if (key->reader == PASSO_READ_DISTANCE)
			axes |= axes_of_list(place, sizeof(int64_t));
		else if (key->reader == PASSO_READ_AXIS)
			axes |= (uint8_t)(1u << *(const uint8_t *)place);
	}
	return axes;
}

static enum passo_error queue_user(struct passo *passo, const struct passo_form_move *move)
{
	const struct passo_user_shape shape = {.bank = PASSO_USER_BANK, .table = move->table->points};

	switch (move->form) {
#define QUEUE(name, NAME)                                                                                    \
	case PASSO_FORM_##NAME:                                                                              \
		return passo_move_user_##name(passo, &move->values.name, &shape);
		PASSO_MOVES_BY_SHAPE(QUEUE)
#undef QUEUE
	default:
		return PASSO_ERROR_ARGUMENT_POINTER;
	}
}

static enum passo_error queue(struct passo *passo, const struct passo_form_move *move)
{
	if (move->table != NULL)
		return queue_user(passo, move);
	switch (move->form) {
#define QUEUE(name, NAME)                                                                                    \
	case PASSO_FORM_##NAME:                                                                              \
		return passo_move_##name(passo, &move->values.name);
		PASSO_MOVES(QUEUE)
#undef QUEUE
	case PASSO_FORM_COUNT:
		break;
	}
	return PASSO_ERROR_ARGUMENT_POINTER;
}

enum passo_error passo_forms_queue(struct passo *passo, const struct passo_form_move *move)
{
	const enum passo_error error = queue(passo, move);

	if (error >= PASSO_ERROR_ABSURD && error < PASSO_ERROR_ARGUMENT) /* values of a line have units */
		return (enum passo_error)((unsigned)error - PASSO_ERROR_ABSURD + PASSO_ERROR_PLAN);
	return error;
}

#ifndef PASSO_WITHOUT_PARTS
static enum passo_plan_error plan_user(
    const struct passo *passo, const struct passo_form_move *move, struct passo_plan *plan)
{
	const struct passo_user_shape shape = {.bank = PASSO_USER_BANK, .table = move->table->points};

	switch (move->form) {
#define PLAN(name, NAME)                                                                                     \
	case PASSO_FORM_##NAME:                                                                              \
		return passo_plan_user_##name(passo_machine(passo), &move->values.name, &shape, plan);
		PASSO_MOVES_BY_SHAPE(PLAN)
#undef PLAN
	default:
		return PASSO_PLAN_BAD_PROFILE;
	}
}

enum passo_plan_error passo_forms_plan(
    const struct passo *passo, const struct passo_form_move *move, struct passo_plan *plan)
{
	if (move->table != NULL)
		return plan_user(passo, move, plan);
	switch (move->form) {
#define PLAN(name, NAME)                                                                                     \
	case PASSO_FORM_##NAME:                                                                              \
		return passo_plan_##name(passo_machine(passo), &move->values.name, plan);
		PASSO_MOVES(PLAN)
#undef PLAN
	case PASSO_FORM_COUNT:
		break;
	}
	return PASSO_PLAN_BAD_PROFILE;
}
#endif

void passo_forms_help(const struct passo_sink *sink)
{
	for (unsigned i = 0; i < PASSO_FORM_COUNT; i++) {
		const struct passo_form_table *form = &passo_form_tables[i];

		passo_say(
		    sink, form->told_by != NULL ? "  move [method=%s]" : "  move method=%s", form->name);
		passo_keys_help(sink, form->keys + 1, form->count - 1u);
		passo_say(sink, "\n");
	}
}

bool passo_complain_error(const struct passo_sink *sink, enum passo_error error)
{
	return passo_complain(sink, "%s: %s", passo_error_name(error), passo_error_text(error));
}
