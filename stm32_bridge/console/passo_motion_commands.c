/* SPDX-License-Identifier: MIT
 * Commands for motion and readings.
 */
#include "passo_call.h"
#include "passo_release.h"
#include "passo_words.h"

/* Finds axes that are not enabled. If enabled drives are needed, prints an error and returns false. */
static bool check_enabled(const struct passo_console *console, uint8_t axes, uint8_t *off)
{
	uint32_t axis = 0;

	*off = axes & (uint8_t)~console->enabled;
	if (!console->need_enable || *off == 0u)
		return true;
	while (((uint32_t)*off >> axis & 1u) == 0u)
		axis++;
	return passo_complain(&console->sink, "NOT_ENABLED: axis %u is not enabled", axis);
}

/* Notes once for each axis that it moves without its drive. */
static void note_disabled(struct passo_console *console, uint8_t off)
{
	const uint32_t news = off & (uint8_t)~console->announced;

	for (uint32_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		if ((news >> axis & 1u) != 0u)
			passo_say(&console->sink, "note: axis %u is not enabled\n", axis);
	}
	console->announced |= off;
}

/* Whether the move can be queued later, when those before it have progressed. */
static bool can_wait(const struct passo_console *console, enum passo_error error)
{
	return console->flow_waits && (error == PASSO_ERROR_FULL || error == PASSO_ERROR_TABLE)
	    && passo_is_moving(&console->passo);
}

bool passo_run_move(const struct passo_call *call)
{
	struct passo_console *console = call->console;
	struct passo_form_move move;
	enum passo_error error;
	uint8_t off;

	if (!passo_forms_read(call->reading, call->words, &console->table, &move)
	    || !check_enabled(console, passo_forms_axes(&move), &off))
		return false;
	error = passo_forms_queue(&console->passo, &move);
	if (can_wait(console, error)) {
		const struct passo_snapshot *seen = passo_snapshot(&console->passo);

		console->waits = true;
		console->seen_state = seen->state;
		console->seen_lines = seen->line_room;
		console->seen_ramps = seen->ramp_room;
		return false;
	}
	if (error == PASSO_OK)
		note_disabled(console, off);
	return passo_answer(call, error);
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
	enum passo_error error;
	uint8_t off;

	if (!check_enabled(call->console, (uint8_t)(1u << values->axis), &off))
		return false;
	error = passo_turn_start(&call->console->passo, &turning, values->rpm);
	if (error == PASSO_OK)
		note_disabled(call->console, off);
	return passo_answer(call, error);
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
	struct passo_console *console = call->console;
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; axis < call->reading->axes && error == PASSO_OK; axis++) {
		const uint8_t bit = (uint8_t)(1u << axis);

		if (call->reading->given != 0u && axis != call->values->axis)
			continue;
		error = passo_enable(&console->passo, axis, call->values->on);
		if (error == PASSO_ERROR_MOVING)
			break; /* the drive is on as before */
		console->announced &= (uint8_t)~bit;
		console->enabled &= (uint8_t)~bit;
		if (error == PASSO_OK && call->values->on)
			console->enabled |= bit;
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
	passo_say(&console->sink, " waiting=%u", (uint32_t)console->waits);
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
		passo_say(&console->sink, " axes=%u", (uint32_t)call->reading->axes);
	else
		passo_say(&console->sink, " fault=%s", passo_error_name(fault));
	passo_say(&console->sink, " clock_hz=%u", console->clock_hz);
	return true;
}
