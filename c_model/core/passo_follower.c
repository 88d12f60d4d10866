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

uint64_t passo_follower_quiet(const struct passo_follower *follower, const struct passo_follower_wires *wires)
{
	const int32_t owed = follower->owed;

	if (wires->count_made || wires->slipped || follower->change != 0 || follower->lost
	    || follower->due != (owed > 0) || follower->behind != (owed >= 2 * (1 << wires->scale))
	    || owed >= OWED_MAX || owed < -OWED_MAX)
		return 0;
	if (!wires->following)
		return owed == 0 && follower->sum == 0u && follower->credit ? UINT64_MAX : 0u;
	if (!wires->enable)
		return UINT64_MAX;
	if (follower->credit)
		return follower->due ? 0u : UINT64_MAX;
	return wires->limit == 0u ? UINT64_MAX : (UINT32_MAX - follower->sum) / wires->limit;
}

void passo_follower_skip(
    struct passo_follower *follower, const struct passo_follower_wires *wires, uint64_t clocks)
{
	if (wires->following && wires->enable && !follower->credit)
		follower->sum += wires->limit * (uint32_t)clocks;
}
