/* SPDX-License-Identifier: MIT
 * M66: waits at rest for an input of the core. P0 is the probe, P1 and up are the home inputs of its motors.
 */
#include "passo_inputs.h"
#include "passo_player_private.h"

#define NEVER (-1)

enum passo_error passo_player_hear(const struct passo_player *player, uint8_t input, bool *level)
{
	struct passo_readings readings = {.probe = false};
	enum passo_error error = PASSO_OK;
	uint32_t levels;

	if (player->machine->inputs) {
		levels = *player->machine->inputs;
	} else {
		error = passo_read_inputs(player->feed->passo, &readings);
		levels = (uint32_t)readings.home << 1 | (readings.probe ? 1u : 0u);
	}
	*level = (levels >> input & 1u) != 0u;
	return error;
}

static bool is_as_wanted(uint8_t wanted, bool before, bool now)
{
	switch (wanted) {
	case PASSO_GCODE_WANTED_RISE:
		return now && !before;
	case PASSO_GCODE_WANTED_FALL:
		return before && !now;
	case PASSO_GCODE_WANTED_HIGH:
		return now;
	case PASSO_GCODE_WANTED_LOW:
		return !now;
	default:
		return true;
	}
}

enum passo_error passo_player_listen(struct passo_player *player, enum passo_player_event *event)
{
	const struct passo_gcode_action *action = &player->action;
	bool now = false;
	const enum passo_error error = passo_player_hear(player, action->input, &now);

	if (error != PASSO_OK) {
		passo_player_drop(player);
		return error;
	}
	const bool reached = is_as_wanted(action->wanted, player->listened ? player->input > 0 : now, now);

	player->input = now;
	if (reached)
		player->dwells = false;
	else
		passo_player_dwell(player);
	player->listened = player->waits;
	if (player->waits)
		return PASSO_OK;
	player->input = reached ? now : NEVER;
	*event = PASSO_PLAYER_INPUT;
	return PASSO_OK;
}
