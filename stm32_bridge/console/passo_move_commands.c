/* SPDX-License-Identifier: MIT
 * Commands that start motions: moves and rotation.
 */
#include "passo_call.h"
#include "passo_commands.h"

bool passo_check_enabled(const struct passo_call *call, uint8_t axes, uint8_t *off)
{
	uint32_t axis = 0;

	*off = axes & (uint8_t)~call->channel->enabled;
	if (!call->console->need_enable || *off == 0u)
		return true;
	while (((uint32_t)*off >> axis & 1u) == 0u)
		axis++;
	return passo_complain(&call->console->sink, "NOT_ENABLED: axis %u is not enabled", axis);
}

void passo_note_disabled(const struct passo_call *call, uint8_t off)
{
	const uint32_t news = off & (uint8_t)~call->channel->announced;

	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		if ((news >> axis & 1u) != 0u)
			passo_say(&call->console->sink, "note: axis %u is not enabled\n", axis);
	}
	call->channel->announced |= off;
}

/* Remembers which channels move; returns whether their motions end by themselves, as a rotation does not. */
static bool see_moving(struct passo_console *console)
{
	int32_t ends[PASSO_AXES_MAX];
	bool all_end = true;

	console->seen_moving = 0;
	for (unsigned i = 0; i < passo_commands_channels(console); i++) {
		const struct passo *passo = &console->channel[i].passo;

		if (!passo_is_moving(passo))
			continue;
		console->seen_moving |= (uint8_t)(1u << i);
		all_end &= passo_target(passo, ends) != PASSO_ERROR_MOVING;
	}
	return all_end;
}

/* Whether the move can be queued later, when those before it have progressed. A table needs all channels at
 * rest. */
static bool can_wait(const struct passo_call *call, enum passo_error error)
{
	struct passo_console *console = call->console;
	const bool all_end = see_moving(console);

	if (!console->flow_waits)
		return false;
	if (error == PASSO_ERROR_TABLE)
		return console->seen_moving != 0u && all_end;
	return error == PASSO_ERROR_FULL && passo_is_moving(&call->channel->passo);
}

bool passo_run_move(const struct passo_call *call)
{
	struct passo_console *console = call->console;
	struct passo_form_move move;
	enum passo_error error;
	uint8_t off;

	if (!passo_output_read(call) || !passo_forms_read(call->reading, call->words, &console->table, &move)
	    || !passo_output_fits(call, &move) || !passo_check_enabled(call, passo_forms_axes(&move), &off))
		return false;
	error = passo_output_queue(call, &move);
	if (can_wait(call, error)) {
		const struct passo_snapshot *seen = passo_snapshot(&call->channel->passo);

		console->waits = PASSO_AWAITS_ROOM;
		console->waiting_channel = (uint8_t)(call->channel - console->channel);
		console->seen_state = seen->state;
		console->seen_lines = seen->line_room;
		console->seen_ramps = seen->ramp_room;
		return false;
	}
	if (error == PASSO_OK)
		passo_note_disabled(call, off);
	return passo_answer(call, error);
}

bool passo_run_turn(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo_turning turning = {.axis = values->axis,
	    .steps_per_turn = values->steps_per_turn,
	    .backward = values->on,
	    .top_rpm = values->top_rpm,
	    .minimum_rpm = values->minimum_rpm,
	    .acceleration = values->acceleration};
	enum passo_error error;
	uint8_t off;

	if (!passo_check_enabled(call, (uint8_t)(1u << values->axis), &off))
		return false;
	error = passo_turn_start(&call->channel->passo, &turning, values->rpm);
	if (error == PASSO_OK)
		passo_note_disabled(call, off);
	return passo_answer(call, error);
}

bool passo_run_rpm(const struct passo_call *call)
{
	struct passo *passo = &call->channel->passo;
	uint64_t rpm = call->values->rpm;

	return passo_answer(call, rpm == 0u ? passo_turn_stop(passo) : passo_turn_speed(passo, rpm));
}
