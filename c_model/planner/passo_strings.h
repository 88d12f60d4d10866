/* SPDX-License-Identifier: MIT
 * Strings one behind the other, which take less flash than a pointer to each, from a list of X(name, text) in
 * the order of the codes. Names and texts are apart: a program that says only names does not have the texts.
 */
#ifndef PASSO_STRINGS_H
#define PASSO_STRINGS_H

#define PASSO_STRING_NAME(name, text) #name "\0"
#define PASSO_STRING_TEXT(name, text) text "\0"

/* A member of a struct for each: its offset is the number of the string. */
#define PASSO_STRING_PLACE(name, text) char name;

static inline const char *passo_string(const char *strings, unsigned number)
{
	for (; number > 0; strings++)
		number -= *strings == '\0';
	return strings;
}

#endif
