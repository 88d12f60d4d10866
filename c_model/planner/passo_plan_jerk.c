/* SPDX-License-Identifier: MIT
 * Jerk-limited moves in up to seven phases.
 */
#include "passo_plan_draft.h"

enum passo_plan_error passo_plan_jerk(
    const struct passo_machine *machine, const struct passo_move_jerk *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, PASSO_PROFILE_JERK);
	if (error != PASSO_PLAN_OK)
		return error;
	if (move->acceleration == 0)
		return PASSO_PLAN_NO_ACCELERATION;
	if (move->jerk == 0)
		return PASSO_PLAN_NO_JERK;

	const struct passo_rise rise = {.acceleration = move->acceleration, .jerk = move->jerk};
	const struct passo_limits limits = {
	    .start_speed = move->start_speed,
	    .speed = move->speed,
	    .stop_speed = move->stop_speed,
	    .up = rise,
	    .down = rise,
	};
	return passo_draft_by_speed(&draft, &limits, plan);
}
