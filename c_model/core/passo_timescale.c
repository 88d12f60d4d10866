/* SPDX-License-Identifier: MIT
 * Time scale: the clock enable of the profile. See rtl/passo_timescale.v.
 */
#include "passo_model.h"

enum { AFTER_DIRECTION = 1, AFTER_SLEW = 2, AFTER_LAST = 6 }; /* clocks since the slew tick */

static uint32_t moved(uint32_t rate, uint32_t goal, uint32_t slew, bool down)
{
	if (down)
		return rate - goal <= slew ? goal : rate - slew;
	return goal - rate <= slew ? goal : rate + slew;
}

void passo_timescale_clock(struct passo_timescale *timescale, const struct passo_channel_registers *registers,
    bool moving, bool stopping, bool slew_tick)
{
	const uint32_t sum = timescale->rate_sum + timescale->rate;
	const uint32_t goal = timescale->goal;

	timescale->enable = sum >> 16 != 0u;
	timescale->rate_sum = sum & 0xFFFFu;
	if (timescale->after == AFTER_DIRECTION)
		timescale->down = timescale->rate > goal;
	if (timescale->after == AFTER_SLEW) {
		const uint32_t slew = timescale->stops ? registers->stop_slew : registers->rate_slew;
		timescale->slew = slew == 0u ? 1u : slew;
	}
	/* a change that started before the stop is dropped */
	if (timescale->after == AFTER_LAST && (timescale->stops || !stopping))
		timescale->rate = moved(timescale->rate, goal, timescale->slew, timescale->down);
	if (slew_tick) {
		timescale->goal = stopping ? 0u : registers->rate_target;
		timescale->stops = stopping;
	}
	timescale->after = slew_tick ? 1u
	                 : timescale->after == 0u || timescale->after == AFTER_LAST
	                     ? 0u
	                     : (uint8_t)(timescale->after + 1u);
	if (!moving) {
		if (timescale->still)
			timescale->rate = goal;
		timescale->goal = registers->rate_target;
		timescale->stops = false;
		timescale->after = 0;
		timescale->rate_sum = 0;
		timescale->enable = false;
	}
	timescale->still = !moving;
}
