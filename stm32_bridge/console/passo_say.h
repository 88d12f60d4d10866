/* SPDX-License-Identifier: MIT
 * Internal: formatted output without buffer, heap or printf.
 */
#ifndef PASSO_SAY_H
#define PASSO_SAY_H

#include <stdbool.h>
#include <stdint.h>

/* Destination of text. */
struct passo_sink {
	void (*write)(void *context, const char *text);
	void *context;
};

/* Like printf, with %s (const char *), %q (the same in quotes, truncated if long), %Q (const char *, uint32_t
 * length: the same for part of a text), %u (uint32_t), %x (uint32_t, 8 hexadecimal digits), %d (int32_t), %m
 * (int64_t in thousandths, three decimal places) and %%. */
void passo_say(const struct passo_sink *sink, const char *format, ...);

/* Prints "error: ..." with its end of line. Returns false. */
bool passo_complain(const struct passo_sink *sink, const char *format, ...);

#endif
