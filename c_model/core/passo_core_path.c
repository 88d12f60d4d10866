/* SPDX-License-Identifier: MIT
 * Path: accumulates the velocity; each carry is a substep. See rtl/passo_path.v.
 */
#include "passo_model.h"

static const uint32_t QUARTER = 0x400000u;
static const uint32_t HALF_MASK = 0xFFFFFFu; /* phase and velocity are stored in two 24-bit halves */

void passo_path_reset(struct passo_path *path)
{
	*path = (struct passo_path){.phase_high = QUARTER, .refresh = true};
}

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
	path->phase_low_carry = false;
	if (advance) {
		const uint32_t sum = path->phase_low + path->velocity_low;
		path->phase_low = sum & HALF_MASK;
		path->phase_low_carry = sum > HALF_MASK;
	}
}

void passo_path_clock(struct passo_path *path, const struct passo_ramp_unit *ramp,
    const struct passo_channel_wires *wires, uint32_t drain_velocity)
{
	const uint64_t drained = (uint64_t)drain_velocity << 16;
	const uint64_t velocity = wires->drain ? drained : ramp->ends_next ? 0u : ramp->velocity_next;
	const bool take = wires->next || path->refresh;

	add(path, wires->advance);
	if (take)
		path->velocity_low = (uint32_t)velocity & HALF_MASK;
	if (path->take_q)
		path->velocity_high = (uint32_t)(velocity >> 24);
	path->take_q = take;
	path->refresh = wires->stopped || wires->drain;
	if (wires->prepare) {
		path->phase_low = 0;
		path->phase_low_carry = false;
		path->phase_high = QUARTER;
		path->advance_q = false;
		path->substep = false;
	}
}
