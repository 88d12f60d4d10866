/* SPDX-License-Identifier: MIT
 * Reading the state and the positions of the channel, and whether it is at rest.
 */
#include "passo_driver.h"

#define STATE_WORDS 4u
#define LOOKS_AT_REST 2u /* consecutive */

/* Four queued steps and one in progress, with four times of at most 65535 clocks each, take at most this many
 * status reads of more than 1024 clocks each. */
#define PIN_LOOKS_MAX 1280u

/* No motion is running or queued; steps may still be at the pins. */
static bool is_empty(const struct passo *passo)
{
	const struct passo_snapshot *snapshot = &passo->snapshot;

	return snapshot->state == PASSO_STATE_IDLE && snapshot->line_room == passo->line_places
	    && snapshot->ramp_room == passo->ramp_places;
}

enum passo_error passo_driver_look(struct passo *passo, bool once)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_STATE);
	struct passo_snapshot *snapshot = &passo->snapshot;
	uint32_t words[STATE_WORDS]; /* STATE, RATE, ROOM, VELOCITY */
	enum passo_error error = once ? passo_host_read_once(passo->host, address, words, STATE_WORDS)
	                              : passo_host_read(passo->host, address, words, STATE_WORDS);

	passo->looked_at = passo_driver_now(passo);
	if (error != PASSO_OK)
		return error;
	const struct passo_channel_state state = passo_unpack_channel_state(words[0]);
	const struct passo_channel_room room = passo_unpack_channel_room(words[2]);
	*snapshot = (struct passo_snapshot){
	    .state = state.state,
	    .cause = state.cause,
	    .quiet = state.quiet,
	    .stopping = state.stopping,
	    .overrun = state.overrun,
	    .drained = state.drained,
	    .rate = words[1],
	    .line_room = room.line_room,
	    .ramp_room = room.ramp_room,
	    .velocity = words[3],
	};
	if (state.state == PASSO_STATE_STOPPED)
		passo_driver_forget_home(passo);
	return PASSO_OK;
}

enum passo_error passo_driver_look_at_rest(struct passo *passo)
{
	const struct passo_snapshot *snapshot = &passo->snapshot;
	enum passo_error error = passo_driver_look(passo, false);

	for (unsigned looks = 1; error == PASSO_OK && looks < PIN_LOOKS_MAX && !snapshot->quiet
	                         && (snapshot->state == PASSO_STATE_STOPPED || is_empty(passo));
	    looks++)
		error = passo_driver_look(passo, false);
	return error;
}

enum passo_error passo_driver_require_rest(struct passo *passo)
{
	const struct passo_snapshot *snapshot = &passo->snapshot;

	if (passo->task.kind != PASSO_TASK_NONE)
		return PASSO_ERROR_MOVING; /* perhaps between two of its motions */
	for (unsigned looks = 0; looks < LOOKS_AT_REST; looks++) {
		enum passo_error error = passo_driver_look_at_rest(passo);
		if (error != PASSO_OK)
			return error;
		if (!passo_driver_at_rest(passo)
		    && !(snapshot->state == PASSO_STATE_STOPPED && snapshot->quiet))
			return PASSO_ERROR_MOVING;
	}
	return PASSO_OK;
}

#ifndef PASSO_WITHOUT_TRACKERS
enum passo_error passo_driver_take_off_trackers(struct passo *passo, uint32_t *positions, bool once)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_TRACKER_POSITION_BASE);
	const size_t axes = passo->axes;
	uint32_t words[PASSO_AXES_MAX];

	if (!passo->has_trackers)
		return PASSO_OK;
	const enum passo_error error = once ? passo_host_read_once(passo->host, address, words, axes)
	                                    : passo_host_read(passo->host, address, words, axes);
	for (size_t i = 0; error == PASSO_OK && i < axes; i++) {
		positions[i] -= words[i];
		if (passo->zero_due)
			passo->axis[i].tracked_from = words[i];
	}
	return error;
}
#endif

enum passo_error passo_driver_positions(struct passo *passo, int32_t *positions, bool once)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_POSITION_BASE);
	uint32_t words[PASSO_AXES_MAX];
	enum passo_error error = once ? passo_host_read_once(passo->host, address, words, passo->axes)
	                              : passo_host_read(passo->host, address, words, passo->axes);

	if (error != PASSO_OK)
		return error;
	error = passo_driver_take_off_trackers(passo, words, once);
	if (error != PASSO_OK)
		return error;
	for (unsigned i = 0; i < passo->axes; i++) {
		positions[i] = (int32_t)words[i];
		if (passo->zero_due)
			passo->axis[i].offset = 0u - words[i];
	}
	passo->zero_due = false;
	return PASSO_OK;
}

int32_t passo_driver_offset(const struct passo *passo, unsigned axis, int32_t position)
{
	return (int32_t)((uint32_t)position + passo->axis[axis].offset);
}

bool passo_driver_at_rest(const struct passo *passo)
{
	return is_empty(passo) && passo->snapshot.quiet;
}
