/* SPDX-License-Identifier: MIT
 * Follower: turns encoder counts into the clock of a profile. See rtl/passo_follower.v.
 */
#include "passo_core_encoder.h"

enum { OWED_MAX = 1 << 22 };

void passo_follower_reset(struct passo_follower *follower)
{
	*follower = (struct passo_follower){.credit = true};
}

bool passo_follower_advance(const struct passo_follower *follower, const struct passo_follower_wires *wires)
{
	return wires->enable && follower->due && follower->credit && !wires->stall;
}

void passo_follower_clock(struct passo_follower *follower, const struct passo_follower_wires *wires)
{
	const bool advance = passo_follower_advance(follower, wires);
	const int32_t owed = follower->owed;
	const int32_t one_count = 1 << wires->scale;

	if (!wires->following) {
		passo_follower_reset(follower);
		return;
	}
	follower->owed += follower->change - (advance ? 1 : 0);
	follower->change = 0;
	if (wires->count_made && !follower->lost)
		follower->change = wires->count_down ? -one_count : one_count;
	follower->due = owed > 0;
	follower->behind = owed >= 2 * one_count;
	follower->lost = follower->lost || owed >= OWED_MAX || owed < -OWED_MAX || wires->slipped;
	if (wires->enable && (!follower->credit || advance)) {
		const uint64_t sum = (uint64_t)follower->sum + wires->limit;
		follower->sum = (uint32_t)sum;
		follower->credit = sum >> 32 != 0u;
	}
}
