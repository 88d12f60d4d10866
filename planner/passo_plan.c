/* SPDX-License-Identifier: MIT
 * The planner: from a move to one line and a few ramps.
 *
 * Every plan is made in the same order:
 *
 *   1. phases        how many ticks the move speeds up, keeps its speed and slows down
 *   2. oversampling  how many substeps a step is worth: as many as the highest velocity allows
 *   3. peak          the one velocity at which exactly these ticks cover exactly these substeps
 *
 * Step 3 alone decides where the move ends, and it reckons with the numbers the core will use: ticks,
 * velocities and progress as they are after rounding. What comes before need only be on the safe side.
 *
 * What remains between the distance under the ramps and M, in substeps, for moves of less than 2^44 clocks:
 *
 *   peak to the nearest 2^-48                at most 2^44 / 2 * 2^-48 = 1/32
 *   velocities inside ramps down to 2^-48    at most 2^44     * 2^-48 = 1/16, as a rule half of that
 *   weights of ramps down to 2^-24           at most 2^-9, where a tick has 2^16 clocks
 *
 * That is less than 0.1 after days and less than 0.001 after minutes. The core bears 1/4: a motion starts
 * with a quarter of a substep in its phase.
 *
 * One thing is out of the planner's reach. The core knows progress to 24 bits, so a ramp can come out longer
 * or shorter by up to 2^-24 (as a rule below 2^-30) of ticks * change of velocity. Where both ramps have the
 * same ticks and speeds the second takes back what the first has added; otherwise it can show in ramps of
 * some ten seconds. No step is lost by it: the core makes missing substeps at the end, and none beyond M.
 */
#include "passo_plan.h"

#include "passo_plan_draft.h"

/* ------------------------------------------------------------------------------------------- in time ---- */

enum passo_plan_error passo_draft_in_ticks(
    struct passo_draft *draft, uint64_t total, uint64_t ramp, uint64_t speed_limit, struct passo_plan *plan)
{
	/* Ramps of half the time can round to more than half the ticks; less than 2 ticks cannot be halved.
	 */
	bool in_halves = draft->profile == PASSO_PROFILE_JERK;
	uint64_t ticks =
	    passo_smaller(passo_draft_halvable(draft, ramp), in_halves ? total / 4 * 2 : total / 2);
	draft->accelerate = draft->decelerate = (struct passo_phase){ticks, 0, 0};
	draft->cruise = total - 2 * ticks;
	if (passo_draft_is_too_long(draft))
		return PASSO_PLAN_TOO_LONG;
	passo_draft_weigh(draft);

	/* M = peak * weight, and the peak is at most 1/2. */
	passo_draft_oversample_to(
	    draft, (passo_draft_weight(draft) >> (PASSO_WEIGHT_BITS + 1 - draft->machine->tick_log2))
	               / draft->longest);
	if (draft->oversampling == 0)
		return PASSO_PLAN_TOO_FAST;

	passo_draft_solve(draft);
	draft->peak = passo_smaller(draft->peak, passo_draft_velocity(draft, speed_limit));
	passo_draft_finish(draft, plan);
	return PASSO_PLAN_OK;
}

enum passo_plan_error passo_draft_in_time(
    struct passo_draft *draft, uint64_t total_clocks, uint64_t ramp_clocks, struct passo_plan *plan)
{
	if (total_clocks >> draft->machine->tick_log2 == 0)
		return PASSO_PLAN_NO_TIME;
	if (ramp_clocks > total_clocks / 2)
		return PASSO_PLAN_RAMP_TOO_LONG;
	uint64_t total = passo_ticks_nearest(draft->machine, total_clocks);
	uint64_t ramp = passo_ticks_nearest(draft->machine, ramp_clocks);
	return passo_draft_in_ticks(draft, total, ramp, PASSO_ANY_SPEED, plan);
}

enum passo_plan_error passo_plan_in_time(
    const struct passo_machine *machine, const struct passo_move_in_time *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	return passo_draft_in_time(&draft, move->total_clocks, move->ramp_clocks, plan);
}
