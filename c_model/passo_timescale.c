/* SPDX-License-Identifier: MIT
 * Time scale: the clock enable of the profile. See rtl/passo_timescale.v.
 */
#include "passo_model.h"

void passo_timescale_clock(struct passo_timescale *timescale, const struct passo_channel_registers *registers,
    bool moving, bool stopping, bool slew_tick)
{
	const int32_t distance = timescale->distance;
	const int32_t slew = (int32_t)timescale->slew;
	const uint32_t goal = timescale->goal;
	const uint32_t sum = timescale->rate_sum + timescale->rate;

	timescale->enable = sum >> 16 != 0u;
	timescale->rate_sum = sum & 0xFFFFu;
	timescale->distance = (int32_t)goal - (int32_t)timescale->rate;
	if (slew_tick) {
		const uint32_t chosen = stopping ? registers->stop_slew : registers->rate_slew;
		if (distance <= slew && distance >= -slew)
			timescale->rate = goal;
		else
			timescale->rate += distance < 0 ? 0u - (uint32_t)slew : (uint32_t)slew;
		timescale->goal = stopping ? 0u : registers->rate_target;
		timescale->slew = chosen == 0u ? 1u : chosen;
	}
	if (!moving) {
		timescale->rate = registers->rate_target;
		timescale->goal = registers->rate_target;
		timescale->slew = 1;
		timescale->rate_sum = 0;
		timescale->enable = false;
	}
}
