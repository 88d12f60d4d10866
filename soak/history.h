/* SPDX-License-Identifier: MIT
 * One history: set-up and motions, disturbances aimed at the clocks where something changes, and the end: the
 * core always comes to rest, and one more move is made exactly.
 */
#ifndef SOAK_HISTORY_H
#define SOAK_HISTORY_H

#include "judge.h"
#include "plot.h"

struct history_counts {
	struct judge_counts judge;
	uint64_t clocks, frames, refused, busy;
	uint64_t aimed, hit;          /* disturbances, and those that fell on the clock they were for */
	uint64_t kinds[PLOT_KINDS];   /* disturbances */
	uint64_t events[EVENT_KINDS]; /* at which they were aimed */
};

/* Plays history `number` of a seed, first on the model alone to find what to aim at, then for good with
 * everything else that `world` was opened for. `rtl` may be NULL. `record` may be NULL, so may `print`.
 * `brief`: it ends when the core has come to rest, before the last move. */
void history_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    bool brief, FILE *record, FILE *print, struct history_counts *counts);

#endif
