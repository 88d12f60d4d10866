/* SPDX-License-Identifier: MIT
 * Fuzzes the G-code interpreter, and the path planner with what it hands out: gcode_fuzz SEED SECONDS.
 *
 * Whatever the line, it is refused as a whole or all its actions are such that the planner takes them or
 * names an error, and the last one ends at the programmed position.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "passo_gcode.h"
#include "passo_gcode_line.h"

#define ITEMS 16u
#define TEXT 200u
#define CHORDS_MAX 2000u /* of an arc that are checked */

static void must(bool holds, const char *what, const char *text)
{
	if (!holds) {
		fprintf(stderr, "%s: %s\n", what, text);
		abort();
	}
}

static size_t add_number(char *text)
{
	static const char *const ODD[] = {"", "-", ".", "1e9", "999999999.9999999", "-999999999", "0",
	    "-0.0000004", "12345678901", "0.000001", "00000000000000000001", "1.2.3"};

	if (below(12) == 0)
		return (size_t)sprintf(text, "%s", ODD[below(sizeof ODD / sizeof *ODD)]);
	const unsigned whole = below(3) ? below(30) : below(1u << below(30));
	return (size_t)sprintf(text, "%s%u.%0*u", below(3) ? "" : "-", whole, (int)below(8), below(1000));
}

/* Words of the language with numbers that often make sense, or any bytes. */
static size_t any_line(char *text)
{
	static const char *const COMMANDS[] = {"G0", "G1", "G2", "G3", "G4P.1", "G10L2P1", "G10L20P0", "G17",
	    "G18", "G19", "G20", "G21", "G28", "G28.1", "G30", "G30.1", "G38.2", "G40", "G43.1", "G49", "G53",
	    "G54", "G59", "G61", "G80", "G90", "G91", "G91.1", "G92", "G92.1", "G93", "G94", "M0", "M2", "M3",
	    "M5", "M8", "M30", "M6", "M61Q3", "G43", "G43H2", "G43.2H1", "G10L1P1", "G10L1P2Z3", "G73", "G81",
	    "G82", "G83Q1", "G89", "G98", "G99", "G61.1", "G64P.1", "G", "M", "G38.9", "(", ")", ";", "/",
	    "%"};
	size_t length = 0;

	if (below(20) == 0) {
		for (length = below(TEXT); length > 0; length--)
			*text++ = (char)below(256);
		return TEXT / 2;
	}
	for (unsigned words = below(7); words > 0; words--) {
		if (below(3) == 0) {
			length += (size_t)sprintf(
			    text + length, "%s", COMMANDS[below(sizeof COMMANDS / sizeof *COMMANDS)]);
		} else {
			text[length++] = "XYZABCIJKRFPLSTNHQ"[below(18)];
			length += add_number(text + length);
		}
	}
	return length;
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
		must(action->output == 0, "it turns", text);
		passo_gcode_load(gcode, action->tool);
	}
	if (action->kind != PASSO_GCODE_LINE)
		return;
	must(action->feed > 0, "no feed", text);
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
		move.target[axis] = passo_gcode_millimetres(action->target[axis]);
	if (passo_path_add(path, &move) == PASSO_PLAN_PATH_FULL) {
		take_all(path);
		passo_path_add(path, &move);
	}
}

static void execute(struct passo_path_planner *path, struct passo_gcode *gcode)
{
	char text[TEXT] = "";
	struct passo_gcode_line line;
	struct passo_gcode_action action;
	const struct passo_gcode before = *gcode;

	passo_gcode_line_read(&line, text, any_line(text));
	const enum passo_gcode_error error =
	    below(10) ? passo_gcode_execute(gcode, line.text) : passo_gcode_jog(gcode, line.text);
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
		if (action.kind == PASSO_GCODE_LINE || action.kind == PASSO_GCODE_PROBE) {
			memcpy(last, action.target, sizeof last);
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

static void fuzz(struct passo_path_item *items)
{
	struct passo_path_planner path;
	struct passo_gcode gcode;
	struct passo_path_settings settings = {
	    .machine = {64000000, 7, (uint8_t)(1 + below(6))}, .junction_deviation = PASSO_UNIT_Q32 / 100};

	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++)
		settings.axis[axis] = (struct passo_path_axis){
		    .steps_per_mm = 80 * PASSO_UNIT_Q32,
		    .speed = 200 * PASSO_UNIT_Q32,
		    .acceleration = 1000 * PASSO_UNIT_Q32,
		};
	must(passo_path_open(&path, &settings, items, ITEMS) == PASSO_PLAN_OK, "open", "");
	passo_gcode_open(&gcode, &(struct passo_gcode_settings){settings.machine.axes,
				     1 + below(1u << below(20)), below(20000), below(2) != 0u, below(2000)});
	for (unsigned count = below(200); count > 0; count--)
		execute(&path, &gcode);
}

int main(int count, char **words)
{
	static struct passo_path_item items[ITEMS];
	uint64_t rounds = 0;

	for (fuzz_begin(count, words); rounds == 0 || fuzz_goes_on(); rounds++)
		fuzz(items);
	printf("%llu programs\n", (unsigned long long)rounds);
	return 0;
}
