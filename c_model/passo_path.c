/* SPDX-License-Identifier: MIT
 * Path: sums the velocity; each carry is a substep. See rtl/passo_path.v.
 */
#include "passo_model.h"

static const uint32_t QUARTER = 0x400000u;
static const uint32_t HALF_MASK = 0xFFFFFFu; /* the phase is kept in two halves of 24 bits */

void passo_path_clock(struct passo_path *path, bool restart, bool advance, uint64_t velocity)
{
	if (restart) {
		*path = (struct passo_path){.phase_high = QUARTER, .velocity_high_q = path->velocity_high_q};
		return;
	}
	path->substep = false;
	if (path->advance_q) {
		const uint32_t sum =
		    path->phase_high + path->velocity_high_q + (path->phase_low_carry ? 1u : 0u);
		path->phase_high = sum & HALF_MASK;
		path->substep = sum > HALF_MASK;
	}
	path->advance_q = advance;
	if (advance) {
		const uint32_t sum = path->phase_low + ((uint32_t)velocity & HALF_MASK);
		path->phase_low = sum & HALF_MASK;
		path->phase_low_carry = sum > HALF_MASK;
		path->velocity_high_q = (uint32_t)(velocity >> 24);
	}
}
