/* SPDX-License-Identifier: MIT
 * Axis: STEP and DIR pins of one axis, with all four pin timings. See rtl/passo_axis.v and
 * rtl/passo_axis_registers.v.
 */
#include "passo_model.h"

enum { WAITING_MAX = 4, LOST_MAX = 15 };

void passo_axis_reset(struct passo_axis *axis)
{
	*axis = (struct passo_axis){
	    .settings =
		{
		    .step_high = PASSO_AXIS_STEP_TIMING_STEP_HIGH_RESET,
		    .step_low = PASSO_AXIS_STEP_TIMING_STEP_LOW_RESET,
		    .dir_setup = PASSO_AXIS_DIR_TIMING_DIR_SETUP_RESET,
		    .dir_hold = PASSO_AXIS_DIR_TIMING_DIR_HOLD_RESET,
		},
	};
}

void passo_axis_registers_write(struct passo_axis_settings *settings, uint8_t address, uint32_t data)
{
	const uint16_t high = (uint16_t)(data >> 16);
	const uint16_t low = (uint16_t)data;

	switch (address) {
	case PASSO_AXIS_PINS:
		settings->enable = (data & 1u) != 0u;
		settings->step_inverted = (data & 2u) != 0u;
		settings->direction_inverted = (data & 4u) != 0u;
		settings->enable_inverted = (data & 8u) != 0u;
		settings->both_edges = (data & 16u) != 0u;
		break;
	case PASSO_AXIS_STEP_TIMING:
		settings->step_high = high;
		settings->step_low = low;
		break;
	case PASSO_AXIS_DIR_TIMING:
		settings->dir_setup = high;
		settings->dir_hold = low;
		break;
	default:
		break;
	}
}

static bool timer_done(const struct passo_axis *axis)
{
	return axis->timer <= 1u;
}

static bool dir_right(const struct passo_axis *axis, bool line_direction)
{
	const bool wanted = axis->waiting_count != 0u ? (axis->waiting & 1u) != 0u : line_direction;
	return wanted == axis->dir;
}

static void clock_queue(struct passo_axis *axis, bool step_begins, const struct passo_axis_wires *wires)
{
	const bool full = axis->waiting_count == WAITING_MAX;

	if (step_begins) {
		axis->waiting >>= 1;
		axis->waiting_count--;
	}
	axis->overrun = wires->step_request && full;
	if (wires->step_request && !full) {
		const uint8_t place = (uint8_t)(1u << axis->waiting_count);
		axis->waiting = (uint8_t)(wires->direction ? axis->waiting | place : axis->waiting & ~place);
		axis->waiting_count++;
	}
	if (wires->drop)
		axis->waiting_count = 0;
}

void passo_axis_clock(struct passo_axis *axis, const struct passo_axis_wires *wires)
{
	const struct passo_axis_settings *settings = &axis->settings;
	const bool done = timer_done(axis);
	const enum passo_axis_state state = axis->state;
	const bool right = dir_right(axis, wires->direction);
	const bool free =
	    state == PASSO_AXIS_READY || state == PASSO_AXIS_HOLD || (done && state != PASSO_AXIS_HIGH);
	const bool step_begins = free && axis->waiting_count != 0u && right;
	const bool turn = !right && (state == PASSO_AXIS_READY || (state == PASSO_AXIS_HOLD && done));

	/* registers */
	if (axis->overrun && axis->lost != LOST_MAX)
		axis->lost++;
	if (wires->clear)
		axis->lost = 0;
	if (wires->snapshot)
		axis->position_snapshot = axis->position;

	/* pins and position follow a clock later */
	if (axis->step_begins_q)
		axis->position += axis->dir_q ? 0xFFFFFFFFu : 1u;
	if (wires->zero)
		axis->position = 0;
	axis->step_begins_q = step_begins;
	axis->dir_q = axis->dir;
	axis->step_pin = axis->step != settings->step_inverted;
	axis->dir_pin = axis->dir != settings->direction_inverted;
	axis->enable_pin = settings->enable != settings->enable_inverted;

	clock_queue(axis, step_begins, wires);

	if (!done)
		axis->timer--;
	if (state == PASSO_AXIS_HIGH && done) {
		axis->step = false;
		axis->timer = settings->step_low;
		axis->state = PASSO_AXIS_LOW;
	} else if (state == PASSO_AXIS_LOW && done) {
		axis->timer = settings->dir_hold;
		axis->state = PASSO_AXIS_HOLD;
	} else if ((state == PASSO_AXIS_HOLD || state == PASSO_AXIS_SETUP) && done) {
		axis->state = PASSO_AXIS_READY;
	}
	if (turn) {
		axis->dir = !axis->dir;
		axis->timer = settings->dir_setup;
		axis->state = PASSO_AXIS_SETUP;
	}
	if (step_begins) {
		axis->timer = settings->both_edges && axis->step ? settings->step_low : settings->step_high;
		axis->state = settings->both_edges ? PASSO_AXIS_LOW : PASSO_AXIS_HIGH;
		axis->step = !axis->step;
	}
}

uint32_t passo_axis_quiet(const struct passo_axis *axis, bool line_direction)
{
	const struct passo_axis_settings *settings = &axis->settings;
	const bool pins_settled = axis->step_pin == (axis->step != settings->step_inverted)
	                       && axis->dir_pin == (axis->dir != settings->direction_inverted)
	                       && axis->enable_pin == (settings->enable != settings->enable_inverted)
	                       && !axis->step_begins_q && axis->dir_q == axis->dir && !axis->overrun;

	if (!pins_settled)
		return 0;
	if (axis->state == PASSO_AXIS_READY)
		return axis->waiting_count == 0u && dir_right(axis, line_direction) ? UINT32_MAX : 0u;
	if (axis->state == PASSO_AXIS_HOLD && axis->waiting_count != 0u && dir_right(axis, line_direction))
		return 0;
	/* the timer runs down to 1; what follows then happens in the clock that finds it there */
	return axis->timer <= 1u ? 0u : axis->timer - 1u;
}

void passo_axis_skip(struct passo_axis *axis, uint64_t clocks)
{
	/* in READY the timer runs down, unseen */
	const uint64_t left = axis->timer > clocks ? axis->timer - clocks : 1u;
	if (axis->timer > 1u)
		axis->timer = (uint16_t)left;
}
