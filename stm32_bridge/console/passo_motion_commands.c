/* SPDX-License-Identifier: MIT
 * Commands for motion and readings.
 */
#include "passo_call.h"
#include "passo_release.h"
#include "passo_words.h"

bool passo_run_move(const struct passo_call *call)
{
	struct passo_console *console = call->console;

	return passo_forms_move(&console->passo, call->reading, call->words, &console->table)
	    && passo_answer(call, PASSO_OK);
}

bool passo_run_turn(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo_turning turning = {.axis = values->axis,
	    .steps_per_turn = values->steps_per_turn,
	    .backwards = values->on,
	    .top_rpm = values->top_rpm,
	    .minimum_rpm = values->minimum_rpm,
	    .acceleration = values->acceleration};

	return passo_answer(call, passo_turn_start(&call->console->passo, &turning, values->rpm));
}

bool passo_run_rpm(const struct passo_call *call)
{
	struct passo *passo = &call->console->passo;
	uint64_t rpm = call->values->rpm;

	return passo_answer(call, rpm == 0u ? passo_turn_stop(passo) : passo_turn_speed(passo, rpm));
}

bool passo_run_hold(const struct passo_call *call)
{
	return passo_answer(call, passo_hold(&call->console->passo));
}

bool passo_run_resume(const struct passo_call *call)
{
	return passo_answer(call, passo_resume(&call->console->passo));
}

bool passo_run_override(const struct passo_call *call)
{
	return passo_answer(call, passo_override(&call->console->passo, call->values->number));
}

bool passo_run_stop(const struct passo_call *call)
{
	return passo_answer(call, passo_stop(&call->console->passo));
}

bool passo_run_abort(const struct passo_call *call)
{
	return passo_answer(call, passo_abort(&call->console->passo));
}

bool passo_run_sync(const struct passo_call *call)
{
	return passo_answer(call, passo_wait_for_sync(&call->console->passo, call->values->on));
}

bool passo_run_zero(const struct passo_call *call)
{
	return passo_answer(call, passo_zero(&call->console->passo));
}

/* For one axis, or for all. */
bool passo_run_enable(const struct passo_call *call)
{
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; axis < call->reading->axes && error == PASSO_OK; axis++) {
		if (call->reading->given == 0u || axis == call->values->axis)
			error = passo_enable(&call->console->passo, axis, call->values->on);
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
	struct passo_snapshot now;

	if (!passo_answer(call, passo_read_state(&console->passo, &now)))
		return false;
	passo_say(&console->sink, " state=%s cause=%s moving=%u rate=%m", passo_state_name(now.state),
	    now.cause < PASSO_COUNT(CAUSES) ? CAUSES[now.cause] : "?",
	    (uint32_t)passo_is_moving(&console->passo), (int64_t)now.rate * 100000 / PASSO_RATE_FULL);
	passo_say(&console->sink, " lines=%u ramps=%u drained=%u overrun=%u fault=%s retries=%u",
	    (uint32_t)now.line_room, (uint32_t)now.ramp_room, (uint32_t)now.drained, (uint32_t)now.overrun,
	    passo_error_name(passo_fault(&console->passo)), console->host.counters.retries);
	if (console->board.lost_bytes)
		passo_say(
		    &console->sink, " lost_bytes=%u", console->board.lost_bytes(console->board.context));
	return true;
}

bool passo_run_position(const struct passo_call *call)
{
	int32_t positions[PASSO_AXES_MAX];

	if (!passo_answer(call, passo_positions(&call->console->passo, positions)))
		return false;
	for (unsigned axis = 0; axis < call->reading->axes; axis++)
		passo_say(&call->console->sink, axis == 0u ? " position=%d" : ",%d", positions[axis]);
	return true;
}

bool passo_run_angle(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo *passo = &call->console->passo;
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

	if (!passo_answer(call, passo_host_read(&console->host, PASSO_ADDRESS_VERSION, &word, 1)))
		return false;
	const struct passo_version core = passo_unpack_version(word);
	passo_say(&console->sink, " console=" PASSO_RELEASE " core=%u.%u.%u axes=%u clock_hz=%u",
	    (uint32_t)core.major, (uint32_t)core.minor, (uint32_t)core.patch, (uint32_t)call->reading->axes,
	    console->clock_hz);
	return true;
}
