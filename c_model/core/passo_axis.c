/* SPDX-License-Identifier: MIT
 * Axis: STEP and DIR pins of one axis with the four pin timings. See rtl/passo_axis.v and
 * rtl/passo_axis_settings.v.
 */
#include "passo_model.h"

enum { PLACES = 4, LOST_MAX = 15 };

void passo_axis_reset(struct passo_axis *axis, bool step, bool dir, bool enable)
{
	*axis = (struct passo_axis){
	    .settings =
		{
		    .step_inverted = step,
		    .direction_inverted = dir,
		    .enable_inverted = enable,
		    .step_high = PASSO_AXIS_STEP_TIMING_STEP_HIGH_RESET,
		    .step_low = PASSO_AXIS_STEP_TIMING_STEP_LOW_RESET,
		    .dir_setup = PASSO_AXIS_DIR_TIMING_DIR_SETUP_RESET,
		    .dir_hold = PASSO_AXIS_DIR_TIMING_DIR_HOLD_RESET,
		},
	    .step_pin = step,
	    .dir_pin = dir,
	    .enable_pin = enable,
	};
	const struct passo_axis configured = *axis;
	passo_axis_restart(axis, &configured);
}

void passo_axis_restart(struct passo_axis *axis, const struct passo_axis *before)
{
	const struct passo_axis_settings *settings = &before->settings;

	*axis = (struct passo_axis){
	    .settings = *settings,
	    .state = PASSO_AXIS_PULSE,
	    .restarts = true,
	    .unsettled = true,
	    .step = before->step_pin != settings->step_inverted,
	    .dir = before->dir_pin != settings->direction_inverted,
	    .step_pin = before->step_pin,
	    .dir_pin = before->dir_pin,
	    .enable_pin = settings->enable != settings->enable_inverted,
	};
	axis->settings.enable = false;
	axis->settings.half_written = false;
}

void passo_axis_settings_write(struct passo_axis_settings *settings, uint8_t address, uint32_t data)
{
	const uint16_t high = (uint16_t)(data >> 16);
	const uint16_t low = (uint16_t)data;

	switch (address) {
	case PASSO_AXIS_PINS:
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
	case PASSO_AXIS_ENABLE:
		settings->enable = (data & 1u) != 0u;
		break;
	case PASSO_AXIS_INPUTS:
		settings->inputs = (uint8_t)(data & PASSO_AXIS_INPUTS_DEFINED);
		break;
	default:
		break;
	}
}

/* Duration of the present state in clocks; 0 counts as 1. */
static uint16_t time_of(const struct passo_axis *axis)
{
	const struct passo_axis_settings *settings = &axis->settings;
	uint16_t time;

	if (axis->state == PASSO_AXIS_PULSE)
		time = axis->step ? settings->step_high : settings->step_low;
	else
		time = axis->state == PASSO_AXIS_SETUP ? settings->dir_setup : settings->dir_hold;
	return time == 0u ? 1u : time;
}

static bool is_over(const struct passo_axis *axis)
{
	return axis->state != PASSO_AXIS_READY && axis->timer == time_of(axis);
}

static bool place_is(uint8_t places, unsigned place)
{
	return ((uint32_t)places >> place & 1u) != 0u;
}

static void clock_queue(struct passo_axis *axis, bool step_begins, const struct passo_axis_wires *wires)
{
	const uint8_t waits = axis->waits;
	const bool full = place_is(waits, PLACES - 1);
	const bool accepted = wires->step_request && !full;
	const uint8_t behind = (uint8_t)(axis->waiting >> 1 & waits >> 1);
	const uint8_t latest = wires->direction ? (uint8_t)(0xFu & ~(waits >> 1)) : 0u;
	const uint8_t moving = step_begins ? 0xFu : (uint8_t)(0xFu & ~waits);

	/* free entries hold the latest direction */
	axis->waiting = (uint8_t)((axis->waiting & ~moving) | ((behind | latest) & moving));
	if (step_begins && !accepted)
		axis->waits = waits >> 1;
	if (accepted && !step_begins)
		axis->waits = (uint8_t)(0xFu & (waits << 1 | 1u));
	axis->overrun = wires->step_request && full;
	if (axis->overrun && axis->lost != LOST_MAX)
		axis->lost++;
	if (wires->clear)
		axis->lost = 0;
	if (wires->drop)
		axis->waits = 0;
}

static void clock_pins(struct passo_axis *axis, bool step_begins)
{
	const struct passo_axis_settings *settings = &axis->settings;

	/* pins and position are registered one clock later */
	if (axis->step_made)
		axis->position += axis->dir ? 0xFFFFFFFFu : 1u;
	axis->step_made = step_begins;
	axis->step_pin = axis->step != settings->step_inverted;
	axis->dir_pin = axis->dir != settings->direction_inverted;
	axis->enable_pin = settings->enable != settings->enable_inverted;
}

void passo_axis_clock(struct passo_axis *axis, const struct passo_axis_wires *wires)
{
	const enum passo_axis_state state = axis->state;
	const bool over = axis->over;
	const bool right = place_is(axis->waiting, 0) == axis->dir;
	const bool settle = axis->settle;
	const bool level_done = state == PASSO_AXIS_PULSE && over;
	const bool falls = level_done && axis->step && !axis->settings.both_edges;
	const bool free = state == PASSO_AXIS_READY || state == PASSO_AXIS_HOLD || (level_done && !falls)
	               || (state == PASSO_AXIS_SETUP && over);
	const bool waits = place_is(axis->waits, 0);
	const bool closed = axis->dir ? axis->closed.low : axis->closed.high;
	const bool step_begins = free && waits && right && !axis->unsettled && !closed;
	const bool setup_begins =
	    (!right || axis->unsettled) && (state == PASSO_AXIS_READY || (state == PASSO_AXIS_HOLD && over));

	axis->quiet = state == PASSO_AXIS_READY && right && !axis->unsettled && !waits && !wires->step_request
	           && !wires->pins_written && !settle;
	clock_pins(axis, step_begins);
	if (wires->zero)
		axis->position = 0;
	clock_queue(axis, step_begins, wires);

	axis->closed = wires->closed;
	axis->timer = step_begins || setup_begins || level_done ? 1u : (uint16_t)(axis->timer + 1u);
	if (axis->restarts)
		axis->timer = 0;
	axis->restarts = wires->timing_written || wires->pins_written;
	axis->settle = wires->pins_written;
	axis->unsettled = settle || (axis->unsettled && !setup_begins);
	if (level_done && !falls)
		axis->state = PASSO_AXIS_HOLD;
	if ((state == PASSO_AXIS_HOLD || state == PASSO_AXIS_SETUP) && over)
		axis->state = PASSO_AXIS_READY;
	if (setup_begins)
		axis->state = PASSO_AXIS_SETUP;
	if (step_begins || settle)
		axis->state = PASSO_AXIS_PULSE;
	if (wires->pins_written && !wires->both_edges_next)
		axis->step = false;
	axis->step = axis->step != (step_begins || falls);
	axis->dir = axis->dir != (setup_begins && !right);
	axis->over = is_over(axis);
}

uint32_t passo_axis_quiet(const struct passo_axis *axis, bool line_direction)
{
	const struct passo_axis_settings *settings = &axis->settings;
	const uint8_t free_places = (uint8_t)(0xFu & ~axis->waits);
	const bool settled = axis->step_pin == (axis->step != settings->step_inverted)
	                  && axis->dir_pin == (axis->dir != settings->direction_inverted)
	                  && axis->enable_pin == (settings->enable != settings->enable_inverted)
	                  && !axis->step_made && !axis->overrun && !axis->restarts
	                  && (axis->waiting & free_places) == (line_direction ? free_places : 0u);
	const bool waits = place_is(axis->waits, 0);
	const bool right = place_is(axis->waiting, 0) == axis->dir && !axis->unsettled;
	const bool quiet = axis->state == PASSO_AXIS_READY && !waits && right;

	if (!settled || axis->quiet != quiet)
		return 0;
	if (axis->state == PASSO_AXIS_READY)
		return quiet ? UINT32_MAX : 0u;
	if (axis->state == PASSO_AXIS_HOLD && waits && right)
		return 0;
	/* the timer counts up to the time; the next event is in the clock that finds it there */
	const uint16_t time = time_of(axis);
	return axis->timer < time ? (uint32_t)time - axis->timer : 0u;
}

void passo_axis_skip(struct passo_axis *axis, uint64_t clocks)
{
	/* in READY the timer keeps counting without effect */
	axis->timer = (uint16_t)(axis->timer + clocks);
	axis->over = is_over(axis);
}
