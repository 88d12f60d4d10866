/* SPDX-License-Identifier: MIT */
#include "passo_say.h"

#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#define PIECE 32u      /* literal characters that are written at a time */
#define QUOTED_MAX 40u /* characters of a quoted value */
#define NUMBER_SIZE 24u

static void say_text(const struct passo_sink *sink, const char *text)
{
	sink->write(sink->context, text);
}

static void say_char(const struct passo_sink *sink, char c)
{
	const char text[2] = {c, '\0'};

	say_text(sink, text);
}

/* With a minimum number of digits. */
static void say_number(const struct passo_sink *sink, uint64_t number, unsigned digits)
{
	char text[NUMBER_SIZE];
	unsigned at = NUMBER_SIZE - 1u;

	text[at] = '\0';
	do {
		text[--at] = (char)('0' + number % 10u);
		number /= 10u;
	} while (number != 0u || NUMBER_SIZE - 1u - at < digits);
	say_text(sink, text + at);
}

static void say_hexadecimal(const struct passo_sink *sink, uint32_t number)
{
	for (unsigned shift = 32; shift > 0u; shift -= 4u)
		say_char(sink, "0123456789ABCDEF"[number >> (shift - 4u) & 0xFu]);
}

static uint64_t say_sign(const struct passo_sink *sink, int64_t number)
{
	if (number < 0)
		say_char(sink, '-');
	return number < 0 ? 0u - (uint64_t)number : (uint64_t)number;
}

static void say_thousandths(const struct passo_sink *sink, int64_t number)
{
	uint64_t amount = say_sign(sink, number);

	say_number(sink, amount / 1000u, 1u);
	say_char(sink, '.');
	say_number(sink, amount % 1000u, 3u);
}

static void say_quoted(const struct passo_sink *sink, const char *text, size_t length)
{
	say_char(sink, '\'');
	for (unsigned i = 0; i < length; i++) {
		if (i == QUOTED_MAX) {
			say_text(sink, "...");
			break;
		}
		say_char(sink, text[i]);
	}
	say_char(sink, '\'');
}

static void say_list(const struct passo_sink *sink, const char *format, va_list *values)
{
	char piece[PIECE + 1u];
	unsigned length = 0;
	const char *text;

	for (;; format++) {
		if (*format != '%' && *format != '\0' && length < PIECE) {
			piece[length++] = *format;
			continue;
		}
		piece[length] = '\0';
		say_text(sink, piece);
		length = 0;
		if (*format == '\0')
			break;
		if (*format != '%') {
			piece[length++] = *format;
			continue;
		}
		switch (*++format) {
		case 's':
			say_text(sink, va_arg(*values, const char *));
			break;
		case 'q':
			text = va_arg(*values, const char *);
			say_quoted(sink, text, strlen(text));
			break;
		case 'Q':
			text = va_arg(*values, const char *);
			say_quoted(sink, text, va_arg(*values, uint32_t));
			break;
		case 'u':
			say_number(sink, va_arg(*values, uint32_t), 1u);
			break;
		case 'x':
			say_hexadecimal(sink, va_arg(*values, uint32_t));
			break;
		case 'd':
			say_number(sink, say_sign(sink, va_arg(*values, int32_t)), 1u);
			break;
		case 'm':
			say_thousandths(sink, va_arg(*values, int64_t));
			break;
		default:
			say_char(sink, *format);
		}
	}
}

void passo_say(const struct passo_sink *sink, const char *format, ...)
{
	va_list values;

	va_start(values, format);
	say_list(sink, format, &values);
	va_end(values);
}

bool passo_complain(const struct passo_sink *sink, const char *format, ...)
{
	va_list values;

	say_text(sink, "error: ");
	va_start(values, format);
	say_list(sink, format, &values);
	va_end(values);
	say_text(sink, "\n");
	return false;
}
