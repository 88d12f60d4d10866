/* SPDX-License-Identifier: MIT */
#include "passo_gcode_line.h"

bool passo_gcode_line_ends(char byte)
{
	return byte == '\n' || byte == '\r';
}

size_t passo_gcode_line_count(const char *text, size_t count)
{
	size_t i = 0;

	while (i < count && !passo_gcode_line_ends(text[i]))
		i++;
	if (i == count)
		return count;
	return text[i] == '\r' && i + 1 < count && text[i + 1] == '\n' ? i + 2 : i + 1;
}

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
	if ((unsigned char)byte <= ' ')
		return;
	if (line->length + 1u == PASSO_GCODE_LINE_SIZE) {
		line->overflow = true;
		return;
	}
	if (byte >= 'a' && byte <= 'z')
		byte = (char)(byte - 'a' + 'A');
	line->text[line->length++] = byte;
	line->text[line->length] = '\0';
}

void passo_gcode_line_read(struct passo_gcode_line *line, const char *text, size_t count)
{
	const bool mark = count >= 3 && text[0] == '\xEF' && text[1] == '\xBB' && text[2] == '\xBF';

	passo_gcode_line_clear(line);
	for (size_t i = mark ? 3 : 0; i < count && !passo_gcode_line_ends(text[i]); i++)
		passo_gcode_line_add(line, text[i]);
}
