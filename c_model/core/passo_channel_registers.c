/* SPDX-License-Identifier: MIT
 * Registers of one channel and its axes. See rtl/passo_channel_registers.v and rtl/passo_axis_registers.v.
 */
#include "passo_model.h"
#include "passo_words.h"

static const uint32_t DRAIN_VELOCITY_LOW = 0xFFu;

/* The effective bits of a command. */
static uint32_t command_of(uint32_t data)
{
	const uint32_t stop = 1u << PASSO_CHANNEL_COMMAND_STOP_LSB;
	const uint32_t abort = 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB;

	return (data & abort) != 0u ? abort : (data & stop) != 0u ? stop : data;
}

struct passo_needs passo_channel_needs(
    const struct passo_channel *channel, const struct passo_bus *bus, bool needs_quiet)
{
	const uint8_t address = (uint8_t)bus->address;
	const uint32_t command = address == PASSO_CHANNEL_COMMAND ? command_of(bus->data) : 0u;

	if (!bus->check || (bus->address >> 8) != channel->number + 1u)
		return (struct passo_needs){0};
	return (struct passo_needs){
	    .idle = (command >> PASSO_CHANNEL_COMMAND_CLEAR_LSB & 1u) != 0u,
	    .quiet = needs_quiet || (command >> PASSO_CHANNEL_COMMAND_ZERO_LSB & 1u) != 0u,
	    .motion = bus->push && address == PASSO_CHANNEL_RAMP
	           && passo_ramp_queue_checks_now(&channel->ramp_queue, bus->data),
	};
}

static uint32_t state_word(const struct passo_channel *channel)
{
	const struct passo_motion *motion = &channel->motion;
	uint32_t overrun = 0;

	for (unsigned axis = 0; axis < channel->axes; axis++)
		overrun |= (channel->axis[axis].lost != 0u ? 1u : 0u) << axis;
	return passo_pack_channel_state(&(struct passo_channel_state){
	    .drained = motion->drained,
	    .overrun = (uint8_t)overrun,
	    .stopping = motion->stopping,
	    .cause = (enum passo_cause)motion->cause,
	    .quiet = passo_channel_quiet(channel),
	    .state = (enum passo_state)motion->state,
	});
}

uint32_t passo_channel_registers_value(const struct passo_channel *channel, uint8_t address)
{
	switch (address) {
	case PASSO_CHANNEL_STATE:
		return state_word(channel);
	case PASSO_CHANNEL_RATE:
		return channel->timescale.rate;
	case PASSO_CHANNEL_ROOM:
		return passo_pack_channel_room(&(struct passo_channel_room){
		    .line_room = channel->line_queue.room, .ramp_room = channel->ramp_queue.room});
	case PASSO_CHANNEL_OUTPUT_STATE:
		return passo_outputs_state(&channel->outputs, channel->has_raster);
	case PASSO_CHANNEL_VELOCITY:
		return channel->path.velocity_high << 8 | channel->path.velocity_low >> 16;
	default:
		return passo_inputs_value(&channel->inputs, address)
		     | passo_encoder_registers_value(channel, address)
		     | passo_trackers_value(channel, address);
	}
}

uint32_t passo_channel_value_now(const struct passo_channel *channel, uint8_t address)
{
	const unsigned number = address % PASSO_AXES_MAX;
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_AXIS_BASE;

	switch (address - number) {
	case PASSO_CHANNEL_POSITION_BASE:
		return channel->positions.copies[number];
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE:
		return channel->positions.latched_copies[number];
	case PASSO_CHANNEL_TRACKER_POSITION_BASE:
		return channel->trackers.axis[number].shown;
	case PASSO_CHANNEL_ENCODER_POSITION_BASE:
		return channel->encoders.positions.copies[number];
	default:
		break;
	}
	return in_axes < channel->axes * PASSO_CHANNEL_AXIS_STRIDE
	            && in_axes % PASSO_CHANNEL_AXIS_STRIDE == PASSO_AXIS_LOST_STEPS
	         ? channel->axis[in_axes / PASSO_CHANNEL_AXIS_STRIDE].lost
	         : 0u;
}

bool passo_channel_objects(const struct passo_channel *channel, uint8_t address, uint32_t data)
{
	return (address == PASSO_CHANNEL_TRIGGER && passo_trigger_objects(channel, data))
	    || passo_output_registers_object(address, data, channel->axes);
}

uint8_t passo_channel_push_refusal(const struct passo_channel *channel,
    const struct passo_parameters *parameters, const struct passo_bus *bus)
{
	const bool stopped = passo_channel_stopped(channel);

	switch ((uint8_t)bus->address) {
	case PASSO_CHANNEL_LINE:
		return passo_line_queue_refusal(&channel->line_queue, parameters, bus, stopped);
	case PASSO_CHANNEL_RAMP:
		return passo_ramp_queue_refusal(&channel->ramp_queue, bus, stopped);
	default:
		return passo_raster_refusal(&channel->outputs.raster, stopped);
	}
}

void passo_channel_registers_reset(struct passo_channel_registers *registers)
{
	*registers = (struct passo_channel_registers){
	    .rate_target = PASSO_CHANNEL_RATE_TARGET_RESET,
	    .rate_slew = PASSO_CHANNEL_RATE_SLEW_RESET,
	    .stop_slew = PASSO_CHANNEL_STOP_SLEW_RESET,
	    .drain_velocity = PASSO_CHANNEL_DRAIN_VELOCITY_RESET,
	};
}

void passo_channel_registers_clock(
    struct passo_channel_registers *registers, const struct passo_bus *bus, bool selected)
{
	const uint32_t data = bus->data;
	const uint32_t command = command_of(data);

	/* the upper bits are written one clock after the lower ones */
	if (registers->drain_velocity_written)
		registers->drain_velocity =
		    (data & ~DRAIN_VELOCITY_LOW) | (registers->drain_velocity & DRAIN_VELOCITY_LOW);
	registers->drain_velocity_written = false;
	registers->command_stop = registers->command_abort = registers->command_clear =
	    registers->command_zero = false;
	if (!selected || !bus->write)
		return;
	switch ((uint8_t)bus->address) {
	case PASSO_CHANNEL_COMMAND:
		registers->command_stop = (command >> PASSO_CHANNEL_COMMAND_STOP_LSB & 1u) != 0u;
		registers->command_abort = (command >> PASSO_CHANNEL_COMMAND_ABORT_LSB & 1u) != 0u;
		registers->command_clear = (command >> PASSO_CHANNEL_COMMAND_CLEAR_LSB & 1u) != 0u;
		registers->command_zero = (command >> PASSO_CHANNEL_COMMAND_ZERO_LSB & 1u) != 0u;
		break;
	case PASSO_CHANNEL_RATE_TARGET:
		registers->rate_target = data;
		break;
	case PASSO_CHANNEL_RATE_SLEW:
		registers->rate_slew = data;
		break;
	case PASSO_CHANNEL_STOP_SLEW:
		registers->stop_slew = data;
		break;
	case PASSO_CHANNEL_DRAIN_VELOCITY:
		registers->drain_velocity =
		    (registers->drain_velocity & ~DRAIN_VELOCITY_LOW) | (data & DRAIN_VELOCITY_LOW);
		registers->drain_velocity_written = true;
		break;
	default:
		break;
	}
}
