/* SPDX-License-Identifier: MIT
 * The trackers of a channel, and how their steps join those of the path. See rtl/passo_trackers.v.
 */
#include "passo_model.h"

/* The profile runs, and the rate is not 0. */
static bool path_runs(const struct passo_channel *channel)
{
	return passo_motion_moves(&channel->motion) && channel->timescale.rate != 0u;
}

bool passo_trackers_settled(const struct passo_channel *channel)
{
	return channel->trackers.path_runs == path_runs(channel);
}

bool passo_trackers_path_moves(const struct passo_channel *channel, unsigned axis)
{
	return channel->trackers.path_runs && ((uint32_t)channel->line.moves >> axis & 1u) != 0u;
}

static struct passo_tracker_join_wires join_wires(const struct passo_channel *channel, unsigned axis)
{
	return (struct passo_tracker_join_wires){
	    .made = channel->trackers.axis[axis].step_made,
	    .made_down = channel->trackers.step_down,
	    .path_step = passo_dda_step_request(&channel->dda[axis], &channel->line),
	    .path_down = ((uint32_t)channel->line.directions >> axis & 1u) != 0u,
	    .path_moves = passo_trackers_path_moves(channel, axis),
	    .waits = (channel->axis[axis].waits & 1u) != 0u,
	};
}

struct passo_tracker_join_result passo_trackers_join(const struct passo_channel *channel, unsigned axis)
{
	const struct passo_tracker_join_wires wires = join_wires(channel, axis);

	if (!channel->trackers.present)
		return (struct passo_tracker_join_result){
		    .step_request = wires.path_step, .direction = wires.path_down};
	return passo_tracker_join_wires(&channel->trackers.join[axis], &wires);
}

void passo_trackers_clock(
    struct passo_channel *channel, const struct passo_bus *bus, const struct passo_channel_wires *wires)
{
	struct passo_trackers *trackers = &channel->trackers;
	const struct passo_tracker_wires unit_wires = {
	    .halt = wires->drop || wires->stopped,
	    .zero = channel->registers.command_zero,
	    .brake = channel->motion.stopping,
	    .hold = wires->hold || wires->requests.wait,
	};
	struct passo_tracker_join joins[PASSO_AXES_MAX];
	bool busy = false;

	if (!trackers->present)
		return;
	for (unsigned i = 0; i < channel->axes; i++) {
		struct passo_tracker_join_wires of_axis = join_wires(channel, i);

		of_axis.halt = unit_wires.halt;
		busy = busy || trackers->axis[i].moves || trackers->join[i].owed != 0
		    || trackers->axis[i].step_made;
		joins[i] = trackers->join[i];
		passo_tracker_join_clock(&joins[i], &of_axis);
	}
	passo_tracker_clock(channel, bus, wires->selected, &unit_wires);
	for (unsigned i = 0; i < channel->axes; i++)
		trackers->join[i] = joins[i];
	trackers->busy = busy;
	trackers->path_runs = path_runs(channel);
}
