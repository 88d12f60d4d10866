/* SPDX-License-Identifier: MIT
 * The preview of a program of G-code: the interpreter, the path planner, the player and the driver as on a
 * microcontroller, and in place of link and core two queues that time empties. Nothing makes steps, so a
 * program takes a small part of the time that the model needs; the lines and ramps are those of a run.
 *
 *     preview = passo_preview_create(&config);
 *     while (passo_preview_play(preview, 1000)) ;
 *     passo_preview_ramps(preview, ramps); // ..._lines, ..._refusals
 *     passo_preview_destroy(preview);
 */
#ifndef PASSO_PREVIEW_H
#define PASSO_PREVIEW_H

#include "passo_program.h"

struct passo_preview_config {
	struct passo_program_settings program;
	uint8_t core_axes; /* of the core: a frame holds more lines for one with fewer */
	uint8_t line_queue_log2, ramp_queue_log2;
	uint32_t look_ahead;                               /* lines */
	uint32_t period;                                   /* clocks between two polls */
	uint32_t step_high, step_low, dir_setup, dir_hold; /* clocks */
	const char *text;                                  /* the program: outlives the preview */
	size_t length;
};

enum { PASSO_PREVIEW_NO_PROBE = -1 }; /* instead of an error: the line probes, no probe is fitted */

/* A refused line, or what was found in its place. */
struct passo_preview_refusal {
	uint32_t line; /* counted from 0 */
	int32_t error; /* enum passo_gcode_error; PASSO_PREVIEW_NO_PROBE; below: minus an enum passo_error of
	                  the player, minus 1 */
};

/* What a check has found. */
struct passo_preview_check {
	uint32_t lines;  /* up to the end of the program */
	size_t bytes;    /* of these lines */
	uint32_t unread; /* lines with words behind it */
	uint32_t chords; /* with those of the arcs */
	uint32_t refused;
	bool ended; /* by M2 or M30 */
};

/* A line of the path, in the order of the core. */
struct passo_preview_line {
	int32_t steps[PASSO_AXES_MAX]; /* of the motors, signed */
	uint32_t substeps;
	uint32_t feed;   /* UQ0.32 substeps per clock: as wanted */
	uint32_t limit;  /* the same: what the axes allow within the line */
	uint32_t source; /* the line of the program, counted from 0 */
	uint8_t tool;    /* in the spindle; 0: none */
	bool rapid;
};

/* A ramp of the profile. */
struct passo_preview_ramp {
	uint64_t velocity; /* at its end, UQ0.48 substeps per clock; the first one of a motion begins at 0 */
	uint32_t ticks;
	uint8_t shape; /* enum passo_shape */
	bool last;     /* of a motion */
};

struct passo_preview;

/* Executes all lines of a text without any motion and counts what it says; tools are loaded immediately.
 * Writes the first `most` refusals. A refused line changes nothing. */
struct passo_preview_check passo_preview_check(struct passo_gcode *gcode, const char *text, size_t length,
    struct passo_preview_refusal *refusals, uint32_t most);

/* *error: why there is none (null): those of passo_program_open(); PASSO_OK: out of memory. The program ends
 * with the text; a probe finds nothing. */
struct passo_preview *passo_preview_create(
    const struct passo_preview_config *config, enum passo_error *error);
void passo_preview_destroy(struct passo_preview *preview);
/* Before the first line: begins with the modes of an interpreter, at these positions of the motors. */
void passo_preview_begin(
    struct passo_preview *preview, const struct passo_gcode *gcode, const int32_t *positions);

/* Plays until `lines` further lines are taken. False: the program has ended, or memory is short, or nothing
 * makes a step for an hour. */
bool passo_preview_play(struct passo_preview *preview, uint32_t lines);
/* Lines of the text taken so far; whether all motions have ended; whether the core was short of ramps. */
uint32_t passo_preview_taken(const struct passo_preview *preview);
bool passo_preview_is_done(const struct passo_preview *preview);
bool passo_preview_ran_dry(const struct passo_preview *preview);
/* Scale of the path. */
uint32_t passo_preview_substeps_per_mm(const struct passo_preview *preview);

/* The results, copied to an array unless it is null; they return their number. */
size_t passo_preview_lines(const struct passo_preview *preview, struct passo_preview_line *lines);
size_t passo_preview_ramps(const struct passo_preview *preview, struct passo_preview_ramp *ramps);
size_t passo_preview_refusals(const struct passo_preview *preview, struct passo_preview_refusal *refusals);

#endif
