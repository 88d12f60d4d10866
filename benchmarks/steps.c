/* SPDX-License-Identifier: MIT
 * When substeps are made: the recurrences of docs/architecture.md, a tick at a time, in nothing but integers.
 * Shares no code with the C model; parts of constant velocity are one division each.
 */
#include <stdbool.h>
#include <stdint.h>

struct ramp {
	uint64_t velocity_end, progress_step;
	uint32_t ticks, shape, mirror; /* shape 0 is linear and needs no table */
};

struct walk {
	uint64_t substeps, phase; /* made, and the fraction of the next, UQ0.48 */
	uint64_t clock;
	const uint64_t *due; /* the substeps that are asked for, ascending, and how many of them are left */
	uint64_t *clocks;    /* where to write the clocks, from 1, on which they are made */
	uint32_t left;
};

static const uint64_t ONE = UINT64_C(1) << 48;

static uint32_t look_up(const uint32_t table[257], uint32_t x)
{
	const uint32_t k = x >> 16;
	if (k == 256)
		return 1u << 24;
	const int64_t point = table[k], next = table[k + 1], f = x & 0xFFFFu;
	/* ties go up in the lower half of the table, down in the upper */
	const int64_t half = k < 128 ? 128 : 127;
	return (uint32_t)((point * 65536 + (next - point) * f + half) >> 8);
}

static uint32_t shape(const struct ramp *ramp, const uint32_t tables[][257], uint64_t progress)
{
	const uint32_t x = (uint32_t)((progress + (1u << 23)) >> 24);
	if (ramp->shape == 0)
		return x;
	const uint32_t *table = tables[ramp->shape - 1];
	return ramp->mirror ? (1u << 24) - look_up(table, (1u << 24) - x) : look_up(table, x);
}

/* Go on at a velocity for some clocks. */
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

/* Write the clocks of the `count` substeps `due` and return how many of them the ramps reach. */
uint32_t substep_clocks(const struct ramp *ramps, uint32_t ramp_count, uint32_t tick_log2,
    const uint32_t tables[][257], const uint64_t *due, uint32_t count, uint64_t *clocks)
{
	struct walk walk = {.phase = ONE / 4, .due = due, .clocks = clocks, .left = count};
	const uint64_t tick = UINT64_C(1) << tick_log2;
	uint64_t start = 0;

	for (const struct ramp *ramp = ramps; ramp < ramps + ramp_count; ramp++) {
		const bool up = ramp->velocity_end >= start;
		const uint64_t change = up ? ramp->velocity_end - start : start - ramp->velocity_end;
		uint64_t progress = ramp->progress_step >> 1;

		if (change == 0)
			go(&walk, start, ramp->ticks * tick);
		for (uint32_t i = 0; change > 0 && i < ramp->ticks; i++) {
			/* floor, of what may be negative */
			const unsigned __int128 product =
			    (unsigned __int128)change * shape(ramp, tables, progress);
			const uint64_t part = (uint64_t)((up ? product : product + (1u << 24) - 1) >> 24);
			go(&walk, up ? start + part : start - part, tick);
			progress += ramp->progress_step;
		}
		start = ramp->velocity_end;
	}
	return count - walk.left;
}
