/* SPDX-License-Identifier: MIT
 * Moves in exact time and distance, with the highest speed given:
 *
 *   steps = speed * (total - ramp)
 *
 * holds for every symmetric shape, so each of total and ramp follows from the other.
 */
#include "passo_math.h"
#include "passo_plan_draft.h"

/* Ticks in which so many steps are made at this speed; rounded up, so that it is not exceeded. */
static uint64_t ticks_at_speed(const struct passo_draft *draft, uint64_t speed)
{
	uint64_t clocks_per_second = (uint64_t)draft->machine->clock_hz << 32;
	return passo_ticks_ceil(draft->machine, passo_mul_div_ceil(draft->longest, clocks_per_second, speed));
}

uint64_t passo_longest_ramp(uint32_t clock_hz, uint32_t steps, uint64_t total_clocks, uint64_t speed)
{
	uint64_t flat = passo_mul_div_ceil(steps, (uint64_t)clock_hz << 32, speed);
	return flat < total_clocks ? total_clocks - flat : 0;
}

enum passo_plan_error passo_plan_below_speed(
    const struct passo_machine *machine, const struct passo_move_below_speed *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	if (move->speed == 0)
		return PASSO_PLAN_NO_SPEED;
	uint64_t total = passo_ticks_nearest(machine, move->total_clocks);
	uint64_t flat = ticks_at_speed(&draft, move->speed);
	if (move->total_clocks >> machine->tick_log2 == 0)
		return PASSO_PLAN_NO_TIME;
	if (flat > total)
		return PASSO_PLAN_SPEED_TOO_LOW;

	/* The two halves of a jerk-limited ramp are equal; rounding it up would take it beyond the limit. */
	uint64_t ramp = total - flat;
	if (move->profile == PASSO_PROFILE_JERK)
		ramp &= ~UINT64_C(1);
	return passo_draft_in_ticks(&draft, total, ramp, move->speed, plan);
}

enum passo_plan_error passo_plan_at_speed(
    const struct passo_machine *machine, const struct passo_move_at_speed *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	if (move->speed == 0)
		return PASSO_PLAN_NO_SPEED;
	uint64_t flat = ticks_at_speed(&draft, move->speed);
	uint64_t ramp = passo_ticks_ceil(machine, move->ramp_clocks);
	if (move->profile == PASSO_PROFILE_JERK)
		ramp += ramp & 1;
	if (ramp > flat)
		return PASSO_PLAN_RAMP_TOO_LONG;
	return passo_draft_in_ticks(&draft, flat + ramp, ramp, move->speed, plan);
}
