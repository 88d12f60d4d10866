/* SPDX-License-Identifier: MIT
 * Admission: checks that the state of the channel allows the frame to be executed. See
 * rtl/passo_admission.v.
 */
#include "passo_model.h"

void passo_admission_clock(
    struct passo_admission *admission, const struct passo_bus *bus, const struct passo_needs *needs)
{
	if (bus->frame && !bus->commit) {
		*admission = (struct passo_admission){0};
		return;
	}
	admission->idle_needed |= needs->idle || needs->quiet;
	admission->quiet_needed |= needs->quiet;
	admission->motion_needed |= needs->motion;
}

void passo_admission_wires(const struct passo_admission *admission, const struct passo_bus *bus,
    bool tables_wanted, struct passo_channel_wires *wires)
{
	wires->hold = bus->commit && (admission->idle_needed || tables_wanted);
	wires->now_coming = bus->commit && admission->motion_needed;
}

bool passo_channel_busy(const struct passo_channel *channel)
{
	const struct passo_admission *admission = &channel->admission;

	return (admission->idle_needed && passo_channel_occupied(channel))
	    || (admission->quiet_needed && !channel->at_rest)
	    || (admission->motion_needed && channel->ramp.ends_next);
}
