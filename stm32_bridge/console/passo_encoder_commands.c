/* SPDX-License-Identifier: MIT
 * Commands of the encoders: settings, readings, the position that they measure, threads.
 */
#ifndef PASSO_WITHOUT_PARTS

#include <string.h>

#include "passo_call.h"
#include "passo_command_table.h"
#include "passo_commands.h"
#include "passo_math.h"
#include "passo_value.h"

#define LIMIT_MAX UINT16_MAX
#define SECONDS_PER_MINUTE 60u

/* The keys of `encoder` before those of an axis. */
enum encoder_key { ENCODER_AXIS, ENCODER_CHANNEL, ENCODER_FILTER, ENCODER_OF_AXIS };

/* UQ32.32 in 1/2^16, to nearest. */
static uint64_t ratio_of(uint64_t counts_per_step)
{
	return (counts_per_step >> 16) + (counts_per_step >> 15 & 1u);
}

/* a * b / 2^(bits + 1), to nearest. */
static uint64_t product(uint64_t a, uint64_t b, unsigned bits)
{
	const uint64_t twice = passo_mul_div(a, b, UINT64_C(1) << bits);

	return (twice >> 1) + (twice & 1u);
}

/* ------------------------------------------------------------------------------------------ settings ---- */

/* Counts of the following error at its limit. */
static uint64_t limit_of(const struct passo_console_encoder *encoder)
{
	if (encoder->limit == PASSO_NO_FOLLOWING_LIMIT)
		return LIMIT_MAX;
	return product(encoder->limit, ratio_of(encoder->counts_per_step), 47);
}

static enum passo_error set_encoder(
    struct passo *passo, uint8_t axis, const struct passo_console_encoder *encoder)
{
	const bool limited = encoder->limit != PASSO_NO_FOLLOWING_LIMIT;
	const struct passo_encoder_config config = {.inverted = encoder->inverted,
	    .index_inverted = encoder->index_inverted,
	    .index_gated = encoder->index_gated,
	    .ratio = (uint32_t)ratio_of(encoder->counts_per_step),
	    .limit = (uint16_t)limit_of(encoder),
	    .stop = limited ? (enum passo_following_stop)encoder->stop : PASSO_FOLLOWING_SHOW};

	return passo_configure_encoder(passo, axis, &config);
}

void passo_commands_reset_encoders(struct passo_console_channel *channel)
{
	channel->encoder_filter = PASSO_CHANNEL_ENCODER_FILTER_FILTER_RESET;
	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++)
		channel->encoder[axis] = (struct passo_console_encoder){
		    .limit = PASSO_NO_FOLLOWING_LIMIT, .stop = PASSO_FOLLOWING_SOFT};
}

enum passo_error passo_commands_set_encoders(struct passo_console_channel *channel)
{
	struct passo *passo = &channel->passo;
	enum passo_error error = passo_configure_encoder_filter(passo, channel->encoder_filter);

	if (error == PASSO_ERROR_NO_ENCODERS)
		return PASSO_OK;
	for (uint8_t axis = 0; axis < passo_axes(passo) && error == PASSO_OK; axis++) {
		channel->encoder_readings[axis].valid = false;
		if (((uint32_t)channel->encoders_given >> axis & 1u) != 0u)
			error = set_encoder(passo, axis, &channel->encoder[axis]);
	}
	return error;
}

/* Whether the settings of an axis fit into their registers; 0 is refused by the driver. */
static bool check_encoder(const struct passo_call *call)
{
	const struct passo_console_encoder *encoder = &call->values->encoder;
	const struct passo_sink *sink = call->reading->sink;

	if (ratio_of(encoder->counts_per_step) > UINT32_MAX)
		return passo_complain(sink, "counts_per_step must be below 65536");
	if (passo_words_find(call->words, "stop") != NULL && encoder->limit == PASSO_NO_FOLLOWING_LIMIT)
		return passo_complain(sink, "stop needs limit");
	if (limit_of(encoder) > LIMIT_MAX)
		return passo_complain(sink, "limit must be at most %u counts", (uint32_t)LIMIT_MAX);
	return true;
}

static void show(const struct passo_call *call, uint8_t axis)
{
	const struct passo_console_encoder *encoder = &call->channel->encoder[axis];
	const struct passo_sink *sink = &call->console->sink;

	passo_say(sink, "ok axis=%u counts_per_step=%m", (uint32_t)axis,
	    passo_thousandths((int64_t)encoder->counts_per_step));
	if (encoder->limit != PASSO_NO_FOLLOWING_LIMIT) {
		passo_say(sink, " limit=%m stop=", passo_thousandths((int64_t)encoder->limit));
		passo_value_say(sink, PASSO_READ_STOP, encoder->stop);
	}
	passo_say(sink, " inverted=%u index_inverted=%u index_gated=%u", (uint32_t)encoder->inverted,
	    (uint32_t)encoder->index_inverted, (uint32_t)encoder->index_gated);
}

static bool configure_filter(const struct passo_call *call)
{
	const uint32_t filter = call->values->filter;

	if (!passo_answer(call, passo_configure_encoder_filter(&call->channel->passo, filter)))
		return false;
	call->channel->encoder_filter = filter;
	return true;
}

/* Changes only the settings that are given: reads them once more, over the present ones. */
bool passo_run_encoder(const struct passo_call *call)
{
	const struct passo_command *command = passo_command_find("encoder");
	struct passo_console_channel *channel = call->channel;
	const struct passo_reading *reading = call->reading;
	const uint8_t axis = call->values->axis;
	const bool has_axis = (reading->given >> ENCODER_AXIS & 1u) != 0u;
	const bool has_filter = (reading->given >> ENCODER_FILTER & 1u) != 0u;
	const bool has_others = reading->given >> ENCODER_OF_AXIS != 0u;

	if (has_axis && has_filter)
		return passo_complain(reading->sink, "axis and filter are mutually exclusive");
	if (has_others && !has_axis)
		return passo_complain(reading->sink, "axis is missing");
	if (has_filter)
		return configure_filter(call);
	if (!has_others) {
		if (has_axis)
			show(call, axis);
		else
			passo_say(reading->sink, "ok filter=%u", channel->encoder_filter);
		return true;
	}
	call->values->encoder = channel->encoder[axis];
	if (!passo_keys_read(call->reading, command->keys, command->count, call->words, call->values)
	    || !check_encoder(call)
	    || !passo_answer(call, set_encoder(&channel->passo, axis, &call->values->encoder)))
		return false;
	channel->encoder[axis] = call->values->encoder;
	channel->encoders_given |= (uint8_t)(1u << axis);
	return true;
}

/* ------------------------------------------------------------------------------------------ readings ---- */

/* Thousandths of a value of a reading. */
static int64_t value_of(const struct passo_encoder_reading *reading, unsigned which)
{
	switch (which) {
	case 0:
		return reading->counts;
	case 1:
		return passo_thousandths(reading->speed);
	case 2:
		return (int64_t)reading->error * 1000 / 256;
	case 3:
		return reading->greatest;
	case 4:
		return reading->latch;
	case 5:
		return reading->indexes;
	default:
		return reading->illegal;
	}
}

static void say_readings(const struct passo_call *call)
{
	static const char *const NAMES[] = {
	    "counts", "speed", "error", "greatest", "latch", "indexes", "illegal"};
	const struct passo_encoder_reading *readings = call->channel->encoder_readings;
	const struct passo_sink *sink = &call->console->sink;
	uint8_t exceeded = 0;

	for (unsigned which = 0; which < PASSO_COUNT(NAMES); which++) {
		const bool fraction = which == 1u || which == 2u;

		if (which == 1u && readings[0].speed == PASSO_NO_UNITS)
			continue;
		passo_say(sink, " %s=", NAMES[which]);
		for (unsigned axis = 0; axis < call->reading->axes; axis++) {
			const int64_t value = value_of(&readings[axis], which);

			passo_say(sink, axis == 0u ? "" : ",");
			if (fraction)
				passo_say(sink, "%m", value);
			else
				passo_say(sink, "%d", (int32_t)value);
		}
	}
	for (unsigned axis = 0; axis < call->reading->axes; axis++)
		exceeded |= (uint8_t)((unsigned)readings[axis].exceeded << axis);
	passo_say_axes(sink, " exceeded=", exceeded);
}

bool passo_run_encoders(const struct passo_call *call)
{
	struct passo_console_channel *channel = call->channel;
	struct passo_thread_state thread;
	enum passo_error error = passo_read_thread(&channel->passo, &thread);

	for (uint8_t axis = 0; axis < call->reading->axes && error == PASSO_OK; axis++)
		error = passo_read_encoder(&channel->passo, axis, &channel->encoder_readings[axis]);
	if (!passo_answer(call, error))
		return false;
	say_readings(call);
	passo_say(&call->console->sink, " owed=%d behind=%u lost=%u", thread.owed, (uint32_t)thread.behind,
	    (uint32_t)thread.lost);
	return true;
}

bool passo_run_adopt(const struct passo_call *call)
{
	return passo_answer(call, passo_adopt_encoder(&call->channel->passo, call->values->axis));
}

/* ------------------------------------------------------------------------------------------- threads ---- */

bool passo_run_thread(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	const uint64_t counts = product(values->turns, values->counts_per_turn, 31);
	struct passo_thread thread = {.encoder = values->axis,
	    .wait_index = values->wait_index,
	    .endless = values->endless,
	    .counts = (uint32_t)counts,
	    .top_speed = passo_mul_div(values->top_rpm, values->counts_per_turn, SECONDS_PER_MINUTE)};
	uint8_t axes = 0, off;

	if (counts > UINT32_MAX)
		return passo_complain(call->reading->sink, "turns must be at most %u counts", UINT32_MAX);
	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++) {
		thread.steps[axis] = values->steps[axis];
		axes |= (uint8_t)((thread.steps[axis] != 0 ? 1u : 0u) << axis);
	}
	if (!passo_check_enabled(call, axes, &off))
		return false;
	enum passo_error error = passo_thread(&call->channel->passo, &thread);
	if (error == PASSO_OK)
		passo_note_disabled(call, off);
	return passo_answer(call, error);
}

#endif
