/* SPDX-License-Identifier: MIT
 * Internal: quiet time of a channel, for passo_advance.c.
 */
#ifndef PASSO_ADVANCE_H
#define PASSO_ADVANCE_H

#include "passo_model.h"

static inline uint64_t passo_advance_least(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

/* Clocks for which everything in the channel is quiet, except what a running profile changes. */
uint64_t passo_advance_surroundings_quiet(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew);
/* Whether no substep is in flight between path and DDA. */
bool passo_advance_slots_empty(const struct passo_channel *channel);

/* Whether a profile is running and its clock enable is on. */
bool passo_advance_profile_counts(const struct passo_channel *channel);
/* Clocks to the next event of a running profile, within its tick. */
uint64_t passo_advance_profile_quiet(
    const struct passo_channel *channel, const struct passo_parameters *parameters, uint64_t limit);
/* Clocks for which the whole channel is quiet, and skipping them. */
uint64_t passo_advance_channel_quiet(const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew, uint64_t limit);
void passo_advance_channel_skip(struct passo_channel *channel, uint64_t clocks);
/* Skips whole ticks without events, from a point in a tick at which the next velocity is ready to the same
 * point in a later tick of the same ramp. Returns the clocks. */
uint64_t passo_advance_skip_ticks(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit);

#endif
