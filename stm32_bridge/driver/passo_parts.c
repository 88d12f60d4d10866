/* SPDX-License-Identifier: MIT
 * Output word and clock source of every motion, on a core with outputs or encoders.
 */
#include "passo_driver.h"
#include "passo_math.h"

/* Relative rounding tolerance within which a power above full is full. */
#define POWER_MARGIN 128u

enum passo_error passo_driver_recall_outputs(struct passo *passo)
{
	uint32_t word = 0;

	if (!passo->has_outputs)
		return PASSO_OK;
	enum passo_error error =
	    passo_host_read(passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_OUTPUT_STATE), &word, 1);
	passo->output.levels = passo_unpack_channel_output_state(word).levels;
	return error;
}

size_t passo_driver_line_words(const struct passo *passo, uint32_t *words, const struct passo_line *line)
{
	struct passo_line sent = *line;

	for (unsigned i = 0; i < passo->machine.axes; i++) {
		const unsigned bit = 1u << i;
		if (line->steps[i] == 0u)
			sent.directions = (uint8_t)(passo->axis[i].backward ? sent.directions | bit
			                                                    : sent.directions & ~bit);
	}
	const size_t length = passo_line_words(words, &sent, passo->machine.axes);
	if (!passo->has_outputs)
		return length;
	words[length] = line->output;
	return length + 1u;
}

uint32_t passo_driver_word_of(const struct passo_output *output)
{
	return passo_pack_line_output(&(struct passo_line_output){.raster = output->raster,
	    .proportional = output->proportional,
	    .levels = output->levels,
	    .power = (uint16_t)output->power});
}

/* Substeps per step differ between moves: the power in the word compensates. */
static enum passo_error scale(
    const struct passo *passo, const struct passo_plan *plan, struct passo_output *output)
{
	const uint32_t peak = (uint32_t)(plan->velocity_peak >> 16);

	if (passo->reference == 0u)
		return PASSO_ERROR_REFERENCE;
	if (peak > passo->reference)
		return PASSO_ERROR_ABOVE_REFERENCE;
	if (output->speed == 0u || output->power == 0u)
		return PASSO_OK;
	const uint64_t wanted =
	    passo_mul_div_ceil(output->speed, plan->oversampling, passo->machine.clock_hz);
	if (wanted < peak)
		return PASSO_ERROR_ABOVE_REFERENCE;
	const uint64_t power = passo_mul_div(output->power, passo->reference, wanted);
	if (power > PASSO_POWER_FULL + PASSO_POWER_FULL / POWER_MARGIN)
		return PASSO_ERROR_ABOVE_REFERENCE;
	output->power = power < PASSO_POWER_FULL ? (uint32_t)power : PASSO_POWER_FULL;
	return PASSO_OK;
}

enum passo_error passo_driver_output(const struct passo *passo, const struct passo_plan *plan, uint32_t *word)
{
	struct passo_output output = passo->output;
	enum passo_error error = PASSO_OK;

	*word = 0;
	if (!passo->has_outputs)
		return PASSO_OK;
	if (passo->task.inside || plan->line.endless) {
		output.power = 0;
		output.raster = false;
	}
	if (output.proportional && (output.power != 0u || output.raster))
		error = scale(passo, plan, &output);
	*word = passo_driver_word_of(&output);
	return error;
}

enum passo_error passo_driver_check_output(const struct passo *passo, uint32_t word)
{
	const struct passo_line_output output = passo_unpack_line_output(word);

	if ((!passo->has_outputs && word != 0u) || (output.raster && !passo->has_raster))
		return PASSO_ERROR_NO_OUTPUTS;
	if ((word & ~PASSO_LINE_OUTPUT_DEFINED) != 0u || (output.raster && output.power != 0u))
		return PASSO_ERROR_SUPPLY;
	return PASSO_OK;
}

enum passo_error passo_driver_unfollow(struct passo *passo)
{
	const uint32_t word = passo_pack_channel_follow(&(struct passo_channel_follow){.follow = false});

	if (!passo->follows)
		return PASSO_OK;
	enum passo_error error = passo_driver_ready(passo, true);
	if (error == PASSO_OK)
		error = passo_driver_write(passo, PASSO_CHANNEL_FOLLOW, &word, 1);
	if (error == PASSO_OK)
		passo->follows = false;
	return passo_driver_moving(error);
}
