/* SPDX-License-Identifier: MIT
 * Trackers: limits, targets, readings.
 */
#include "passo_driver.h"
#include "passo_math.h"

#ifndef PASSO_WITHOUT_TRACKERS

static enum passo_error check_axis(const struct passo *passo, uint8_t axis)
{
	enum passo_error error = passo_driver_check_axis(passo, axis);

	return error == PASSO_OK && !passo->has_trackers ? PASSO_ERROR_NO_TRACKERS : error;
}

static enum passo_error check(const struct passo *passo, const struct passo_track *track)
{
	return track ? check_axis(passo, track->axis) : PASSO_ERROR_ARGUMENT_POINTER;
}

static enum passo_error read_state(struct passo *passo, struct passo_channel_tracker_state *state)
{
	uint32_t word;
	const enum passo_error error =
	    passo_host_read(passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_TRACKER_STATE), &word, 1);

	if (error == PASSO_OK)
		*state = passo_unpack_channel_tracker_state(word);
	return error;
}

/* Enables the tracker of an axis, or not; leaves the others. */
static enum passo_error enable(struct passo *passo, uint8_t axis, bool on)
{
	const uint32_t bit = 1u << axis;
	struct passo_channel_tracker_state state;
	const enum passo_error error = read_state(passo, &state);

	if (error != PASSO_OK)
		return error;
	const uint32_t word = on ? state.enabled | bit : state.enabled & ~bit;
	return passo_driver_write(passo, PASSO_CHANNEL_TRACKER_ENABLE, &word, 1);
}

enum passo_error passo_configure_tracker(struct passo *passo, const struct passo_track *track)
{
	enum passo_error error = check(passo, track);

	if (error != PASSO_OK)
		return error;
	const uint32_t tick = PASSO_TRACKER_TICK(passo->axes), clock_hz = passo->machine.clock_hz;
	const uint64_t speed = passo_mul_div(track->top_speed, tick, clock_hz);
	const uint64_t acceleration =
	    passo_mul_div(passo_mul_div(track->acceleration, tick, clock_hz), tick, clock_hz);
	if (speed > UINT32_MAX || acceleration == 0u || acceleration > speed)
		return PASSO_ERROR_TRACKER_LIMITS;
	const uint32_t words[] = {(uint32_t)speed, (uint32_t)acceleration};
	return passo_driver_moving(passo_driver_write(passo,
	    (uint16_t)(PASSO_CHANNEL_AXIS_BASE + track->axis * PASSO_CHANNEL_AXIS_STRIDE
	               + PASSO_AXIS_TRACKER_SPEED),
	    words, 2));
}

enum passo_error passo_track_to(struct passo *passo, const struct passo_track *track, int32_t target)
{
	enum passo_error error = check(passo, track);

	if (error != PASSO_OK)
		return error;
	const uint32_t up = (uint32_t)target, down = up - track->backlash;
	error =
	    passo_driver_write(passo, (uint16_t)(PASSO_CHANNEL_TRACKER_TARGET_BASE + track->axis), &up, 1);
	if (error == PASSO_OK)
		error = passo_driver_write(
		    passo, (uint16_t)(PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + track->axis), &down, 1);
	return error == PASSO_OK ? enable(passo, track->axis, true) : error;
}

enum passo_error passo_untrack(struct passo *passo, uint8_t axis)
{
	enum passo_error error = check_axis(passo, axis);

	return error == PASSO_OK ? enable(passo, axis, false) : error;
}

enum passo_error passo_read_tracker(struct passo *passo, uint8_t axis, struct passo_track_reading *reading)
{
	enum passo_error error = check_axis(passo, axis);
	struct passo_channel_tracker_state state;
	uint32_t position;

	if (error == PASSO_OK && !reading)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_host_read(passo->host,
		    (uint16_t)(passo->base + PASSO_CHANNEL_TRACKER_POSITION_BASE + axis), &position, 1);
	if (error == PASSO_OK)
		error = read_state(passo, &state);
	if (error != PASSO_OK)
		return error;
	*reading = (struct passo_track_reading){.position = (int32_t)position,
	    .enabled = ((uint32_t)state.enabled >> axis & 1u) != 0u,
	    .moves = ((uint32_t)state.moves >> axis & 1u) != 0u,
	    .at_target = ((uint32_t)state.at_target >> axis & 1u) != 0u};
	return PASSO_OK;
}

int32_t passo_track_at(const struct passo_track_table *table, int32_t position)
{
	const int16_t *targets = table->targets;
	const int64_t way = (int64_t)position - table->begin, pitch = table->pitch;

	if (table->points == 0u || way <= 0 || pitch == 0)
		return table->points ? targets[0] : 0;
	const int64_t point = way / pitch;
	if (point >= (int64_t)table->points - 1)
		return targets[table->points - 1u];
	const int64_t change = (int64_t)targets[point + 1] - targets[point];
	const int64_t twice = 2 * change * (way % pitch) + pitch; /* in halves of `pitch`, and one more */
	const int64_t rounded = twice >= 0 ? twice / (2 * pitch) : -((2 * pitch - 1 - twice) / (2 * pitch));
	return targets[point] + (int32_t)rounded;
}

#endif
