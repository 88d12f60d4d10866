/* SPDX-License-Identifier: MIT
 * Timed points as a stream: a line for each interval, and ramps of one velocity, which end before the lines.
 */
#include "passo_follow.h"

#include "passo_driver.h"

#define BATCHES 4u /* ramps for half a queue of lines */

static uint32_t smaller(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

static bool give_line(void *context, struct passo_line *line)
{
	struct passo_follow *follow = context;

	if (follow->given == follow->count
	    || passo_timed_add(&follow->timed, &follow->points[follow->given], line) != PASSO_TIMED_OK)
		return false; /* the latter cannot be: all points were checked */
	line->last = ++follow->given == follow->count;
	return true;
}

/* Ticks from the start to the end of a number of lines, rounded down, but up at the end of `all`. */
static uint64_t ticks_to(const struct passo_follow *follow, uint32_t lines, bool all)
{
	const uint32_t tick_log2 = follow->timed.settings->machine.tick_log2;
	const uint64_t clocks = lines > 0u ? passo_timed_clocks(&follow->points[lines - 1u]) : 0u;

	return (clocks + (all ? (UINT64_C(1) << tick_log2) - 1u : 0u)) >> tick_log2;
}

/* First a jump to the velocity, then the time of the lines that are given but not in reserve, a part of the
 * queue each. */
static bool give_ramp(void *context, struct passo_ramp *ramp)
{
	struct passo_follow *follow = context;
	const bool all = follow->given == follow->count;
	const uint32_t lines = all ? follow->given : follow->given - smaller(follow->given, follow->reserve);
	const uint64_t ticks = ticks_to(follow, lines, all) - follow->ticks;

	*ramp = (struct passo_ramp){.velocity_end = PASSO_TIMED_VELOCITY};
	if (!follow->jumped) {
		follow->jumped = true;
		return true;
	}
	if (!all && (lines < follow->covered + follow->reserve / BATCHES || ticks == 0u))
		return false;
	ramp->ticks = ticks < UINT32_MAX ? (uint32_t)ticks : UINT32_MAX;
	ramp->last = all && ramp->ticks == ticks;
	ramp->progress_step = ramp->ticks > 1u ? PASSO_ONE_Q48 / ramp->ticks : PASSO_PROGRESS_STEP_MAX;
	follow->ticks += ramp->ticks;
	follow->covered = lines;
	return true;
}

/* Whether the pins of all motors can make a line. */
static enum passo_error check_pins(
    struct passo *passo, struct passo_follow *follow, const struct passo_line *line)
{
	for (uint8_t motor = 0; motor < passo->machine.axes; motor++) {
		const uint32_t shortest = passo->axis[motor].shortest_clocks;

		if (line->steps[motor] == 0u)
			continue;
		if (shortest == 0u)
			return PASSO_ERROR_NOT_CONFIGURED;
		if ((uint64_t)line->steps[motor] * shortest > (uint64_t)line->substeps * PASSO_TIMED_GRAIN) {
			follow->axis = (uint8_t)(follow->timed.settings->machine.axes + motor);
			follow->reason = PASSO_TIMED_PINS;
			return PASSO_ERROR_SUPPLY;
		}
	}
	return PASSO_OK;
}

static enum passo_error refuse(struct passo_follow *follow, enum passo_timed_error reason)
{
	follow->axis = follow->timed.axis;
	follow->reason = reason;
	return reason == PASSO_TIMED_OK ? PASSO_OK : PASSO_ERROR_SUPPLY;
}

/* All points in turn. */
static enum passo_error check(struct passo *passo, struct passo_follow *follow)
{
	for (follow->refused = 0; follow->refused < follow->count; follow->refused++) {
		struct passo_line line;
		enum passo_error error =
		    refuse(follow, passo_timed_add(&follow->timed, &follow->points[follow->refused], &line));

		if (error == PASSO_OK)
			error = check_pins(passo, follow, &line);
		if (error != PASSO_OK)
			return error;
	}
	return refuse(follow, passo_timed_end(&follow->timed));
}

/* Fills the queue, unless the stream has started by itself, and starts. */
static enum passo_error start(struct passo *passo)
{
	enum passo_error error = PASSO_OK;

	while (error == PASSO_OK && passo->stream == PASSO_STREAM_FILLS
	       && (passo_driver_is_sending(passo) || passo_driver_wants_lines(passo)
	           || passo_driver_wants_ramps(passo)))
		error = passo_poll(passo);
	return error == PASSO_OK && passo->stream == PASSO_STREAM_FILLS ? passo_stream_start(passo) : error;
}

enum passo_error passo_follow(struct passo *passo, struct passo_follow *follow,
    const struct passo_path_settings *settings, const struct passo_timed_point *points, uint32_t count)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!follow || !settings || (!points && count > 0u))
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (passo_timed_motors(settings) > passo->machine.axes)
		return PASSO_ERROR_ARGUMENT_AXIS;
	error = passo_target(passo, positions);
	if (error != PASSO_OK)
		return error;
	*follow = (struct passo_follow){.points = points, .count = count, .reserve = passo->line_places / 2u};
	error = refuse(follow, passo_timed_open(&follow->timed, settings, positions));
	if (error == PASSO_OK)
		error = check(passo, follow);
	if (error != PASSO_OK)
		return error;
	passo_timed_open(&follow->timed, settings, positions);
	error = passo_stream(
	    passo, &(struct passo_source){.line = give_line, .ramp = give_ramp, .context = follow});
	return error != PASSO_OK ? error : start(passo);
}
