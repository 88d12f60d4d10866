/* SPDX-License-Identifier: MIT
 * Lines that begin with `$`.
 */
#include "passo_grbl_private.h"

#include <string.h>

static enum passo_gcode_error unlock(struct passo_grbl *grbl)
{
	if (grbl->stopping)
		return PASSO_GCODE_LOCKED; /* e-stop is still pressed */
	if (grbl->locked)
		passo_grbl_say(grbl, "[MSG:Caution: Unlocked]\r\n");
	grbl->locked = false;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check(struct passo_grbl *grbl)
{
	passo_grbl_say(grbl, grbl->checks ? "[MSG:Disabled]\r\n" : "[MSG:Enabled]\r\n");
	if (grbl->checks)
		passo_grbl_ask_reset(grbl);
#ifndef PASSO_PLAIN_GCODE
	else
		grbl->loaded = grbl->player->gcode->loaded;
#endif
	grbl->checks = grbl->player->checks = true; /* until the reset */
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error jog(struct passo_grbl *grbl, const char *text)
{
	struct passo_gcode *gcode = grbl->player->gcode;
	passo_gcode_position before = {0};

	if (text[0] != '=')
		return PASSO_GCODE_JOG;
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
		before[axis] = gcode->position[axis];
	const enum passo_gcode_error error = passo_gcode_jog(gcode, text + 1);
	if (error == PASSO_GCODE_OK && !passo_player_allows(grbl->player, gcode->position)) {
		passo_gcode_set_position(gcode, before);
		return PASSO_GCODE_TRAVEL;
	}
	if (error == PASSO_GCODE_OK) {
		grbl->jogs = true;
		passo_grbl_override(grbl);
	}
	return error;
}

/* Until a reset. Then the position is not sure any more. */
static enum passo_gcode_error sleep(struct passo_grbl *grbl)
{
	if (passo_grbl_drive(grbl, false) != PASSO_OK)
		return PASSO_GCODE_NOT_IDLE;
	grbl->sleeps = grbl->locked = true;
	passo_gcode_reset(grbl->player->gcode); /* spindle and coolant */
	passo_grbl_say(grbl, "[MSG:Sleeping]\r\n");
	return PASSO_GCODE_OK;
}

/* What needs rest. */
static enum passo_gcode_error at_rest(struct passo_grbl *grbl, const char *text)
{
	if (!passo_grbl_is_idle(grbl))
		return PASSO_GCODE_NOT_IDLE;
	if (strcmp(text, "#") == 0)
		passo_grbl_report_offsets(grbl);
	else if (strcmp(text, "I") == 0)
		passo_grbl_report_build(grbl);
	else if (strcmp(text, "N") == 0)
		passo_grbl_report_starts(grbl);
#ifndef PASSO_PLAIN_GCODE
	else if (strcmp(text, "TLR") == 0)
		return passo_grbl_set_reference(grbl);
	else if (strcmp(text, "TPW") == 0)
		return passo_grbl_touch(grbl);
#endif
	else if (strcmp(text, "H") == 0)
		return passo_grbl_home(grbl);
	else if (strcmp(text, "SLP") == 0)
		return sleep(grbl);
	else if (strncmp(text, "RST=", 4) == 0)
		return passo_grbl_restore(grbl, text + 4);
	else if (!grbl->setup->take_line || !grbl->setup->take_line(text))
		return passo_grbl_change(grbl, text);
	return PASSO_GCODE_OK;
}

enum passo_gcode_error passo_grbl_system(struct passo_grbl *grbl, enum passo_grbl_kind kind, const char *text)
{
	switch (kind) {
	case PASSO_GRBL_KIND_JOG:
		return jog(grbl, text + 2);
	case PASSO_GRBL_KIND_UNLOCK:
		return unlock(grbl);
	case PASSO_GRBL_KIND_CHECK:
		return check(grbl);
	case PASSO_GRBL_KIND_MODES:
		if (text[1] == 'G')
			passo_grbl_report_modes(grbl);
		else
			passo_grbl_say(grbl, "[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H "
					     "$RST= ~ ! ? ctrl-x]\r\n");
		return PASSO_GCODE_OK;
	case PASSO_GRBL_KIND_SETTINGS:
		passo_grbl_report_settings(grbl);
		return PASSO_GCODE_OK;
	default:
		return at_rest(grbl, text + 1);
	}
}
