/* SPDX-License-Identifier: MIT
 * The check of a text before it is played: every line is executed, nothing moves.
 */
#include "passo_preview.h"

#include <string.h>

static bool has_words(const char *text, size_t length)
{
	struct passo_gcode_line line;

	passo_gcode_line_read(&line, text, length);
	return line.text[strspn(line.text, "%")] != '\0';
}

/* Takes all actions of a line; true: it ends the program. */
static bool take(struct passo_gcode *gcode, struct passo_preview_check *made, bool *probes)
{
	struct passo_gcode_action action;
	bool ends = false;

	while (passo_gcode_next(gcode, &action)) {
		if (action.kind == PASSO_GCODE_CHANGE)
			passo_gcode_load(gcode, action.tool);
		*probes |= action.kind == PASSO_GCODE_PROBE;
		ends |= action.kind == PASSO_GCODE_END;
		made->chords += action.kind == PASSO_GCODE_LINE;
	}
	return ends;
}

struct passo_preview_check passo_preview_check(struct passo_gcode *gcode, const char *text, size_t length,
    struct passo_preview_refusal *refusals, uint32_t most)
{
	struct passo_preview_check made = {.lines = 0};

	for (size_t at = 0, count; at < length; at += count) {
		struct passo_gcode_line line;
		bool probes = false;

		count = passo_gcode_line_count(text + at, length - at);
		if (made.ended) {
			made.unread += has_words(text + at, count);
			continue;
		}
		passo_gcode_line_read(&line, text + at, count);
		const enum passo_gcode_error error =
		    line.overflow ? PASSO_GCODE_LINE_OVERFLOW : passo_gcode_execute(gcode, line.text);
		if (error == PASSO_GCODE_OK)
			made.ended = take(gcode, &made, &probes);
		if (error != PASSO_GCODE_OK || probes) {
			if (made.refused < most)
				refusals[made.refused] = (struct passo_preview_refusal){
				    made.lines, probes ? PASSO_PREVIEW_NO_PROBE : (int32_t)error};
			made.refused++;
		}
		made.lines++;
		made.bytes = at + count;
	}
	return made;
}
