/* SPDX-License-Identifier: MIT
 * A history: setup and motions, disturbances aimed at the clocks where something changes, and the end: the
 * core must come to rest and make one more move exactly.
 */
#ifndef SOAK_HISTORY_H
#define SOAK_HISTORY_H

#include "judge.h"
#include "scenario.h"

struct history_counts {
	struct judge_counts judge;
	uint64_t clocks, frames, refused, busy;
	uint64_t aimed, hit;            /* aimed disturbances, and those that hit their clock */
	uint64_t kinds[SCENARIO_KINDS]; /* disturbances by kind */
	uint64_t events[EVENT_KINDS];   /* targets by kind */
};

/* Plays history `number` of a seed: first on the model alone to find targets, then with everything that
 * `world` was opened for. `rtl`, `record` and `print` may be NULL. `brief`: ends when the core has come to
 * rest, without the last move. */
void history_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    bool brief, FILE *record, FILE *print, struct history_counts *counts);

#endif
