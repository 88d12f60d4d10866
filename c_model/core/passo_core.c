/* SPDX-License-Identifier: MIT
 * The core: link, registers, tables and channels on one clock. See rtl/passo_core.v.
 */
#include "passo_core.h"

#include <string.h>

#include "passo_advance.h"
#include "passo_registers_core.h"
#include "passo_rules.h"

static bool in_range(unsigned value, unsigned low, unsigned high)
{
	return value >= low && value <= high;
}

void passo_core_estop(const struct passo_core *core, bool estop_n, struct passo_outputs *outputs)
{
	const bool off = core->parameters.inputs != 0u && (core->machine.estop_pressed || !estop_n);

	outputs->enable = 0;
	outputs->power = 0;
	for (unsigned i = 0; i < core->parameters.channels; i++) {
		const struct passo_channel *channel = &core->channel[i];
		for (unsigned a = 0; a < core->parameters.axes; a++) {
			const struct passo_axis *axis = &channel->axis[a];
			const bool level = off ? axis->settings.enable_inverted : axis->enable_pin;
			outputs->enable |= (uint64_t)level << (i * core->parameters.axes + a);
		}
		outputs->power |= (uint8_t)((channel->outputs.pwm.pin && !off ? 1u : 0u) << i);
	}
}

void passo_core_gather_outputs(struct passo_core *core)
{
	struct passo_outputs *outputs = &core->outputs;

	outputs->step = outputs->dir = 0;
	outputs->outputs = 0;
	outputs->compare = 0;
	outputs->running = 0;
	for (unsigned i = 0; i < core->parameters.channels; i++) {
		const struct passo_channel *channel = &core->channel[i];
		for (unsigned a = 0; a < core->parameters.axes; a++) {
			const unsigned bit = i * core->parameters.axes + a;
			outputs->step |= (uint64_t)channel->axis[a].step_pin << bit;
			outputs->dir |= (uint64_t)channel->axis[a].dir_pin << bit;
		}
		outputs->outputs |= (uint64_t)channel->outputs.levels << 8u * i;
		outputs->compare |= (uint8_t)((channel->outputs.compare.pin ? 1u : 0u) << i);
		outputs->running |= (uint8_t)((channel->motion.running ? 1u : 0u) << i);
	}
	passo_core_estop(core, true, outputs);
	outputs->spi_miso = core->spi.miso;
}

bool passo_core_reset(struct passo_core *core, const struct passo_parameters *parameters)
{
	if (!in_range(parameters->channels, 1, PASSO_CHANNELS_MAX)
	    || !in_range(parameters->axes, 1, PASSO_AXES_MAX)
	    || !in_range(parameters->tick_log2, PASSO_TICK_LOG2_MIN, PASSO_TICK_LOG2_MAX)
	    || !in_range(parameters->line_queue_log2, 2, 8) || !in_range(parameters->ramp_queue_log2, 2, 8)
	    || parameters->inputs > 1u || parameters->encoders > 1u || parameters->outputs > 1u
	    || parameters->raster > parameters->outputs || parameters->compare > parameters->outputs
	    || parameters->trackers > 1u || parameters->tracked >= parameters->axes
	    || (parameters->tracked != 0u && parameters->trackers == 0u))
		return false;
	memset(core, 0, sizeof *core);
	core->parameters = *parameters;
	core->inputs = (struct passo_inputs)PASSO_INPUTS_IDLE;
	core->sync_q = 7;
	passo_machine_reset(&core->machine);
	passo_spi_reset(&core->spi);
	passo_link_reset(&core->link);
	for (unsigned bank = 0; bank < PASSO_BANKS; bank++) {
		for (unsigned k = 0; k < PASSO_BANK_POINTS; k++)
			core->tables.points[bank][k] = (uint16_t)passo_shape_point(bank + 1u, k);
	}
	for (unsigned i = 0; i < parameters->channels; i++)
		passo_channel_reset(&core->channel[i], parameters, (uint8_t)i);
	passo_core_gather_outputs(core);
	return true;
}

/* The channel at the address of the bus; NULL if it is none's. */
static const struct passo_channel *addressed(const struct passo_core *core, uint16_t address)
{
	const unsigned block = (unsigned)address >> 8;

	return in_range(block, 1, core->parameters.channels) ? &core->channel[block - 1u] : NULL;
}

/* Response to the bus strobe; `rule` is that of its address. */
static struct passo_response respond(const struct passo_core *core, const struct passo_rule *rule)
{
	const struct passo_bus *bus = &core->link.bus;
	const struct passo_channel *channel = addressed(core, bus->address);
	const uint8_t address = (uint8_t)bus->address;
	struct passo_response response = {0};

	if ((!bus->check && !bus->read) || !passo_rule_exists(rule))
		return response;
	const bool objects = channel != NULL ? passo_channel_objects(channel, address, bus->data)
	                                     : passo_registers_object(core, bus->address, bus->data);
	response.claim = true;
	response.refusal = passo_rule_refusal(rule, bus, objects);
	if (bus->check && bus->push && rule->push)
		response.refusal = passo_channel_push_refusal(channel, &core->parameters, bus);
	response.reads = bus->read && rule->read;
	response.address = bus->address;
	if (response.reads && channel != NULL)
		response.read_data = passo_channel_value_now(channel, address);
	return response;
}

/* The response to the strobe of the previous clock. */
static struct passo_response late_answer(const struct passo_core *core)
{
	struct passo_response response = core->response;
	const struct passo_channel *channel = addressed(core, response.address);

	if (response.reads)
		response.read_data |= channel != NULL
		                        ? passo_channel_registers_value(channel, (uint8_t)response.address)
		                        : passo_registers_value(core, response.address);
	return response;
}

bool passo_core_any_incomplete(const struct passo_core *core)
{
	for (unsigned i = 0; i < core->parameters.channels; i++)
		if (passo_channel_incomplete(&core->channel[i]))
			return true;
	return false;
}

bool passo_core_any_busy(const struct passo_core *core)
{
	for (unsigned i = 0; i < core->parameters.channels; i++)
		if (passo_channel_busy(&core->channel[i]))
			return true;
	return core->tables.wanted && passo_registers_any_occupied(core);
}

/* Levels at the inputs of a channel. */
void passo_core_take_pins(const struct passo_core *core, unsigned channel, const struct passo_inputs *inputs,
    struct passo_channel_inputs *made)
{
	const unsigned axes = core->parameters.axes, first = channel * axes;
	const uint64_t mask = (UINT64_C(1) << axes) - 1u;

	made->pins[PASSO_KIND_LIMIT_LOW] = (uint8_t)(inputs->limit_low >> first & mask);
	made->pins[PASSO_KIND_LIMIT_HIGH] = (uint8_t)(inputs->limit_high >> first & mask);
	made->pins[PASSO_KIND_HOME] = (uint8_t)(inputs->home >> first & mask);
	made->pins[PASSO_KIND_ALARM] = (uint8_t)(inputs->alarm >> first & mask);
	made->pins[PASSO_KIND_PROBE] = (uint8_t)(inputs->probe >> channel & 1u);
}

bool passo_core_any_moving(const struct passo_core *core)
{
	for (unsigned i = 0; i < core->parameters.channels; i++)
		if (passo_motion_moves(&core->channel[i].motion) || core->channel[i].trackers.busy)
			return true;
	return false;
}

/* A clock of all units but the channels, if these are `still`. */
static void clock_all(struct passo_core *core, const struct passo_inputs *inputs, bool still)
{
	const struct passo_parameters *parameters = &core->parameters;
	const struct passo_link_wires link_wires = {
	    .spi = passo_spi_wires(&core->spi),
	    .half_low = core->spi.half_low,
	    .half = core->spi.half,
	    .status = passo_registers_status(core),
	    .response = late_answer(core),
	    .incomplete = passo_core_any_incomplete(core),
	    .busy = passo_core_any_busy(core),
	};
	const struct passo_bus bus = core->link.bus;
	const struct passo_rule rule =
	    bus.check || bus.read ? passo_rule_at(parameters, bus.address) : (struct passo_rule){0};
	struct passo_channel_inputs channel_inputs = {
	    .parameters = parameters,
	    .tables = &core->tables,
	    .bus = &bus,
	    .sync_edge = (core->sync_q >> 1 & 1u) != 0u && (core->sync_q >> 2 & 1u) == 0u,
	    .slew_tick = core->slew_tick,
	    .snapshot = link_wires.spi.frame_start,
	    .tables_wanted = core->tables.wanted,
	    .needs_quiet = rule.needs_quiet,
	    .machine = &core->machine,
	};
	const bool irq = passo_registers_any_stopped(core);
	const struct passo_machine_wires machine_wires = {
	    .tick_log2 = parameters->tick_log2,
	    .moving = passo_core_any_moving(core),
	    .slew_tick = core->slew_tick,
	};
	const struct passo_registers registers = core->registers;
	const uint32_t reply_word = core->link.reply_word;

	core->response = respond(core, &rule);
	passo_registers_clock(core);
	for (unsigned i = 0; i < parameters->channels && !still; i++) {
		channel_inputs.run = (registers.run >> i & 1u) != 0u;
		channel_inputs.wait_sync = (registers.wait_sync >> i & 1u) != 0u;
		passo_core_take_pins(core, i, inputs, &channel_inputs);
		passo_encoders_pins(&channel_inputs, inputs, i);
		passo_channel_clock(&core->channel[i], &channel_inputs);
	}
	if (parameters->inputs != 0u)
		passo_machine_clock(&core->machine, &bus, inputs, &machine_wires);
	passo_link_clock(&core->link, &link_wires);
	passo_spi_clock(&core->spi, core->inputs.spi_sclk, inputs->spi_sclk, inputs->spi_mosi,
	    inputs->spi_cs_n, reply_word);

	passo_tables_turn(&core->tables, parameters->channels);
	core->sync_q = (uint8_t)((core->sync_q << 1 | (inputs->sync ? 1 : 0)) & 7);
	core->slew_tick = core->slew_count == (1u << parameters->tick_log2) - 1u;
	core->slew_count = (core->slew_count + 1u) & ((1u << parameters->tick_log2) - 1u);
	core->outputs.irq = irq;
	core->inputs = *inputs;
}

/* Synchronous reset in the clock just simulated. It does not affect the SPI slave, the tables, and the
 * settings and pins of the axes. */
static void restart(struct passo_core *core, const struct passo_core *before)
{
	const struct passo_parameters parameters = core->parameters;
	const struct passo_inputs inputs = core->inputs;
	const struct passo_tables tables = core->tables;
	const struct passo_spi spi = core->spi;
	const struct passo_machine_unit machine = core->machine;

	passo_core_reset(core, &parameters);

	core->spi = spi;
	core->inputs = inputs;
	passo_machine_restart(&core->machine, &machine);
	memcpy(core->tables.points, tables.points, sizeof core->tables.points);
	for (unsigned i = 0; i < parameters.channels; i++)
		passo_channel_restart(&core->channel[i], &before->channel[i], &parameters, &inputs);
}

static void clock_in_reset(struct passo_core *core, const struct passo_inputs *inputs)
{
	const struct passo_core before = *core;

	clock_all(core, inputs, false);
	restart(core, &before);
}

void passo_core_clock(struct passo_core *core, const struct passo_inputs *inputs)
{
	if (inputs->rst)
		clock_in_reset(core, inputs);
	else
		clock_all(core, inputs, false);
	passo_core_gather_outputs(core);
}

void passo_core_clock_bus(struct passo_core *core, const struct passo_inputs *inputs)
{
	clock_all(core, inputs, true);
	core->outputs.spi_miso = core->spi.miso;
}

const struct passo_outputs *passo_core_outputs(const struct passo_core *core)
{
	return &core->outputs;
}

uint64_t passo_core_size(void)
{
	return sizeof(struct passo_core);
}
