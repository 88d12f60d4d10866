/* SPDX-License-Identifier: MIT
 * Line counter: counts the substeps of the current line and controls the DDAs. See rtl/passo_line.v.
 */
#include "passo_model.h"

void passo_line_wires(const struct passo_line_unit *line, const struct passo_line_queue *queue, bool substep,
    struct passo_channel_wires *wires)
{
	const bool endless = queue->endless && !line->no_repeat_before;

	wires->substep_taken = substep && line->active;
	wires->line_done = wires->substep_taken && line->on_last;
	const bool goes_on = wires->line_done && !queue->last;
	wires->repeats = goes_on && endless;
	wires->take = wires->prepare || (goes_on && !endless && queue->next_valid);
}

int64_t passo_line_addend(const struct passo_line_unit *line, uint32_t last_substep)
{
	const int64_t substeps = (int64_t)last_substep + 1;
	return line->load_start ? -((substeps + 1) / 2) : -substeps;
}

void passo_line_clock(struct passo_line_unit *line, const struct passo_line_queue *queue,
    const struct passo_channel_wires *wires)
{
	if (line->load_start_q) {
		line->directions = queue->directions;
		line->moves = 0;
		for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
			line->moves |= (uint8_t)((queue->steps[i] != 0u ? 1u : 0u) << i);
	}
	line->decide_step = line->add_n;
	line->load_start_q = line->load_start;
	line->add_n = wires->substep_taken;
	line->load_start = wires->take || wires->repeats;

	line->endless = queue->endless && !line->no_repeat;
	line->no_repeat_before = line->no_repeat;
	line->no_repeat = wires->requests.end_endless || (line->no_repeat && !wires->take);
	line->on_last = line->substep_number == queue->last_substep;
	line->underrun = false;
	if (wires->take || wires->repeats) {
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
		line->add_n = line->load_start = line->decide_step = line->load_start_q = false;
	}
}
