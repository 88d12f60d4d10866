/* SPDX-License-Identifier: MIT
 * Quiet time of a channel, for passo_advance.c.
 */
#ifndef PASSO_ADVANCE_H
#define PASSO_ADVANCE_H

#include "passo_model.h"

static inline uint64_t passo_advance_least(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

/* Clocks for which everything in the channel is quiet, but for what a running profile moves. */
uint64_t passo_advance_surroundings_quiet(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew);
/* Nothing is on its way from path to DDA. */
bool passo_advance_slots_empty(const struct passo_channel *channel);

/* A profile runs, and its rate lets it. */
bool passo_advance_profile_counts(const struct passo_channel *channel);
/* Clocks to the next event of a running profile, within its tick. */
uint64_t passo_advance_profile_quiet(
    const struct passo_channel *channel, const struct passo_parameters *parameters, uint64_t limit);
/* Clocks for which the whole channel is quiet, and jumping over them. */
uint64_t passo_advance_channel_quiet(const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew, uint64_t limit);
void passo_advance_channel_skip(struct passo_channel *channel, uint64_t clocks);
/* Jumps from one place in a tick to the same place in a later one, over ticks without any event; returns the
 * clocks. The place is one at which the next velocity is ready, and the ramp goes on. */
uint64_t passo_advance_skip_ticks(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit);

#endif
