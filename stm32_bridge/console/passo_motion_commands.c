/* SPDX-License-Identifier: MIT
 * Commands that control motions, and readings.
 */
#include "passo_call.h"
#include "passo_commands.h"
#include "passo_release.h"
#include "passo_words.h"

bool passo_run_hold(const struct passo_call *call)
{
	return passo_answer(call, passo_hold(&call->channel->passo));
}

bool passo_run_resume(const struct passo_call *call)
{
	return passo_answer(call, passo_resume(&call->channel->passo));
}

bool passo_run_override(const struct passo_call *call)
{
	return passo_answer(call, passo_override(&call->channel->passo, call->values->number));
}

bool passo_run_stop(const struct passo_call *call)
{
	return passo_answer(call, passo_stop(&call->channel->passo));
}

bool passo_run_abort(const struct passo_call *call)
{
	return passo_answer(call, passo_abort(&call->channel->passo));
}

bool passo_run_sync(const struct passo_call *call)
{
	return passo_answer(call, passo_wait_for_sync(&call->channel->passo, call->values->on));
}

bool passo_run_start(const struct passo_call *call)
{
	struct passo_console *console = call->console;
	struct passo *waiting[PASSO_CHANNELS_MAX];
	unsigned count = 0;

	for (unsigned i = 0; i < passo_commands_channels(console); i++) {
		struct passo *passo = &console->channel[i].passo;

		if (passo_waits_for_sync(passo) && passo_is_moving(passo))
			waiting[count++] = passo;
	}
	return passo_answer(
	    call, count != 0u ? passo_start_together(waiting, count) : PASSO_ERROR_NOT_PREPARED);
}

bool passo_run_zero(const struct passo_call *call)
{
	return passo_answer(call, passo_zero(&call->channel->passo));
}

/* For one axis, or for all. */
bool passo_run_enable(const struct passo_call *call)
{
	struct passo_console_channel *channel = call->channel;
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; axis < call->reading->axes && error == PASSO_OK; axis++) {
		const uint8_t bit = (uint8_t)(1u << axis);

		if ((call->reading->given & 1u) != 0u && axis != call->values->axis)
			continue;
		error = passo_enable(&channel->passo, axis, call->values->on);
		if (error == PASSO_ERROR_MOVING)
			break; /* the drive is on as before */
		channel->announced &= (uint8_t)~bit;
		channel->enabled &= (uint8_t)~bit;
		if (error == PASSO_OK && call->values->on)
			channel->enabled |= bit;
	}
	return passo_answer(call, error);
}

bool passo_run_disable(const struct passo_call *call)
{
	call->values->on = false;
	return passo_run_enable(call);
}

bool passo_run_status(const struct passo_call *call)
{
	static const char *const CAUSES[] = PASSO_CAUSE_NAMES;
	struct passo_console *console = call->console;
	struct passo *passo = &call->channel->passo;
	struct passo_snapshot now;
	struct passo_readings inputs;
	enum passo_error error = passo_read_state(passo, &now);

	if (error == PASSO_OK && passo_has_inputs(passo))
		error = passo_read_inputs(passo, &inputs);
	if (!passo_answer(call, error))
		return false;
	passo_say(&console->sink, " state=%s cause=%s moving=%u rate=%m", passo_state_name(now.state),
	    now.cause < PASSO_COUNT(CAUSES) ? CAUSES[now.cause] : "?", (uint32_t)passo_is_moving(passo),
	    (int64_t)now.rate * 100000 / PASSO_RATE_FULL);
	passo_say(&console->sink, " lines=%u ramps=%u drained=%u overrun=%u fault=%s retries=%u",
	    (uint32_t)now.line_room, (uint32_t)now.ramp_room, (uint32_t)now.drained, (uint32_t)now.overrun,
	    passo_error_name(passo_fault(passo)), console->host.counters.retries);
	passo_say(&console->sink, " waiting=%u", (uint32_t)(console->waits != PASSO_AWAITS_NOTHING));
	if (passo_has_inputs(passo))
		passo_say_inputs(call, &inputs);
	if (console->board.lost_bytes)
		passo_say(
		    &console->sink, " lost_bytes=%u", console->board.lost_bytes(console->board.context));
	return true;
}

bool passo_run_position(const struct passo_call *call)
{
	int32_t positions[PASSO_AXES_MAX];

	if (!passo_answer(call, passo_positions(&call->channel->passo, positions)))
		return false;
	for (unsigned axis = 0; axis < call->reading->axes; axis++)
		passo_say(&call->console->sink, axis == 0u ? " position=%d" : ",%d", positions[axis]);
	return true;
}

bool passo_run_angle(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo *passo = &call->channel->passo;
	int64_t degrees;
	uint64_t rpm;
	enum passo_error error = passo_angle(passo, values->axis, values->steps_per_turn, &degrees);

	if (error == PASSO_OK)
		error = passo_rpm(passo, values->steps_per_turn, &rpm);
	if (!passo_answer(call, error))
		return false;
	passo_say(&call->console->sink, " angle=%m rpm=%m", passo_thousandths(degrees),
	    passo_thousandths((int64_t)rpm));
	return true;
}

bool passo_run_version(const struct passo_call *call)
{
	struct passo_console *console = call->console;
	uint32_t word;
	const enum passo_error error = passo_host_read(&console->host, PASSO_ADDRESS_VERSION, &word, 1);
	const enum passo_error fault = console->opened ? error : console->absent;

	passo_say(&console->sink, "ok console=" PASSO_RELEASE);
	if (error == PASSO_OK) {
		const struct passo_version core = passo_unpack_version(word);

		passo_say(&console->sink, " core=%u.%u.%u", (uint32_t)core.major, (uint32_t)core.minor,
		    (uint32_t)core.patch);
	} else {
		passo_say(&console->sink, " core=none");
	}
	if (fault == PASSO_OK)
		passo_say(&console->sink, " channels=%u axes=%u", (uint32_t)passo_commands_channels(console),
		    (uint32_t)call->reading->axes);
	else
		passo_say(&console->sink, " fault=%s", passo_error_name(fault));
	passo_say(&console->sink, " clock_hz=%u", console->clock_hz);
	return true;
}
