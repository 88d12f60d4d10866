/* SPDX-License-Identifier: MIT
 * The trigger: arming, waiting, reading the latched positions.
 */
#include "passo_driver.h"

/* Of more than 1024 clocks each; the longest filter takes 2^17. */
#define ARMING_LOOKS 1024u

static enum passo_error write_trigger(struct passo *passo, struct passo_channel_trigger trigger)
{
	const uint32_t word = passo_pack_channel_trigger(&trigger);

	return passo_driver_write(passo, PASSO_CHANNEL_TRIGGER, &word, 1);
}

enum passo_error passo_driver_check_source(
    const struct passo *passo, enum passo_trigger_source source, uint8_t axis)
{
	if (source == PASSO_TRIGGER_SOURCE_NONE)
		return PASSO_ERROR_NO_SOURCE;
	if ((unsigned)source > PASSO_TRIGGER_SOURCE_INDEX || axis >= passo->axes)
		return PASSO_ERROR_ARGUMENT;
	if (source == PASSO_TRIGGER_SOURCE_INDEX)
		return PASSO_OK;
	const bool is_fitted = source == PASSO_TRIGGER_SOURCE_PROBE
	                         ? passo->probe_fitted
	                         : (passo->axis[axis].switches >> source & 1u) != 0u;
	return is_fitted ? PASSO_OK : PASSO_ERROR_NO_SWITCH;
}

enum passo_error passo_driver_arm(struct passo *passo, const struct passo_trigger_config *config)
{
	enum passo_error error = passo_driver_check_source(passo, config->source, config->axis);

	if (error == PASSO_OK && (unsigned)config->action > PASSO_TRIGGER_ACTION_END_ENDLESS)
		error = PASSO_ERROR_ARGUMENT;
	if (error != PASSO_OK)
		return error;
	const bool hard = config->action == PASSO_TRIGGER_ACTION_HARD_STOP;
	passo->hard_trigger |= hard; /* until it is armed, the one before may be */
	error = write_trigger(passo, (struct passo_channel_trigger){.arm = true,
					 .action = config->action,
					 .falling = config->falling,
					 .axis = config->axis,
					 .source = config->source});
	if (error == PASSO_OK)
		passo->hard_trigger = hard;
	return error;
}

enum passo_error passo_driver_disarm(struct passo *passo)
{
	enum passo_error error = write_trigger(passo, (struct passo_channel_trigger){.arm = false});

	if (error == PASSO_OK)
		passo->task.armed = false;
	return error;
}

static enum passo_error read_state(struct passo *passo, struct passo_channel_trigger_state *state)
{
	uint32_t word = 0;
	enum passo_error error =
	    passo_host_read(passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_TRIGGER_STATE), &word, 1);

	*state = passo_unpack_channel_trigger_state(word);
	return error;
}

enum passo_error passo_driver_armed(struct passo *passo, bool *active)
{
	const uint32_t since = passo_driver_now(passo);
	struct passo_channel_trigger_state state;
	unsigned looks = 0;
	enum passo_error error;

	do {
		error = read_state(passo, &state);
		if (error != PASSO_OK)
			return error;
		if (++looks > ARMING_LOOKS && passo_driver_now(passo) - since >= PASSO_INPUTS_MICROSECONDS)
			return PASSO_ERROR_INPUTS_UNKNOWN;
	} while (state.arming);
	*active = state.source_active;
	return PASSO_OK;
}

enum passo_error passo_driver_is_blind(struct passo *passo, bool *blind)
{
	struct passo_channel_trigger_state state;
	enum passo_error error = read_state(passo, &state);

	*blind = state.unknown || state.arming;
	return error;
}

/* The trigger of homing or probing is not changed. */
static enum passo_error check_free(const struct passo *passo)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	return error == PASSO_OK && passo->task.kind != PASSO_TASK_NONE ? PASSO_ERROR_UNDER_WAY : error;
}

enum passo_error passo_arm_trigger(struct passo *passo, const struct passo_trigger_config *config)
{
	enum passo_error error = check_free(passo);

	if (error == PASSO_OK && !config)
		error = PASSO_ERROR_ARGUMENT;
	if (error == PASSO_OK)
		error = passo_driver_arm(passo, config);
	if (error == PASSO_OK)
		passo->task.armed = false; /* it now belongs to the program */
	return error;
}

enum passo_error passo_disarm_trigger(struct passo *passo)
{
	enum passo_error error = check_free(passo);

	return error != PASSO_OK ? error : passo_driver_disarm(passo);
}

enum passo_error passo_read_trigger(struct passo *passo, struct passo_trigger_report *report)
{
	uint32_t words[PASSO_AXES_MAX];
	struct passo_channel_trigger_state state;
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error == PASSO_OK && !report)
		error = PASSO_ERROR_ARGUMENT;
	if (error == PASSO_OK)
		error = read_state(passo, &state);
	if (error != PASSO_OK)
		return error;
	*report =
	    (struct passo_trigger_report){.arming = state.arming, .armed = state.armed, .fired = state.fired};
	if (!state.fired)
		return PASSO_OK;
	error = passo_host_read(
	    passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_TRIGGER_POSITION_BASE), words, passo->axes);
	if (error == PASSO_OK)
		error = passo_driver_take_off_trackers(passo, words, false);
	for (unsigned i = 0; error == PASSO_OK && i < passo->axes; i++)
		report->positions[i] = passo_driver_offset(passo, i, (int32_t)words[i]);
	return error;
}

enum passo_error passo_wait_for_trigger(
    struct passo *passo, uint64_t timeout_clocks, struct passo_trigger_report *report)
{
	enum passo_error error = passo_driver_check_inputs(passo);

	if (error != PASSO_OK)
		return error;
	const struct passo_hardware *hardware = &passo->host->hardware;
	struct passo_deadline deadline = passo_driver_deadline(passo, timeout_clocks);
	for (;;) {
		error = passo_poll(passo);
		if (error == PASSO_OK || error == PASSO_ERROR_TRIGGER)
			error = passo_read_trigger(passo, report);
		if (error != PASSO_OK || report->fired)
			return error;
		if (!report->armed && !report->arming)
			return PASSO_ERROR_NO_SOURCE;
		if (passo_driver_left(passo, &deadline) == 0u)
			return PASSO_ERROR_TIMEOUT;
		if (hardware->wait)
			hardware->wait(hardware->context, passo_driver_interval(passo));
	}
}
