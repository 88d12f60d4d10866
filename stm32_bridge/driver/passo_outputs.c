/* SPDX-License-Identifier: MIT
 * Outputs: of the following moves, settings, raster values, compare points.
 */
#include "passo_driver.h"
#include "passo_math.h"

#define PWM_BITS 24u
#define PWM_STEP_MAX (UINT32_C(1) << (PWM_BITS - 1u))
#define REFERENCE_MAX (UINT32_C(1) << 31)
#define LAG_MAX ((UINT32_C(1) << PASSO_CHANNEL_OUTPUT_LAG_LAG_BITS) - 1u)
#define WIDTH_MAX ((UINT32_C(1) << PASSO_CHANNEL_COMPARE_PULSE_WIDTH_BITS) - 1u)
#define VALUES_PER_WORD 4u

/* What of the core a call needs. */
enum part { NEEDS_OUTPUTS, NEEDS_RASTER, NEEDS_COMPARE };
static enum passo_error check(const struct passo *passo, enum part part, const void *pointer)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	const bool has = part == NEEDS_OUTPUTS ? passo->has_outputs
	               : part == NEEDS_RASTER  ? passo->has_raster
	                                       : passo->has_compare;
	if (!has)
		return PASSO_ERROR_NO_OUTPUTS;
	return pointer ? PASSO_OK : PASSO_ERROR_ARGUMENT_POINTER;
}

static enum passo_error check_output(const struct passo *passo, const struct passo_output *output)
{
	enum passo_error error = check(passo, NEEDS_OUTPUTS, output);

	if (error == PASSO_OK
	    && (output->power > PASSO_POWER_FULL || (output->raster && output->power != 0u)))
		error = PASSO_ERROR_POWER;
	if (error == PASSO_OK && output->raster && !passo->has_raster)
		error = PASSO_ERROR_NO_OUTPUTS;
	return error;
}

enum passo_error passo_set_output(struct passo *passo, const struct passo_output *output)
{
	enum passo_error error = check_output(passo, output);

	if (error == PASSO_OK)
		passo->output = *output;
	return error;
}

enum passo_error passo_output_word(
    const struct passo *passo, const struct passo_output *output, uint32_t *word)
{
	enum passo_error error = check_output(passo, output);

	if (error == PASSO_OK && !word)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		*word = passo_driver_word_of(output);
	return error;
}

/* Writes registers that need rest. */
static enum passo_error write_at_rest(
    struct passo *passo, uint16_t address, const uint32_t *words, size_t length)
{
	enum passo_error error = passo_driver_require_rest(passo);

	if (error == PASSO_OK)
		error = passo_driver_write(passo, address, words, length);
	return passo_driver_moving(error);
}

enum passo_error passo_set_levels(struct passo *passo, uint8_t levels)
{
	const uint32_t word = levels;
	enum passo_error error = check(passo, NEEDS_OUTPUTS, passo);

	if (error == PASSO_OK)
		error = write_at_rest(passo, PASSO_CHANNEL_OUTPUT_LEVELS, &word, 1);
	if (error == PASSO_OK)
		passo->output.levels = levels;
	return error;
}

enum passo_error passo_configure_outputs(struct passo *passo, const struct passo_outputs_config *config)
{
	enum passo_error error = check(passo, NEEDS_OUTPUTS, config);

	if (error != PASSO_OK)
		return error;
	const uint32_t clock_hz = passo->machine.clock_hz;
	const uint64_t step = (((uint64_t)config->pwm_hz << PWM_BITS) + clock_hz / 2u) / clock_hz;
	const uint32_t reference = config->reference != 0u ? config->reference : REFERENCE_MAX;
	if (step == 0u || step > PWM_STEP_MAX)
		return PASSO_ERROR_PWM;
	if (reference > REFERENCE_MAX)
		return PASSO_ERROR_REFERENCE;
	if (config->lag > LAG_MAX)
		return PASSO_ERROR_LAG_TOO_LONG;
	const uint32_t words[] = {config->lag, (uint32_t)step, reference};
	error = write_at_rest(passo, PASSO_CHANNEL_OUTPUT_LAG, words, sizeof words / sizeof words[0]);
	if (error == PASSO_OK || passo_driver_is_link_error(error))
		passo->reference = error == PASSO_OK ? reference : 0u;
	return error;
}

enum passo_error passo_read_outputs(struct passo *passo, struct passo_outputs_state *state)
{
	uint32_t word;
	enum passo_error error = check(passo, NEEDS_OUTPUTS, state);

	if (error == PASSO_OK)
		error = passo_host_read(
		    passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_OUTPUT_STATE), &word, 1);
	if (error != PASSO_OK)
		return error;
	const struct passo_channel_output_state now = passo_unpack_channel_output_state(word);
	*state = (struct passo_outputs_state){.levels = now.levels,
	    .overflow = now.overflow,
	    .raster_empty = now.raster_empty,
	    .raster_room = (uint16_t)(now.raster_room * VALUES_PER_WORD)};
	return PASSO_OK;
}

enum passo_error passo_set_pitch(struct passo *passo, uint32_t substeps)
{
	enum passo_error error = check(passo, NEEDS_RASTER, passo);

	if (error == PASSO_OK && (substeps == 0u || substeps > PASSO_SUBSTEPS_MAX))
		error = PASSO_ERROR_PITCH;
	return error != PASSO_OK ? error
	                         : passo_driver_write(passo, PASSO_CHANNEL_RASTER_PITCH, &substeps, 1);
}

enum passo_error passo_push_raster(struct passo *passo, const uint8_t *values, size_t count, size_t *taken)
{
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX] = {0};
	struct passo_outputs_state state;
	enum passo_error error = check(passo, NEEDS_RASTER, taken);

	if (error == PASSO_OK && !values)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_read_outputs(passo, &state);
	if (error != PASSO_OK)
		return error;
	size_t most = sizeof words < state.raster_room ? sizeof words : state.raster_room;
	most = most < count ? most : count;
	*taken = 0;
	if (most == 0u)
		return PASSO_OK;
	for (size_t i = 0; i < most; i++)
		words[i / VALUES_PER_WORD] |= (uint32_t)values[i] << 8u * (i % VALUES_PER_WORD);
	error = passo_host_push(passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_RASTER), words,
	    (most + VALUES_PER_WORD - 1u) / VALUES_PER_WORD);
	if ((unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_BUSY)
		return PASSO_ERROR_STOPPED;
	if (error == PASSO_OK)
		*taken = most;
	return error;
}

enum passo_error passo_arm_compare(struct passo *passo, const struct passo_compare_config *config)
{
	int32_t now[PASSO_AXES_MAX];
	enum passo_error error = check(passo, NEEDS_COMPARE, config);

	if (error == PASSO_OK && config->axis >= passo->axes)
		error = PASSO_ERROR_ARGUMENT_AXIS;
	if (error == PASSO_OK && config->interval == 0)
		error = PASSO_ERROR_INTERVAL;
	if (error == PASSO_OK && (config->width == 0u || config->width > WIDTH_MAX))
		error = PASSO_ERROR_PULSE;
	if (error == PASSO_OK)
		error = passo_driver_require_rest(passo);
	if (error == PASSO_OK)
		error = passo_positions(passo, now);
	if (error != PASSO_OK)
		return error;
	const struct passo_channel_compare_pulse pulse = {
	    .axis = config->axis, .width = (uint16_t)config->width};
	const uint32_t words[] = {passo_pack_channel_compare_pulse(&pulse),
	    (uint32_t)config->position - (uint32_t)now[config->axis], (uint32_t)config->interval};
	error = passo_driver_write(passo, PASSO_CHANNEL_COMPARE_PULSE, words, sizeof words / sizeof words[0]);
	return passo_driver_moving(error);
}

enum passo_error passo_disarm_compare(struct passo *passo)
{
	const uint32_t word = 0;
	enum passo_error error = check(passo, NEEDS_COMPARE, passo);

	return error != PASSO_OK ? error : write_at_rest(passo, PASSO_CHANNEL_COMPARE_PULSE, &word, 1);
}
