/* SPDX-License-Identifier: MIT
 * The judge: looks at the edges that left the pins and at what the host knows, and at nothing else.
 *
 * Position = active edges; quiet is quiet; no step after an abort or a reset; no pin timing violated; a frame
 * that was accepted was executed, one that was refused was not. See docs/soak.md.
 */
#ifndef SOAK_JUDGE_H
#define SOAK_JUDGE_H

#include "world.h"

/* What was seen, to tell that the judge had something to judge. */
struct judge_counts {
	uint64_t steps, turns, quiets, positions, paths, aborts, stops, gaps, resets, gates;
};

/* Judges a whole history; the first broken promise is a failure of the world. */
void judge_history(struct world *world, struct judge_counts *counts);

#endif
