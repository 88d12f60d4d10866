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
#ifndef PASSO_PLAIN_GCODE
	line->message[0] = '\0';
	line->said = 0;
#endif
}

static char upper(char byte)
{
	return byte >= 'a' && byte <= 'z' ? (char)(byte - 'a' + 'A') : byte;
}

#ifdef PASSO_PLAIN_GCODE
static void begin_comment(struct passo_gcode_line *line)
{
	(void)line;
}

static void add_to_comment(struct passo_gcode_line *line, char byte)
{
	(void)line, (void)byte;
}
#else
static const char MARK[] = "MSG,";
#define MARKED (sizeof MARK - 1u)
#define NO_MESSAGE UINT8_MAX

static void begin_comment(struct passo_gcode_line *line)
{
	line->begun = line->comment == '(' ? 0 : NO_MESSAGE;
}

/* Spaces before the mark and before the text do not count. */
static void add_to_comment(struct passo_gcode_line *line, char byte)
{
	if (line->begun < MARKED && byte != ' ') {
		line->begun = upper(byte) == MARK[line->begun] ? (uint8_t)(line->begun + 1u) : NO_MESSAGE;
		line->said = line->begun == MARKED ? 0 : line->said;
		line->message[line->said] = '\0';
	} else if (line->begun == MARKED && (unsigned char)byte >= ' ' && (line->said > 0 || byte != ' ')
	           && line->said + 1u < PASSO_GCODE_MESSAGE_SIZE) {
		line->message[line->said++] = byte;
		line->message[line->said] = '\0';
	}
}
#endif

void passo_gcode_line_add(struct passo_gcode_line *line, char byte)
{
	if (line->comment != '\0') {
		if (line->comment == '(' && byte == ')')
			line->comment = '\0';
		else
			add_to_comment(line, byte);
		return;
	}
	if (byte == '(' || byte == ';') {
		line->comment = byte;
		begin_comment(line);
		return;
	}
	if ((unsigned char)byte <= ' ')
		return;
	if (line->length + 1u == PASSO_GCODE_LINE_SIZE) {
		line->overflow = true;
		return;
	}
	line->text[line->length++] = upper(byte);
	line->text[line->length] = '\0';
}

void passo_gcode_line_read(struct passo_gcode_line *line, const char *text, size_t count)
{
	const bool mark = count >= 3 && text[0] == '\xEF' && text[1] == '\xBB' && text[2] == '\xBF';

	passo_gcode_line_clear(line);
	for (size_t i = mark ? 3 : 0; i < count && !passo_gcode_line_ends(text[i]); i++)
		passo_gcode_line_add(line, text[i]);
}
