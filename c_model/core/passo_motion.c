/* SPDX-License-Identifier: MIT
 * Motion: start, end, stops and faults of a channel. See rtl/passo_motion.v.
 */
#include "passo_model.h"

enum { START_LAST = 6 };

static bool aborts(const struct passo_channel *channel, const struct passo_channel_wires *wires)
{
	return channel->registers.command_abort || wires->estop || wires->requests.hard || wires->too_far;
}

static bool stop_wanted(const struct passo_channel *channel, const struct passo_channel_wires *wires)
{
	return aborts(channel, wires) || ((wires->moving || wires->tracking) && wires->overrun)
	    || (wires->moving && channel->line.underrun)
	    || (channel->motion.stopping && !wires->tracking
	        && (channel->motion.rate_was_zero || wires->finished || !wires->moving));
}

static enum passo_cause cause_of_stop(
    const struct passo_channel *channel, const struct passo_channel_wires *wires)
{
	if (channel->motion.stopping)
		return channel->motion.soft_cause;
	if (wires->estop)
		return PASSO_CAUSE_ESTOP;
	if (channel->registers.command_abort)
		return PASSO_CAUSE_ABORT;
	if ((wires->moving || wires->tracking) && wires->overrun)
		return PASSO_CAUSE_STEP_OVERRUN;
	if (wires->requests.hard)
		return wires->requests.hard_cause;
	if (wires->too_far)
		return PASSO_CAUSE_FOLLOWING_ERROR;
	if (wires->moving && channel->line.underrun)
		return PASSO_CAUSE_LINE_UNDERRUN;
	return channel->motion.soft_cause;
}

void passo_motion_wires(const struct passo_channel *channel, const struct passo_channel_inputs *inputs,
    struct passo_channel_wires *wires)
{
	const struct passo_motion *motion = &channel->motion;
	const enum passo_state state = motion->state;
	const bool line_over = channel->line.ended;

	wires->stopped = state == PASSO_STATE_STOPPED;
	wires->occupied = state != PASSO_STATE_IDLE && !wires->stopped;
	wires->moving = passo_motion_moves(motion);
	wires->counting = state == PASSO_STATE_RUN || state == PASSO_STATE_DRAIN;
	wires->drain = state == PASSO_STATE_DRAIN;
	wires->tracking = channel->trackers.busy;
	wires->startable = state == PASSO_STATE_IDLE && inputs->run && channel->line_queue.next_valid
	                && wires->ramp_valid && !wires->hold && !wires->requests.wait
	                && !(motion->stopping && wires->tracking) && passo_outputs_quiet(&channel->outputs);
	wires->prepare = state == PASSO_STATE_IDLE && motion->startable;
	passo_encoders_wires(channel, wires);
	wires->synced_next =
	    state == PASSO_STATE_ARMED && !wires->requests.wait && (inputs->sync_edge || motion->synced);
	wires->begins_next = state == PASSO_STATE_ARMED && !wires->requests.wait
	                  && (wires->synced_next || !inputs->wait_sync) && wires->may_begin;
	wires->begin_profile = motion->begin_profile;
	wires->finished = motion->settled && (line_over || channel->line.endless);
	wires->stop_now = motion->stop_due && !wires->stopped;
	wires->running_next =
	    !wires->stop_now
	    && (state != PASSO_STATE_RUN || motion->count == START_LAST ? wires->moving : motion->running);
	wires->drop = aborts(channel, wires) || motion->aborted != 0u;
}

void passo_motion_clock(
    struct passo_motion *motion, const struct passo_channel *channel, const struct passo_channel_wires *wires)
{
	const enum passo_state state = motion->state;
	const uint8_t count = motion->count;
	const uint8_t settling = motion->settling;
	const bool settled = motion->settled;
	const bool dry = channel->ramp.dry && !channel->line.endless;
	const enum passo_cause cause_due = motion->cause_due;
	const struct passo_channel_registers *registers = &channel->registers;

	motion->startable = wires->startable && !motion->stop_due;
	motion->synced = wires->synced_next;
	motion->begin_profile = wires->begins_next && !wires->begin_profile && !wires->stop_now;
	motion->stop_due = stop_wanted(channel, wires) && !wires->stopped;
	motion->cause_due = cause_of_stop(channel, wires);
	motion->count = state != PASSO_STATE_RUN ? 0u : count == START_LAST ? count : (uint8_t)(count + 1u);
	motion->settling = (uint8_t)(state == PASSO_STATE_SETTLE ? (settling << 1 | 1u) & 7u : 0u);
	motion->settled = state == PASSO_STATE_SETTLE && (settling & 4u) != 0u && !settled;
	motion->rate_was_zero = channel->timescale.rate == 0u;
	motion->aborted =
	    (uint8_t)(((uint32_t)motion->aborted << 1 | (aborts(channel, wires) ? 1u : 0u)) & 3u);
	if (wires->prepare)
		motion->state = PASSO_STATE_PREPARE;
	if (state == PASSO_STATE_PREPARE && channel->ramp.ready)
		motion->state = PASSO_STATE_ARMED;
	if (state == PASSO_STATE_RUN && wires->ramp_ended)
		motion->state = PASSO_STATE_SETTLE;
	if (state == PASSO_STATE_SETTLE && settled)
		motion->state = PASSO_STATE_DRAIN;
	if (state == PASSO_STATE_DRAIN && channel->line.ended)
		motion->state = PASSO_STATE_SETTLE;
	if (wires->begin_profile)
		motion->state = wires->ramp_ended ? PASSO_STATE_SETTLE : PASSO_STATE_RUN;
	if (wires->finished)
		motion->state = PASSO_STATE_IDLE;
	motion->running = wires->running_next;

	if (wires->drain && channel->path.substep && !channel->line.ended)
		motion->drained = (motion->drained + 1u) & 0x7FFFu;

	if (!motion->stopping && !wires->stopped) {
		if (registers->command_stop)
			motion->soft_cause = PASSO_CAUSE_STOP;
		else if (wires->requests.soft)
			motion->soft_cause = wires->requests.soft_cause;
		else if (dry)
			motion->soft_cause = PASSO_CAUSE_RAMP_UNDERRUN;
		else if (wires->lags)
			motion->soft_cause = PASSO_CAUSE_FOLLOWING_ERROR;
		motion->stopping = registers->command_stop || wires->requests.soft || dry || wires->lags;
	}

	if (wires->stopped && registers->command_clear) {
		motion->state = PASSO_STATE_IDLE;
		motion->cause = PASSO_CAUSE_NONE;
	}
	if (wires->stop_now) {
		motion->state = PASSO_STATE_STOPPED;
		motion->cause = cause_due;
		motion->stopping = false;
		motion->settled = false;
	}
}
