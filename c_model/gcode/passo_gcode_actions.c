/* SPDX-License-Identifier: MIT
 * The actions of an accepted line, one after the other.
 */
#include "passo_gcode_private.h"
#include "passo_math.h"

static uint64_t full_speed(const struct passo_gcode *gcode)
{
	return (uint64_t)gcode->settings.spindle_maximum * PASSO_GCODE_MILLION;
}

uint64_t passo_gcode_speed(const struct passo_gcode *gcode, int64_t wanted)
{
	const uint64_t own = passo_mul_div((uint64_t)wanted, gcode->spindle_percent, 100);
	const uint64_t least = own > 0 ? (uint64_t)gcode->settings.spindle_minimum * PASSO_GCODE_MILLION : 0;
	const uint64_t turning = own > least ? own : least, full = full_speed(gcode);

	return turning < full || full == 0 ? turning : full;
}

uint32_t passo_gcode_output(const struct passo_gcode *gcode)
{
#ifdef PASSO_PLAIN_GCODE
	return passo_gcode_output_at(gcode, gcode->spindle);
#else
	return passo_gcode_output_at(gcode, passo_gcode_wanted_speed(gcode, gcode->position[0]));
#endif
}

uint32_t passo_gcode_output_at(const struct passo_gcode *gcode, int64_t wanted)
{
	uint32_t output = 0;

	if (gcode->mode[PASSO_GCODE_SPINDLE] != PASSO_GCODE_M(5)) {
		const uint64_t full = full_speed(gcode), speed = passo_gcode_speed(gcode, wanted);
		const uint32_t reverse =
		    gcode->settings.laser ? PASSO_GCODE_OUTPUT_PROPORTIONAL : PASSO_GCODE_OUTPUT_REVERSE;

		output = PASSO_GCODE_OUTPUT_SPINDLE;
		output |= full > 0 ? (uint32_t)passo_mul_div(speed, PASSO_GCODE_POWER_FULL, full) : 0u;
		output |= gcode->mode[PASSO_GCODE_SPINDLE] == PASSO_GCODE_M(4) ? reverse : 0u;
	}
#ifndef PASSO_PLAIN_GCODE
	output |= gcode->digital * PASSO_GCODE_OUTPUT_DIGITAL;
	if (gcode->power != PASSO_GCODE_POWER_OF_SPINDLE)
		output = (output & ~PASSO_GCODE_POWER_FULL) | gcode->power;
#endif
	output |= gcode->flood ? PASSO_GCODE_OUTPUT_FLOOD : 0u;
	return output | (gcode->mist ? PASSO_GCODE_OUTPUT_MIST : 0u);
}

/* M2 and M30. */
static void end_program(struct passo_gcode *gcode)
{
	static const uint8_t ENDING[] = {PASSO_GCODE_SYSTEM, PASSO_GCODE_PLANE, PASSO_GCODE_DISTANCE,
	    PASSO_GCODE_FEED_MODE, PASSO_GCODE_SPINDLE};

	gcode->mode[PASSO_GCODE_MOTION] = 10;
	for (unsigned i = 0; i < sizeof ENDING; i++)
		gcode->mode[ENDING[i]] = passo_gcode_power_up(gcode, ENDING[i]);
	gcode->flood = gcode->mist = false;
#ifndef PASSO_PLAIN_GCODE
	gcode->power = PASSO_GCODE_POWER_OF_SPINDLE;
#endif
}

bool passo_gcode_is_busy(const struct passo_gcode *gcode)
{
	const struct passo_gcode_job *job = &gcode->job;

#ifndef PASSO_PLAIN_GCODE
	if (job->change || job->listens)
		return true;
#endif
	return job->output || job->dwell || job->offsets || job->via || job->motion || job->pause || job->end;
}

/* Takes a part of the job, if it is there. */
static bool take(bool *part)
{
	const bool there = *part;

	*part = false;
	return there;
}

/* False: no stroke is left. */
static bool next_of_cycle(struct passo_gcode *gcode, struct passo_gcode_action *action)
{
	struct passo_gcode_job *job = &gcode->job;
	const enum passo_gcode_stroke stroke = passo_gcode_cycle_next(&job->cycle);

	job->motion = stroke != PASSO_GCODE_STROKE_NONE;
	passo_gcode_copy(gcode, job->cycle.at, action->target);
	if (stroke == PASSO_GCODE_STROKE_DWELL) {
		action->kind = PASSO_GCODE_DWELL;
		action->microseconds = job->cycle.microseconds;
	} else if (stroke != PASSO_GCODE_STROKE_FEED) {
		action->feed = PASSO_PATH_RAPID;
		if (stroke == PASSO_GCODE_STROKE_RAPID_STOPPED)
			action->output &=
			    PASSO_GCODE_OUTPUT_FLOOD | PASSO_GCODE_OUTPUT_MIST | PASSO_GCODE_OUTPUTS_DIGITAL;
	}
	return job->motion;
}

/* False: nothing is left of it. */
static bool next_of_motion(struct passo_gcode *gcode, struct passo_gcode_action *action)
{
	struct passo_gcode_job *job = &gcode->job;

	action->kind = PASSO_GCODE_LINE;
	action->feed = job->feed;
	if (job->drills)
		return next_of_cycle(gcode, action);
	if (job->turns) {
		passo_gcode_arc_next(&job->arc, action->target);
		job->motion = job->arc.done < job->arc.chords;
		action->stops = action->stops && !job->motion;
		return true;
	}
#ifndef PASSO_WITHOUT_THREADS
	if (job->pitch > 0) {
		job->motion = false;
		passo_gcode_thread(gcode, action);
		return true;
	}
#endif
	if (job->probe != PASSO_GCODE_NONE) {
		action->kind = PASSO_GCODE_PROBE;
		action->probe = job->probe;
	}
	passo_gcode_copy(gcode, job->destination, action->target);
	job->motion = false;
	return true;
}

/* The same of a lathe. */
static bool next_of_turning(struct passo_gcode *gcode, struct passo_gcode_action *action)
{
	const bool there = next_of_motion(gcode, action);

#ifndef PASSO_PLAIN_GCODE
	if (there)
		passo_gcode_turn(gcode, action);
#endif
	return there;
}

bool passo_gcode_next(struct passo_gcode *gcode, struct passo_gcode_action *action)
{
	struct passo_gcode_job *job = &gcode->job;

	if (!passo_gcode_is_busy(gcode))
		return false;
	*action = (struct passo_gcode_action){.line = gcode->line,
	    .output = passo_gcode_output(gcode),
	    .probe = PASSO_GCODE_NONE,
	    .tolerance = job->drills ? PASSO_PATH_UNMERGED : gcode->tolerance,
	    .stops = gcode->mode[PASSO_GCODE_PATH] == PASSO_GCODE_G(61, 1)};
	if (PASSO_GCODE_HAS_TOOLS && take(&job->change)) {
		action->kind = PASSO_GCODE_CHANGE;
		action->tool = gcode->tool;
		action->output &= PASSO_GCODE_OUTPUTS_DIGITAL;
	} else if (take(&job->output)) {
		action->kind = PASSO_GCODE_OUTPUT;
#ifndef PASSO_PLAIN_GCODE
		action->stops = job->settles;
	} else if (take(&job->listens)) {
		action->kind = PASSO_GCODE_INPUT;
		action->input = job->input;
		action->wanted = job->wanted;
		action->microseconds = job->timeout;
#endif
	} else if (take(&job->dwell)) {
		action->kind = PASSO_GCODE_DWELL;
		action->microseconds = job->microseconds;
	} else if (take(&job->offsets)) {
		action->kind = PASSO_GCODE_OFFSETS;
	} else if (take(&job->via)) {
		action->kind = PASSO_GCODE_LINE;
		action->feed = PASSO_PATH_RAPID;
		passo_gcode_copy(gcode, job->stopover, action->target);
	} else if (job->motion) {
		if (!next_of_turning(gcode, action))
			return passo_gcode_next(gcode, action);
	} else if (take(&job->pause)) {
		action->kind = PASSO_GCODE_PAUSE;
	} else {
		job->end = false;
		action->kind = PASSO_GCODE_END;
		end_program(gcode);
		action->output = passo_gcode_output(gcode);
	}
	return true;
}

int64_t passo_gcode_offset(const struct passo_gcode *gcode, unsigned axis)
{
	const struct passo_gcode_check check = {.gcode = gcode,
	    .tool_length = gcode->tool_length,
	    .mode = {[PASSO_GCODE_SYSTEM] = gcode->mode[PASSO_GCODE_SYSTEM]}};

	return passo_gcode_offset_of(&check, axis);
}

int64_t passo_gcode_millimetres(int64_t nanometres)
{
	const uint64_t size = nanometres < 0 ? 0 - (uint64_t)nanometres : (uint64_t)nanometres;
	const struct passo_u128 scaled = passo_u128_add(
	    (struct passo_u128){size >> 32, size << 32}, (struct passo_u128){0, PASSO_GCODE_MILLION / 2});
	const int64_t value = (int64_t)passo_divide(scaled, PASSO_GCODE_MILLION, 0);

	return nanometres < 0 ? -value : value;
}
