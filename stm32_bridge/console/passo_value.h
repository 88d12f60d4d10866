/* SPDX-License-Identifier: MIT
 * Internal: the value of a key: a number or time, a list of them, or a profile.
 */
#ifndef PASSO_VALUE_H
#define PASSO_VALUE_H

#include "passo_keys.h"

#define PASSO_FLOW_WAIT "wait"
#define PASSO_FLOW_REFUSE "refuse"

/* Reads a value into its member of a struct. Prints an error and returns false if it is invalid. */
bool passo_value_read(
    struct passo_reading *reading, const struct passo_key *key, const char *text, void *values);

/* Reads a value that is one of some words. */
bool passo_value_choose(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint8_t *choice);

/* Name of a flow. */
const char *passo_value_flow(bool waits);

/* Prints the word of a value that is one of some. */
void passo_value_say(const struct passo_sink *sink, enum passo_reader reader, uint8_t choice);

/* Placeholder of a value in the help. */
const char *passo_value_placeholder(enum passo_reader reader);

#endif
