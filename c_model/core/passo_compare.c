/* SPDX-License-Identifier: MIT
 * Position-compare output. See rtl/passo_compare.v.
 */
#include "passo_core_outputs.h"

void passo_compare_clock(struct passo_compare *compare, const struct passo_outputs_wires *wires)
{
	const struct passo_output_settings *settings = &wires->settings;
	const bool steps = (wires->step_made >> settings->compare_axis & 1u) != 0u;
	const bool down = (wires->step_direction >> settings->compare_axis & 1u) != 0u;
	const bool arrives = steps && (down ? compare->one_down : compare->one_up);

	compare->one_up = compare->away == 1u;
	compare->one_down = compare->away == UINT32_MAX;
	if (steps)
		compare->away =
		    arrives ? settings->compare_interval : compare->away + (down ? 1u : UINT32_MAX);
	if (compare->timer == settings->compare_width)
		compare->pin = false;
	compare->timer++;
	if (arrives) {
		compare->pin = settings->compare_width != 0u;
		compare->timer = 1;
	}
	if (wires->write_distance)
		compare->away = wires->bus.data;
	if (wires->write_distance || wires->write_pulse)
		compare->pin = false;
}
