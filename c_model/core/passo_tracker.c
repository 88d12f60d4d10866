/* SPDX-License-Identifier: MIT
 * Trackers of a channel. See rtl/passo_tracker.v and rtl/passo_trackers.v.
 *
 * The unit computes with words of 16 bits; here a turn is computed when what it depends on has been read.
 */
#include <stddef.h>

#include "passo_least.h"
#include "passo_model.h"
#include "passo_words.h"

enum {
	SLOT_OVER = 0, /* of the turn before */
	SLOT_SETTINGS = 1,
	SLOT_TARGET = 2,
	SLOT_COMPARED = 16, /* all that is compared has been read */
	SLOT_LIMIT = 20,
	SLOT_SHOWN = 21,
	SLOT_LAST = 31
};

/* Positions are Q32.32 and half a step: their whole part is that of the nearest step. */
static const uint64_t HALF = UINT64_C(1) << 31;

static uint64_t place_of(uint32_t target)
{
	return (uint64_t)target << 32 | HALF;
}

static bool sign_of(uint64_t value)
{
	return value >> 63 != 0u;
}

static unsigned turns_of(const struct passo_channel *channel)
{
	return PASSO_TRACKER_TICK(channel->axes) / PASSO_TRACKER_TURN;
}

static unsigned turn_before(const struct passo_channel *channel)
{
	return (channel->trackers.turn + turns_of(channel) - 1u) % turns_of(channel);
}

void passo_trackers_reset(struct passo_trackers *trackers, bool present)
{
	*trackers = (struct passo_trackers){
	    .present = present, .slot = SLOT_SETTINGS, .clears = 2, .clears_position = true};
}

void passo_trackers_restart(struct passo_trackers *trackers, const struct passo_trackers *before)
{
	passo_trackers_reset(trackers, before->present);
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		const struct passo_tracker_axis *axis = &before->axis[i];

		trackers->axis[i] = (struct passo_tracker_axis){.host = axis->host,
		    .target = axis->target,
		    .speed = axis->speed,
		    .acceleration = axis->acceleration};
	}
}

/* The word that the host writes to, if there is such an axis. */
static uint32_t *written_word(struct passo_trackers *trackers, unsigned axes, uint8_t address)
{
	const unsigned number = address % PASSO_AXES_MAX;
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_AXIS_BASE;
	const unsigned axis = in_axes / PASSO_CHANNEL_AXIS_STRIDE;

	if (address - number == PASSO_CHANNEL_TRACKER_TARGET_BASE && number < axes)
		return &trackers->axis[number].host.target[0];
	if (address - number == PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE && number < axes)
		return &trackers->axis[number].host.target[1];
	if (in_axes >= axes * PASSO_CHANNEL_AXIS_STRIDE)
		return NULL;
	switch (in_axes % PASSO_CHANNEL_AXIS_STRIDE) {
	case PASSO_AXIS_TRACKER_SPEED:
		return &trackers->axis[axis].host.speed;
	case PASSO_AXIS_TRACKER_ACCELERATION:
		return &trackers->axis[axis].host.acceleration;
	default:
		return NULL;
	}
}

static bool is_acceleration(unsigned axes, uint8_t address)
{
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_AXIS_BASE;

	return in_axes < axes * PASSO_CHANNEL_AXIS_STRIDE
	    && in_axes % PASSO_CHANNEL_AXIS_STRIDE == PASSO_AXIS_TRACKER_ACCELERATION;
}

static struct passo_tracker_turn begin_turn(
    const struct passo_trackers *trackers, unsigned i, bool brake, bool hold)
{
	const struct passo_tracker_axis *axis = &trackers->axis[i];
	const bool rests = axis->velocity == 0u;

	return (struct passo_tracker_turn){
	    .negative = axis->negative,
	    .rests = rests,
	    .target_down = trackers->join[i].went_down,
	    .brakes = !axis->enabled || brake || trackers->clears != 0u || (hold && rests),
	    .cleared = trackers->clears != 0u,
	    .cleared_position = trackers->clears_position,
	};
}

/* What the sums of a turn say. */
static void compare(struct passo_tracker_turn *now, const struct passo_tracker_axis *axis)
{
	const bool negative = now->negative;
	const uint64_t target = place_of(axis->target);
	uint64_t y = target - axis->position - (negative ? 1u : 0u);

	now->acceleration = now->reduction = axis->acceleration;
	now->slow = axis->speed >= axis->velocity;
	now->slower = now->slow && axis->speed - axis->velocity >= axis->acceleration;
	now->there = target == axis->position && !now->cleared_position;
	now->behind = sign_of(y) != negative;
	y = negative ? y + axis->stopping : y - axis->stopping;
	now->near = sign_of(y) != negative;
	y = negative ? y + axis->velocity : y - axis->velocity;
	y = negative ? y + axis->acceleration : y - axis->acceleration;
	now->close = sign_of(y) != negative;
}

static void move(struct passo_trackers *trackers, struct passo_tracker_axis *axis)
{
	const struct passo_tracker_turn *now = &trackers->now;
	const bool speeds = !now->brakes && !now->close && now->slower;
	const bool keeps = !speeds && (now->rests || (!now->brakes && !now->near && now->slow));
	const uint32_t old = axis->velocity;
	const uint64_t before = axis->position;
	uint32_t velocity = speeds ? old + now->acceleration : keeps ? old : old - now->reduction;

	if (now->cleared)
		velocity = 0;
	const bool lands = velocity == 0u && !now->brakes && !now->behind
	                && (now->rests ? now->close && now->slower : now->near);
	if (now->cleared)
		axis->stopping = 0;
	else if (speeds)
		axis->stopping += velocity;
	else if (!keeps)
		axis->stopping -= old;
	if (now->cleared_position)
		axis->position = HALF;
	else if (lands)
		axis->position = place_of(axis->target);
	else
		axis->position += now->negative ? 0u - (uint64_t)velocity : velocity;
	axis->velocity = velocity;
	axis->step_made = axis->position >> 32 != before >> 32 && trackers->clears == 0u && !now->cleared;
	axis->negative = now->negative != (now->rests && now->behind && !now->brakes);
	axis->at_target = now->there;
	trackers->step_down = axis->step_made && now->negative;
	trackers->now = (struct passo_tracker_turn){0};
}

/* The lower half of the one before has been read when the speed is reduced; it is only written at rest. */
static void copy_acceleration(struct passo_trackers *trackers, struct passo_tracker_axis *axis)
{
	axis->acceleration = axis->host.acceleration;
	trackers->now.reduction = (axis->acceleration & 0xFFFF0000u) | (trackers->now.reduction & 0xFFFFu);
}

/* A clock of the turn of an axis; `written`: the host writes a setting in this clock. */
static void clock_turn(
    struct passo_trackers *trackers, unsigned i, bool written, const struct passo_tracker_wires *wires)
{
	struct passo_tracker_axis *axis = &trackers->axis[i];

	switch (trackers->slot) {
	case SLOT_SETTINGS:
		trackers->now = begin_turn(trackers, i, wires->brake, wires->hold);
		break;
	case SLOT_TARGET:
		if (!written)
			axis->target = axis->host.target[trackers->now.target_down ? 1 : 0];
		break;
	case SLOT_COMPARED:
		compare(&trackers->now, axis);
		break;
	case SLOT_LIMIT:
		if (written)
			break;
		if (!trackers->odd)
			axis->speed = axis->host.speed;
		else
			copy_acceleration(trackers, axis);
		break;
	default:
		break;
	}
}

/* It lasts until an odd tick is over that began after it, in which every axis has copied its acceleration. */
static void clock_clearing(struct passo_trackers *trackers, bool tick_ends, bool writes_acceleration,
    const struct passo_tracker_wires *wires)
{
	const bool again = trackers->clears == 2u;

	if (tick_ends && trackers->clears != 0u) {
		trackers->clears = !again ? 0u : trackers->odd ? 2u : 1u;
		trackers->clears_position = trackers->clears_position && again;
	}
	if (wires->halt || wires->zero || writes_acceleration)
		trackers->clears = 2;
	if (wires->halt || wires->zero)
		for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
			trackers->axis[i].enabled = false;
	trackers->clears_position = trackers->clears_position || wires->zero;
}

/* Whether an axis moves; others see it one clock later. */
static bool moves(const struct passo_tracker_axis *axis, bool brake)
{
	return axis->velocity != 0u || (axis->enabled && !axis->at_target && !brake);
}

void passo_tracker_clock(struct passo_channel *channel, const struct passo_bus *bus, bool selected,
    const struct passo_tracker_wires *wires)
{
	struct passo_trackers *trackers = &channel->trackers;
	const uint8_t address = (uint8_t)bus->address;
	const unsigned turn = trackers->turn, before = turn_before(channel);
	const bool turn_ends = trackers->slot == SLOT_LAST;
	const bool tick_ends = turn_ends && turn == turns_of(channel) - 1u;
	const bool shows = trackers->slot == SLOT_SHOWN && !bus->read;
	uint32_t *const word =
	    trackers->writes_setting ? written_word(trackers, channel->axes, trackers->written) : NULL;

	for (unsigned i = 0; i < channel->axes; i++) {
		struct passo_tracker_axis *axis = &trackers->axis[i];

		axis->moves = moves(axis, wires->brake);
		axis->step_made = false;
		if (shows)
			axis->shown = (uint32_t)(axis->position >> 32);
	}
	if (trackers->slot == SLOT_OVER && before < channel->axes)
		move(trackers, &trackers->axis[before]);
	if (turn < channel->axes)
		clock_turn(trackers, turn, word != NULL, wires);
	if (trackers->writes_enable)
		for (unsigned i = 0; i < channel->axes; i++)
			trackers->axis[i].enabled = (bus->data >> i & 1u) != 0u;
	clock_clearing(
	    trackers, tick_ends, selected && bus->write && is_acceleration(channel->axes, address), wires);
	trackers->hold = wires->hold;
	trackers->writes_enable = selected && bus->write && address == PASSO_CHANNEL_TRACKER_ENABLE;
	if (word != NULL)
		*word = bus->data;
	trackers->writes_setting = selected && bus->write;
	if (trackers->writes_setting)
		trackers->written = address;
	trackers->slot = (uint8_t)((trackers->slot + 1u) % PASSO_TRACKER_TURN);
	if (turn_ends)
		trackers->turn = (uint8_t)((turn + 1u) % turns_of(channel));
	trackers->odd = trackers->odd != tick_ends;
}

uint32_t passo_trackers_value(const struct passo_channel *channel, uint8_t address)
{
	struct passo_channel_tracker_state state = {0};

	if (!channel->trackers.present || address != PASSO_CHANNEL_TRACKER_STATE)
		return 0;
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_tracker_axis *axis = &channel->trackers.axis[i];

		state.enabled |= (uint8_t)((axis->enabled ? 1u : 0u) << i);
		state.moves |= (uint8_t)((axis->moves ? 1u : 0u) << i);
		state.at_target |= (uint8_t)((axis->at_target ? 1u : 0u) << i);
	}
	return passo_pack_channel_tracker_state(&state);
}

/* Whether each turn leaves an axis as it is. */
static bool axis_rests(const struct passo_trackers *trackers, unsigned i)
{
	const struct passo_tracker_axis *axis = &trackers->axis[i];
	const bool there = axis->position == place_of(axis->target) && !trackers->clears_position;

	return axis->velocity == 0u && (trackers->clears == 0u || axis->stopping == 0u)
	    && (!trackers->clears_position || axis->position == HALF)
	    && axis->target == axis->host.target[trackers->join[i].went_down ? 1 : 0]
	    && axis->speed == axis->host.speed && axis->acceleration == axis->host.acceleration
	    && axis->at_target == there && (there || !axis->enabled);
}

/* The axis whose settings have been read; `axes` or more: none. */
static unsigned turn_in_progress(const struct passo_channel *channel)
{
	const struct passo_trackers *trackers = &channel->trackers;

	if (trackers->slot == SLOT_SETTINGS)
		return channel->axes;
	return trackers->slot == SLOT_OVER ? turn_before(channel) : trackers->turn;
}

/* Whether the turn in progress began as it would now. */
static bool began_so(const struct passo_trackers *trackers, unsigned i)
{
	const struct passo_tracker_turn *now = &trackers->now;
	const struct passo_tracker_turn other = begin_turn(trackers, i, false, trackers->hold);

	return now->brakes == other.brakes && now->target_down == other.target_down
	    && now->cleared == other.cleared && now->cleared_position == other.cleared_position;
}

/* Clocks before a slot of any turn. */
static uint64_t clocks_to_slot(const struct passo_trackers *trackers, unsigned slot)
{
	return (slot + PASSO_TRACKER_TURN - trackers->slot) % PASSO_TRACKER_TURN;
}

/* Clocks before one in which the turn of an axis has an effect. */
static uint64_t clocks_to_effect(const struct passo_channel *channel, unsigned i)
{
	static const uint8_t effects[] = {
	    SLOT_SETTINGS, SLOT_TARGET, SLOT_COMPARED, SLOT_LIMIT, PASSO_TRACKER_TURN + SLOT_OVER};
	const struct passo_trackers *trackers = &channel->trackers;
	const unsigned tick = PASSO_TRACKER_TICK(channel->axes);
	const unsigned now = trackers->turn * PASSO_TRACKER_TURN + trackers->slot;
	uint64_t clocks = UINT64_MAX;

	for (unsigned k = 0; k < sizeof effects; k++)
		clocks = passo_least(clocks, (i * PASSO_TRACKER_TURN + effects[k] + tick - now) % tick);
	return clocks;
}

/* Whether all units but the turns have nothing to do. */
static bool others_settled(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_trackers *trackers = &channel->trackers;
	const bool stopped = passo_channel_stopped(channel); /* which clears without end */
	struct passo_channel_wires wires = {0};
	bool busy = false;

	if (!passo_trackers_settled(channel) || trackers->clears != (stopped ? 2u : 0u)
	    || trackers->writes_enable || trackers->writes_setting)
		return false;
	passo_admission_wires(&channel->admission, inputs->bus, inputs->tables_wanted, &wires);
	if (trackers->hold != (wires.hold || passo_inputs_requests(channel, inputs).wait))
		return false;
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_tracker_axis *axis = &trackers->axis[i];
		const struct passo_tracker_join *join = &trackers->join[i];
		const bool down = ((uint32_t)channel->line.directions >> i & 1u) != 0u;

		if (axis->step_made || axis->moves != moves(axis, channel->motion.stopping) || join->owed != 0
		    || join->ready
		    || (passo_trackers_path_moves(channel, i) && (join->went_down != down || join->turned)))
			return false;
		busy = busy || axis->moves;
	}
	return trackers->busy == busy;
}

uint64_t passo_trackers_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_trackers *trackers = &channel->trackers;
	uint64_t clocks = UINT64_MAX;

	if (!trackers->present)
		return UINT64_MAX;
	if (!others_settled(channel, inputs))
		return 0;
	const unsigned turn = turn_in_progress(channel);
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_tracker_axis *axis = &trackers->axis[i];

		if (axis->shown != (uint32_t)(axis->position >> 32))
			clocks = passo_least(clocks, clocks_to_slot(trackers, SLOT_SHOWN));
		if (!axis_rests(trackers, i) || (i == turn && !began_so(trackers, i)))
			clocks = passo_least(clocks, clocks_to_effect(channel, i));
	}
	return clocks;
}

void passo_trackers_skip(struct passo_channel *channel, uint64_t clocks)
{
	struct passo_trackers *trackers = &channel->trackers;
	const uint64_t tick = PASSO_TRACKER_TICK(channel->axes);
	const uint64_t now = trackers->turn * PASSO_TRACKER_TURN + trackers->slot;
	const uint64_t into_turn = PASSO_TRACKER_TURN - 1u - clocks_to_slot(trackers, SLOT_OVER);
	const bool same_turn = into_turn != 0u && into_turn + clocks < PASSO_TRACKER_TURN;
	const bool compared = same_turn && into_turn > SLOT_COMPARED - SLOT_SETTINGS;

	trackers->slot = (uint8_t)((now + clocks) % PASSO_TRACKER_TURN);
	trackers->turn = (uint8_t)((now + clocks) % tick / PASSO_TRACKER_TURN);
	trackers->odd = trackers->odd != ((now + clocks) / tick % 2u != 0u);
	const unsigned axis = turn_in_progress(channel);
	if (!same_turn)
		trackers->now = axis < channel->axes ? begin_turn(trackers, axis, false, trackers->hold)
		                                     : (struct passo_tracker_turn){0};
	if (axis < channel->axes && !compared
	    && (trackers->slot > SLOT_COMPARED || trackers->slot == SLOT_OVER))
		compare(&trackers->now, &trackers->axis[axis]);
}
