/* SPDX-License-Identifier: MIT
 * Words: a letter and a number. G and M are commands, all others are values.
 */
#include "passo_gcode_block.h"

#include <stddef.h>

#define INTEGER_MAX UINT32_C(999999999)
#define PLACES 6u
#define TENTH (PASSO_GCODE_MILLION / 10u)

/* Properties of a command. */
#define AXIS_WORDS 1u /* the axis words are its own, if there are any */
#define TENTHS 2u     /* there are others of the same number and a fraction, though not all are known */

struct code {
	int16_t number; /* tenths */
	uint8_t group;
	uint8_t properties;
};

static const struct code G_CODES[] = {
    {0, PASSO_GCODE_MOTION, AXIS_WORDS},
    {10, PASSO_GCODE_MOTION, AXIS_WORDS},
    {20, PASSO_GCODE_MOTION, AXIS_WORDS},
    {30, PASSO_GCODE_MOTION, AXIS_WORDS},
    {40, PASSO_GCODE_COMMAND, 0},
#ifndef PASSO_PLAIN_GCODE
    {70, PASSO_GCODE_DIAMETER, 0},
    {80, PASSO_GCODE_DIAMETER, 0},
#endif
    {100, PASSO_GCODE_COMMAND, AXIS_WORDS},
    {170, PASSO_GCODE_PLANE, 0},
    {180, PASSO_GCODE_PLANE, 0},
    {190, PASSO_GCODE_PLANE, 0},
    {200, PASSO_GCODE_UNITS, 0},
    {210, PASSO_GCODE_UNITS, 0},
    {280, PASSO_GCODE_COMMAND, AXIS_WORDS | TENTHS},
    {281, PASSO_GCODE_COMMAND, TENTHS},
    {300, PASSO_GCODE_COMMAND, AXIS_WORDS | TENTHS},
    {301, PASSO_GCODE_COMMAND, TENTHS},
#ifndef PASSO_WITHOUT_THREADS
    {330, PASSO_GCODE_MOTION, AXIS_WORDS | TENTHS},
    {331, PASSO_GCODE_MOTION, AXIS_WORDS | TENTHS},
#endif
    {382, PASSO_GCODE_MOTION, AXIS_WORDS | TENTHS},
    {383, PASSO_GCODE_MOTION, AXIS_WORDS | TENTHS},
    {384, PASSO_GCODE_MOTION, AXIS_WORDS | TENTHS},
    {385, PASSO_GCODE_MOTION, AXIS_WORDS | TENTHS},
    {400, PASSO_GCODE_CUTTER, 0},
#ifndef PASSO_PLAIN_GCODE
    {430, PASSO_GCODE_TOOL_LENGTH, TENTHS},
    {432, PASSO_GCODE_TOOL_LENGTH, TENTHS},
#endif
    {431, PASSO_GCODE_TOOL_LENGTH, AXIS_WORDS | TENTHS},
    {490, PASSO_GCODE_TOOL_LENGTH, 0},
    {530, PASSO_GCODE_COMMAND, 0},
    {540, PASSO_GCODE_SYSTEM, 0},
    {550, PASSO_GCODE_SYSTEM, 0},
    {560, PASSO_GCODE_SYSTEM, 0},
    {570, PASSO_GCODE_SYSTEM, 0},
    {580, PASSO_GCODE_SYSTEM, 0},
    {590, PASSO_GCODE_SYSTEM, 0},
    {610, PASSO_GCODE_PATH, TENTHS},
    {611, PASSO_GCODE_PATH, TENTHS},
    {640, PASSO_GCODE_PATH, TENTHS},
    {730, PASSO_GCODE_MOTION, AXIS_WORDS},
    {800, PASSO_GCODE_MOTION, 0},
    {810, PASSO_GCODE_MOTION, AXIS_WORDS},
    {820, PASSO_GCODE_MOTION, AXIS_WORDS},
    {830, PASSO_GCODE_MOTION, AXIS_WORDS},
    {850, PASSO_GCODE_MOTION, AXIS_WORDS},
    {860, PASSO_GCODE_MOTION, AXIS_WORDS},
    {890, PASSO_GCODE_MOTION, AXIS_WORDS},
    {900, PASSO_GCODE_DISTANCE, TENTHS},
    {910, PASSO_GCODE_DISTANCE, TENTHS},
    {911, PASSO_GCODE_ARC_DISTANCE, TENTHS},
    {920, PASSO_GCODE_COMMAND, AXIS_WORDS | TENTHS},
    {921, PASSO_GCODE_COMMAND, TENTHS},
    {930, PASSO_GCODE_FEED_MODE, 0},
    {940, PASSO_GCODE_FEED_MODE, 0},
#ifndef PASSO_PLAIN_GCODE
    {950, PASSO_GCODE_FEED_MODE, 0},
    {960, PASSO_GCODE_SURFACE, 0},
    {970, PASSO_GCODE_SURFACE, 0},
#endif
    {980, PASSO_GCODE_RETRACT, 0},
    {990, PASSO_GCODE_RETRACT, 0},
};

static const struct code M_CODES[] = {
    {0, PASSO_GCODE_PROGRAM, 0},
    {10, PASSO_GCODE_PROGRAM, 0},
    {20, PASSO_GCODE_PROGRAM, 0},
    {30, PASSO_GCODE_SPINDLE, 0},
    {40, PASSO_GCODE_SPINDLE, 0},
    {50, PASSO_GCODE_SPINDLE, 0},
#ifndef PASSO_PLAIN_GCODE
    {60, PASSO_GCODE_TOOL_CHANGE, 0},
    {610, PASSO_GCODE_TOOL_CHANGE, 0},
    {620, PASSO_GCODE_PORT, 0},
    {630, PASSO_GCODE_PORT, 0},
    {640, PASSO_GCODE_PORT, 0},
    {650, PASSO_GCODE_PORT, 0},
    {660, PASSO_GCODE_PORT, 0},
    {670, PASSO_GCODE_PORT, 0},
    {680, PASSO_GCODE_PORT, 0},
#endif
    {70, PASSO_GCODE_COOLANT, 0},
    {80, PASSO_GCODE_COOLANT, 0},
    {90, PASSO_GCODE_COOLANT, 0},
    {300, PASSO_GCODE_PROGRAM, 0},
};

#define COUNT(table) (sizeof(table) / sizeof *(table))

static const char AXIS_LETTERS[PASSO_GCODE_AXES_MAX + 1u] = "XYZABC";
/* Those of values that every machine knows. */
#ifdef PASSO_PLAIN_GCODE
#define MORE_WORDS 0u
#else
#define MORE_WORDS (PASSO_GCODE_WORD('D') | PASSO_GCODE_WORD('E') | PASSO_GCODE_WORD('H'))
#endif
static const uint32_t VALUE_WORDS = MORE_WORDS | PASSO_GCODE_WORD('F') | PASSO_GCODE_WORD('I')
                                  | PASSO_GCODE_WORD('J') | PASSO_GCODE_WORD('K') | PASSO_GCODE_WORD('L')
                                  | PASSO_GCODE_WORD('N') | PASSO_GCODE_WORD('P') | PASSO_GCODE_WORD('Q')
                                  | PASSO_GCODE_WORD('R') | PASSO_GCODE_WORD('S') | PASSO_GCODE_WORD('T');
static const uint32_t POSITIVE_WORDS = MORE_WORDS | PASSO_GCODE_WORD('F') | PASSO_GCODE_WORD('N')
                                     | PASSO_GCODE_WORD('P') | PASSO_GCODE_WORD('Q') | PASSO_GCODE_WORD('S')
                                     | PASSO_GCODE_WORD('T');

#ifdef PASSO_PLAIN_GCODE
char passo_gcode_axis_letter(uint8_t left_out, unsigned axis)
{
	(void)left_out;
	return AXIS_LETTERS[axis];
}
#else
char passo_gcode_axis_letter(uint8_t left_out, unsigned axis)
{
	unsigned at = 0;

	for (; at + 1u < PASSO_GCODE_AXES_MAX; at++) {
		if ((left_out >> at & 1) == 0 && axis-- == 0)
			break;
	}
	return AXIS_LETTERS[at];
}
#endif

uint32_t passo_gcode_axis_words(uint8_t left_out, unsigned axes)
{
	uint32_t words = 0;

	for (unsigned axis = 0; axis < axes; axis++)
		words |= PASSO_GCODE_WORD(passo_gcode_axis_letter(left_out, axis));
	return words;
}

static bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

bool passo_gcode_number(const char **text, int64_t *millionths)
{
	const char *at = *text;
	const bool negative = *at == '-';
	uint32_t whole = 0, fraction = 0, places = 0;

	if (*at == '-' || *at == '+')
		at++;
	if (!is_digit(*at) && !(*at == '.' && is_digit(at[1])))
		return false;
	for (; is_digit(*at); at++) {
		if (whole > INTEGER_MAX / 10)
			return false;
		whole = 10 * whole + (uint32_t)(*at - '0');
	}
	if (*at == '.') {
		for (at++; is_digit(*at); at++, places++) {
			if (places < PLACES)
				fraction = 10 * fraction + (uint32_t)(*at - '0');
			else if (places == PLACES && *at >= '5')
				fraction++;
		}
	}
	for (; places < PLACES; places++)
		fraction *= 10;
	*text = at;
	*millionths = (int64_t)whole * PASSO_GCODE_MILLION + fraction;
	if (negative)
		*millionths = -*millionths;
	return true;
}

/* G80 with another motion in the line only ends the one in force. */
static enum passo_gcode_error add_code(struct passo_gcode_block *block, const struct code *code)
{
	passo_gcode_command *given = &block->command[code->group];

	if (code->properties & AXIS_WORDS) {
		if (block->takes_axes)
			return PASSO_GCODE_TWO_COMMANDS;
		block->takes_axes = true;
	}
	if (*given != PASSO_GCODE_NONE && code->number == PASSO_GCODE_G(80, 0))
		return PASSO_GCODE_OK;
	if (*given != PASSO_GCODE_NONE && *given != PASSO_GCODE_G(80, 0))
		return PASSO_GCODE_MODAL_GROUP;
	*given = code->number;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error add_command(
    struct passo_gcode_block *block, const struct code *table, size_t count, int64_t value)
{
	const uint32_t millionths = (uint32_t)value;
	const bool every = table == M_CODES && millionths % PASSO_GCODE_MILLION != 0;
	enum passo_gcode_error error = every ? PASSO_GCODE_NOT_INTEGER : PASSO_GCODE_UNSUPPORTED;

	if (value >> 32 != 0) /* far above the largest one, or negative */
		return PASSO_GCODE_UNSUPPORTED;
	for (size_t i = 0; i < count; i++) {
		const uint32_t tenths = (uint32_t)table[i].number;

		if (tenths * TENTH == millionths)
			return add_code(block, &table[i]);
		if (tenths / 10 == millionths / PASSO_GCODE_MILLION && !(table[i].properties & TENTHS))
			error = PASSO_GCODE_NOT_INTEGER;
	}
	return error;
}

static enum passo_gcode_error add_value(
    struct passo_gcode_block *block, uint32_t known, char letter, int64_t value)
{
	const uint32_t word = PASSO_GCODE_WORD(letter);

	if (!(known & word))
		return PASSO_GCODE_UNSUPPORTED;
	if (block->words & word)
		return PASSO_GCODE_REPEATED;
	if (value < 0 && (POSITIVE_WORDS & word))
		return PASSO_GCODE_NEGATIVE;
	block->words |= word;
	block->value[letter - 'A'] = value;
	return PASSO_GCODE_OK;
}

/* The axis words are those of G49, as in grbl; without any, other commands may be in its line. */
static enum passo_gcode_error mind_g49(struct passo_gcode_block *block, uint32_t axis_words)
{
	if (block->command[PASSO_GCODE_TOOL_LENGTH] != PASSO_GCODE_G(49, 0) || !(block->words & axis_words))
		return PASSO_GCODE_OK;
	if (block->takes_axes)
		return PASSO_GCODE_TWO_COMMANDS;
	block->takes_axes = true;
	return PASSO_GCODE_OK;
}

enum passo_gcode_error passo_gcode_parse(
    const char *text, uint32_t axis_words, struct passo_gcode_block *block)
{
	const uint32_t known = VALUE_WORDS | axis_words;
	enum passo_gcode_error error = PASSO_GCODE_OK;

	*block = (struct passo_gcode_block){.words = 0};
	for (unsigned group = 0; group < PASSO_GCODE_GROUPS; group++)
		block->command[group] = PASSO_GCODE_NONE;
	if (*text == '/')
		text++;
	if (text[0] == '%' && text[1] == '\0')
		return PASSO_GCODE_OK;
	while (*text != '\0' && error == PASSO_GCODE_OK) {
		const char letter = *text++;
		int64_t value = 0;

		if (letter < 'A' || letter > 'Z')
			return PASSO_GCODE_LETTER;
		if (!passo_gcode_number(&text, &value))
			return PASSO_GCODE_NUMBER;
		if (letter == 'G')
			error = add_command(block, G_CODES, COUNT(G_CODES), value);
		else if (letter == 'M')
			error = add_command(block, M_CODES, COUNT(M_CODES), value);
		else
			error = add_value(block, known, letter, value);
	}
	return error == PASSO_GCODE_OK ? mind_g49(block, axis_words) : error;
}
