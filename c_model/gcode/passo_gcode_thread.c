/* SPDX-License-Identifier: MIT
 * G33 and G33.1: lines in step with the spindle.
 */
#include "passo_gcode_private.h"
#include "passo_math.h"

#ifndef PASSO_WITHOUT_THREADS

bool passo_gcode_is_thread(passo_gcode_command motion)
{
	return motion == PASSO_GCODE_G(33, 0) || motion == PASSO_GCODE_G(33, 1);
}

/* K is the way along the line in a turn. G33.1 comes back to where it began. */
enum passo_gcode_error passo_gcode_check_thread(struct passo_gcode_check *check)
{
	const struct passo_gcode *gcode = check->gcode;
	struct passo_gcode_job *job = check->job;
	const bool rigid = check->mode[PASSO_GCODE_MOTION] == PASSO_GCODE_G(33, 1);
	bool moves = false;

	if (gcode->settings.turn_counts == 0)
		return PASSO_GCODE_UNSUPPORTED;
	if (check->axis_words == 0)
		return PASSO_GCODE_NO_AXIS_WORDS;
	if (!passo_gcode_take(check, 'K'))
		return PASSO_GCODE_NO_VALUE;
	const int64_t pitch = passo_gcode_length_of(check, 'K');
	if (pitch <= 0)
		return PASSO_GCODE_NEGATIVE;
	const enum passo_gcode_error error = passo_gcode_check_turning(check);
	if (error != PASSO_GCODE_OK)
		return error;
	job->pitch = (uint64_t)pitch;
	passo_gcode_copy(gcode, gcode->position, job->destination);
	if (passo_gcode_find_target(check, job->stopover) != PASSO_GCODE_OK)
		return PASSO_GCODE_TARGET;
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
		moves = moves || job->stopover[axis] != gcode->position[axis];
	if (!rigid)
		passo_gcode_copy(gcode, job->stopover, job->destination);
	job->feed = 0;
	job->motion = moves;
	return PASSO_GCODE_OK;
}

void passo_gcode_thread(const struct passo_gcode *gcode, struct passo_gcode_action *action)
{
	const struct passo_gcode_job *job = &gcode->job;
	const int64_t wanted = passo_gcode_wanted_speed(gcode, job->stopover[0]);

	action->kind = PASSO_GCODE_THREAD;
	action->rigid = gcode->mode[PASSO_GCODE_MOTION] == PASSO_GCODE_G(33, 1);
	action->pitch = job->pitch;
	action->speed = passo_gcode_speed(gcode, wanted);
	action->output = passo_gcode_output_at(gcode, wanted);
	action->feed = passo_gcode_feed(passo_mul_div(job->pitch, action->speed, PASSO_GCODE_MILLION));
	passo_gcode_copy(gcode, job->stopover, action->target);
}

#endif
