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

static struct passo_pwm_wires pwm_wires(
    const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	return (struct passo_pwm_wires){
	    .go = outputs->lit && (outputs->still >> STILL_LAST & 1u) == 0u && !outputs->overflow
	       && wires->running && wires->running_next,
	    .restart = outputs->restart,
	    .power = outputs->now.power,
	    .proportional = outputs->now.proportional,
	    .step = wires->settings.pwm_step,
	    .cost = outputs->power.cost,
	};
}

static bool differ(const struct passo_line_output *a, const struct passo_line_output *b)
{
	return a->power != b->power || a->proportional != b->proportional;
}

/* Whether the path is at rest, for the power. */
static bool is_still(const struct passo_outputs_wires *wires)
{
	return wires->velocity == 0u || wires->rate == 0u || wires->waits;
}

/* The active word, and the levels at the pins. */
static void clock_word(struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const struct passo_changes *changes = &outputs->changes;
	const struct passo_line_output *next = &changes->data.word;
	struct passo_line_output *now = &outputs->now;
	const bool differs = differ(next, now);

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
	outputs->still = (uint8_t)((outputs->still << 1 | (is_still(wires) ? 1 : 0)) & STILL_MASK);
	outputs->overflow = (outputs->overflow || changes->overflow) && !wires->clear;
	outputs->raster_empty = (outputs->raster_empty || outputs->raster.missed) && !wires->clear;
}

static bool path_moves(const struct passo_outputs_unit *outputs, bool running)
{
	return running && (outputs->still & 1u) == 0u;
}

void passo_outputs_clock(struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const bool take = passo_raster_take(&outputs->raster, wires);
	const bool change = take || (wires->substep && outputs->raster.first);
	const bool moves = path_moves(outputs, wires->running);
	const struct passo_pwm_wires pwm = pwm_wires(outputs, wires);
	struct passo_line_output word = wires->word;

	word.raster = false;
	if (take)
		word.power = (uint16_t)(passo_raster_value(&outputs->raster) * 0x101u);
	passo_pwm_clock(&outputs->pwm, &pwm);
	clock_word(outputs, wires);
	passo_power_clock(&outputs->power, wires, moves);
	passo_raster_clock(&outputs->raster, wires);
	passo_changes_clock(&outputs->changes, wires->stopped, wires->settings.lag, change, &word);
	passo_compare_clock(&outputs->compare, wires);
}

bool passo_outputs_ignore(
    const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires, uint32_t substeps)
{
	const struct passo_raster *raster = &outputs->raster;

	return !wires->word.raster && !raster->first && (raster->left == 0u || raster->left > substeps + 1u);
}

/* Whether the active word and what follows it are constant. */
static bool word_steady(const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const struct passo_line_output *now = &outputs->now;

	return (wires->running || (now->power == 0u && !outputs->lit)) && outputs->levels == now->levels
	    && !outputs->restart && outputs->differs == differ(&outputs->changes.data.word, now)
	    && outputs->still == (is_still(wires) ? STILL_MASK : 0) && !wires->clear;
}

static uint64_t pwm_steady(const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const struct passo_pwm_wires pwm = pwm_wires(outputs, wires);
	struct passo_pwm next = outputs->pwm;

	if (pwm.go)
		return passo_pwm_quiet(&outputs->pwm, &pwm);
	passo_pwm_clock(&next, &pwm);
	return memcmp(&next, &outputs->pwm, sizeof next) == 0 ? UINT64_MAX : 0u;
}

static bool power_steady(const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	const bool moves = path_moves(outputs, wires->running);
	struct passo_power next = outputs->power;

	if (moves)
		return passo_power_divides(&outputs->power);
	passo_power_clock(&next, wires, moves);
	return memcmp(&next, &outputs->power, sizeof next) == 0;
}

static bool compare_steady(const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	struct passo_compare next = outputs->compare;

	if (outputs->compare.pin)
		return false;
	passo_compare_clock(&next, wires);
	next.timer--;
	return memcmp(&next, &outputs->compare, sizeof next) == 0;
}

uint64_t passo_outputs_steady(
    const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires)
{
	if (!word_steady(outputs, wires)
	    || !passo_changes_steady(&outputs->changes, wires->stopped, wires->settings.lag)
	    || !passo_raster_steady(&outputs->raster, wires->stopped) || !power_steady(outputs, wires)
	    || !compare_steady(outputs, wires))
		return 0;
	return pwm_steady(outputs, wires);
}

void passo_outputs_skip(
    struct passo_outputs_unit *outputs, const struct passo_outputs_skipped *skipped, uint64_t clocks)
{
	struct passo_power *power = &outputs->power;

	outputs->changes.now = (uint16_t)(outputs->changes.now + clocks);
	outputs->changes.due = (uint16_t)(outputs->changes.due + clocks);
	outputs->compare.timer = (uint16_t)(outputs->compare.timer + clocks);
	passo_raster_skip(&outputs->raster, skipped->substeps);
	if (!outputs->pwm.idle)
		passo_pwm_skip(&outputs->pwm, skipped->pwm_step, clocks);
	if (clocks == 0u || !path_moves(outputs, skipped->running))
		return;
	/* the PWM takes the cost of the clock before */
	passo_power_skip(power, skipped->velocity, skipped->rate, clocks - 1u);
	outputs->pwm.cost = passo_pwm_cost(outputs->now.proportional, skipped->pwm_step, power->cost);
	passo_power_skip(power, skipped->velocity, skipped->rate, 1);
}
