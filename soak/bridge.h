/* SPDX-License-Identifier: MIT
 * Histories through the driver (stm32_bridge/driver) over a wire that flips bits, loses and doubles clocks,
 * cuts frames, or dies in the middle of a call: every move is made exactly once or the driver says that it is
 * broken, and a stop, an abort or a hold takes place however often it has to be sent.
 */
#ifndef SOAK_BRIDGE_H
#define SOAK_BRIDGE_H

#include "plot.h"

/* Its set of parameters. */
#define BRIDGE_SET 2u

struct bridge_counts {
	uint64_t frames, retries, flips, lost, doubled, cuts, deaths;
	uint64_t moves, lines, stops, steps, errors;
	uint64_t clocks;
};

void bridge_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    FILE *print, struct bridge_counts *counts);

#endif
