/* SPDX-License-Identifier: MIT
 * The planner: from a move to one line and a few ramps.
 *
 * A plan is computed in three stages:
 *
 *   1. phases        ticks of acceleration, cruise and deceleration
 *   2. oversampling  substeps per step: as many as the peak velocity allows
 *   3. peak          the velocity at which exactly these ticks cover exactly these substeps
 *
 * Only stage 3 determines where the move ends. It uses the numbers of the core: ticks, velocities and
 * progress after rounding. Stages 1 and 2 only have to be conservative.
 *
 * Remaining difference between the area under the ramps and M, in substeps, for moves below 2^44 clocks:
 *
 *   peak rounded to the nearest 2^-48             at most 2^44 / 2 * 2^-48 = 1/32
 *   velocities in ramps rounded down to 2^-48     at most 2^44     * 2^-48 = 1/16, typically half of that
 *   weights of ramps rounded down to 2^-24        at most 2^-9, with ticks of 2^16 clocks
 *
 * That is less than 0.1 after days and less than 0.001 after minutes. The core tolerates 1/4, because a
 * motion starts with a quarter substep in its phase.
 *
 * One error is not compensated. The core resolves progress to 24 bits, so the distance of a ramp can deviate
 * by up to 2^-24 (typically below 2^-30) of ticks * change of velocity. It cancels if both ramps have the
 * same ticks and speeds; otherwise it can show in ramps of more than about ten seconds. No step is lost: the
 * core drains missing substeps at the end, and never makes more than M.
 */
#include "passo_plan.h"

#include "passo_plan_draft.h"

/* ------------------------------------------------------------------------------------------- in time ---- */

enum passo_plan_error passo_draft_in_ticks(
    struct passo_draft *draft, uint64_t total, uint64_t ramp, uint64_t speed_limit, struct passo_plan *plan)
{
	/* Rounding can make a ramp of half the time longer than half the ticks. */
	bool in_halves = draft->profile == PASSO_PROFILE_JERK;
	uint64_t ticks =
	    passo_smaller(passo_draft_halvable(draft, ramp), in_halves ? total / 4 * 2 : total / 2);
	draft->accelerate = draft->decelerate = (struct passo_phase){ticks, 0, 0};
	draft->cruise = total - 2 * ticks;
	if (passo_draft_is_too_long(draft))
		return PASSO_PLAN_TOO_LONG;
	passo_draft_weigh(draft);

	/* M = peak * weight, with peak <= 1/2 */
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
