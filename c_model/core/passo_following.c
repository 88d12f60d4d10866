/* SPDX-License-Identifier: MIT
 * Following error: how far the encoder is behind the steps, in counts. See rtl/passo_following.v.
 */
#include "passo_core_encoder.h"

static const int64_t COUNT = 65536; /* 1.0 */

static uint32_t magnitude_of(int64_t error)
{
	return (uint32_t)((error < 0 ? -1 - error : error) / COUNT);
}

static bool off_scale(int64_t error)
{
	return magnitude_of(error) >= 0x10000u;
}

void passo_following_clock(struct passo_following *following, const struct passo_following_wires *wires)
{
	if (wires->zero) {
		*following = (struct passo_following){0};
		return;
	}
	if (following->magnitude > following->greatest)
		following->greatest = following->magnitude;
	if (wires->clear)
		following->greatest = 0;
	following->exceeded = following->magnitude >= wires->limit;
	following->magnitude = magnitude_of(following->error);
	if (!off_scale(following->error))
		following->error += following->change;
	following->change = 0;
	if (wires->step_made)
		following->change += wires->step_direction ? -(int64_t)wires->ratio : (int64_t)wires->ratio;
	if (wires->count_made)
		following->change += wires->count_down ? COUNT : -COUNT;
}

bool passo_following_quiet(const struct passo_following *following, const struct passo_following_wires *wires)
{
	return following->change == 0 && following->magnitude == magnitude_of(following->error)
	    && following->exceeded == (following->magnitude >= wires->limit)
	    && following->greatest >= following->magnitude && !wires->zero && !wires->clear
	    && !wires->step_made && !wires->count_made;
}
