/* SPDX-License-Identifier: MIT
 * Encoders: settings, readings, and adopting the measured position.
 */
#include "passo_driver.h"
#include "passo_math.h"

#define ERROR_BITS 8u
#define RATIO_BITS 16u
#define ERROR_OFF_SCALE (INT32_C(1) << 24)
#define FILTER_MAX ((UINT64_C(1) << PASSO_CHANNEL_ENCODER_FILTER_FILTER_BITS) - 1u)
#define MICROSECONDS_PER_SECOND UINT64_C(1000000)

enum passo_error passo_driver_check_encoders(const struct passo *passo)
{
	enum passo_error error = passo_driver_check(passo);

	return error == PASSO_OK && !passo->has_encoders ? PASSO_ERROR_NO_ENCODERS : error;
}

static enum passo_error check_axis(const struct passo *passo, uint8_t axis)
{
	enum passo_error error = passo_driver_check_encoders(passo);

	return error == PASSO_OK && axis >= passo->axes ? PASSO_ERROR_ARGUMENT_AXIS : error;
}

static uint16_t address_of(uint8_t axis, uint16_t reg)
{
	return (uint16_t)(PASSO_CHANNEL_ENCODER_BASE + axis * PASSO_CHANNEL_ENCODER_STRIDE + reg);
}

enum passo_error passo_configure_encoder(
    struct passo *passo, uint8_t axis, const struct passo_encoder_config *config)
{
	enum passo_error error = check_axis(passo, axis);

	if (error == PASSO_OK && !config)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK && (unsigned)config->stop > PASSO_FOLLOWING_HARD)
		error = PASSO_ERROR_ARGUMENT;
	if (error == PASSO_OK && config->ratio == 0u)
		error = PASSO_ERROR_RATIO;
	if (error == PASSO_OK && config->limit == 0u)
		error = PASSO_ERROR_FOLLOWING_LIMIT;
	if (error == PASSO_OK)
		error = passo_driver_require_rest(passo);
	if (error != PASSO_OK)
		return error;
	const struct passo_encoder_setup setup = {.inverted = config->inverted,
	    .index_inverted = config->index_inverted,
	    .index_gated = config->index_gated,
	    .stop_soft = config->stop == PASSO_FOLLOWING_SOFT,
	    .stop_hard = config->stop == PASSO_FOLLOWING_HARD};
	const uint32_t words[] = {passo_pack_encoder_setup(&setup), config->ratio, config->limit};
	error = passo_driver_write(
	    passo, address_of(axis, PASSO_ENCODER_SETUP), words, sizeof words / sizeof words[0]);
	passo->axis[axis].ratio = error == PASSO_OK ? config->ratio : 0u;
	return error;
}

enum passo_error passo_configure_encoder_filter(struct passo *passo, uint64_t clocks)
{
	const uint32_t word = (uint32_t)clocks;
	enum passo_error error = passo_driver_check_encoders(passo);

	if (error == PASSO_OK && clocks > FILTER_MAX)
		error = PASSO_ERROR_ENCODER_FILTER;
	return error != PASSO_OK ? error : passo_driver_write(passo, PASSO_CHANNEL_ENCODER_FILTER, &word, 1);
}

/* Q31.32 counts/s. */
static int64_t speed_of(int32_t counts, uint32_t microseconds)
{
	const uint64_t size = counts < 0 ? 0u - (uint64_t)(int64_t)counts : (uint64_t)counts;
	const uint64_t speed = passo_mul_div(size << 32, MICROSECONDS_PER_SECOND, microseconds);

	if (speed > INT64_MAX)
		return PASSO_NO_UNITS;
	return counts < 0 ? -(int64_t)speed : (int64_t)speed;
}

enum passo_error passo_read_encoder(struct passo *passo, uint8_t axis, struct passo_encoder_reading *reading)
{
	uint32_t words[PASSO_ENCODER_INDEX - PASSO_ENCODER_ERROR + 1u], counts;
	enum passo_error error = check_axis(passo, axis);

	if (error == PASSO_OK && !reading)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_host_read(passo->host,
		    (uint16_t)(passo->base + address_of(axis, PASSO_ENCODER_ERROR)), words,
		    sizeof words / sizeof words[0]);
	if (error == PASSO_OK)
		error = passo_host_read(passo->host,
		    (uint16_t)(passo->base + PASSO_CHANNEL_ENCODER_POSITION_BASE + axis), &counts, 1);
	if (error != PASSO_OK)
		return error;
	const struct passo_encoder_greatest greatest = passo_unpack_encoder_greatest(words[1]);
	const struct passo_encoder_index index = passo_unpack_encoder_index(words[2]);
	const struct passo_encoder_reading before = *reading;
	*reading = (struct passo_encoder_reading){.counts = (int32_t)counts,
	    .speed = PASSO_NO_UNITS,
	    .error = (int32_t)words[0],
	    .greatest = greatest.greatest,
	    .exceeded = greatest.exceeded,
	    .latch = index.latch,
	    .indexes = index.indexes,
	    .illegal = index.illegal,
	    .at = passo_driver_now(passo),
	    .valid = true};
	if (before.valid && reading->at != before.at)
		reading->speed =
		    speed_of((int32_t)(counts - (uint32_t)before.counts), reading->at - before.at);
	return PASSO_OK;
}

/* A following error, Q23.8 counts, in steps, to nearest; wraps. */
static uint32_t steps_of(int32_t counts, uint32_t ratio)
{
	const uint64_t size = counts < 0 ? 0u - (uint64_t)(int64_t)counts : (uint64_t)counts;
	const uint64_t steps = ((size << (RATIO_BITS - ERROR_BITS)) + ratio / 2u) / ratio;

	return counts < 0 ? 0u - (uint32_t)steps : (uint32_t)steps;
}

enum passo_error passo_adopt_encoder(struct passo *passo, uint8_t axis)
{
	uint32_t word;
	enum passo_error error = check_axis(passo, axis);

	if (error == PASSO_OK && passo->axis[axis].ratio == 0u)
		error = PASSO_ERROR_RATIO;
	if (error == PASSO_OK)
		error = passo_driver_require_rest(passo);
	if (error == PASSO_OK)
		error = passo_host_read(
		    passo->host, (uint16_t)(passo->base + address_of(axis, PASSO_ENCODER_ERROR)), &word, 1);
	if (error != PASSO_OK)
		return error;
	const int32_t behind = (int32_t)word;
	const uint32_t ratio = passo->axis[axis].ratio;
	if (behind >= ERROR_OFF_SCALE || behind <= -ERROR_OFF_SCALE)
		return PASSO_ERROR_OFF_SCALE;
	error = passo_driver_write(passo, address_of(axis, PASSO_ENCODER_RATIO), &ratio, 1);
	if (error == PASSO_OK)
		passo->axis[axis].offset -= steps_of(behind, ratio);
	else
		passo->axis[axis].ratio = 0; /* the error may already be 0: do not adopt twice */
	return error;
}
