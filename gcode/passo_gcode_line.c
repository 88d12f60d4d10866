/* SPDX-License-Identifier: MIT */
#include "passo_gcode_line.h"

void passo_gcode_line_clear(struct passo_gcode_line *line)
{
	line->text[0] = '\0';
	line->length = 0;
	line->comment = '\0';
	line->overflow = false;
}

void passo_gcode_line_add(struct passo_gcode_line *line, char byte)
{
	if (line->comment != '\0') {
		if (line->comment == '(' && byte == ')')
			line->comment = '\0';
		return;
	}
	if (byte == '(' || byte == ';') {
		line->comment = byte;
		return;
	}
	if (byte == ' ' || byte == '\t' || byte == '\r')
		return;
	if (line->length + 1u == PASSO_GCODE_LINE_SIZE) {
		line->overflow = true;
		return;
	}
	if (byte >= 'a' && byte <= 'z')
		byte = (char)(byte - 'a' + 'A');
	line->text[line->length++] = byte == '\0' ? '?' : byte;
	line->text[line->length] = '\0';
}

void passo_gcode_line_read(struct passo_gcode_line *line, const char *text, size_t count)
{
	passo_gcode_line_clear(line);
	for (size_t i = 0; i < count && text[i] != '\n'; i++)
		passo_gcode_line_add(line, text[i]);
}
