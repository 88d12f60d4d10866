/* SPDX-License-Identifier: MIT
 * Moves by speed: ramps, cruise phase, and the limits of a move.
 */
#include <stddef.h>

#include "passo_math.h"
#include "passo_plan_draft.h"
#include "passo_plan_slope.h"

/* Rounded up, so the ramp is never steeper than its slope. */
static struct passo_phase ramp_phase(
    const struct passo_draft *draft, struct passo_slope slope, uint64_t low, uint64_t high)
{
	uint64_t clocks = low < high ? passo_slope_clocks_ceil(slope, high - low) : 0;
	uint64_t ticks = passo_ticks_ceil(draft->machine, clocks);
	if (!passo_slope_is_eased(&slope) || clocks == 0)
		return (struct passo_phase){passo_draft_halvable(draft, ticks), 0, 0};
	uint64_t curve = passo_ticks_ceil(draft->machine, passo_slope_curve(slope, high - low, clocks));
	uint64_t straight = ticks > curve ? ticks - curve : 0;
	return (struct passo_phase){2 * curve + straight, straight, 0};
}

static enum passo_plan_error find_slope(struct passo_slope *slope, const struct passo_draft *draft,
    const struct passo_rise *rise, uint64_t end_speed, uint64_t speed)
{
	uint32_t clock_hz = draft->machine->clock_hz;
	if (speed == end_speed)
		*slope = PASSO_VERTICAL;
	else if (rise->acceleration > 0)
		*slope = (struct passo_slope){clock_hz, rise->acceleration, 0, 0};
	else if (rise->ramp_clocks > 0)
		*slope = (struct passo_slope){rise->ramp_clocks, speed - end_speed, 0, 0};
	else
		return PASSO_PLAN_NO_ACCELERATION;
#ifdef PASSO_LINEAR_MOVES
	if (rise->jerk > 0)
		return PASSO_PLAN_BAD_PROFILE;
#endif
	if (rise->jerk > 0 && speed > end_speed) {
		slope->ease = passo_mul_div_ceil(rise->acceleration, clock_hz, rise->jerk);
		slope->jerk = rise->jerk;
	}
	bool too_long = slope->ease > PASSO_SLOPE_CLOCKS_MAX
	             || passo_slope_clocks(*slope, speed) > PASSO_SLOPE_CLOCKS_MAX;
	return too_long ? PASSO_PLAN_TOO_LONG : PASSO_PLAN_OK;
}

/* Ticks of the cruise phase: the distance that the ramps do not cover, at the highest velocity allowed;
 * rounded up. */
static uint64_t cruise_ticks(const struct passo_draft *draft, uint64_t velocity)
{
	uint64_t remainder;
	uint64_t weight = passo_divide(passo_draft_distance(draft), velocity, &remainder);
	uint64_t ramps = passo_draft_weight(draft);
	if (weight < ramps)
		return 0;
	uint64_t missing = weight - ramps;
	uint64_t ticks = missing >> PASSO_WEIGHT_BITS;
	bool needs_more = ticks << PASSO_WEIGHT_BITS < missing || remainder > 0;
	bool weightless =
	    ramps == 0 && ticks == 0; /* a user-defined shape may be 0 in the middle of its only tick */
	return ticks + (needs_more || weightless);
}

/* In moves of a few ticks, rounding up can make the peak lower than the start or stop velocity. That ramp
 * then becomes part of the cruise phase. This raises the peak, but not above the velocity it was below, so no
 * limit is exceeded if the higher velocity is handled first. Returns true if the peak has to be solved
 * again. */
static bool flatten_ramp(struct passo_draft *draft)
{
	bool below_start = draft->accelerate.ticks > 0 && draft->peak < draft->start;
	bool below_stop = draft->decelerate.ticks > 0 && draft->peak < draft->stop;
	struct passo_phase *ramp;
	if (below_start && (!below_stop || draft->start >= draft->stop))
		ramp = &draft->accelerate;
	else if (below_stop)
		ramp = &draft->decelerate;
	else
		return false;
	draft->cruise += ramp->ticks;
	*ramp = (struct passo_phase){0, 0, 0};
	return true;
}

enum passo_plan_error passo_draft_by_speed(
    struct passo_draft *draft, const struct passo_limits *limits, struct passo_plan *plan)
{
	uint64_t start = limits->start_speed, speed = limits->speed, stop = limits->stop_speed;
	if (speed == 0)
		return PASSO_PLAN_NO_SPEED;
	if (passo_oversampling_at(draft->machine, speed) == 0)
		return PASSO_PLAN_TOO_FAST;
	if (start > speed)
		return PASSO_PLAN_START_ABOVE_SPEED;
	if (stop > speed)
		return PASSO_PLAN_STOP_ABOVE_SPEED;

	struct passo_slope up, down;
	enum passo_plan_error error = find_slope(&up, draft, &limits->up, start, speed);
	if (error == PASSO_PLAN_OK)
		error = find_slope(&down, draft, &limits->down, stop, speed);
	if (error != PASSO_PLAN_OK)
		return error;

	/* A move too short for its start or stop speed omits that ramp and starts or stops at the peak. It
	 * cannot be too short for both: the peak is above the lower of the two. */
	uint64_t peak = passo_slope_reach(draft, speed, &up, start, &down, stop);
	if (peak < start) {
		up = PASSO_VERTICAL;
		peak = passo_slope_reach(draft, start, &up, 0, &down, stop);
	} else if (peak < stop) {
		down = PASSO_VERTICAL;
		peak = passo_slope_reach(draft, stop, &up, start, &down, 0);
	}
	draft->accelerate = ramp_phase(draft, up, start, peak);
	draft->decelerate = ramp_phase(draft, down, stop, peak);
	if (passo_draft_is_too_long(draft))
		return PASSO_PLAN_TOO_LONG;
	passo_draft_weigh(draft);

	passo_draft_oversample(draft, peak);
	draft->start = passo_draft_velocity(draft, start);
	draft->stop = passo_draft_velocity(draft, stop);
	draft->cruise = cruise_ticks(draft, passo_draft_velocity(draft, peak));
	do {
		if (passo_draft_is_too_long(draft))
			return PASSO_PLAN_TOO_LONG;
		passo_draft_solve(draft);
	} while (flatten_ramp(draft));

	passo_draft_finish(draft, plan);
	return PASSO_PLAN_OK;
}

struct passo_limits passo_limits_of(const struct passo_move_by_speed *move)
{
	uint64_t deceleration = move->deceleration > 0 ? move->deceleration : move->acceleration;
	return (struct passo_limits){
	    .start_speed = move->start_speed,
	    .speed = move->speed,
	    .stop_speed = move->stop_speed,
	    .up = {.acceleration = move->acceleration, .ramp_clocks = move->ramp_clocks},
	    .down = {.acceleration = deceleration, .ramp_clocks = move->ramp_clocks},
	};
}

enum passo_plan_error passo_plan_by_speed(
    const struct passo_machine *machine, const struct passo_move_by_speed *move, struct passo_plan *plan)
{
	struct passo_draft draft;
	enum passo_plan_error error = passo_draft_start(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	const struct passo_limits limits = passo_limits_of(move);
	return passo_draft_by_speed(&draft, &limits, plan);
}
