/* SPDX-License-Identifier: MIT
 * The parsed words of a line, before the semantic checks.
 *
 * Numbers are exact in millionths: millimeters become nanometers, seconds microseconds.
 *
 * PASSO_PLAIN_GCODE, for the flash of a small controller: no tool change, no tool table, no inputs and
 * outputs of the user, none of a lathe (passo_gcode_lathe.c); their words are refused. No axis is left out.
 * PASSO_WITHOUT_THREADS: no motion in step with the spindle.
 */
#ifndef PASSO_GCODE_BLOCK_H
#define PASSO_GCODE_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_gcode_error.h"

#if defined PASSO_PLAIN_GCODE && !defined PASSO_WITHOUT_THREADS
#define PASSO_WITHOUT_THREADS
#endif

/* Axes are X Y Z A B C, in this order. Those that a machine leaves out are a mask, bit 0 X: of X Y Z only the
 * last ones, or Y. */
#define PASSO_GCODE_AXES_MAX 6u

#define PASSO_GCODE_MILLION 1000000

/* Modal groups; at most one command of each in a line. Those before COMMAND are kept from line to line. */
enum passo_gcode_group {
	PASSO_GCODE_MOTION,       /* G0 G1 G2 G3 G33 G33.1 G38.2-5 G73 G80-G83 G85 G86 G89 */
	PASSO_GCODE_SYSTEM,       /* G54-59 */
	PASSO_GCODE_PLANE,        /* G17-19 */
	PASSO_GCODE_UNITS,        /* G20 G21 */
	PASSO_GCODE_DISTANCE,     /* G90 G91 */
	PASSO_GCODE_FEED_MODE,    /* G93 G94 G95 */
	PASSO_GCODE_PATH,         /* G61 G61.1 G64 */
	PASSO_GCODE_TOOL_LENGTH,  /* G43 G43.1 G43.2 G49 */
	PASSO_GCODE_CUTTER,       /* G40 */
	PASSO_GCODE_ARC_DISTANCE, /* G91.1 */
	PASSO_GCODE_SPINDLE,      /* M3 M4 M5 */
	PASSO_GCODE_RETRACT,      /* G98 G99 */
#ifndef PASSO_PLAIN_GCODE
	PASSO_GCODE_DIAMETER, /* G7 G8 */
	PASSO_GCODE_SURFACE,  /* G96 G97 */
#endif
	PASSO_GCODE_COMMAND,     /* G4 G10 G28 G28.1 G30 G30.1 G53 G92 G92.1 */
	PASSO_GCODE_COOLANT,     /* M7 M8 M9 */
	PASSO_GCODE_PROGRAM,     /* M0 M1 M2 M30 */
	PASSO_GCODE_TOOL_CHANGE, /* M6 M61 */
#ifndef PASSO_PLAIN_GCODE
	PASSO_GCODE_PORT, /* M62-68 */
#endif
	PASSO_GCODE_GROUPS
};
#define PASSO_GCODE_MODES PASSO_GCODE_COMMAND

/* A command is its number in tenths: G38.2 is 382. */
typedef int16_t passo_gcode_command;
#define PASSO_GCODE_NONE ((passo_gcode_command) - 1)
/* Commands by name: G28.1 is PASSO_GCODE_G(28, 1), M30 is PASSO_GCODE_M(30). */
#define PASSO_GCODE_G(whole, tenths) ((whole) * 10 + (tenths))
#define PASSO_GCODE_M(whole) ((whole) * 10)

#define PASSO_GCODE_WORD(letter) (UINT32_C(1) << ((letter) - 'A'))

struct passo_gcode_block {
	passo_gcode_command command[PASSO_GCODE_GROUPS]; /* PASSO_GCODE_NONE: none */
	bool takes_axes;                                 /* one of them uses the axis words */
	uint32_t words;                                  /* other words, one bit per letter */
	int64_t value[26];                               /* of a letter, in millionths */
};

/* Letter of an axis of a machine, and the words of its first `axes` ones. */
char passo_gcode_axis_letter(uint8_t left_out, unsigned axis);
uint32_t passo_gcode_axis_words(uint8_t left_out, unsigned axes);

/* Reads a number: sign, digits and at most one point, below 10^9; rounded to millionths. Advances *text
 * past it. False: no number. */
bool passo_gcode_number(const char **text, int64_t *millionths);

/* Reads the words of a line (passo_gcode_line.h) for a machine with these axis words. Errors: LETTER,
 * NUMBER, NEGATIVE, UNSUPPORTED, MODAL_GROUP, NOT_INTEGER, TWO_COMMANDS, REPEATED. */
enum passo_gcode_error passo_gcode_parse(
    const char *text, uint32_t axis_words, struct passo_gcode_block *block);

#endif
