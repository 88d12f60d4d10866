/* SPDX-License-Identifier: MIT
 * The outputs of a move: levels, power, raster.
 */
#ifndef PASSO_WITHOUT_PARTS

#include <string.h>

#include "passo_call.h"
#include "passo_math.h"

#define PERCENT_MAX 100u
#define ONE_Q32 (UINT64_C(1) << 32)

/* Bits of `given`. */
#define GIVEN(key) (UINT32_C(1) << (key))
enum move_key { MOVE_LEVELS, MOVE_POWER, MOVE_SPEED, MOVE_RASTER, MOVE_PITCH };

/* The keys of a move, as a move file has them in its table `output`. */
#define PREFIX "output."
static const struct passo_key MOVE_KEYS[] = {
    [MOVE_LEVELS] = PASSO_WHOLE(PREFIX "levels", levels, 0, UINT8_MAX, ""),
    [MOVE_POWER] = PASSO_VALUE(PREFIX "power", power, NUMBER, "0"),
    [MOVE_SPEED] = PASSO_VALUE(PREFIX "speed", speed, NUMBER, ""),
    [MOVE_RASTER] = PASSO_VALUE(PREFIX "raster", raster, RASTER, ""),
    [MOVE_PITCH] = PASSO_WHOLE(PREFIX "pitch", pitch, 1, PASSO_SUBSTEPS_MAX, "1"),
};

/* Moves the words of the outputs to words of their own. */
static void take_words(struct passo_words *words, struct passo_words *own)
{
	unsigned left = 0;

	own->count = 0;
	for (unsigned i = 0; i < words->count; i++) {
		if (strncmp(words->word[i].key, PREFIX, sizeof PREFIX - 1u) == 0)
			own->word[own->count++] = words->word[i];
		else
			words->word[left++] = words->word[i];
	}
	words->count = left;
}

static bool check_rules(const struct passo_reading *reading, const struct passo_values *values)
{
	const uint32_t given = reading->given;
	const bool has_power = (given & GIVEN(MOVE_POWER)) != 0u,
		   has_raster = (given & GIVEN(MOVE_RASTER)) != 0u;
	const bool has_speed = (given & GIVEN(MOVE_SPEED)) != 0u,
		   has_pitch = (given & GIVEN(MOVE_PITCH)) != 0u;

	if (has_power && has_raster)
		return passo_complain(
		    reading->sink, PREFIX "power and " PREFIX "raster are mutually exclusive");
	if (has_speed && !has_power)
		return passo_complain(reading->sink, PREFIX "speed needs " PREFIX "power");
	if (has_pitch && !has_raster)
		return passo_complain(reading->sink, PREFIX "pitch needs " PREFIX "raster");
	if (has_speed && values->speed == 0u)
		return passo_complain(reading->sink, PREFIX "speed must be greater than 0");
	if (values->power > PERCENT_MAX * ONE_Q32)
		return passo_complain(
		    reading->sink, PREFIX "power must be at most %u", (uint32_t)PERCENT_MAX);
	return true;
}

bool passo_output_read(const struct passo_call *call)
{
	struct passo_values *values = call->values;
	struct passo_words own;

	take_words(call->words, &own);
	values->output_given = own.count != 0u;
	values->levels = call->channel->levels;
	values->speed = 0;
	return !values->output_given
	    || (passo_keys_check(call->reading, MOVE_KEYS, PASSO_COUNT(MOVE_KEYS), 0, &own)
	        && passo_keys_read(call->reading, MOVE_KEYS, PASSO_COUNT(MOVE_KEYS), &own, values)
	        && check_rules(call->reading, values));
}

/* Whether the values of a raster are not more than the move takes; its pitch is in substeps then. An error of
 * the planner comes up when the move is queued. */
bool passo_output_fits(const struct passo_call *call, const struct passo_form_move *move)
{
	struct passo_values *values = call->values;
	const struct passo_raster_values *raster = &values->raster;
	struct passo_form_move scaled = *move;
	struct passo_plan plan = {.ramp_count = 0};

	for (unsigned i = 0; move->form == PASSO_FORM_STRAIGHT && i < PASSO_AXES_MAX; i++) {
		if (scaled.values.straight.limits[i].steps_per_mm == 0u) /* as the driver does */
			scaled.values.straight.limits[i].steps_per_mm = call->channel->axis[i].steps_per_unit;
	}
	if (raster->count == 0u || passo_forms_plan(&call->channel->passo, &scaled, &plan) != PASSO_PLAN_OK)
		return true;
	const uint64_t pitch = (uint64_t)values->pitch * plan.oversampling;
	const uint64_t most = (plan.line.substeps + pitch - 1u) / pitch;
	if (raster->count > most)
		return passo_complain(call->reading->sink, PREFIX "raster has %u values; the move takes %u",
		    (uint32_t)raster->count, (uint32_t)most);
	values->pitch = pitch > UINT32_MAX ? UINT32_MAX : (uint32_t)pitch;
	return true;
}

/* Queues a move that waits for its start, then its raster: neither begins without the other. At rest, as the
 * values of one move must not be those of another. */
static enum passo_error queue_raster(const struct passo_call *call, const struct passo_form_move *move)
{
	const struct passo_raster_values *raster = &call->values->raster;
	struct passo *passo = &call->channel->passo;
	const bool waits = passo_waits_for_sync(passo);
	int32_t ends[PASSO_AXES_MAX];
	size_t taken = 0;

	if (passo_is_moving(passo))
		return passo_target(passo, ends) == PASSO_ERROR_MOVING ? PASSO_ERROR_MOVING
		                                                       : PASSO_ERROR_FULL;
	enum passo_error error = passo_wait_for_sync(passo, true);
	if (error == PASSO_OK)
		error = passo_forms_queue(passo, move);
	if (error == PASSO_OK) {
		error = passo_set_pitch(passo, call->values->pitch);
		if (error == PASSO_OK)
			error = passo_push_raster(passo, raster->values, raster->count, &taken);
		if (error != PASSO_OK)
			passo_abort(passo);
	}
	const enum passo_error opened = waits ? PASSO_OK : passo_wait_for_sync(passo, false);
	return error != PASSO_OK ? error : opened;
}

enum passo_error passo_output_queue(const struct passo_call *call, const struct passo_form_move *move)
{
	const struct passo_values *values = call->values;
	struct passo *passo = &call->channel->passo;
	const struct passo_output output = {.levels = (uint8_t)values->levels,
	    .power = (uint32_t)passo_mul_div(values->power, PASSO_POWER_FULL, PERCENT_MAX * ONE_Q32),
	    .proportional = values->speed != 0u,
	    .speed = values->speed,
	    .raster = values->raster.count != 0u};

	if (!values->output_given)
		return passo_forms_queue(passo, move);
	enum passo_error error = passo_set_output(passo, &output);
	if (error != PASSO_OK)
		return error;
	error = output.raster ? queue_raster(call, move) : passo_forms_queue(passo, move);
	passo_set_output(passo, &(struct passo_output){.levels = call->channel->levels});
	return error;
}

void passo_output_help(const struct passo_sink *sink)
{
	passo_say(sink, "  move ..");
	passo_keys_help(sink, MOVE_KEYS, PASSO_COUNT(MOVE_KEYS));
	passo_say(sink, "\n");
}

#endif
