/* SPDX-License-Identifier: MIT
 * Registers of one channel and its axes. See rtl/passo_channel_registers.v and rtl/passo_axis_registers.v.
 */
#include "passo_answer.h"
#include "passo_model.h"
#include "passo_words.h"

static const uint32_t VELOCITY_MAX = 0x80000000u; /* UQ0.32 */
static const uint32_t DRAIN_VELOCITY_LOW = 0xFFu;

/* The effective bits of a command. */
static uint32_t command_of(uint32_t data)
{
	const uint32_t stop = 1u << PASSO_CHANNEL_COMMAND_STOP_LSB;
	const uint32_t abort = 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB;

	return (data & abort) != 0u ? abort : (data & stop) != 0u ? stop : data;
}

/* PINS of an axis, or INPUTS if the core has them. */
static bool axis_needs_quiet(uint8_t place, bool has_inputs)
{
	return place == PASSO_AXIS_PINS || (has_inputs && place == PASSO_AXIS_INPUTS);
}

struct passo_needs passo_channel_needs(
    const struct passo_channel *channel, const struct passo_bus *bus, bool has_inputs)
{
	const uint8_t address = (uint8_t)bus->address;
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_AXIS_BASE;
	const uint32_t command = address == PASSO_CHANNEL_COMMAND ? command_of(bus->data) : 0u;
	const bool outputs = channel->has_outputs && passo_output_registers_need_quiet(address);
	const bool pins = in_axes < channel->axes * PASSO_CHANNEL_AXIS_STRIDE
	               && axis_needs_quiet((uint8_t)(in_axes % PASSO_CHANNEL_AXIS_STRIDE), has_inputs);

	if (!bus->check || (bus->address >> 8) != channel->number + 1u)
		return (struct passo_needs){0};
	return (struct passo_needs){
	    .idle = (command >> PASSO_CHANNEL_COMMAND_CLEAR_LSB & 1u) != 0u,
	    .quiet = pins || outputs || address == PASSO_CHANNEL_FOLLOW
	          || (command >> PASSO_CHANNEL_COMMAND_ZERO_LSB & 1u) != 0u,
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
		return passo_outputs_state(&channel->outputs);
	case PASSO_CHANNEL_VELOCITY:
		return channel->path.velocity_high << 8 | channel->path.velocity_low >> 16;
	default:
		return passo_inputs_value(&channel->inputs, address)
		     | passo_encoder_registers_value(channel, address);
	}
}

static struct passo_answer axis_answer(
    const struct passo_axis *axis, uint8_t address, uint32_t data, bool has_inputs)
{
	switch (address) {
	case PASSO_AXIS_PINS:
		return passo_write_only(passo_value_check((data & ~PASSO_AXIS_PINS_DEFINED) != 0u));
	case PASSO_AXIS_ENABLE:
		return passo_write_only(passo_value_check((data & ~PASSO_AXIS_ENABLE_DEFINED) != 0u));
	case PASSO_AXIS_STEP_TIMING:
	case PASSO_AXIS_DIR_TIMING:
		return passo_write_only(PASSO_VERDICT_OK);
	case PASSO_AXIS_LOST_STEPS:
		return passo_read_only(axis->lost);
	case PASSO_AXIS_INPUTS:
		if (has_inputs)
			return passo_write_only(passo_value_check((data & ~PASSO_AXIS_INPUTS_DEFINED) != 0u));
		return (struct passo_answer){0};
	default:
		return (struct passo_answer){0};
	}
}

/* Registers of the outputs. */
static struct passo_answer output_answer(const struct passo_channel *channel, const struct passo_bus *bus)
{
	const uint8_t address = (uint8_t)bus->address;

	if (address == PASSO_CHANNEL_RASTER)
		return passo_write_only(
		    bus->push ? passo_raster_refusal(&channel->outputs.raster, passo_channel_stopped(channel))
		              : PASSO_VERDICT_BAD_OPERATION);
	if (address == PASSO_CHANNEL_OUTPUT_STATE)
		return passo_read_late();
	if (passo_output_registers_known(address))
		return passo_write_only(passo_output_registers_check(address, bus->data, channel->axes));
	return (struct passo_answer){0};
}

/* Registers of the parts that a core may have. */
static struct passo_answer part_answer(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint8_t address)
{
	struct passo_answer answer = {0};

	if (inputs->parameters->inputs != 0u)
		answer = passo_inputs_answer(channel, address, inputs->bus->data);
	if (!answer.known && channel->encoders.present)
		answer = passo_encoder_registers_answer(channel, address, inputs->bus->data);
	if (!answer.known && channel->has_outputs)
		answer = output_answer(channel, inputs->bus);
	return answer;
}

static struct passo_answer channel_answer(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint8_t address)
{
	const struct passo_bus *bus = inputs->bus;
	const bool stopped = passo_channel_stopped(channel);
	const unsigned position = (unsigned)address - PASSO_CHANNEL_POSITION_BASE;
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_AXIS_BASE;

	switch (address) {
	case PASSO_CHANNEL_COMMAND:
		return passo_write_only(
		    passo_value_check((bus->data & ~PASSO_CHANNEL_COMMAND_DEFINED) != 0u));
	case PASSO_CHANNEL_RATE_TARGET:
	case PASSO_CHANNEL_RATE_SLEW:
	case PASSO_CHANNEL_STOP_SLEW:
		return passo_write_only(passo_value_check(bus->data > PASSO_RATE_ONE));
	case PASSO_CHANNEL_DRAIN_VELOCITY:
		return passo_write_only(passo_value_check(bus->data == 0u || bus->data > VELOCITY_MAX));
	case PASSO_CHANNEL_STATE:
	case PASSO_CHANNEL_RATE:
	case PASSO_CHANNEL_ROOM:
	case PASSO_CHANNEL_VELOCITY:
		return passo_read_late();
	case PASSO_CHANNEL_LINE:
		return passo_write_only(bus->push ? passo_line_queue_refusal(&channel->line_queue,
							inputs->parameters, bus, stopped)
		                                  : PASSO_VERDICT_BAD_OPERATION);
	case PASSO_CHANNEL_RAMP:
		return passo_write_only(bus->push
					    ? passo_ramp_queue_refusal(&channel->ramp_queue, bus, stopped)
					    : PASSO_VERDICT_BAD_OPERATION);
	default:
		break;
	}
	if (position < channel->axes)
		return passo_read_only(channel->positions.copies[position]);
	if (in_axes < channel->axes * PASSO_CHANNEL_AXIS_STRIDE)
		return axis_answer(&channel->axis[in_axes / PASSO_CHANNEL_AXIS_STRIDE],
		    (uint8_t)(in_axes % PASSO_CHANNEL_AXIS_STRIDE), bus->data,
		    inputs->parameters->inputs != 0u);
	return part_answer(channel, inputs, address);
}

struct passo_response passo_channel_respond(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_bus *bus = inputs->bus;
	const uint8_t address = (uint8_t)bus->address;
	struct passo_response response = {0};

	const struct passo_answer answer = channel_answer(channel, inputs, address);
	response.claim = answer.known;
	if (answer.known && bus->check)
		response.refusal = bus->push && address != PASSO_CHANNEL_LINE && address != PASSO_CHANNEL_RAMP
		                        && address != PASSO_CHANNEL_RASTER
		                     ? PASSO_VERDICT_BAD_OPERATION
		                     : answer.check;
	if (answer.known && bus->read) {
		response.refusal = answer.read;
		response.read_data = answer.value;
		response.late = answer.late;
		response.address = bus->address;
	}
	return response;
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
