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
	passo->tracked = (uint8_t)(on ? passo->tracked | bit : passo->tracked & ~bit);
	return passo_driver_write(passo, PASSO_CHANNEL_TRACKER_ENABLE, &word, 1);
}

/* Its targets while the path goes up, and down. */
static enum passo_error aim(struct passo *passo, unsigned axis, uint32_t up, uint32_t down)
{
	const enum passo_error error =
	    passo_driver_write(passo, (uint16_t)(PASSO_CHANNEL_TRACKER_TARGET_BASE + axis), &up, 1);

	return error != PASSO_OK ? error
	                         : passo_driver_write(passo,
				       (uint16_t)(PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + axis), &down, 1);
}

static enum passo_error aim_at_both(struct passo *passo, unsigned axis)
{
	const uint32_t up = (uint32_t)passo->axis[axis].track;

	return aim(passo, axis, up, up - passo->axis[axis].backlash);
}

/* The channel moves until its trackers are at their targets; then the positions are read. */
static void wait_for_them(struct passo *passo)
{
	if (passo->expects == PASSO_EXPECT_NOTHING)
		passo->expects = PASSO_EXPECT_END;
	passo->idle_looks = 0;
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
	passo->axis[track->axis].track = (int32_t)((uint32_t)target + passo->axis[track->axis].tracked_from);
	passo->axis[track->axis].backlash = track->backlash;
	passo->parked = (uint8_t)(passo->parked & ~(1u << track->axis));
	error = aim_at_both(passo, track->axis);
	return error == PASSO_OK ? enable(passo, track->axis, true) : error;
}

/* Axes with an active limit switch on one side, of those of which the tracker has a way to go. */
static enum passo_error find_limits(struct passo *passo, uint8_t axes, uint8_t *low, uint8_t *high)
{
	struct passo_readings readings;

	*low = *high = 0;
	if (axes == 0u || !passo->has_inputs)
		return PASSO_OK;
	const enum passo_error error = passo_read_inputs(passo, &readings);
	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++) {
		const uint8_t bit = (uint8_t)(1u << i), switches = passo->axis[i].switches;

		if ((axes & bit) == 0u)
			continue;
		if ((switches >> PASSO_TRIGGER_SOURCE_LIMIT_LOW & 1u) != 0u)
			*low |= (uint8_t)(readings.limit_low & bit);
		if ((switches >> PASSO_TRIGGER_SOURCE_LIMIT_HIGH & 1u) != 0u)
			*high |= (uint8_t)(readings.limit_high & bit);
	}
	return error;
}

/* Sends trackers of axes at a limit off it. */
static enum passo_error park(struct passo *passo, uint8_t axes, uint8_t low)
{
	enum passo_error error = PASSO_OK;

	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++) {
		const struct passo_axis_memory *axis = &passo->axis[i];

		if (((uint32_t)axes >> i & 1u) == 0u)
			continue;
		const bool is_low = ((uint32_t)low >> i & 1u) != 0u;
		const uint32_t target = (uint32_t)axis->track - (is_low ? 0u : axis->backlash);
		error = aim(passo, i, target, target);
		if (error == PASSO_OK)
			passo->parked = (uint8_t)(passo->parked | 1u << i);
	}
	return error;
}

enum passo_error passo_track_again(struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);
	struct passo_channel_tracker_state state;
	uint8_t low, high;

	if (error != PASSO_OK || passo->tracked == 0u)
		return error;
	error = read_state(passo, &state);
	if (error != PASSO_OK)
		return error;
	const uint8_t ended = (uint8_t)(passo->tracked & ~(state.enabled & state.at_target));
	error = find_limits(passo, (uint8_t)(ended & ~state.at_target), &low, &high);
	const uint8_t caught = low & high; /* it can go nowhere */
	if (error == PASSO_OK)
		error = park(passo, (uint8_t)(low ^ high), low);
	if (error != PASSO_OK || (ended & ~caught) == 0u)
		return error;
	const uint32_t word = (uint32_t)(state.enabled | (ended & ~caught));
	error = passo_driver_write(passo, PASSO_CHANNEL_TRACKER_ENABLE, &word, 1);
	if (error == PASSO_OK)
		wait_for_them(passo);
	return error;
}

enum passo_error passo_driver_note_trackers(struct passo *passo)
{
	struct passo_channel_tracker_state state = {.enabled = 0};
	const enum passo_error error = passo->tracked != 0u ? read_state(passo, &state) : PASSO_OK;

	if (error == PASSO_OK)
		passo->tracked &= state.enabled;
	return error;
}

enum passo_error passo_driver_track_by(
    struct passo *passo, uint8_t axis, int32_t steps, uint64_t speed, uint64_t acceleration)
{
	const struct passo_track track = {.axis = axis, .top_speed = speed, .acceleration = acceleration};
	struct passo_track_reading reading;
	enum passo_error error = passo_read_tracker(passo, axis, &reading);

	if (error == PASSO_OK)
		error = passo_configure_tracker(passo, &track);
	if (error == PASSO_OK)
		error =
		    passo_track_to(passo, &track, (int32_t)((uint32_t)reading.position + (uint32_t)steps));
	if (error == PASSO_OK)
		wait_for_them(passo);
	return error;
}

enum passo_error passo_driver_track_is_at(struct passo *passo, uint8_t axis, int32_t position)
{
	struct passo_track_reading reading;
	const enum passo_error error = passo_read_tracker(passo, axis, &reading);

	if (error == PASSO_OK)
		passo->axis[axis].tracked_from += (uint32_t)reading.position - (uint32_t)position;
	return error;
}

void passo_driver_unpark(struct passo *passo, uint8_t moved)
{
	for (unsigned i = 0; i < passo->axes; i++) {
		const uint8_t bit = (uint8_t)(1u << i);

		if ((passo->parked & moved & bit) == 0u || aim_at_both(passo, i) != PASSO_OK)
			continue;
		passo->parked = (uint8_t)(passo->parked & ~bit);
		wait_for_them(passo);
	}
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
	*reading =
	    (struct passo_track_reading){.position = (int32_t)(position - passo->axis[axis].tracked_from),
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
