/* SPDX-License-Identifier: MIT
 * Plays histories with mutants of a Verilated core, of which only the judge knows what is right.
 */
#ifndef SOAK_MUTANTS_H
#define SOAK_MUTANTS_H

#include "world.h"

/* Reads the numbers of the mutants from standard input. */
bool mutants_read(struct world_mutants *mutants);
/* Plays the present history with each of them: true in the process of a mutant, which continues with it,
 * false in the first process when all have played; those that were killed are removed. */
bool mutants_fork(struct world *world, uint64_t number);
/* Ends the process of a mutant with what the world and its judge have found. */
void mutants_end(const struct world *world) __attribute__((noreturn));

#endif
