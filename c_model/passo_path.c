/* SPDX-License-Identifier: MIT
 * Path: sums the velocity; each carry is a substep. See rtl/passo_path.v.
 */
#include "passo_model.h"

static const uint32_t QUARTER = 0x400000u;
static const uint32_t HALF_MASK = 0xFFFFFFu; /* phase and velocity are kept in two halves of 24 bits */

static void add(struct passo_path *path, bool advance)
{
	path->substep = false;
	if (path->advance_q) {
		const uint32_t sum =
		    path->phase_high + path->velocity_high + (path->phase_low_carry ? 1u : 0u);
		path->phase_high = sum & HALF_MASK;
		path->substep = sum > HALF_MASK;
	}
	path->advance_q = advance;
	if (advance) {
		const uint32_t sum = path->phase_low + path->velocity_low;
		path->phase_low = sum & HALF_MASK;
		path->phase_low_carry = sum > HALF_MASK;
	}
}

void passo_path_clock(struct passo_path *path, const struct passo_ramp_unit *ramp,
    const struct passo_channel_wires *wires, uint32_t drain_velocity)
{
	const uint64_t velocity_next = ramp->ends_next ? 0u : ramp->velocity_next;

	if (wires->prepare) {
		*path = (struct passo_path){.phase_high = QUARTER};
		return;
	}
	add(path, wires->advance);
	if (wires->next)
		path->velocity_low = (uint32_t)velocity_next & HALF_MASK;
	if (path->take_q)
		path->velocity_high = (uint32_t)(velocity_next >> 24);
	if (wires->drain)
		path->velocity_low = (drain_velocity & 0xFFu) << 16;
	if (path->drain_q)
		path->velocity_high = drain_velocity >> 8;
	path->take_q = wires->next;
	path->drain_q = wires->drain;
	if (wires->stopped) {
		path->velocity_low = 0;
		path->velocity_high = 0;
		path->take_q = false;
		path->drain_q = false;
	}
}
