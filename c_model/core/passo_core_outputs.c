/* SPDX-License-Identifier: MIT
 * Path-synchronized outputs of a channel. See rtl/passo_outputs.v.
 */
#include "passo_core_outputs.h"

#include <string.h>

enum { STILL_LAST = 5, STILL_MASK = 0x3F };

void passo_outputs_reset(struct passo_outputs_unit *outputs)
{
	*outputs = (struct passo_outputs_unit){.pwm = {.idle = true}};
	passo_power_reset(&outputs->power);
	passo_changes_reset(&outputs->changes);
	passo_raster_reset(&outputs->raster);
}

bool passo_outputs_quiet(const struct passo_outputs_unit *outputs)
{
	return outputs->changes.empty;
}

uint32_t passo_outputs_state(const struct passo_outputs_unit *outputs, bool has_raster)
{
	return passo_pack_channel_output_state(&(struct passo_channel_output_state){
	    .levels = outputs->levels,
	    .raster_empty = outputs->raster_empty,
	    .overflow = outputs->overflow,
	    .raster_room = has_raster ? outputs->raster.room : 0u,
	});
}

static void clock_pwm(struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	passo_pwm_clock(&outputs->pwm, &(struct passo_pwm_wires){
					   .go = outputs->lit && (outputs->still >> STILL_LAST & 1u) == 0u
	                                      && !outputs->overflow && wires->running && wires->running_next,
					   .restart = outputs->restart,
					   .power = outputs->now.power,
					   .proportional = outputs->now.proportional,
					   .step = wires->settings.pwm_step,
					   .cost = outputs->power.cost,
				       });
}

/* The active word, and the levels at the pins. */
static void clock_word(struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const struct passo_changes *changes = &outputs->changes;
	const struct passo_line_output *next = &changes->data.word;
	struct passo_line_output *now = &outputs->now;
	const bool differs = next->power != now->power || next->proportional != now->proportional;

	outputs->levels = now->levels;
	outputs->restart = changes->hit && outputs->differs;
	outputs->differs = differs;
	if (changes->hit) {
		*now = *next;
		outputs->lit = next->power != 0u;
	}
	if (!wires->running) {
		now->power = 0;
		outputs->lit = false;
	}
	if (wires->write_levels)
		now->levels = (uint8_t)wires->bus.data;
	outputs->still =
	    (uint8_t)((outputs->still << 1 | (wires->velocity == 0u || wires->rate == 0u || wires->waits))
	              & STILL_MASK);
	outputs->overflow = (outputs->overflow || changes->overflow) && !wires->clear;
	outputs->raster_empty = (outputs->raster_empty || outputs->raster.missed) && !wires->clear;
}

void passo_outputs_clock(struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const bool take = passo_raster_take(&outputs->raster, wires);
	const bool change = take || (wires->substep && outputs->raster.first);
	const bool moves = wires->running && (outputs->still & 1u) == 0u;
	struct passo_line_output word = wires->word;

	word.raster = false;
	if (take)
		word.power = (uint16_t)(passo_raster_value(&outputs->raster) * 0x101u);
	clock_pwm(outputs, wires);
	clock_word(outputs, wires);
	passo_power_clock(&outputs->power, wires, moves);
	passo_raster_clock(&outputs->raster, wires);
	passo_changes_clock(&outputs->changes, wires->stopped, wires->settings.lag, change, &word);
	passo_compare_clock(&outputs->compare, wires);
}

bool passo_outputs_steady(const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	struct passo_outputs_unit next = *outputs;

	if (wires->running || outputs->compare.pin || !outputs->changes.empty)
		return false;
	passo_outputs_clock(&next, wires);
	next.changes.now--;
	next.changes.due--;
	next.compare.timer--;
	return memcmp(&next, outputs, sizeof next) == 0;
}

void passo_outputs_skip(struct passo_outputs_unit *outputs, uint64_t clocks)
{
	outputs->changes.now = (uint16_t)(outputs->changes.now + clocks);
	outputs->changes.due = (uint16_t)(outputs->changes.due + clocks);
	outputs->compare.timer = (uint16_t)(outputs->compare.timer + clocks);
}
