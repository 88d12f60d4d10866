/* SPDX-License-Identifier: MIT
 * Clocks of substeps by the recurrences of docs/architecture.md, tick by tick in integers. Shares no code
 * with the C model; intervals of constant velocity take one division each.
 */
#include <stdbool.h>
#include <stdint.h>

struct ramp {
	uint64_t velocity_end, progress_step;
	uint32_t ticks, shape, mirror; /* shape 0 is linear and needs no table */
};

struct walk {
	uint64_t substeps, phase; /* number made, and fraction of the next, UQ0.48 */
	uint64_t clock;
	const uint64_t *due; /* requested substeps, ascending */
	uint64_t *clocks;    /* output: the clocks, from 1, on which they are made */
	uint32_t left;       /* number of requested substeps left */
};

static const uint64_t ONE = UINT64_C(1) << 48;

/* s (UQ1.24) for a progress (UQ0.49) */
static uint32_t shape(const struct ramp *ramp, const uint32_t tables[][257], uint64_t progress)
{
	if (ramp->shape == 0)
		return (uint32_t)((progress + (1u << 24)) >> 25);
	const uint32_t *table = tables[ramp->shape - 1];
	const uint64_t k = progress >> 41, f = ((progress & ((1ull << 41) - 1)) + (1u << 16)) >> 17;
	return (uint32_t)((table[k] * ((1ull << 24) - f) + table[k + 1] * f + (1u << 15)) >> 16);
}

/* Advances at a velocity for some clocks. */
static void go(struct walk *walk, uint64_t velocity, uint64_t clocks)
{
	const unsigned __int128 end = (unsigned __int128)velocity * clocks + walk->phase;
	const uint64_t substeps = walk->substeps + (uint64_t)(end >> 48);

	while (walk->left > 0 && *walk->due <= substeps) {
		const unsigned __int128 missing =
		    ((unsigned __int128)(*walk->due - walk->substeps) << 48) - walk->phase;
		*walk->clocks++ = walk->clock + (uint64_t)((missing + velocity - 1) / velocity);
		walk->due++;
		walk->left--;
	}
	walk->substeps = substeps;
	walk->phase = (uint64_t)end & (ONE - 1);
	walk->clock += clocks;
}

/* Writes the clocks of the `count` substeps `due`; returns how many of them the ramps reach. */
uint32_t substep_clocks(const struct ramp *ramps, uint32_t ramp_count, uint32_t tick_log2,
    const uint32_t tables[][257], const uint64_t *due, uint32_t count, uint64_t *clocks)
{
	struct walk walk = {.phase = ONE / 4, .due = due, .clocks = clocks, .left = count};
	const uint64_t tick = UINT64_C(1) << tick_log2;
	uint64_t start = 0;

	for (const struct ramp *ramp = ramps; ramp < ramps + ramp_count; ramp++) {
		/* a mirrored ramp runs backward, from its end to its start */
		const uint64_t from = ramp->mirror ? ramp->velocity_end : start;
		const uint64_t to = ramp->mirror ? start : ramp->velocity_end;
		uint64_t progress = ramp->progress_step; /* du / 2, UQ0.49 */

		if (from == to)
			go(&walk, start, ramp->ticks * tick);
		for (uint32_t i = 0; from != to && i < ramp->ticks; i++) {
			const uint64_t s =
			    shape(ramp, tables, ramp->mirror ? 2 * ONE - 1 - progress : progress);
			const unsigned __int128 sum =
			    (unsigned __int128)from * ((1u << 24) - s) + (unsigned __int128)to * s;
			go(&walk, (uint64_t)(sum >> 24), tick);
			progress += 2 * ramp->progress_step;
		}
		start = ramp->velocity_end;
	}
	return count - walk.left;
}
