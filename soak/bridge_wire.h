/* SPDX-License-Identifier: MIT
 * The link of the driver, with bit errors, lost and doubled clocks, cut frames, and failure.
 */
#ifndef SOAK_BRIDGE_WIRE_H
#define SOAK_BRIDGE_WIRE_H

#include "bridge.h"

struct wire {
	struct world *world;
	struct plot_random *random;
	struct bridge_counts *counts;
	uint32_t one_in;  /* one bit in one_in is flipped; 0: none */
	uint32_t worse;   /* percentage of frames with a lost or doubled clock, or cut */
	uint32_t dies_in; /* frames until the link dies; 0: never */
	uint32_t dies_at; /* bit of that frame at which it dies */
	bool dead, level; /* of MISO when dead */
};

/* passo_hardware.transfer; the context is a struct wire. */
bool wire_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words);

#endif
