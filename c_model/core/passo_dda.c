/* SPDX-License-Identifier: MIT
 * DDA of one axis: distributes the N steps of a line evenly over its M substeps. See rtl/passo_dda.v.
 */
#include "passo_model.h"

bool passo_dda_step_request(const struct passo_dda *dda, const struct passo_line_unit *line)
{
	return line->decide_step && dda->e_minus_m >= 0;
}

void passo_dda_clock(struct passo_dda *dda, const struct passo_line_unit *line,
    const struct passo_line_queue *queue, unsigned axis)
{
	const bool step_request = passo_dda_step_request(dda, line);
	const int64_t addend = dda->addend;

	dda->addend = line->add_n || line->load_start ? passo_line_addend(line, queue->last_substep)
	                                              : (int64_t)queue->steps[axis];
	if (line->load_start_q)
		dda->e_minus_m = addend;
	else if (line->add_n || step_request)
		dda->e_minus_m += addend;
}
