/* SPDX-License-Identifier: MIT
 * Settings of a channel: pins, units, slews.
 */
#include "passo_driver.h"
#include "passo_math.h"

#define NANOSECONDS UINT64_C(1000000000)

/* A pin time in clocks, rounded up; above PASSO_PIN_CLOCKS_MAX if it is too long. */
static uint64_t clocks_of(const struct passo *passo, const struct passo_axis_config *config, uint32_t time)
{
	uint64_t clocks = time;

	if (!config->in_clocks)
		clocks = ((uint64_t)time * passo->machine.clock_hz + NANOSECONDS - 1u) / NANOSECONDS;
	return clocks != 0u ? clocks : 1u;
}

static uint16_t address_of(uint8_t axis, uint16_t reg)
{
	return (uint16_t)(PASSO_CHANNEL_AXIS_BASE + axis * PASSO_CHANNEL_AXIS_STRIDE + reg);
}

enum passo_error passo_configure_axis(
    struct passo *passo, uint8_t axis, const struct passo_axis_config *config)
{
	enum passo_error error = passo_driver_check_axis(passo, axis);

	if (error != PASSO_OK)
		return error;
	if (!config)
		return PASSO_ERROR_ARGUMENT_POINTER;
	const uint64_t high = clocks_of(passo, config, config->step_high_ns);
	const uint64_t low = clocks_of(passo, config, config->step_low_ns);
	const uint64_t setup = clocks_of(passo, config, config->dir_setup_ns);
	const uint64_t hold = clocks_of(passo, config, config->dir_hold_ns);
	if (high > PASSO_PIN_CLOCKS_MAX || low > PASSO_PIN_CLOCKS_MAX || setup > PASSO_PIN_CLOCKS_MAX
	    || hold > PASSO_PIN_CLOCKS_MAX)
		return PASSO_ERROR_ARGUMENT_PIN_TIME;
	error = passo_driver_ready(passo, true);
	if (error != PASSO_OK)
		return error;

	struct passo_axis_memory *memory = &passo->axis[axis];
	const struct passo_axis_pins pins = {.step_inverted = config->step_inverted,
	    .direction_inverted = config->direction_inverted,
	    .enable_inverted = config->enable_inverted,
	    .both_edges = config->both_edges};
	const struct passo_axis_step_timing step = {.step_high = (uint16_t)high, .step_low = (uint16_t)low};
	const struct passo_axis_dir_timing dir = {.dir_setup = (uint16_t)setup, .dir_hold = (uint16_t)hold};
	const uint32_t words[] = {passo_pack_axis_pins(&pins), passo_pack_axis_step_timing(&step),
	    passo_pack_axis_dir_timing(&dir)};
	error = passo_driver_write(
	    passo, address_of(axis, PASSO_AXIS_PINS), words, sizeof words / sizeof words[0]);
	if (passo_driver_is_link_error(error))
		memory->shortest_clocks = 0;
	if (error != PASSO_OK)
		return passo_driver_moving(error);
	memory->steps_per_unit = config->steps_per_unit;
	memory->shortest_clocks = (uint32_t)(config->both_edges ? (high > low ? high : low) : high + low);
	return PASSO_OK;
}

uint64_t passo_highest_speed(const struct passo *passo, uint8_t axis, uint64_t steps_per_unit)
{
	const uint32_t clocks = axis < passo->axes ? passo->axis[axis].shortest_clocks : 0u;

	if (clocks == 0u)
		return 0;
	const uint64_t steps = passo_mul_div_ceil(passo->machine.clock_hz, UINT64_C(1) << 32, clocks);
	return passo_mul_div_ceil(steps, UINT64_C(1) << 32, steps_per_unit);
}

bool passo_driver_pins_known(const struct passo *passo, const struct passo_line *line)
{
	for (unsigned i = 0; i < passo->machine.axes; i++) {
		if (line->steps[i] != 0u && passo->axis[i].shortest_clocks == 0u)
			return false;
	}
	return true;
}

enum passo_error passo_enable(struct passo *passo, uint8_t axis, bool on)
{
	enum passo_error error = passo_driver_check_axis(passo, axis);

	if (error != PASSO_OK)
		return error;
	const uint32_t enable = (uint32_t)on << PASSO_AXIS_ENABLE_LSB;
	if (!on)
		error = passo_driver_require_rest(passo);
	if (error != PASSO_OK)
		return error;
	if (!on)
		passo->axis[axis].homed = false;
	return passo_driver_write(passo, address_of(axis, PASSO_AXIS_ENABLE), &enable, 1);
}

/* Change of rate per tick for a change by the full rate in this time. */
static uint32_t slew_of(const struct passo *passo, uint64_t clocks)
{
	const uint64_t full = (uint64_t)PASSO_RATE_FULL << passo->machine.tick_log2;
	uint64_t slew = clocks != 0u ? full / clocks : PASSO_RATE_FULL;

	if (slew == 0u)
		slew = 1;
	return slew < PASSO_RATE_FULL ? (uint32_t)slew : PASSO_RATE_FULL;
}

enum passo_error passo_configure_motion(
    struct passo *passo, uint64_t hold_clocks, uint64_t stop_clocks, uint32_t drain_velocity)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (drain_velocity > PASSO_VELOCITY_MAX >> 16)
		return PASSO_ERROR_ARGUMENT_DRAIN_VELOCITY;
	const uint32_t words[] = {slew_of(passo, hold_clocks), slew_of(passo, stop_clocks), drain_velocity};
	error = passo_driver_write(passo, PASSO_CHANNEL_RATE_SLEW, words, drain_velocity != 0u ? 3u : 2u);
	passo->stop_time_known |= error == PASSO_OK;
	return error;
}
