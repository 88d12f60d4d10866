/* SPDX-License-Identifier: MIT
 * The link of the driver, with bit errors, lost and doubled clocks, cut frames, and failure.
 */
#ifndef SOAK_BRIDGE_WIRE_H
#define SOAK_BRIDGE_WIRE_H

#include "bridge.h"
#include "passo_host.h"

struct wire {
	struct world *world;
	struct scenario_random *random;
	struct bridge_counts *counts;
	uint32_t one_in;  /* one bit in one_in is flipped; 0: none */
	uint32_t worse;   /* percentage of frames with a lost or doubled clock, or cut */
	uint32_t dies_in; /* frames until the link fails; 0: never */
	uint32_t dies_at; /* bit of that frame at which it dies */
	bool dead, level; /* of MISO when dead */
	/* an exchange in two halves */
	const uint32_t *send;
	uint32_t *receive;
	size_t words;  /* 0: none is under way */
	uint32_t left; /* calls of `finish` until it is over */
	uint32_t spare[PASSO_FRAME_WORDS_MAX];
};

/* passo_hardware.transfer; the context is a struct wire. */
bool wire_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words);
/* `start` and `finish`; an exchange is over after some calls. */
bool wire_start(void *context, const uint32_t *send, uint32_t *receive, size_t words);
enum passo_error wire_finish(void *context);

#endif
