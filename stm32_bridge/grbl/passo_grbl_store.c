/* SPDX-License-Identifier: MIT
 * Settings, offsets and start lines: changed, stored, and as they were at first.
 */
#include "passo_grbl_private.h"

#include <string.h>

static void set_defaults(struct passo_grbl *grbl)
{
	grbl->setup->defaults(&grbl->stored.settings);
}

/* Another number of axes, or a record of which the values make no sense here, gives the defaults. */
static bool is_possible(struct passo_grbl *grbl)
{
	const struct passo_grbl_counts counts = passo_grbl_counts(grbl);
	struct passo_grbl_settings trial; /* of those before, only homing permits others */
	unsigned number;
	bool whole;

	trial.value[PASSO_GRBL_HOMING] = grbl->stored.settings.value[PASSO_GRBL_HOMING];
	for (unsigned i = 0; (number = passo_grbl_setting_number(i, counts, &whole)) != PASSO_GRBL_NO_SETTING;
	    i++) {
		const int64_t value = *passo_grbl_setting(&grbl->stored.settings, number, counts);

		if (passo_grbl_set(&trial, number, counts, value) != PASSO_GCODE_OK)
			return false;
	}
	for (unsigned i = 0; i < PASSO_GRBL_STARTS; i++)
		grbl->stored.start[i][PASSO_GRBL_START_SIZE - 1] = '\0';
	return passo_grbl_apply(grbl) == PASSO_GCODE_OK;
}

static uint32_t *words_of(struct passo_grbl_stored *stored)
{
	return (uint32_t *)(void *)stored; /* eight-byte members only, and text */
}

enum passo_gcode_error passo_grbl_load(struct passo_grbl *grbl)
{
	const struct passo_storage_pages *pages = grbl->setup->pages;
	enum passo_storage_state state = PASSO_STORAGE_EMPTY;

	_Static_assert(sizeof grbl->stored % sizeof(uint32_t) == 0, "the record is words");
	grbl->path.machine = grbl->setup->path.machine;
	set_defaults(grbl);
	passo_storage_open(&grbl->storage, pages, PASSO_GRBL_STORED_WORDS);
	if (pages)
		state = passo_storage_load(&grbl->storage, words_of(&grbl->stored));
	if (state == PASSO_STORAGE_LOADED && is_possible(grbl)) {
		passo_gcode_set_offsets(grbl->player->gcode, &grbl->stored.offsets);
		return PASSO_GCODE_OK;
	}
	memset(&grbl->stored, 0, sizeof grbl->stored);
	set_defaults(grbl);
	const enum passo_gcode_error applied = passo_grbl_apply(grbl);

	return state == PASSO_STORAGE_EMPTY ? applied : PASSO_GCODE_STORAGE;
}

enum passo_gcode_error passo_grbl_save(struct passo_grbl *grbl)
{
	grbl->stored.offsets = grbl->player->gcode->offsets;
	if (!grbl->setup->pages)
		return PASSO_GCODE_OK;
	return passo_storage_save(&grbl->storage, words_of(&grbl->stored)) ? PASSO_GCODE_OK
	                                                                   : PASSO_GCODE_STORAGE;
}

static enum passo_gcode_error change_start(struct passo_grbl *grbl, const char *text)
{
	const unsigned number = (unsigned)(text[0] - '0');

	if (number >= PASSO_GRBL_STARTS || text[1] != '=')
		return PASSO_GCODE_STATEMENT;
	if (strlen(text + 2) >= PASSO_GRBL_START_SIZE)
		return PASSO_GCODE_LINE_LENGTH;
	if (grbl->locked)
		return PASSO_GCODE_LOCKED;
	struct passo_gcode *gcode = grbl->player->gcode;
	const struct passo_gcode before = *gcode;
	char start[PASSO_GRBL_START_SIZE];
	enum passo_gcode_error error =
	    text[2] == '\0' ? PASSO_GCODE_OK : passo_gcode_execute(gcode, text + 2);

	if (error != PASSO_GCODE_OK)
		return error;
	memcpy(start, grbl->stored.start[number], sizeof start);
	memset(grbl->stored.start[number], 0, sizeof start);
	memcpy(grbl->stored.start[number], text + 2, strlen(text + 2));
	error = passo_grbl_save(grbl);
	if (error != PASSO_GCODE_OK) {
		memcpy(grbl->stored.start[number], start, sizeof start);
		*gcode = before;
	}
	return error;
}

static enum passo_gcode_error change_setting(struct passo_grbl *grbl, unsigned number, int64_t value)
{
	const struct passo_grbl_settings before = grbl->stored.settings;
	enum passo_gcode_error error =
	    passo_grbl_set(&grbl->stored.settings, number, passo_grbl_counts(grbl), value);

	if (error == PASSO_GCODE_OK)
		error = passo_grbl_apply(grbl);
	if (error == PASSO_GCODE_OK)
		error = passo_grbl_save(grbl);
	if (error != PASSO_GCODE_OK) {
		grbl->stored.settings = before;
		passo_grbl_apply(grbl);
	}
	return error;
}

enum passo_gcode_error passo_grbl_change(struct passo_grbl *grbl, const char *text)
{
	unsigned number = 0, digits = 0;
	int64_t value = 0;

	if (text[0] == 'N')
		return change_start(grbl, text + 1);
	for (; text[0] >= '0' && text[0] <= '9' && digits < 3; digits++)
		number = 10 * number + (unsigned)(*text++ - '0');
	if (digits == 0 || *text++ != '=')
		return PASSO_GCODE_STATEMENT;
	if (!passo_gcode_number(&text, &value) || *text != '\0')
		return PASSO_GCODE_NUMBER;
	return change_setting(grbl, number, value);
}

enum passo_gcode_error passo_grbl_restore(struct passo_grbl *grbl, const char *text)
{
	const char what = text[0];

	if ((what != '$' && what != '#' && what != '*') || text[1] != '\0')
		return PASSO_GCODE_STATEMENT;
	const struct passo_grbl_stored before = grbl->stored;

	if (what != '#')
		set_defaults(grbl);
	if (what != '$')
		passo_gcode_set_offsets(grbl->player->gcode, &(struct passo_gcode_offsets){.home = {{0}}});
	if (what == '*')
		memset(grbl->stored.start, 0, sizeof grbl->stored.start);
	passo_grbl_apply(grbl);
	const enum passo_gcode_error error = passo_grbl_save(grbl);
	if (error != PASSO_GCODE_OK) {
		grbl->stored = before;
		passo_gcode_set_offsets(grbl->player->gcode, &before.offsets);
		passo_grbl_apply(grbl);
		return error;
	}
	passo_grbl_say(grbl, "[MSG:Restoring defaults]\r\n");
	passo_grbl_ask_reset(grbl);
	return PASSO_GCODE_OK;
}
