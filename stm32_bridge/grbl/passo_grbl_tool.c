/* SPDX-License-Identifier: MIT
 * Tool change, and tool lengths by the probe, as grblHAL has them.
 *
 * M6 pauses the program until `~`. A sender that says 0xA3 types other lines meanwhile: jogs, probes, `$TPW`.
 * They are read from the ring past the lines of the program, which keep their place.
 */
#include "passo_grbl_private.h"

#ifndef PASSO_PLAIN_GCODE

#include "passo_math.h"

#define RETRACT_NM 2000000 /* between the fast and the slow probe; twice that at the end */
#define OPTIONAL 383       /* as G38.3 */
#define SECONDS_PER_MINUTE 60u

enum touch { TOUCH_NONE, TOUCH_SEEK, TOUCH_BACK, TOUCH_FEED, TOUCH_CLEAR };

/* Z; the number of axes if there is none. */
static unsigned tool_axis(const struct passo_grbl *grbl)
{
	const struct passo_gcode_settings *settings = &grbl->player->gcode->settings;
	unsigned axis = 0;

	while (axis < settings->axes && passo_gcode_axis_letter(settings->left_out, axis) != 'Z')
		axis++;
	return axis;
}

static bool has_tool_axis(const struct passo_grbl *grbl)
{
	return tool_axis(grbl) < grbl->player->gcode->settings.axes;
}

void passo_grbl_begin_change(struct passo_grbl *grbl)
{
	passo_grbl_say(grbl, "[MSG:Tool change: T");
	passo_grbl_say_number(grbl, grbl->player->loads);
	passo_grbl_say(grbl, "]\r\n");
}

void passo_grbl_report_tools(struct passo_grbl *grbl)
{
	const struct passo_gcode *gcode = grbl->player->gcode;

	for (unsigned tool = 0; tool < PASSO_GCODE_TOOLS && has_tool_axis(grbl); tool++) {
		const int64_t length = gcode->offsets.tool_length[tool];

		if (length == 0)
			continue;
		passo_gcode_position offset = {0};
		offset[tool_axis(grbl)] = length;
		passo_grbl_say(grbl, "[T:");
		passo_grbl_say_number(grbl, tool + 1u);
		passo_grbl_say_position(grbl, ",", offset);
		passo_grbl_say(grbl, ",");
		passo_grbl_say_length(grbl, 0); /* the radius */
		passo_grbl_say(grbl, "]\r\n");
	}
}

enum passo_gcode_error passo_grbl_set_reference(struct passo_grbl *grbl)
{
	if (!grbl->player->touched || !has_tool_axis(grbl))
		return PASSO_GCODE_TOOL_LENGTH_UNKNOWN;
	grbl->reference = grbl->player->touch[tool_axis(grbl)];
	grbl->measured = true;
	return PASSO_GCODE_OK;
}

/* A motion of Z alone, to a machine coordinate within the travel. */
static void move(struct passo_grbl *grbl, enum touch step, int64_t target, enum passo_grbl_setting feed)
{
	struct passo_gcode *gcode = grbl->player->gcode;
	const struct passo_player_machine *limits = grbl->player->machine;
	const unsigned tool = tool_axis(grbl);
	struct passo_gcode_action action = {.line = gcode->line,
	    .probe = PASSO_GCODE_NONE,
	    .feed = passo_mul_div((uint64_t)grbl->stored.settings.value[feed], UINT64_C(1) << 32,
		(uint64_t)PASSO_GCODE_MILLION * SECONDS_PER_MINUTE)};

	if (step == TOUCH_SEEK || step == TOUCH_FEED) {
		action.kind = PASSO_GCODE_PROBE;
		action.probe = OPTIONAL;
	}
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
		action.target[axis] = gcode->position[axis];
	action.target[tool] = target;
	if (limits->limited && target < limits->low[tool])
		action.target[tool] = limits->low[tool];
	if (limits->limited && target > limits->high[tool])
		action.target[tool] = limits->high[tool];
	passo_gcode_set_position(gcode, action.target);
	passo_player_take(grbl->player, &action);
	grbl->touch = (uint8_t)step;
}

enum passo_gcode_error passo_grbl_touch(struct passo_grbl *grbl)
{
	const struct passo_gcode *gcode = grbl->player->gcode;

	if (grbl->locked)
		return PASSO_GCODE_LOCKED;
	if (!has_tool_axis(grbl) || !grbl->setup->probe)
		return PASSO_GCODE_TOOL_LENGTH_UNKNOWN;
	move(grbl, TOUCH_SEEK,
	    gcode->position[tool_axis(grbl)] - grbl->stored.settings.value[PASSO_GRBL_TOUCH_DISTANCE],
	    PASSO_GRBL_TOUCH_SEEK);
	return PASSO_GCODE_OK;
}

static void end(struct passo_grbl *grbl, enum passo_gcode_error error)
{
	grbl->touch = TOUCH_NONE;
	grbl->owes = false;
	passo_grbl_answer(grbl, error);
}

void passo_grbl_poll_touch(struct passo_grbl *grbl)
{
	struct passo_player *player = grbl->player;

	if (grbl->touch == TOUCH_NONE || !passo_player_is_idle(player))
		return;
	const int64_t at = player->touch[tool_axis(grbl)];
	if (!player->touched && grbl->touch != TOUCH_CLEAR) {
		passo_grbl_say(grbl, "[MSG:Probe failed, try again]\r\n");
		end(grbl, PASSO_GCODE_TOOL_LENGTH_UNKNOWN);
		return;
	}
	switch (grbl->touch) {
	case TOUCH_SEEK:
		move(grbl, TOUCH_BACK, at + RETRACT_NM, PASSO_GRBL_TOUCH_PULL_OFF);
		break;
	case TOUCH_BACK:
		move(grbl, TOUCH_FEED, at - RETRACT_NM, PASSO_GRBL_TOUCH_FEED);
		break;
	case TOUCH_FEED:
		if (grbl->measured)
			passo_gcode_set_length(player->gcode, at - grbl->reference);
		move(grbl, TOUCH_CLEAR, at + 2 * RETRACT_NM, PASSO_GRBL_TOUCH_SEEK);
		break;
	default:
		grbl->reports = 0;
		end(grbl, PASSO_GCODE_OK);
		break;
	}
}

#endif
