/* SPDX-License-Identifier: MIT
 * Commands of the outputs: settings, state, compare pulses.
 */
#ifndef PASSO_WITHOUT_PARTS

#include "passo_call.h"
#include "passo_commands.h"

#define PWM_HZ 20000u
#define REFERENCE_MAX (UINT32_C(1) << 31) /* 1/2 substep per clock: any single move */

/* Bits of `given`. */
#define GIVEN(key) (UINT32_C(1) << (key))
enum output_key { OUTPUT_LEVELS, OUTPUT_PWM, OUTPUT_LAG, OUTPUT_REFERENCE, OUTPUT_CHANNEL };
enum compare_key {
	COMPARE_ON,
	COMPARE_CHANNEL,
	COMPARE_AXIS,
	COMPARE_POSITION,
	COMPARE_INTERVAL,
	COMPARE_WIDTH
};
static const char *const COMPARE_NAMES[] = {
    [COMPARE_POSITION] = "position", [COMPARE_INTERVAL] = "interval", [COMPARE_WIDTH] = "width"};

static uint32_t saturate(uint64_t value)
{
	return value > UINT32_MAX ? UINT32_MAX : (uint32_t)value;
}

void passo_commands_reset_outputs(struct passo_console_channel *channel, uint32_t clock_hz)
{
	const uint32_t fastest = clock_hz / 2u;

	channel->outputs = (struct passo_outputs_config){
	    .pwm_hz = fastest < PWM_HZ ? fastest : PWM_HZ, .reference = REFERENCE_MAX};
}

enum passo_error passo_commands_set_outputs(struct passo_console_channel *channel)
{
	struct passo_outputs_state state;
	enum passo_error error = passo_configure_outputs(&channel->passo, &channel->outputs);

	if (error == PASSO_ERROR_NO_OUTPUTS)
		return PASSO_OK;
	if (error == PASSO_OK)
		error = passo_read_outputs(&channel->passo, &state);
	if (error == PASSO_OK)
		channel->levels = state.levels;
	return error;
}

/* The settings with what is given. */
static struct passo_outputs_config config_of(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	const uint32_t given = call->reading->given;
	struct passo_outputs_config config = call->channel->outputs;

	if ((given & GIVEN(OUTPUT_PWM)) != 0u)
		config.pwm_hz = saturate((values->pwm + (UINT64_C(1) << 31)) >> 32);
	if ((given & GIVEN(OUTPUT_LAG)) != 0u)
		config.lag = saturate(values->lag);
	if ((given & GIVEN(OUTPUT_REFERENCE)) != 0u)
		config.reference = saturate(values->reference);
	return config;
}

bool passo_run_output(const struct passo_call *call)
{
	struct passo_console_channel *channel = call->channel;
	const uint32_t given = call->reading->given;
	const struct passo_outputs_config config = config_of(call);
	enum passo_error error = PASSO_OK;

	if ((given & (GIVEN(OUTPUT_CHANNEL) - 1u)) == 0u) {
		passo_say(&call->console->sink, "ok levels=%u pwm=%u lag=%uclocks reference=%m",
		    (uint32_t)channel->levels, channel->outputs.pwm_hz, channel->outputs.lag,
		    ((int64_t)channel->outputs.reference * 1000 + (INT64_C(1) << 31)) >> 32);
		return true;
	}
	if (config.reference == 0u)
		return passo_answer(call, PASSO_ERROR_REFERENCE);
	if ((given & ~(GIVEN(OUTPUT_LEVELS) | GIVEN(OUTPUT_CHANNEL))) != 0u)
		error = passo_configure_outputs(&channel->passo, &config);
	if (error == PASSO_OK)
		channel->outputs = config;
	if (error == PASSO_OK && (given & GIVEN(OUTPUT_LEVELS)) != 0u) {
		error = passo_set_levels(&channel->passo, (uint8_t)call->values->levels);
		if (error == PASSO_OK)
			channel->levels = (uint8_t)call->values->levels;
	}
	return passo_answer(call, error);
}

bool passo_run_outputs(const struct passo_call *call)
{
	struct passo_outputs_state state;

	if (!passo_answer(call, passo_read_outputs(&call->channel->passo, &state)))
		return false;
	passo_say(&call->console->sink, " levels=%u overflow=%u raster_empty=%u raster_room=%u",
	    (uint32_t)state.levels, (uint32_t)state.overflow, (uint32_t)state.raster_empty,
	    (uint32_t)state.raster_room);
	return true;
}

bool passo_run_compare(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo *passo = &call->channel->passo;
	const struct passo_compare_config config = {.axis = values->axis,
	    .position = values->position,
	    .interval = values->interval,
	    .width = saturate(values->width)};
	const uint32_t given = call->reading->given;

	for (unsigned key = COMPARE_POSITION; values->on && key <= COMPARE_WIDTH; key++) {
		if ((given & GIVEN(key)) == 0u)
			return passo_complain(call->reading->sink, "%s is missing", COMPARE_NAMES[key]);
	}
	if (!values->on && (given & ~(GIVEN(COMPARE_ON) | GIVEN(COMPARE_CHANNEL))) != 0u)
		return passo_complain(call->reading->sink, "compare 0 disarms; it takes no other keys");
	return passo_answer(
	    call, values->on ? passo_arm_compare(passo, &config) : passo_disarm_compare(passo));
}

#endif
