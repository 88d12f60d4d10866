/* SPDX-License-Identifier: MIT
 * Conditions for a channel to be quiet. See passo_advance.c.
 */
#include "passo_advance.h"

/* Used entries of a queue whose pointers count modulo twice its depth. */
static unsigned used_places(unsigned write, unsigned read, unsigned depth)
{
	return (write - read) & (2u * depth - 1u);
}

static bool lines_settled(const struct passo_channel *channel, const struct passo_parameters *parameters)
{
	const struct passo_line_queue *queue = &channel->line_queue;
	const struct passo_line *current = &queue->lines[queue->current_line];
	const unsigned depth = 1u << parameters->line_queue_log2;
	const unsigned used = used_places(queue->write_end, queue->next_line, depth);

	for (unsigned i = 0; i < channel->axes; i++)
		if (queue->steps[i] != current->steps[i])
			return false;
	if (queue->output_word != queue->output_words[queue->current_line])
		return false;
	return queue->room == depth - used - (queue->has_place ? 1u : 0u)
	    && queue->full == (queue->room == queue->checked)
	    && queue->next_valid == (queue->write_line != queue->next_line)
	    && queue->directions == current->directions;
}

static bool ramps_settled(const struct passo_ramp_queue *queue, const struct passo_parameters *parameters)
{
	const unsigned depth = 1u << parameters->ramp_queue_log2;
	const unsigned used = used_places(queue->write_end, queue->read_ramp, depth);

	return !queue->write_low && queue->room == depth - used
	    && queue->full == (queue->room == queue->checked)
	    && queue->valid == (queue->write_ramp != queue->read_ramp);
}

static bool commands_settled(const struct passo_channel *channel)
{
	const struct passo_channel_registers *registers = &channel->registers;

	return !registers->command_stop && !registers->command_abort && !registers->command_clear
	    && !registers->command_zero && !registers->drain_velocity_written && !channel->writes_axis;
}

bool passo_advance_slots_empty(const struct passo_channel *channel)
{
	const struct passo_line_unit *line = &channel->line;
	const bool stopped = passo_channel_stopped(channel);

	if (line->on_last != (line->substep_number == channel->line_queue.last_substep))
		return false;
	for (unsigned i = 0; i < channel->axes; i++)
		if (channel->dda[i].addend != (int64_t)channel->line_queue.steps[i])
			return false;
	if (channel->path.refresh != stopped || channel->path.take_q != stopped)
		return false;
	if (stopped && (channel->path.velocity_low != 0u || channel->path.velocity_high != 0u))
		return false;
	return !channel->path.advance_q && !channel->path.substep && !line->add_n && !line->decide_step;
}

/* Clocks for which the rate is constant: unlimited, or until the next slew tick. */
static uint64_t timescale_quiet(const struct passo_channel *channel, bool moving, uint64_t clocks_to_slew)
{
	const struct passo_timescale *timescale = &channel->timescale;
	const uint32_t target = channel->registers.rate_target;
	const uint32_t slew = channel->registers.rate_slew == 0u ? 1u : channel->registers.rate_slew;

	if (timescale->rate != timescale->goal || timescale->after != 0u)
		return 0;
	if (!moving)
		return timescale->rate == target && timescale->still && timescale->rate_sum == 0u
		            && !timescale->enable
		         ? UINT64_MAX
		         : 0u;
	const bool steady = timescale->enable ? timescale->rate == PASSO_RATE_ONE : timescale->rate == 0u;
	if (!steady || timescale->still)
		return 0;
	return timescale->goal == target && timescale->slew == slew && !timescale->down && !timescale->stops
	         ? UINT64_MAX
	         : clocks_to_slew;
}

uint64_t passo_advance_ramp_quiet(const struct passo_ramp_unit *ramp)
{
	if (ramp->take_now || ramp->dry || ramp->step == PASSO_RAMP_TAKE)
		return 0;
	if (ramp->step == PASSO_RAMP_CHOOSE)
		return !ramp->ready && !ramp->ends_next ? 0u : UINT64_MAX;
	return ramp->wait - 1u;
}

uint64_t passo_advance_axis_quiet(const struct passo_channel *channel, unsigned axis)
{
	const bool direction = passo_trackers_join(channel, axis).direction;
	const uint32_t clocks = passo_axis_quiet(&channel->axis[axis], direction);

	return clocks == UINT32_MAX ? UINT64_MAX : clocks;
}

/* At rest, nothing is about to start. In a motion, the running pin is high and nothing is about to stop. */
static bool motion_settled(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_motion *motion = &channel->motion;
	const bool waits = passo_inputs_requests(channel, inputs).wait;

	if (motion->stopping || motion->stop_due || motion->settling != 0u || motion->aborted != 0u
	    || motion->rate_was_zero != (channel->timescale.rate == 0u)
	    || (motion->synced && (waits || motion->state != PASSO_STATE_ARMED)))
		return false;
	switch (motion->state) {
	case PASSO_STATE_IDLE:
		return !motion->running && !motion->startable
		    && !(
			inputs->run && !waits && channel->line_queue.next_valid && channel->ramp_queue.valid);
	case PASSO_STATE_PREPARE:
		return !motion->running && !channel->ramp.ready;
	case PASSO_STATE_ARMED:
		return !motion->running && !motion->begin_profile
		    && (waits || passo_encoders_await_index(channel)
		        || (inputs->wait_sync && !motion->synced));
	case PASSO_STATE_STOPPED:
		return !motion->running;
	case PASSO_STATE_RUN:
		return motion->running && motion->count == 6u;
	default:
		return false;
	}
}

/* Whether at_rest has reached its final value. */
static bool rest_settled(const struct passo_channel *channel)
{
	const bool occupied = passo_channel_occupied(channel);
	bool at_rest = !occupied;

	for (unsigned i = 0; i < channel->axes; i++)
		at_rest = at_rest && channel->axis[i].quiet;
	at_rest = at_rest && passo_outputs_quiet(&channel->outputs) && !channel->trackers.busy;
	return channel->occupied_before == (occupied ? 7u : 0u) && channel->at_rest == at_rest;
}

/* A profile that runs is skipped within its ticks, and only if no output depends on it. */
static uint64_t outputs_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_output_registers *registers = &channel->output_registers;
	const struct passo_channel_wires wires = {
	    .stopped = passo_channel_stopped(channel), .running_next = channel->motion.running};
	struct passo_outputs_wires outputs;

	if (!channel->has_outputs)
		return UINT64_MAX;
	if (registers->write_levels || registers->write_power || registers->write_pulse
	    || registers->write_distance)
		return 0;
	outputs = passo_channel_outputs(channel, inputs->bus, &wires);
	if (passo_advance_profile_counts(channel)
	    && !passo_outputs_ignore(&channel->outputs, &outputs, 1u << inputs->parameters->tick_log2))
		return 0;
	return passo_outputs_steady(&channel->outputs, &outputs);
}

uint64_t passo_advance_surroundings_quiet(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew)
{
	const struct passo_line_unit *line = &channel->line;
	const bool moving = channel->motion.state == PASSO_STATE_RUN;

	if (!motion_settled(channel, inputs) || !rest_settled(channel) || !commands_settled(channel)
	    || line->load_start || line->load_start_q || line->underrun
	    || !ramps_settled(&channel->ramp_queue, inputs->parameters)
	    || !lines_settled(channel, inputs->parameters))
		return 0;
	uint64_t clocks =
	    passo_least(passo_inputs_quiet(channel, inputs), passo_positions_quiet(&channel->positions));
	clocks = passo_least(clocks, passo_trackers_quiet(channel, inputs));
	clocks = passo_least(clocks, passo_encoders_quiet(channel, inputs));
	clocks = passo_least(clocks, outputs_quiet(channel, inputs));
	return passo_least(clocks, timescale_quiet(channel, moving, clocks_to_slew));
}
