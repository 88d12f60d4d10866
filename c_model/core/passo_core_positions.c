/* SPDX-License-Identifier: MIT
 * Snapshot of the positions of a channel for the host. See rtl/passo_positions.v.
 *
 * In the model each axis has its full position, and each encoder its full count, so only the time of the
 * snapshot matters here.
 */
#include "passo_model.h"

enum { ROUND_CLOCKS = 64 };

void passo_positions_reset(struct passo_positions *positions)
{
	*positions = (struct passo_positions){0};
}

void passo_positions_clock(struct passo_positions *positions, const uint32_t values[PASSO_AXES_MAX],
    bool zero, bool snapshot, bool latch)
{
	if (positions->slot == ROUND_CLOCKS - 1) {
		if (positions->clear_waits) {
			positions->clear_waits = false;
		} else if (positions->latch_waits) {
			for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
				positions->latched_copies[i] = latch ? values[i] : positions->latched[i];
			positions->latch_waits = false;
		} else if (positions->snapshot_waits) {
			for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
				positions->copies[i] = values[i];
			positions->snapshot_waits = false;
		}
	}
	positions->clear_waits = positions->clear_waits || zero;
	positions->snapshot_waits = positions->snapshot_waits || snapshot;
	positions->latch_waits = positions->latch_waits || latch;
	if (latch)
		for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
			positions->latched[i] = values[i];
	if (zero)
		for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
			positions->latched[i] = 0;
	positions->slot = (positions->slot + 1u) % ROUND_CLOCKS;
}

uint64_t passo_positions_quiet(const struct passo_positions *positions)
{
	return positions->snapshot_waits ? ROUND_CLOCKS - 1u - positions->slot : UINT64_MAX;
}

void passo_positions_skip(struct passo_positions *positions, uint64_t clocks)
{
	if (clocks >= (uint64_t)ROUND_CLOCKS - positions->slot)
		positions->clear_waits = false;
	positions->slot = (uint8_t)((positions->slot + clocks) % ROUND_CLOCKS);
}
