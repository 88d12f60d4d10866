/* SPDX-License-Identifier: MIT
 * Joins the steps of path and tracker of one axis. See rtl/passo_tracker_join.v.
 */
#include "passo_core_trackers.h"

enum { OWED_MAX = 3 };

static int size_of(const struct passo_tracker_join *join)
{
	return join->owed < 0 ? -join->owed : join->owed;
}

struct passo_tracker_join_result passo_tracker_join_wires(
    const struct passo_tracker_join *join, const struct passo_tracker_join_wires *wires)
{
	const int size = size_of(join);
	const bool against = size != 0 && (join->owed < 0) != wires->path_down;
	const bool joins = join->ready && !wires->path_step;
	const bool goes = wires->path_step && !against;
	const bool turned = joins ? against
	                  : goes  ? false
	                          : join->turned && !(wires->path_moves && size == 0);

	return (struct passo_tracker_join_result){.step_request = goes || joins,
	    .direction = wires->path_down != turned,
	    .against = against,
	    .joins = joins};
}

void passo_tracker_join_clock(struct passo_tracker_join *join, const struct passo_tracker_join_wires *wires)
{
	const struct passo_tracker_join_result result = passo_tracker_join_wires(join, wires);
	const int size = size_of(join);
	const bool cancels = wires->path_step && result.against;
	const bool may_join = (!wires->waits && !wires->path_step) || size == OWED_MAX;
	int owed = join->owed;

	if (result.joins || cancels)
		owed += owed < 0 ? 1 : -1;
	if (wires->made)
		owed += wires->made_down ? -1 : 1;
	join->ready = size != 0 && may_join && (!result.against || !wires->path_moves || size >= 2)
	           && !result.joins && !cancels && !wires->made && !wires->halt;
	join->turned = result.direction != wires->path_down;
	if (wires->path_moves)
		join->went_down = wires->path_down;
	join->owed = (int8_t)(wires->halt ? 0 : owed);
}
