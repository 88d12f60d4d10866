/* SPDX-License-Identifier: MIT
 * The driver's wire: it flips bits, loses and doubles clocks, cuts frames, and dies.
 */
#ifndef SOAK_BRIDGE_WIRE_H
#define SOAK_BRIDGE_WIRE_H

#include "bridge.h"

struct wire {
	struct world *world;
	struct plot_random *random;
	struct bridge_counts *counts;
	uint32_t one_in;  /* a bit in so many is flipped; 0: none */
	uint32_t worse;   /* percent of the frames with a lost or doubled clock, or cut */
	uint32_t dies_in; /* frames until the wire dies; 0: it does not */
	uint32_t dies_at; /* in that frame, at this bit */
	bool dead, level; /* of MISO when dead */
};

/* Of struct passo_hardware; the context is a struct wire. */
bool wire_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words);

#endif
