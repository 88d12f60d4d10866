/* SPDX-License-Identifier: MIT
 * Channel: one coordinated group of axes, from the queues to the pins. See rtl/passo_channel.v.
 */
#include "passo_model.h"

bool passo_channel_stopped(const struct passo_channel *channel)
{
	return channel->motion.state == PASSO_STATE_STOPPED;
}

bool passo_channel_occupied(const struct passo_channel *channel)
{
	return channel->motion.state != PASSO_STATE_IDLE && !passo_channel_stopped(channel);
}

bool passo_channel_quiet(const struct passo_channel *channel)
{
	return channel->at_rest && !passo_channel_occupied(channel);
}

bool passo_channel_incomplete(const struct passo_channel *channel)
{
	return channel->line_queue.index != 0u || channel->ramp_queue.index != 0u;
}

void passo_channel_reset(
    struct passo_channel *channel, const struct passo_parameters *parameters, uint8_t number)
{
	*channel = (struct passo_channel){.axes = parameters->axes,
	    .number = number,
	    .has_outputs = parameters->outputs != 0u,
	    .has_raster = parameters->raster != 0u};
	passo_channel_registers_reset(&channel->registers);
	channel->line_queue.room = (uint16_t)(1u << parameters->line_queue_log2);
	channel->ramp_queue.room = (uint16_t)(1u << parameters->ramp_queue_log2);
	channel->timescale.rate = PASSO_RATE_ONE;
	channel->ramp.ends_next = true;
	passo_path_reset(&channel->path);
	for (unsigned axis = 0; axis < parameters->axes; axis++) {
		const unsigned pin = (unsigned)number * parameters->axes + axis;
		passo_axis_reset(&channel->axis[axis], (parameters->step_reset >> pin & 1u) != 0u,
		    (parameters->dir_reset >> pin & 1u) != 0u, (parameters->enable_reset >> pin & 1u) != 0u);
	}
	passo_positions_reset(&channel->positions);
	passo_output_registers_reset(&channel->output_registers);
	passo_outputs_reset(&channel->outputs);
	passo_encoders_reset(&channel->encoders, parameters->encoders != 0u);
	passo_trackers_reset(&channel->trackers, parameters->trackers != 0u);
	passo_inputs_reset(&channel->inputs);
}

void passo_channel_restart(struct passo_channel *channel, const struct passo_channel *before,
    const struct passo_parameters *parameters, const struct passo_inputs *pins)
{
	struct passo_channel_inputs inputs = {.parameters = parameters};

	passo_channel_reset(channel, parameters, before->number);
	passo_encoders_pins(&inputs, pins, before->number);
	passo_encoders_restart(&channel->encoders, &before->encoders, &inputs);
	for (unsigned axis = 0; axis < parameters->axes; axis++)
		passo_axis_restart(&channel->axis[axis], &before->axis[axis]);
	passo_inputs_restart(&channel->inputs, &before->inputs);
	passo_trackers_restart(&channel->trackers, &before->trackers);
}

static struct passo_channel_wires gather_wires(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_bus *bus = inputs->bus;
	const uint32_t tick_last = (1u << inputs->parameters->tick_log2) - 1u;
	struct passo_channel_wires wires = {0};

	wires.selected = (bus->address >> 8) == channel->number + 1u;
	wires.bus_address = (uint8_t)bus->address;
	wires.line_push = wires.selected && bus->push && wires.bus_address == PASSO_CHANNEL_LINE;
	wires.ramp_push = wires.selected && bus->push && wires.bus_address == PASSO_CHANNEL_RAMP;
	wires.ramp_valid = channel->ramp_queue.valid;
	for (unsigned axis = 0; axis < channel->axes; axis++)
		wires.overrun = wires.overrun || channel->axis[axis].overrun;

	passo_admission_wires(&channel->admission, bus, inputs->tables_wanted, &wires);
	wires.estop = (inputs->machine->estop_seen & 2u) != 0u;
	wires.requests = passo_inputs_requests(channel, inputs);
	passo_motion_wires(channel, inputs, &wires);

	const bool at_tick_end = channel->ramp.tick_count == tick_last;
	wires.stall = at_tick_end && channel->ramp.unready;
	wires.advance = wires.follows ? passo_encoders_advance(channel, &wires)
	                              : channel->timescale.enable && wires.counting && !wires.stall;
	wires.tick = wires.advance && at_tick_end;
	wires.next = wires.begin_profile || wires.tick;
	wires.ramp_ended = wires.next && channel->ramp.ends_next;

	passo_line_wires(&channel->line, &channel->line_queue, channel->path.substep, &wires);
	return wires;
}

struct passo_outputs_wires passo_channel_outputs(
    const struct passo_channel *channel, const struct passo_bus *bus, const struct passo_channel_wires *wires)
{
	struct passo_outputs_wires outputs = {
	    .bus = {.push = wires->selected && bus->push && wires->bus_address == PASSO_CHANNEL_RASTER,
		.frame = bus->frame,
		.commit = bus->commit,
		.check = bus->check,
		.write = bus->write,
		.data = bus->data},
	    .settings = channel->output_registers.settings,
	    .word = passo_unpack_line_output(channel->line_queue.output_word),
	    .write_pulse = channel->output_registers.write_pulse,
	    .write_distance = channel->output_registers.write_distance,
	    .write_levels = channel->output_registers.write_levels,
	    .write_power = channel->output_registers.write_power,
	    .line_begins = wires->take || wires->repeats,
	    .substep = wires->substep_taken,
	    .stopped = wires->stopped,
	    .clear = channel->registers.command_clear,
	    .running = channel->motion.running,
	    .running_next = wires->running_next,
	    .velocity = passo_channel_registers_value(channel, PASSO_CHANNEL_VELOCITY),
	    .rate = channel->timescale.rate,
	    .waits = passo_encoders_wait(channel),
	};

	for (unsigned i = 0; i < channel->axes; i++) {
		outputs.step_made |= (uint8_t)((channel->axis[i].step_made ? 1u : 0u) << i);
		outputs.step_direction |= (uint8_t)((channel->axis[i].dir ? 1u : 0u) << i);
	}
	return outputs;
}

static void clock_outputs(
    struct passo_channel *channel, const struct passo_bus *bus, const struct passo_channel_wires *wires)
{
	const struct passo_outputs_wires outputs = passo_channel_outputs(channel, bus, wires);

	passo_outputs_clock(&channel->outputs, &outputs);
	passo_output_registers_clock(
	    &channel->output_registers, wires->selected && bus->write, wires->bus_address, bus->data);
}

/* A write to a register of an axis, which is done in the next clock. */
static void take_axis_write(
    struct passo_channel *channel, const struct passo_channel_wires *wires, const struct passo_bus *bus)
{
	const unsigned in_axes = (unsigned)wires->bus_address - PASSO_CHANNEL_AXIS_BASE;

	channel->writes_axis =
	    wires->selected && bus->write && in_axes < channel->axes * PASSO_CHANNEL_AXIS_STRIDE;
	channel->written_register = (uint8_t)in_axes;
}

void passo_channel_clock(struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_channel_wires wires = gather_wires(channel, inputs);
	const struct passo_bus *bus = inputs->bus;
	const unsigned written_axis = channel->written_register / PASSO_CHANNEL_AXIS_STRIDE;
	const unsigned written_register = channel->written_register % PASSO_CHANNEL_AXIS_STRIDE;
	const bool write_timing =
	    channel->writes_axis
	    && (written_register == PASSO_AXIS_STEP_TIMING || written_register == PASSO_AXIS_DIR_TIMING);
	const bool write_pins = channel->writes_axis && written_register == PASSO_AXIS_PINS;
	const struct passo_needs needs = passo_channel_needs(channel, bus, inputs->needs_quiet);
	const struct passo_channel_registers registers = channel->registers;
	const bool stopping = channel->motion.stopping;
	struct passo_inputs_unit inputs_unit = channel->inputs;
	bool take_ramp;
	bool take_now;
	bool axes_quiet = true;
	struct passo_tracker_join_result steps[PASSO_AXES_MAX];

	for (unsigned i = 0; i < channel->axes; i++)
		axes_quiet = axes_quiet && channel->axis[i].quiet;
	/* a line loaded in the clock of a stop changes DIR up to 4 clocks later */
	channel->at_rest = !wires.occupied && channel->occupied_before == 0u && axes_quiet
	                && passo_outputs_quiet(&channel->outputs) && !channel->trackers.busy;
	channel->occupied_before =
	    (uint8_t)(((uint32_t)channel->occupied_before << 1 | (wires.occupied ? 1u : 0u)) & 7u);
	passo_admission_clock(&channel->admission, bus, &needs);

	if (channel->has_outputs)
		clock_outputs(channel, bus, &wires);
	/* from the pins back to the queues, so that each module sees the old state of those that feed it */
	uint32_t positions[PASSO_AXES_MAX];
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		positions[i] = channel->axis[i].position;
	passo_inputs_clock(&inputs_unit, channel, inputs, &wires);
	passo_positions_clock(
	    &channel->positions, positions, registers.command_zero, inputs->snapshot, wires.requests.latch);
	passo_encoders_clock(channel, inputs, &wires);
	for (unsigned i = 0; i < channel->axes; i++)
		steps[i] = passo_trackers_join(channel, i);
	passo_trackers_clock(channel, bus, &wires);
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_axis_wires axis_wires = {
		    .step_request = steps[i].step_request,
		    .direction = steps[i].direction,
		    .drop = wires.drop,
		    .zero = registers.command_zero,
		    .clear = registers.command_clear,
		    .timing_written =
			(write_timing && written_axis == i) || channel->axis[i].settings.half_written,
		    .pins_written = write_pins && written_axis == i,
		    .both_edges_next = (bus->data >> PASSO_AXIS_PINS_BOTH_EDGES_LSB & 1u) != 0u,
		    .closed = {.low = (channel->inputs.limits.closed_low >> i & 1) != 0,
			.high = (channel->inputs.limits.closed_high >> i & 1) != 0},
		};
		passo_axis_clock(&channel->axis[i], &axis_wires);
		channel->axis[i].settings.half_written = write_timing && written_axis == i;
		passo_dda_clock(&channel->dda[i], &channel->line, &channel->line_queue, i);
	}
	if (channel->writes_axis)
		passo_axis_settings_write(
		    &channel->axis[written_axis].settings, (uint8_t)written_register, bus->data);
	for (unsigned i = 0; i < channel->axes; i++)
		if ((wires.requests.disable >> i & 1u) != 0u)
			channel->axis[i].settings.enable = false;
	take_axis_write(channel, &wires, bus);

	passo_motion_clock(&channel->motion, channel, &wires);
	passo_line_clock(&channel->line, &channel->line_queue, &wires);
	passo_path_clock(&channel->path, &channel->ramp, &wires, registers.drain_velocity);
	passo_ramp_clock(&channel->ramp, channel, inputs, &wires, &take_ramp, &take_now);
	passo_timescale_clock(&channel->timescale, &registers, wires.moving, stopping, inputs->slew_tick);
	passo_line_queue_clock(&channel->line_queue, inputs->parameters, bus, &wires);
	passo_ramp_queue_clock(&channel->ramp_queue, inputs->parameters, bus, &wires, take_ramp, take_now);
	passo_channel_registers_clock(&channel->registers, bus, wires.selected);
	channel->inputs = inputs_unit;
}
