/* SPDX-License-Identifier: MIT
 * Plays pin waveforms to the model, clock by clock or with passo_core_advance().
 */
#ifndef CORE_PLAYER_H
#define CORE_PLAYER_H

#include <stddef.h>

#include "passo_core.h"

/* Constant inputs for a number of clocks. */
struct player_segment {
	uint64_t clocks;
	struct passo_inputs inputs;
	uint8_t spi_miso; /* filled in: the level at the end */
};

struct player {
	struct passo_core *core;
	bool advance;
	uint64_t clock;
	uint64_t skipped; /* clocks that passo_core_advance() did */
	struct passo_pin_event last;
	struct passo_pin_event *events;
	size_t count, capacity;
};

/* Plays all segments and appends output changes to the events. False if an output changed in a clock skipped
 * by passo_core_advance(), or if the events are full. */
bool player_play(struct player *player, struct player_segment *segments, size_t count);
/* The same for that many clocks of an exchange, with passo_core_exchange(). */
bool player_exchange(
    struct player *player, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t clocks);

#endif
