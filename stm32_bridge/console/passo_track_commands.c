/* SPDX-License-Identifier: MIT
 * Commands of the trackers: limits, targets, readings.
 */
#ifndef PASSO_WITHOUT_TRACKERS

#include "passo_call.h"
#include "passo_command_table.h"
#include "passo_commands.h"

/* The keys of `tracker` before its settings. */
enum tracker_key { TRACKER_AXIS, TRACKER_CHANNEL, TRACKER_SETTINGS };

static struct passo_track track_of(const struct passo_console_tracker *tracker, uint8_t axis)
{
	return (struct passo_track){.axis = axis,
	    .backlash = (uint16_t)tracker->backlash,
	    .top_speed = tracker->speed,
	    .acceleration = tracker->acceleration};
}

static bool is_given(const struct passo_console_channel *channel, uint8_t axis)
{
	return channel->tracker[axis].speed != 0u;
}

enum passo_error passo_commands_set_trackers(struct passo_console_channel *channel)
{
	struct passo *passo = &channel->passo;
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; axis < passo_axes(passo) && error == PASSO_OK; axis++) {
		const struct passo_track track = track_of(&channel->tracker[axis], axis);
		if (is_given(channel, axis))
			error = passo_configure_tracker(passo, &track);
	}
	return error == PASSO_ERROR_NO_TRACKERS ? PASSO_OK : error;
}

static bool show(const struct passo_call *call, uint8_t axis)
{
	const struct passo_console_tracker *tracker = &call->channel->tracker[axis];
	const struct passo_sink *sink = &call->console->sink;
	struct passo_track_reading now;

	if (!passo_answer(call, passo_read_tracker(&call->channel->passo, axis, &now)))
		return false;
	passo_say(sink, " speed=%m acceleration=%m backlash=%u", passo_thousandths((int64_t)tracker->speed),
	    passo_thousandths((int64_t)tracker->acceleration), tracker->backlash);
	passo_say(sink, " position=%d enabled=%u moves=%u at_target=%u", now.position, (uint32_t)now.enabled,
	    (uint32_t)now.moves, (uint32_t)now.at_target);
	return true;
}

/* Changes only the settings that are given: reads them once more, over the present ones. */
bool passo_run_tracker(const struct passo_call *call)
{
	const struct passo_command *command = passo_command_find("tracker");
	struct passo_console_channel *channel = call->channel;
	struct passo_console_tracker *wanted = &call->values->tracker;
	const uint8_t axis = call->values->axis;

	if (call->reading->given >> TRACKER_SETTINGS == 0u)
		return show(call, axis);
	*wanted = channel->tracker[axis];
	if (!passo_keys_read(call->reading, command->keys, command->count, call->words, call->values))
		return false;
	const struct passo_track track = track_of(wanted, axis);
	if (!passo_answer(call, passo_configure_tracker(&channel->passo, &track)))
		return false;
	channel->tracker[axis] = *wanted;
	return true;
}

bool passo_run_track(const struct passo_call *call)
{
	const uint8_t axis = call->values->axis;
	const struct passo_track track = track_of(&call->channel->tracker[axis], axis);
	uint8_t off;

	if (!is_given(call->channel, axis))
		return passo_complain(
		    call->reading->sink, "axis %u has no speed: see tracker", (uint32_t)axis);
	if (!passo_check_enabled(call, (uint8_t)(1u << axis), &off))
		return false;
	enum passo_error error = passo_track_to(&call->channel->passo, &track, call->values->distance);
	if (error == PASSO_OK)
		passo_note_disabled(call, off);
	return passo_answer(call, error);
}

bool passo_run_untrack(const struct passo_call *call)
{
	return passo_answer(call, passo_untrack(&call->channel->passo, call->values->axis));
}

#endif
