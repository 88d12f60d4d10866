/* SPDX-License-Identifier: MIT
 * Internal: numbers and times, checked against their limits and converted to the units of driver and planner.
 */
#ifndef PASSO_NUMBER_H
#define PASSO_NUMBER_H

#include "passo_keys.h"

/* An item of a list. */
struct passo_item {
	const char *text;
	size_t length;
};

/* Each prints an error and returns false if the text is not a valid value of the key. */

/* Unsigned, times a factor, rounded to nearest. */
bool passo_number_read(const struct passo_reading *reading, const struct passo_key *key,
    struct passo_item item, uint64_t factor, uint64_t *value);

/* Q31.32 */
bool passo_number_signed(
    const struct passo_reading *reading, const struct passo_key *key, struct passo_item item, int64_t *value);

bool passo_number_whole(const struct passo_reading *reading, const struct passo_key *key,
    struct passo_item item, uint32_t low, uint32_t high, uint32_t *value);

/* In clocks, rounded to nearest, or up. */
bool passo_number_time(const struct passo_reading *reading, const struct passo_key *key, const char *text,
    bool round_up, uint64_t *clocks);

/* Rounded to nearest; saturates. */
bool passo_number_microseconds(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint32_t *value);

/* In clocks, rounded up, 1 .. PASSO_PIN_CLOCKS_MAX. */
bool passo_number_pin_time(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint32_t *value);

#endif
