/* SPDX-License-Identifier: MIT
 * Text that goes out piece by piece: no buffer, no heap, no printf.
 */
#ifndef PASSO_SAY_H
#define PASSO_SAY_H

#include <stdbool.h>
#include <stdint.h>

/* Where text goes. */
struct passo_sink {
	void (*write)(void *context, const char *text);
	void *context;
};

/* Like printf, with %s (const char *), %q (the same in quotes, cut short if it is long), %Q (const char *,
 * uint32_t: so many characters of it in quotes), %u (uint32_t), %x (uint32_t, 8 hexadecimal digits), %d
 * (int32_t), %m (int64_t in thousandths, three decimals) and %%. */
void passo_say(const struct passo_sink *sink, const char *format, ...);

/* The answer "error: ..." with its end of line. Returns false. */
bool passo_complain(const struct passo_sink *sink, const char *format, ...);

#endif
