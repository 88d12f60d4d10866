/* SPDX-License-Identifier: MIT
 * The values of keys in words: in the help, and those that are one of some words.
 */
#include <string.h>

#include "passo_plan.h"
#include "passo_value.h"

/* The value of a key in the help; of those that are one of some
 * words, all of them in the order of their numbers. */
static const char *const PLACEHOLDERS[] = {
    [PASSO_READ_NOTHING] = "name",
    [PASSO_READ_WHOLE] = "n",
    [PASSO_READ_FLAG] = "0|1",
    [PASSO_READ_FLOW] = PASSO_FLOW_WAIT "|" PASSO_FLOW_REFUSE,
    [PASSO_READ_AXIS] = "axis",
    [PASSO_READ_CHANNEL] = "n",
    [PASSO_READ_AXES] = "n",
    [PASSO_READ_STEPS] = "n,..",
    [PASSO_READ_NUMBER] = "x",
    [PASSO_READ_SIGNED] = "x",
    [PASSO_READ_TIME] = "time",
    [PASSO_READ_PIN_TIME] = "time",
    [PASSO_READ_MICROSECONDS] = "time",
    [PASSO_READ_ALPHA] = "x",
    [PASSO_READ_DISTANCE] = "x,..",
    [PASSO_READ_PER_AXIS] = "x[,..]",
    [PASSO_READ_PROFILE] = PASSO_PROFILES_CHOICE,
    [PASSO_READ_SHAPE] = PASSO_PROFILES_CHOICE "|" PASSO_USER_PROFILE,
    [PASSO_READ_POINTS] = "n,..(16)",
    [PASSO_READ_INTEGER] = "n",
    [PASSO_READ_LEVEL] = "none|active_high|active_low",
    [PASSO_READ_SOURCE] = "none|limit_low|limit_high|home|probe|index",
    [PASSO_READ_EDGE] = "rising|falling",
    [PASSO_READ_ACTION] = "latch|soft_stop|hard_stop|end_endless",
#ifndef PASSO_WITHOUT_PARTS
    [PASSO_READ_STOP] = "none|soft|hard",
    [PASSO_READ_RASTER] = "n,..",
#endif
};

/* The length of the first word of some. */
static size_t word_length(const char *words)
{
	return strcspn(words, "|");
}

bool passo_value_choose(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint8_t *choice)
{
	const char *words = PLACEHOLDERS[key->reader];

	for (*choice = 0;; (*choice)++) {
		const size_t length = word_length(words);

		if (strlen(text) == length && memcmp(text, words, length) == 0)
			return true;
		if (words[length] == '\0')
			break;
		words += length + 1u;
	}
	return passo_complain(
	    reading->sink, "%s must be one of %s, not %q", key->name, PLACEHOLDERS[key->reader], text);
}

void passo_value_say(const struct passo_sink *sink, enum passo_reader reader, uint8_t choice)
{
	const char *words = PLACEHOLDERS[reader];
	size_t length;

	for (length = word_length(words); choice > 0u; choice--, length = word_length(words))
		words += length + 1u;
	for (; length > 0u; length--, words++)
		passo_say(sink, "%s", (const char[]){*words, '\0'});
}

const char *passo_value_placeholder(enum passo_reader reader)
{
	return PLACEHOLDERS[reader];
}
