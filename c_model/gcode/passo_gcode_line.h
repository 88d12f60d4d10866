/* SPDX-License-Identifier: MIT
 * Assembles a line byte by byte: drops spaces and comments but for a message, converts to upper case.
 */
#ifndef PASSO_GCODE_LINE_H
#define PASSO_GCODE_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Longest line, without spaces and comments, plus its terminator. */
#define PASSO_GCODE_LINE_SIZE 128u

/* Longest text of a message, plus its terminator; the rest is dropped. */
#define PASSO_GCODE_MESSAGE_SIZE 64u

struct passo_gcode_line {
	char text[PASSO_GCODE_LINE_SIZE];
#ifndef PASSO_PLAIN_GCODE
	char message[PASSO_GCODE_MESSAGE_SIZE]; /* of the last comment (MSG,...); empty: none */
	uint8_t said;                           /* its length */
	uint8_t begun;                          /* characters of `MSG,` at the beginning of the comment */
#endif
	uint8_t length;
	char comment; /* its first character; 0: outside */
	bool overflow;
};

/* Starts an empty line. */
void passo_gcode_line_clear(struct passo_gcode_line *line);

/* Whether a byte ends a line: LF or CR. CR LF ends two lines, the second one empty. */
bool passo_gcode_line_ends(char byte);

/* Bytes of the first line of a text, with its end: LF, CR, CR LF, or that of the text. */
size_t passo_gcode_line_count(const char *text, size_t count);

/* Adds a byte that does not end the line. Comments are (...) and ;... to the end of the line. Spaces and
 * control characters are dropped; any other byte is kept, so that an invalid line is rejected. */
void passo_gcode_line_add(struct passo_gcode_line *line, char byte);

/* Reads the first line of a text, skipping a byte order mark. */
void passo_gcode_line_read(struct passo_gcode_line *line, const char *text, size_t count);

#endif
