/* SPDX-License-Identifier: MIT
 * The value of a key: a number or time, a list of them, a profile.
 */
#ifndef PASSO_VALUE_H
#define PASSO_VALUE_H

#include "passo_keys.h"

/* Read a value into its place in a struct; complain and return false if it is wrong. */
bool passo_value_read(
    struct passo_reading *reading, const struct passo_key *key, const char *text, void *values);

/* What stands for a value in the help. */
const char *passo_value_placeholder(enum passo_reader reader);

#endif
