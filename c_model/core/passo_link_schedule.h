/* SPDX-License-Identifier: MIT
 * Internal: the clocks of the schedule that each word of a frame follows, and the states that act in them.
 * See rtl/passo_link_schedule.v.
 */
#ifndef PASSO_LINK_SCHEDULE_H
#define PASSO_LINK_SCHEDULE_H

#include "passo_model.h"

enum {
	COUNT_READ = 12,
	COUNT_LOAD = 27,
	COUNT_STROBE = 28,
	COUNT_ANSWER = 30,
	COUNT_LOADED = 31,
	COUNT_ROTATE = 31,
	COUNT_ROTATED = 63,
	COUNT_ACT = 65,
	COUNT_REST = 67
};

/* What the present step does in this clock; `was` is the link before it, without the buffer. */
void passo_link_states_clock(struct passo_link *link, const struct passo_link_wires *wires,
    const struct passo_link *was, bool word_valid, bool frame_goes_on);

#endif
