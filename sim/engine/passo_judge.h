/* SPDX-License-Identifier: MIT
 * Compares recorded pins of the core with the C model on every clock.
 *
 * A row has the clock, the inputs, MISO and the other outputs, each as uint64_t in the order of passo_pins.h:
 * as they stand just before that rising edge. There is a row for clock 1, the first one without reset, and
 * one for each clock before which a pin has changed.
 */
#ifndef PASSO_JUDGE_H
#define PASSO_JUDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_pins.h"

/* Bytes of a judge, which is aligned as a uint64_t. */
uint64_t judge_size(void);
/* False if there is no such core. */
bool judge_reset(void *judge, const struct passo_parameters *parameters);
/* Compares up to the clock `until`, which must not be before the last row. False at the first difference. */
bool judge_follow(void *judge, const void *rows, size_t count, uint64_t until);
/* Clock, number of the output (MISO is the last), expected and actual level. */
void judge_difference(const void *judge, uint64_t difference[4]);
/* For each output the edges that agree; then the bits of MISO. */
void judge_matched(const void *judge, uint64_t *matched);

#endif
