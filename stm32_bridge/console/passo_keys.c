/* SPDX-License-Identifier: MIT */
#include "passo_keys.h"

#include <string.h>

#include "passo_value.h"

static bool is_blank(char c)
{
	return c == ' ' || c == '\t';
}

bool passo_words_split(const struct passo_sink *sink, char *text, struct passo_words *words)
{
	words->count = 0;
	for (;;) {
		while (is_blank(*text))
			text++;
		if (*text == '\0')
			return true;
		if (words->count == PASSO_WORDS_MAX)
			return passo_complain(sink, "more than %u words", (uint32_t)PASSO_WORDS_MAX);
		words->word[words->count].key = "";
		words->word[words->count].value = text;
		for (; *text != '\0' && !is_blank(*text); text++) {
			if (*text == '=' && *words->word[words->count].key == '\0') {
				*text = '\0';
				words->word[words->count].key = words->word[words->count].value;
				words->word[words->count].value = text + 1;
				if (*words->word[words->count].key == '\0')
					return passo_complain(sink, "missing key before =");
			}
		}
		if (*text != '\0')
			*text++ = '\0';
		words->count++;
	}
}

const char *passo_words_find(const struct passo_words *words, const char *key)
{
	for (unsigned i = 0; i < words->count; i++) {
		if (strcmp(words->word[i].key, key) == 0)
			return words->word[i].value;
	}
	return NULL;
}

int passo_key_find(const struct passo_key *keys, unsigned count, const char *name)
{
	for (unsigned i = 0; i < count; i++) {
		if (strcmp(keys[i].name, name) == 0)
			return (int)i;
	}
	return -1;
}

static bool complain_unknown(
    const struct passo_sink *sink, const struct passo_key *keys, unsigned count, const char *name)
{
	passo_say(sink, "error: unknown key %q; must be one of ", name);
	for (unsigned i = 0; i < count; i++)
		passo_say(sink, "%s%s", i == 0u ? "" : ", ", keys[i].name);
	passo_say(sink, "\n");
	return false;
}

bool passo_keys_check(const struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    unsigned bare, struct passo_words *words)
{
	for (unsigned i = 0, used = 0; i < words->count; i++) {
		const char *name = words->word[i].key;

		if (*name == '\0') {
			if (used == bare)
				return passo_complain(
				    reading->sink, "%q is not key=value", words->word[i].value);
			name = keys[used++].name;
		} else if (passo_key_find(keys, count, name) < 0) {
			if (count == 0u)
				return passo_complain(reading->sink, "key %q not allowed here", name);
			return complain_unknown(reading->sink, keys, count, name);
		}
		words->word[i].key = "";
		if (passo_words_find(words, name) != NULL)
			return passo_complain(reading->sink, "duplicate key %s", name);
		words->word[i].key = name;
	}
	return true;
}

bool passo_keys_read(struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    const struct passo_words *words, void *values)
{
	reading->given = 0;
	reading->axis = 0;
	reading->list_axes = 0;
	reading->user_shape = false;
	for (unsigned i = 0; i < count; i++) {
		const char *text = passo_words_find(words, keys[i].name);

		if (text != NULL) {
			reading->given |= UINT32_C(1) << i;
		} else {
			text = keys[i].otherwise;
			if (text == NULL)
				return passo_complain(reading->sink, "%s is missing", keys[i].name);
			if (passo_key_find(keys, count, text) >= 0)
				text = passo_words_find(words, text);
			if (text == NULL || *text == '\0')
				continue;
		}
		if (!passo_value_read(reading, &keys[i], text, values))
			return false;
	}
	return true;
}

void passo_keys_help(const struct passo_sink *sink, const struct passo_key *keys, unsigned count)
{
	for (unsigned i = 0; i < count; i++) {
		const char *otherwise = keys[i].otherwise;

		passo_say(sink, otherwise == NULL ? " %s=%s" : " [%s=%s", keys[i].name,
		    passo_value_placeholder(keys[i].reader));
		if (otherwise != NULL)
			passo_say(sink, *otherwise == '\0' ? "]" : ", or %s]", otherwise);
	}
}
