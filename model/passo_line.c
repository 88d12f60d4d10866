/* SPDX-License-Identifier: MIT
 * Line counter: counts the substeps of the current line and controls the DDAs. See rtl/passo_line.v.
 */
#include "passo_model.h"

int64_t passo_line_broadcast(const struct passo_line_unit *line, uint32_t last_substep)
{
	const int64_t substeps = (int64_t)last_substep + 1;
	return line->slot_load ? -((substeps + 1) / 2) : -substeps;
}

void passo_line_clock(struct passo_line_unit *line, const struct passo_line_queue *queue,
    const struct passo_channel_wires *wires)
{
	if (line->slot_load_q)
		line->directions = queue->directions;
	line->slot_step = line->slot_add;
	line->slot_load_q = line->slot_load;
	line->slot_add = wires->substep_taken;
	line->slot_load = wires->take || wires->turn;

	line->endless = queue->endless;
	line->on_last = line->substep_number == queue->last_substep;
	line->underrun = false;
	if (wires->take || wires->turn) {
		line->substep_number = 0;
	} else if (wires->line_done) {
		line->active = false;
		line->ended = queue->last;
		line->underrun = !queue->last;
	} else if (wires->substep_taken) {
		line->substep_number++;
	}
	if (wires->prepare) {
		line->active = true;
		line->ended = false;
	}
	if (wires->stopped) {
		line->active = line->ended = line->underrun = false;
		line->slot_add = line->slot_load = line->slot_step = line->slot_load_q = false;
	}
}
