/* SPDX-License-Identifier: MIT
 * The judge: checks a history by the pin edges and the knowledge of the host alone.
 *
 * Positions equal active edges; quiet means quiet; no step after an abort or a reset; pin timing is kept;
 * accepted frames are executed, refused ones are not. See docs/soak.md.
 */
#ifndef SOAK_JUDGE_H
#define SOAK_JUDGE_H

#include "world.h"

/* Number of checks by kind, to show coverage. */
struct judge_counts {
	uint64_t steps, turns, quiets, positions, paths, aborts, stops, gaps, resets, gates;
	/* of a machine */
	uint64_t causes, slews, tries, latches, fired, levels, glitches, estops, compares, words, holds,
	    counted, encoders;
};

/* Judges a complete history; the first violation fails the world. */
void judge_history(struct world *world, struct judge_counts *counts);

#endif
