/* SPDX-License-Identifier: MIT
 * Line counter: counts the substeps of the current line and leads the DDAs. See rtl/passo_line.v.
 */
#include "passo_model.h"

static const int64_t TWO_TO_32 = INT64_C(1) << 32;

int64_t passo_line_broadcast(const struct passo_line_unit *line)
{
	const int64_t minus_m = (int64_t)line->minus_substeps - TWO_TO_32;
	const int64_t floor_half = -((1 - minus_m) / 2);
	return line->slot_load ? floor_half : minus_m;
}

void passo_line_clock(struct passo_line_unit *line, const struct passo_line_queue *queue,
    const struct passo_channel_wires *wires)
{
	const bool bump = line->remaining_bump;
	const bool last = line->last;

	if (line->slot_load_q)
		line->directions = line->directions_next;
	line->slot_step = line->slot_add;
	line->slot_load_q = line->slot_load;
	line->slot_add = wires->substep_taken;
	line->slot_load = wires->take;

	line->remaining_bump = wires->take;
	line->underrun = wires->line_done && !last && !queue->next_valid;
	if (wires->take) {
		line->minus_substeps = queue->next_minus_substeps;
		line->remaining = (int64_t)queue->next_minus_substeps - TWO_TO_32;
		line->last = queue->next_last;
		line->endless = queue->next_endless;
		line->directions_next = queue->next_directions;
	} else if (wires->substep_taken || bump) {
		line->remaining++;
	}

	if (wires->line_done && !wires->take)
		line->active = false;
	if (wires->line_done && last)
		line->ended = true;
	if (wires->prepare) {
		line->active = true;
		line->ended = false;
	}
	if (wires->stopped) {
		line->active = line->ended = line->endless = line->underrun = false;
		line->slot_add = line->slot_load = line->slot_step = line->slot_load_q = false;
	}
}
