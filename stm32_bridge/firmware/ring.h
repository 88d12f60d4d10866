/* SPDX-License-Identifier: MIT
 * A ring of bytes with one writer, which owns `head`, and one reader, which owns `tail`: an interrupt handler
 * and the main loop. Both are free-running, so head - tail is the fill level.
 */
#ifndef RING_H
#define RING_H

#include <stdbool.h>
#include <stdint.h>

#define RING 512u /* a power of two */

struct ring {
	volatile uint32_t head, tail;
	volatile uint8_t bytes[RING];
};

/* Bytes that can be put into it. */
static inline uint32_t ring_room(const struct ring *ring)
{
	return RING - (ring->head - ring->tail);
}

/* False: it is full. */
static inline bool ring_put(struct ring *ring, uint8_t byte)
{
	if (ring_room(ring) == 0u)
		return false;
	ring->bytes[ring->head % RING] = byte;
	ring->head++;
	return true;
}

/* False: it is empty. */
static inline bool ring_get(struct ring *ring, uint8_t *byte)
{
	if (ring->head == ring->tail)
		return false;
	*byte = ring->bytes[ring->tail % RING];
	ring->tail++;
	return true;
}

#endif
