/* SPDX-License-Identifier: MIT
 * What holds for the G-code interpreter, and the path planner with what it hands out, whatever the line.
 *
 * It is refused as a whole, or all its actions are such that the planner takes them or names an error, and
 * the last one ends at the programmed position.
 */
#ifndef GCODE_CHECKS_H
#define GCODE_CHECKS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo_gcode.h"
#include "passo_gcode_line.h"

#define ITEMS 16u
#define CHORDS_MAX 2000u /* of an arc that are checked */

static void must(bool holds, const char *what, const char *text)
{
	if (!holds) {
		fprintf(stderr, "%s: %s\n", what, text);
		abort();
	}
}

static void take_all(struct passo_path_planner *path)
{
	struct passo_line line;
	struct passo_ramp ramp;

	while (passo_path_next_line(path, &line))
		must(line.substeps > 0 && line.substeps <= PASSO_SUBSTEPS_MAX, "substeps", "");
	for (unsigned count = 0; count < 300 && passo_path_next_ramp(path, UINT32_MAX, &ramp); count++)
		must(ramp.velocity_end <= PASSO_VELOCITY_MAX, "velocity", "");
	passo_path_next_motion(path);
}

static void act(struct passo_path_planner *path, struct passo_gcode *gcode,
    const struct passo_gcode_action *action, const char *text)
{
	struct passo_path_move move = {.feed = action->feed, .output = action->output};

	if (action->kind == PASSO_GCODE_DWELL)
		passo_path_dwell(path, action->microseconds);
	if (action->kind == PASSO_GCODE_CHANGE) {
		must((action->output & ~PASSO_GCODE_OUTPUTS_DIGITAL) == 0, "it turns", text);
		passo_gcode_load(gcode, action->tool);
	}
	if (action->kind == PASSO_GCODE_INPUT)
		must(action->input < gcode->settings.inputs
		         && (action->microseconds > 0 || action->wanted == PASSO_GCODE_WANTED_NOW),
		    "no input", text);
	if (action->kind == PASSO_GCODE_THREAD)
		must(gcode->settings.turn_counts > 0 && action->pitch > 0, "no thread", text);
	if (action->kind != PASSO_GCODE_LINE && action->kind != PASSO_GCODE_THREAD)
		return;
	must(action->feed > 0, "no feed", text);
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
		move.target[axis] = passo_gcode_millimetres(action->target[axis]);
	if (passo_path_add(path, &move) == PASSO_PLAN_PATH_FULL) {
		take_all(path);
		passo_path_add(path, &move);
	}
}

/* A line of text, or the words of a jog. */
static void execute(
    struct passo_path_planner *path, struct passo_gcode *gcode, bool jog, const char *text, size_t length)
{
	struct passo_gcode_line line;
	struct passo_gcode_action action;
	const struct passo_gcode before = *gcode;

	passo_gcode_line_read(&line, text, length);
	const enum passo_gcode_error error =
	    jog ? passo_gcode_jog(gcode, line.text) : passo_gcode_execute(gcode, line.text);
	must(strlen(line.message) == line.said, "message", line.text);
	must(strcmp(passo_gcode_error_text(error), "unknown error") != 0, "no such error", line.text);
	if (error != PASSO_GCODE_OK) {
		must(!passo_gcode_is_busy(gcode), "a refused line acts", line.text);
		must(memcmp(gcode, &before, offsetof(struct passo_gcode, job)) == 0, "it has changed",
		    line.text);
		return;
	}
	const bool moves = gcode->job.motion;
	const passo_gcode_command probe = gcode->job.probe;
	bool moved = false;
	passo_gcode_position last;
	unsigned count = 0;
	for (; count < CHORDS_MAX && passo_gcode_next(gcode, &action); count++) {
		if (action.kind == PASSO_GCODE_LINE || action.kind == PASSO_GCODE_PROBE
		    || action.kind == PASSO_GCODE_THREAD) {
			const bool back = action.kind == PASSO_GCODE_THREAD && action.rigid;

			memcpy(last, back ? gcode->position : action.target, sizeof last);
			moved = true;
		}
		act(path, gcode, &action, line.text);
	}
	must(moved == moves, "motion", line.text);
	must(moves || probe == PASSO_GCODE_NONE, "probe", line.text);
	for (unsigned axis = 0; moves && count < CHORDS_MAX && axis < gcode->settings.axes; axis++)
		must(last[axis] == gcode->position[axis], "the end", line.text);
	if (count == CHORDS_MAX)
		passo_gcode_set_position(gcode, gcode->position);
}

/* A machine that knows nothing yet. */
static void begin(struct passo_path_planner *path, struct passo_gcode *gcode,
    const struct passo_gcode_settings *gcode_settings)
{
	static struct passo_path_item items[ITEMS];
	struct passo_path_settings settings = {
	    .machine = {64000000, 7, gcode_settings->axes}, .junction_deviation = PASSO_UNIT_Q32 / 100};

	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++)
		settings.axis[axis] = (struct passo_path_axis){
		    .steps_per_mm = 80 * PASSO_UNIT_Q32,
		    .speed = 200 * PASSO_UNIT_Q32,
		    .acceleration = 1000 * PASSO_UNIT_Q32,
		};
	must(passo_path_open(path, &settings, items, ITEMS) == PASSO_PLAN_OK, "open", "");
	passo_gcode_open(gcode, gcode_settings);
}

#endif
