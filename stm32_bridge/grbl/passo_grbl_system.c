/* SPDX-License-Identifier: MIT
 * Lines that begin with `$`.
 */
#include "passo_grbl.h"
#include "passo_math.h"

#include <string.h>

/* A setting with three decimals, from UQ32.32 times a factor. */
static void say_setting(struct passo_grbl *grbl, unsigned number, uint64_t value, uint32_t factor)
{
	passo_grbl_say(grbl, "$");
	passo_grbl_say_number(grbl, number);
	passo_grbl_say(grbl, "=");
	passo_grbl_say_millimetres(
	    grbl, (int64_t)passo_mul_div(value, (uint64_t)factor * PASSO_GCODE_MILLION, UINT64_C(1) << 32));
	passo_grbl_say(grbl, "\r\n");
}

static void say_settings(struct passo_grbl *grbl)
{
	const struct passo_player *player = grbl->player;

	passo_grbl_say(grbl, "$12=");
	passo_grbl_say_millimetres(grbl, player->gcode->settings.arc_tolerance);
	passo_grbl_say(grbl, "\r\n$30=");
	passo_grbl_say_number(grbl, player->gcode->settings.spindle_maximum);
	passo_grbl_say(grbl, "\r\n");
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		say_setting(grbl, 100 + axis, player->machine->axis[axis].steps_per_mm, 1);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		say_setting(grbl, 110 + axis, player->machine->axis[axis].speed, 60);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		say_setting(grbl, 120 + axis, player->machine->axis[axis].acceleration, 1);
}

static enum passo_gcode_error unlock(struct passo_grbl *grbl)
{
	if (grbl->alarm != PASSO_GRBL_NO_ALARM)
		passo_grbl_say(grbl, "[MSG:Caution: Unlocked]\r\n");
	grbl->alarm = PASSO_GRBL_NO_ALARM;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check(struct passo_grbl *grbl)
{
	if (!grbl->checks && !passo_grbl_is_idle(grbl))
		return PASSO_GCODE_NOT_IDLE;
	grbl->checks = !grbl->checks;
	passo_grbl_say(grbl, grbl->checks ? "[MSG:Enabled]\r\n" : "[MSG:Disabled]\r\n");
	grbl->resets = grbl->resets || !grbl->checks;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error jog(struct passo_grbl *grbl, const char *text)
{
	if (grbl->alarm != PASSO_GRBL_NO_ALARM)
		return PASSO_GCODE_LOCKED;
	if (text[0] != '=')
		return PASSO_GCODE_JOG;
	if (!grbl->jogs && !passo_grbl_is_idle(grbl))
		return PASSO_GCODE_NOT_IDLE;
	const enum passo_gcode_error error = passo_gcode_jog(grbl->player->gcode, text + 1);
	grbl->jogs = grbl->jogs || error == PASSO_GCODE_OK;
	return error;
}

enum passo_gcode_error passo_grbl_system(struct passo_grbl *grbl, const char *text)
{
	if (strncmp(text, "$J", 2) == 0)
		return jog(grbl, text + 2);
	if (strcmp(text, "$X") == 0)
		return unlock(grbl);
	if (strcmp(text, "$C") == 0)
		return check(grbl);
	if (strcmp(text, "$G") == 0)
		passo_grbl_report_modes(grbl);
	else if (strcmp(text, "$") == 0)
		passo_grbl_say(grbl, "[HLP:$$ $# $G $I $J=line $C $X ~ ! ? ctrl-x]\r\n");
	else if (strcmp(text, "$I") == 0)
		passo_grbl_say(grbl, "[VER:1.1h.passo:]\r\n[OPT:VNM,48,255]\r\n");
	else if (strcmp(text, "$H") == 0)
		return PASSO_GCODE_NO_HOMING;
	else if (strcmp(text, "$$") != 0 && strcmp(text, "$#") != 0)
		return PASSO_GCODE_STATEMENT;
	else if (!passo_grbl_is_idle(grbl))
		return PASSO_GCODE_NOT_IDLE;
	else if (text[1] == '$')
		say_settings(grbl);
	else
		passo_grbl_report_offsets(grbl);
	return PASSO_GCODE_OK;
}
