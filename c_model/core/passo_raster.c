/* SPDX-License-Identifier: MIT
 * Raster: the queue of values, and the substeps that take them. See rtl/passo_raster.v.
 */
#include "passo_core_outputs.h"
#include "passo_registers.h"

enum { TWICE_DEPTH = 2 * PASSO_RASTER_DEPTH, VALUES = 4, PITCH_BITS = 0x3FFFFFFF };

static void drop(struct passo_raster *raster)
{
	raster->write_word = raster->write_end = raster->read_word = 0;
	raster->available = raster->first = raster->missed = false;
	raster->index = 0;
}

void passo_raster_reset(struct passo_raster *raster)
{
	*raster = (struct passo_raster){.room = PASSO_RASTER_DEPTH};
}

bool passo_raster_take(const struct passo_raster *raster, const struct passo_outputs_wires *wires)
{
	return wires->substep && wires->word.raster && (raster->first || raster->due);
}

uint8_t passo_raster_value(const struct passo_raster *raster)
{
	return (uint8_t)(raster->available ? raster->word >> (8u * raster->index) : 0u);
}

uint8_t passo_raster_refusal(const struct passo_raster *raster, bool blocked)
{
	if (blocked)
		return PASSO_VERDICT_BUSY;
	return raster->full ? PASSO_VERDICT_QUEUE_FULL : PASSO_VERDICT_OK;
}

static uint16_t free_places(const struct passo_raster *raster)
{
	return (uint16_t)(((raster->read_word ^ PASSO_RASTER_DEPTH) - raster->write_end) % TWICE_DEPTH);
}

static void clock_writing(struct passo_raster *raster, const struct passo_raster_bus *bus)
{
	const uint16_t write_word = raster->write_word;

	raster->full = raster->room == raster->checked;
	raster->room = free_places(raster);
	if (bus->frame && bus->commit)
		raster->write_end = (uint16_t)((write_word + raster->checked) % TWICE_DEPTH);
	if (bus->push && bus->write) {
		raster->words[write_word % PASSO_RASTER_DEPTH] = bus->data;
		raster->write_word = (uint16_t)((write_word + 1u) % TWICE_DEPTH);
	}
	if (bus->push && bus->check)
		raster->checked = (uint16_t)((raster->checked + 1u) % TWICE_DEPTH);
	if (bus->frame)
		raster->checked = 0;
}

void passo_raster_clock(struct passo_raster *raster, const struct passo_outputs_wires *wires)
{
	const bool take = passo_raster_take(raster, wires);
	const uint16_t read_word = raster->read_word;
	const bool available = read_word != raster->write_word;
	uint8_t index = raster->index;

	raster->word = raster->words[read_word % PASSO_RASTER_DEPTH];
	clock_writing(raster, &wires->bus);
	raster->missed = take && !raster->available;
	if (take && raster->available)
		index++;
	if (index == VALUES || (wires->line_begins && index != 0u)) {
		raster->read_word = (uint16_t)((read_word + 1u) % TWICE_DEPTH);
		index = 0;
	}
	raster->index = index;
	raster->available = available;
	raster->first = wires->line_begins || (raster->first && !wires->substep);
	raster->due = raster->left == 1u;
	if (take)
		raster->left = wires->settings.pitch;
	else if (wires->substep)
		raster->left = (raster->left - 1u) & PITCH_BITS;
	if (wires->stopped)
		drop(raster);
}

bool passo_raster_steady(const struct passo_raster *raster, bool stopped)
{
	if (stopped && (raster->write_word | raster->write_end | raster->read_word | raster->index) != 0u)
		return false;
	return !raster->missed && !(stopped && (raster->available || raster->first))
	    && raster->word == raster->words[raster->read_word % PASSO_RASTER_DEPTH]
	    && (stopped || raster->available == (raster->read_word != raster->write_word))
	    && raster->full == (raster->room == raster->checked) && raster->room == free_places(raster)
	    && raster->due == (raster->left == 1u);
}

void passo_raster_skip(struct passo_raster *raster, uint32_t substeps)
{
	raster->left = (raster->left - substeps) & PITCH_BITS;
}
