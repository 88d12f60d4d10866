/* SPDX-License-Identifier: MIT
 * Histories through the driver (stm32_bridge/driver) over a link that flips bits, drops and doubles clocks,
 * cuts frames, or dies during a call. Every move is made exactly once, or the driver reports that it is
 * broken; a stop, an abort or a hold takes effect however often it has to be sent.
 */
#ifndef SOAK_BRIDGE_H
#define SOAK_BRIDGE_H

#include "scenario.h"

/* Parameter set of these histories. */
#define BRIDGE_SET 2u

struct bridge_counts {
	uint64_t frames, retries, flips, lost, doubled, cuts, deaths;
	uint64_t moves, lines, stops, steps, errors;
	uint64_t clocks;
};

void bridge_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    FILE *print, struct bridge_counts *counts);

#endif
