/* SPDX-License-Identifier: MIT
 * Home, probe, and the wait for a trigger: commands whose line is answered when they are over. Jog and goto.
 */
#include "passo_call.h"
#include "passo_commands.h"
#include "passo_goto.h"

static uint32_t now_of(const struct passo_console *console)
{
	const struct passo_hardware *hardware = &console->hardware;

	return hardware->microseconds ? hardware->microseconds(hardware->context) : 0u;
}

/* The line is answered later. */
static bool await(const struct passo_call *call, enum passo_awaited what)
{
	struct passo_console *console = call->console;

	console->waits = what;
	console->waiting_channel = (uint8_t)(call->channel - console->channel);
	call->channel->noted = PASSO_OK;
	return false;
}

/* Home and probe have begun, or not. */
static bool begun(const struct passo_call *call, enum passo_error error, uint8_t off, enum passo_awaited what)
{
	if (error != PASSO_OK)
		return passo_answer(call, error);
	passo_note_disabled(call, off);
	return call->console->flow_waits ? await(call, what) : passo_answer(call, PASSO_OK);
}

bool passo_run_home(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo_console_channel *channel = call->channel;
	const struct passo_home home = {.axis = values->axis,
	    .source = (enum passo_trigger_source)values->source,
	    .distance = values->distance,
	    .back_off = values->back_off,
	    .pull_off = values->pull_off,
	    .speed = values->speed,
	    .slow_speed = values->slow_speed,
	    .acceleration = values->acceleration,
	    .position = values->position};
	uint8_t off;

	if (passo_is_moving(&channel->passo)) /* its home must not change */
		return passo_answer(call, PASSO_ERROR_MOVING);
	if (!passo_check_enabled(call, (uint8_t)(1u << home.axis), &off))
		return false;
	channel->home = home;
	return begun(call, passo_home(&channel->passo, &channel->home, 1), off, PASSO_AWAITS_HOME);
}

bool passo_run_probe(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	struct passo_probe probe = {.speed = values->speed,
	    .acceleration = values->acceleration,
	    .away = values->away,
	    .optional = values->optional};
	uint8_t axes = 0, off;

	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++) {
		probe.steps[axis] = values->steps[axis];
		axes |= (uint8_t)((probe.steps[axis] != 0 ? 1u : 0u) << axis);
	}
	if (!passo_check_enabled(call, axes, &off))
		return false;
	return begun(call, passo_probe(&call->channel->passo, &probe), off, PASSO_AWAITS_PROBE);
}

bool passo_run_jog(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	const struct passo_jog jog = {.axis = values->axis,
	    .backward = values->backward,
	    .steps = values->distance,
	    .speed = values->speed,
	    .top_speed = values->top_speed,
	    .acceleration = values->acceleration};
	const bool by_distance = passo_words_find(call->words, "steps") != NULL;
	enum passo_error error;
	uint8_t off;

	if (by_distance && values->backward)
		return passo_complain(call->reading->sink, "steps and backward are mutually exclusive");
	if (by_distance && jog.steps == 0)
		return passo_complain(call->reading->sink, "steps must not be 0; omit it for an endless jog");
	if (!passo_check_enabled(call, (uint8_t)(1u << jog.axis), &off))
		return false;
	error = passo_jog(&call->channel->passo, &jog);
	if (error == PASSO_OK)
		passo_note_disabled(call, off);
	return passo_answer(call, error);
}

#ifndef PASSO_WITHOUT_GOTO
bool passo_run_goto(const struct passo_call *call)
{
	const struct passo_values *values = call->values;
	const struct passo_goto wanted = {.axis = values->axis,
	    .target = values->distance,
	    .speed = values->speed,
	    .top_speed = values->top_speed,
	    .acceleration = values->acceleration,
	    .late_clocks = passo_clocks(&call->channel->passo, values->timeout_microseconds)};
	uint8_t off;

	if (!passo_check_enabled(call, (uint8_t)(1u << wanted.axis), &off))
		return false;
	enum passo_error error = passo_goto(&call->channel->passo, &wanted);
	if (error == PASSO_OK)
		passo_note_disabled(call, off);
	return passo_answer(call, error);
}
#endif

bool passo_run_jog_speed(const struct passo_call *call)
{
	return passo_answer(call, passo_jog_speed(&call->channel->passo, call->values->speed));
}

bool passo_run_jog_cancel(const struct passo_call *call)
{
	return passo_answer(call, passo_jog_cancel(&call->channel->passo));
}

bool passo_run_wait_trigger(const struct passo_call *call)
{
	struct passo_trigger_report report;
	enum passo_error error = passo_read_trigger(&call->channel->passo, &report);

	if (error == PASSO_OK && !report.armed && !report.fired)
		error = PASSO_ERROR_NO_SOURCE;
	if (error != PASSO_OK)
		return passo_answer(call, error);
	call->console->waits_since = now_of(call->console);
	call->console->waits_most = call->values->timeout_microseconds;
	await(call, PASSO_AWAITS_TRIGGER);
	passo_tasks_try_again(call->console);
	return false;
}

/* ---------------------------------------------------------------------------------------- answers ---- */

/* Why a channel does not go on with what is awaited. */
static enum passo_error problem_of(const struct passo_console_channel *channel)
{
	const enum passo_error noted = channel->noted;

	return noted == PASSO_ERROR_NOT_STOPPED || noted == PASSO_ERROR_NOT_HELD ? PASSO_OK : noted;
}

/* Result of homing or probing; PENDING while in progress. */
static enum passo_error end_of(const struct passo_console_channel *channel)
{
	int32_t positions[PASSO_AXES_MAX];
	const enum passo_error problem = problem_of(channel);

	if (problem != PASSO_OK)
		return problem;
	if (passo_is_moving(&channel->passo))
		return PASSO_PENDING;
	return passo_target(&channel->passo, positions); /* STOPPED, by a command */
}

static enum passo_error trigger_of(struct passo_console *console, struct passo_trigger_report *report)
{
	struct passo_console_channel *channel = &console->channel[console->waiting_channel];
	enum passo_error error = problem_of(channel);

	if (error == PASSO_OK || error == PASSO_ERROR_TRIGGER)
		error = passo_read_trigger(&channel->passo, report);
	if (error != PASSO_OK || report->fired)
		return error;
	if (!report->armed)
		return PASSO_ERROR_NO_SOURCE;
	return now_of(console) - console->waits_since >= console->waits_most ? PASSO_ERROR_TIMEOUT
	                                                                     : PASSO_PENDING;
}

void passo_tasks_try_again(struct passo_console *console)
{
	struct passo_console_channel *channel = &console->channel[console->waiting_channel];
	const struct passo_sink *sink = &console->sink;
	const enum passo_awaited awaited = console->waits;
	struct passo_trigger_report report = {.fired = false};
	enum passo_error error =
	    awaited == PASSO_AWAITS_TRIGGER ? trigger_of(console, &report) : end_of(channel);

	if (error == PASSO_PENDING)
		return;
	console->waits = PASSO_AWAITS_NOTHING;
	if (error == PASSO_OK && awaited == PASSO_AWAITS_PROBE)
		error = passo_read_trigger(&channel->passo, &report);
	if (error == PASSO_ERROR_TIMEOUT) {
		passo_complain(sink, "TIMEOUT: the trigger has not fired and stays armed");
	} else if (error != PASSO_OK) {
		passo_complain_error(sink, error);
	} else {
		passo_say(sink, "ok");
		if (awaited == PASSO_AWAITS_PROBE)
			passo_say(sink, " touched=%u", (uint32_t)report.fired);
		if (awaited != PASSO_AWAITS_HOME)
			passo_say_trigger(sink, &channel->passo, &report);
		passo_say(sink, "\n");
	}
}

const char *passo_tasks_name(enum passo_awaited awaited)
{
	switch (awaited) {
	case PASSO_AWAITS_HOME:
		return "home is in progress";
	case PASSO_AWAITS_PROBE:
		return "probe is in progress";
	case PASSO_AWAITS_TRIGGER:
		return "a line waits for the trigger";
	default:
		return "a move waits for queue space";
	}
}
