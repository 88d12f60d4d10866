/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of world.h.
 */
#ifndef SOAK_WORLD_PRIVATE_H
#define SOAK_WORLD_PRIVATE_H

#include "world.h"

/* State of a channel before the clock. */
struct world_before {
	enum passo_state state;
	bool stopping, at_rest;
	uint32_t rate;
	uint16_t line, ramp, tick;
	uint8_t waits;
};

struct world_before world_look(const struct passo_channel *channel);

/* Adds the events of a clock; `pins` are those before it. */
void world_note_events(
    struct world *world, const struct world_before *before, const struct passo_outputs *pins);

/* Adds a clock to the record. */
void world_note_pins(
    struct world *world, const struct passo_inputs *inputs, const struct passo_outputs *outputs);

/* A larger array; *room is the number of elements that it has room for. */
void *world_more(void *array, size_t *room, size_t size);

#endif
