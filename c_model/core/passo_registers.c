/* SPDX-License-Identifier: MIT
 * Registers of the core, and the bus interface of the shape tables. See rtl/passo_registers.v and
 * rtl/passo_tables.v.
 */
#include "passo_core.h"

#include "passo_registers_core.h"
#include "passo_words.h"

static uint8_t at_most_255(uint16_t room)
{
	return (uint8_t)(room > 255u ? 255u : room);
}

bool passo_registers_any_occupied(const struct passo_core *core)
{
	bool any = false;

	for (unsigned i = 0; i < core->parameters.channels; i++)
		any |= passo_channel_occupied(&core->channel[i]);
	return any;
}

bool passo_registers_any_stopped(const struct passo_core *core)
{
	bool any = false;

	for (unsigned i = 0; i < core->parameters.channels; i++)
		any |= passo_channel_stopped(&core->channel[i]);
	return any;
}

uint32_t passo_registers_status(const struct passo_core *core)
{
	const struct passo_channel *channel = &core->channel[core->registers.status_channel];

	return passo_pack_status(&(struct passo_status){
	    .marker = PASSO_STATUS_MARKER_RESET,
	    .any_stopped = passo_registers_any_stopped(core),
	    .any_occupied = passo_registers_any_occupied(core),
	    .channel = core->registers.status_channel,
	    .sequence = core->link.last_sequence,
	    .line_room = at_most_255(channel->line_queue.room),
	    .ramp_room = at_most_255(channel->ramp_queue.room),
	});
}

static uint32_t parameters_word(const struct passo_parameters *parameters)
{
	return passo_pack_parameters(&(struct passo_parameters_word){
	    .channels = parameters->channels,
	    .axes = parameters->axes,
	    .tick_log2 = parameters->tick_log2,
	    .line_queue_log2 = parameters->line_queue_log2,
	    .ramp_queue_log2 = parameters->ramp_queue_log2,
	    .inputs = parameters->inputs,
	    .encoders = parameters->encoders,
	    .outputs = parameters->outputs,
	    .raster = parameters->raster,
	    .compare = parameters->compare,
	    .trackers = parameters->trackers,
	    .tracked = parameters->tracked,
	});
}

static uint32_t four_counters(const uint8_t *counters)
{
	return (uint32_t)counters[3] << 24 | (uint32_t)counters[2] << 16 | (uint32_t)counters[1] << 8
	     | counters[0];
}

uint32_t passo_registers_value(const struct passo_core *core, uint16_t address)
{
	const struct passo_registers *registers = &core->registers;

	switch (address) {
	case PASSO_ADDRESS_IDENTIFICATION:
		return PASSO_IDENTIFICATION_RESET;
	case PASSO_ADDRESS_VERSION:
		return passo_pack_version(&(struct passo_version){
		    .major = PASSO_VERSION_MAJOR_RESET,
		    .minor = PASSO_VERSION_MINOR_RESET,
		    .patch = PASSO_VERSION_PATCH_RESET,
		});
	case PASSO_ADDRESS_PARAMETERS:
		return parameters_word(&core->parameters);
	case PASSO_ADDRESS_RUN:
		return passo_pack_run(&(struct passo_run){
		    .status_channel = registers->status_channel,
		    .wait_sync = registers->wait_sync,
		    .run = registers->run,
		});
	case PASSO_ADDRESS_REFUSALS_0:
		return four_counters(&registers->refusals[0]);
	case PASSO_ADDRESS_REFUSALS_1:
		return four_counters(&registers->refusals[4]);
	case PASSO_ADDRESS_CLOCK:
		return core->parameters.clock_hz;
	case PASSO_ADDRESS_BUILD:
		return core->parameters.build;
	case PASSO_ADDRESS_ESTOP:
		return (uint32_t)core->machine.estop_seen >> 1;
	default:
		return 0;
	}
}

bool passo_registers_object(const struct passo_core *core, uint16_t address, uint32_t data)
{
	const unsigned channels = core->parameters.channels;
	const struct passo_run word = passo_unpack_run(data);

	return address == PASSO_ADDRESS_RUN
	    && (word.run >> channels != 0 || word.wait_sync >> channels != 0
	        || word.status_channel >= channels);
}

void passo_tables_clock(struct passo_tables *tables, const struct passo_bus *bus)
{
	const unsigned bank = bus->check || bus->write ? passo_bank_at(bus->address) : 0u;

	tables->wanted = !(bus->frame && !bus->commit) && (tables->wanted || (bus->check && bank != 0u));
	if (bus->write && bank != 0u)
		tables->points[bank - 1u][bus->address % PASSO_BANK_POINTS] = (uint16_t)bus->data;
}

void passo_tables_turn(struct passo_tables *tables, uint8_t channels)
{
	tables->slot = (uint8_t)((tables->slot + 1u) % (2u * channels));
}

void passo_registers_clock(struct passo_core *core)
{
	const struct passo_bus *bus = &core->link.bus;
	struct passo_registers *registers = &core->registers;

	if (core->link.refused)
		registers->refusals[core->link.verdict - PASSO_VERDICT_BAD_CRC]++;
	if (bus->write && bus->address == PASSO_ADDRESS_RUN) {
		const struct passo_run word = passo_unpack_run(bus->data);
		registers->run = word.run;
		registers->wait_sync = word.wait_sync;
		registers->status_channel = word.status_channel;
	}
	passo_tables_clock(&core->tables, bus);
}
