/* SPDX-License-Identifier: MIT
 * Moves in exact time and distance with a given speed:
 *
 *   steps = speed * (total - ramp)
 * holds for every symmetric shape, so either of total and ramp determines the other.
 */
#include "passo_math.h"
#include "passo_plan_draft.h"

/* Duration of the steps at this speed, in clocks; rounded up so that the speed is not exceeded. */
static uint64_t clocks_at_speed(uint32_t clock_hz, uint32_t steps, uint64_t speed)
{
	return passo_mul_div_ceil(steps, (uint64_t)clock_hz << 32, speed);
}

uint64_t passo_longest_ramp(uint32_t clock_hz, uint32_t steps, uint64_t total_clocks, uint64_t speed)
{
	uint64_t flat = clocks_at_speed(clock_hz, steps, speed);
	return flat < total_clocks ? total_clocks - flat : 0;
}

/* Initializes a draft; *flat is its duration at constant speed, in ticks. */
static enum passo_plan_error start_at_speed(struct passo_draft *draft, uint64_t *flat,
    const struct passo_machine *machine, const int32_t *steps, enum passo_profile profile, uint64_t speed)
{
	enum passo_plan_error error = passo_draft_start(draft, machine, steps, profile);
	if (error != PASSO_PLAN_OK)
		return error;
	if (speed == 0)
		return PASSO_PLAN_NO_SPEED;
	*flat = passo_ticks_ceil(machine, clocks_at_speed(machine->clock_hz, draft->longest, speed));
	return PASSO_PLAN_OK;
}

enum passo_plan_error passo_plan_below_speed(
    const struct passo_machine *machine, const struct passo_move_below_speed *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	uint64_t flat;
	enum passo_plan_error error =
	    start_at_speed(&draft, &flat, machine, move->steps, move->profile, move->speed);
	if (error != PASSO_PLAN_OK)
		return error;
	uint64_t total = passo_ticks_nearest(machine, move->total_clocks);
	if (move->total_clocks >> machine->tick_log2 == 0)
		return PASSO_PLAN_NO_TIME;
	if (flat > total)
		return PASSO_PLAN_SPEED_TOO_LOW;

	/* A jerk-limited ramp has two equal halves; rounding it up would exceed the speed. */
	uint64_t ramp = total - flat;
	if (move->profile == PASSO_PROFILE_JERK)
		ramp &= ~UINT64_C(1);
	return passo_draft_in_ticks(&draft, total, ramp, move->speed, plan);
}

enum passo_plan_error passo_plan_at_speed(
    const struct passo_machine *machine, const struct passo_move_at_speed *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	uint64_t flat;
	enum passo_plan_error error =
	    start_at_speed(&draft, &flat, machine, move->steps, move->profile, move->speed);
	if (error != PASSO_PLAN_OK)
		return error;
	uint64_t ramp = passo_draft_halvable(&draft, passo_ticks_ceil(machine, move->ramp_clocks));
	if (ramp > flat)
		return PASSO_PLAN_RAMP_TOO_LONG;
	return passo_draft_in_ticks(&draft, flat + ramp, ramp, move->speed, plan);
}
