/* SPDX-License-Identifier: MIT
 * Inputs: settings, levels and flags, e-stop, watchdog.
 */
#include "passo_driver.h"

#define FILTER_MAX ((UINT64_C(1) << PASSO_INPUT_FILTER_FILTER_BITS) - 1u)
#define WATCHDOG_UNIT_LOG2 16u
#define ALL_FLAGS UINT32_MAX

enum passo_error passo_driver_check_inputs(const struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	return error == PASSO_OK && !passo->has_inputs ? PASSO_ERROR_NO_INPUTS : error;
}

bool passo_has_inputs(const struct passo *passo)
{
	return passo->has_inputs;
}

enum passo_error passo_configure_inputs(
    struct passo *passo, uint8_t axis, const struct passo_input_config *config)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK && (!config || axis >= passo->axes))
		error = PASSO_ERROR_ARGUMENT;
	if (error == PASSO_OK)
		error = passo_driver_require_rest(passo);
	if (error != PASSO_OK)
		return error;
	const struct passo_axis_inputs inputs = {.alarm_disables = config->alarm_disables,
	    .alarm_soft = config->alarm_soft,
	    .limit_soft = config->limit_soft,
	    .alarm_inverted = config->alarm_inverted,
	    .home_inverted = config->home_inverted,
	    .limit_high_inverted = config->limit_high_inverted,
	    .limit_low_inverted = config->limit_low_inverted};
	const uint32_t word = passo_pack_axis_inputs(&inputs);
	struct passo_axis_memory *memory = &passo->axis[axis];
	memory->switches = 0;
	memory->limit_soft = false;
	error = passo_driver_write(passo,
	    (uint16_t)(PASSO_CHANNEL_AXIS_BASE + axis * PASSO_CHANNEL_AXIS_STRIDE + PASSO_AXIS_INPUTS), &word,
	    1);
	if (error != PASSO_OK)
		return passo_driver_moving(error);
	memory->limit_soft = config->limit_soft;
	memory->switches = (uint8_t)((unsigned)config->limit_low << PASSO_TRIGGER_SOURCE_LIMIT_LOW
	                             | (unsigned)config->limit_high << PASSO_TRIGGER_SOURCE_LIMIT_HIGH
	                             | (unsigned)config->home << PASSO_TRIGGER_SOURCE_HOME);
	return PASSO_OK;
}

static enum passo_error write_probe(struct passo *passo, bool clear)
{
	const uint32_t word = passo_pack_channel_probe(
	    &(struct passo_channel_probe){.clear = clear, .inverted = passo->probe_inverted});

	return passo_driver_write(passo, PASSO_CHANNEL_PROBE, &word, 1);
}

enum passo_error passo_configure_probe(struct passo *passo, bool inverted)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK)
		error = passo_driver_require_rest(passo);
	if (error != PASSO_OK)
		return error;
	passo->probe_inverted = inverted;
	error = write_probe(passo, false);
	passo->probe_fitted = error == PASSO_OK;
	return passo_driver_moving(error);
}

enum passo_error passo_configure_filter(struct passo *passo, uint64_t clocks)
{
	const uint32_t word = (uint32_t)clocks;
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK && clocks > FILTER_MAX)
		error = PASSO_ERROR_FILTER_TOO_LONG;
	return error != PASSO_OK ? error
	                         : passo_host_write(passo->host, PASSO_ADDRESS_INPUT_FILTER, &word, 1);
}

/* Times of the watchdog, rounded up. */
static uint16_t units_of(uint64_t clocks)
{
	return (uint16_t)((clocks + (1u << WATCHDOG_UNIT_LOG2) - 1u) >> WATCHDOG_UNIT_LOG2);
}

enum passo_error passo_driver_watchdog(struct passo *passo, uint64_t stop_clocks, uint64_t disable_clocks)
{
	if (stop_clocks > PASSO_WATCHDOG_CLOCKS_MAX || disable_clocks > PASSO_WATCHDOG_CLOCKS_MAX)
		return PASSO_ERROR_WATCHDOG_TOO_LONG;
	if (stop_clocks == 0u && disable_clocks != 0u)
		return PASSO_ERROR_ARGUMENT;
	const uint32_t word = passo_pack_watchdog(&(struct passo_watchdog){
	    .stop_after = units_of(stop_clocks), .disable_after = units_of(disable_clocks)});
	return passo_host_write(passo->host, PASSO_ADDRESS_WATCHDOG, &word, 1);
}

enum passo_error passo_configure_watchdog(struct passo *passo, uint64_t stop_clocks, uint64_t disable_clocks)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	return error != PASSO_OK ? error : passo_driver_watchdog(passo, stop_clocks, disable_clocks);
}

static enum passo_error read_channel(struct passo *passo, uint16_t address, uint32_t *words, size_t length)
{
	return passo_host_read(passo->host, (uint16_t)(passo->base + address), words, length);
}

enum passo_error passo_read_inputs(struct passo *passo, struct passo_readings *readings)
{
	uint32_t words[2], trigger, estop;
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK && !readings)
		error = PASSO_ERROR_ARGUMENT;
	if (error == PASSO_OK)
		error = read_channel(passo, PASSO_CHANNEL_INPUT_LEVELS, words, 2);
	if (error == PASSO_OK)
		error = read_channel(passo, PASSO_CHANNEL_TRIGGER_STATE, &trigger, 1);
	if (error == PASSO_OK)
		error = passo_host_read(passo->host, PASSO_ADDRESS_ESTOP, &estop, 1);
	if (error != PASSO_OK)
		return error;
	const struct passo_channel_input_levels now = passo_unpack_channel_input_levels(words[0]);
	const struct passo_channel_input_flags was = passo_unpack_channel_input_flags(words[1]);
	const struct passo_channel_trigger_state state = passo_unpack_channel_trigger_state(trigger);
	*readings = (struct passo_readings){.limit_low = now.limit_low,
	    .limit_high = now.limit_high,
	    .home = now.home,
	    .alarm = now.alarm,
	    .was_limit_low = was.limit_low,
	    .was_limit_high = was.limit_high,
	    .was_home = was.home,
	    .was_alarm = was.alarm,
	    .probe = state.probe,
	    .was_probe = state.probe_flag,
	    .estop = estop != 0u,
	    .axes = state.axes,
	    .unknown = state.unknown};
	return PASSO_OK;
}

enum passo_error passo_clear_flags(struct passo *passo)
{
	const uint32_t word = ALL_FLAGS;
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK)
		error = passo_driver_write(passo, PASSO_CHANNEL_INPUT_CLEAR, &word, 1);
	/* else its polarity is unknown, and stays */
	return error == PASSO_OK && passo->probe_fitted ? write_probe(passo, true) : error;
}

enum passo_error passo_clear_estop(struct passo *passo)
{
	uint32_t word = 1u << PASSO_ESTOP_CLEAR_CLEAR_LSB;
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK)
		passo_driver_forget_all(passo); /* regardless of the stop cause */
	if (error == PASSO_OK)
		error = passo_host_write(passo->host, PASSO_ADDRESS_ESTOP_CLEAR, &word, 1);
	if (error == PASSO_OK)
		error = passo_host_read(passo->host, PASSO_ADDRESS_ESTOP, &word, 1);
	return error == PASSO_OK && word != 0u ? PASSO_ERROR_ESTOP : error;
}
