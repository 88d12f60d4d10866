/* SPDX-License-Identifier: MIT
 * From a draft to a plan: the peak, then the line and its ramps; see passo_plan.c.
 */
#include <stddef.h>

#include "passo_plan_draft.h"

/* ------------------------------------------------------------------------------------------- 3. peak ---- */

/* Very long ramps round down: rounding to nearest would take their progress beyond 1. */
static uint64_t progress_step(uint64_t ticks)
{
	if (ticks == 0)
		return 0;
	uint64_t half = ticks <= UINT64_C(1) << 24 ? ticks / 2 : 0;
	return passo_smaller((PASSO_ONE_Q48 + half) / ticks, PASSO_PROGRESS_STEP_MAX);
}

int64_t passo_lacking_weight(uint64_t ticks, uint64_t divisor)
{
	uint64_t end = ticks * progress_step(ticks);
	bool beyond = end > PASSO_ONE_Q48;
	uint64_t lack = ticks * (beyond ? end - PASSO_ONE_Q48 : PASSO_ONE_Q48 - end);
	if (lack >> (48 - PASSO_WEIGHT_BITS) == 0)
		return 0;
	uint64_t weight = passo_mul_div(lack, ticks, divisor) >> (48 - PASSO_WEIGHT_BITS);
	return beyond ? -(int64_t)weight : (int64_t)weight;
}

/* Weight of a ramp's end velocity in its distance; the rest of the ticks is the weight of its start velocity.
 * All built-in shapes are symmetric, so it is half the ticks except for the rounding of progress_step(). A
 * jerk-limited ramp divides its change of velocity as curve/2 : straight : curve/2, which makes the
 * acceleration continuous where the parts meet. */
static uint64_t weight_of_end(const struct passo_draft *draft, struct passo_phase ramp, bool mirror)
{
	if (ramp.ticks == 0)
		return 0;
	if (draft->table_weight != NULL)
		return draft->table_weight(draft, ramp.ticks, mirror);
	uint64_t weight = ramp.ticks << (PASSO_WEIGHT_BITS - 1);
	if (draft->profile != PASSO_PROFILE_JERK)
		return weight - (uint64_t)passo_lacking_weight(ramp.ticks, 2 * ramp.ticks);
	uint64_t curve = (ramp.ticks - ramp.straight) / 2;
	uint64_t divisor = 2 * (curve + ramp.straight);
	int64_t lacking = passo_lacking_weight(curve, divisor) + passo_lacking_weight(ramp.straight, divisor);
	return weight - (uint64_t)lacking;
}

void passo_draft_weigh(struct passo_draft *draft)
{
	draft->accelerate.weight = weight_of_end(draft, draft->accelerate, false);
	draft->decelerate.weight = weight_of_end(draft, draft->decelerate, draft->mirrors);
}

/* Weight of a ramp's start velocity in its distance. */
static uint64_t weight_of_begin(struct passo_phase ramp)
{
	return (ramp.ticks << PASSO_WEIGHT_BITS) - ramp.weight;
}

/* Weight of the peak in the total distance. */
uint64_t passo_draft_weight(const struct passo_draft *draft)
{
	return draft->accelerate.weight + (draft->cruise << PASSO_WEIGHT_BITS)
	     + weight_of_begin(draft->decelerate);
}

/* Distance that the peak has to cover: the line minus the share of the start and stop velocities. In units of
 * velocity times weight. */
struct passo_u128 passo_draft_distance(const struct passo_draft *draft)
{
	struct passo_u128 line = {0, (uint64_t)draft->longest * draft->oversampling};
	line = passo_u128_shift_left(line, 48 + PASSO_WEIGHT_BITS - draft->machine->tick_log2);

	struct passo_u128 ends =
	    passo_u128_add(passo_multiply(draft->start, weight_of_begin(draft->accelerate)),
		passo_multiply(draft->stop, draft->decelerate.weight));

	return passo_u128_less(line, ends) ? (struct passo_u128){0, 0} : passo_u128_subtract(line, ends);
}

void passo_draft_solve(struct passo_draft *draft)
{
	uint64_t weight = passo_draft_weight(draft);
	struct passo_u128 half = {0, weight / 2};
	draft->peak = passo_divide(passo_u128_add(passo_draft_distance(draft), half), weight, NULL);
}

/* -------------------------------------------------------------------------------------------- result ---- */

void passo_plan_add_ramp(
    struct passo_plan *plan, enum passo_shape shape, bool mirror, uint64_t velocity_end, uint64_t ticks)
{
	plan->ramps[plan->ramp_count++] = (struct passo_ramp){
	    .mirror = mirror,
	    .shape = shape,
	    .velocity_end = velocity_end,
	    .ticks = (uint32_t)ticks,
	    .progress_step = progress_step(ticks),
	};
}

static void add_jump(struct passo_plan *plan, uint64_t velocity)
{
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, velocity, 0);
}

/* Adds the ramp between two velocities; in a jerk-limited ramp both curves take the same share of the
 * change. */
static void add_change(struct passo_plan *plan, const struct passo_draft *draft, struct passo_phase ramp,
    uint64_t from, uint64_t to)
{
	if (draft->profile != PASSO_PROFILE_JERK) {
		passo_plan_add_ramp(plan, draft->shape, draft->mirrors && to < from, to, ramp.ticks);
		return;
	}
	uint64_t curve = (ramp.ticks - ramp.straight) / 2;
	if (ramp.straight == 0) {
		passo_plan_add_ramp(plan, draft->shape, false, (from + to) / 2, curve);
	} else {
		uint64_t change = from < to ? to - from : from - to;
		uint64_t share = passo_mul_div(change, curve, 2 * (curve + ramp.straight));
		uint64_t end = from < to ? to - share : to + share;
		passo_plan_add_ramp(
		    plan, draft->shape, false, from < to ? from + share : from - share, curve);
		passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, end, ramp.straight);
	}
	passo_plan_add_ramp(plan, draft->shape, true, to, curve);
}

static struct passo_line line_of(const struct passo_draft *draft)
{
	struct passo_line line = {.last = true, .substeps = draft->longest * draft->oversampling};
	for (uint32_t axis = 0; axis < draft->machine->axes; axis++) {
		line.steps[axis] = passo_magnitude(draft->steps[axis]);
		if (draft->steps[axis] < 0)
			line.directions |= (uint8_t)(1u << axis);
	}
	return line;
}

/* Steps of the longest axis during deceleration, rounded to nearest. */
static uint32_t steps_to_stop(const struct passo_draft *draft)
{
	struct passo_u128 distance =
	    passo_u128_add(passo_multiply(draft->peak, weight_of_begin(draft->decelerate)),
		passo_multiply(draft->stop, draft->decelerate.weight));

	/* below 2^30 substeps, with a 16-bit fraction */
	const uint32_t surplus = 48 + PASSO_WEIGHT_BITS - 16 - draft->machine->tick_log2;
	uint64_t substeps = distance.high << (64 - surplus) | distance.low >> surplus;
	uint64_t step = (uint64_t)draft->oversampling << 16;
	return (uint32_t)((substeps + step / 2) / step);
}

void passo_draft_finish(const struct passo_draft *draft, struct passo_plan *plan)
{
	bool speeds_up = draft->accelerate.ticks > 0, slows_down = draft->decelerate.ticks > 0;
	*plan = (struct passo_plan){
	    .line = line_of(draft),
	    .oversampling = draft->oversampling,
	    .velocity_start = speeds_up ? draft->start : draft->peak,
	    .velocity_peak = draft->peak,
	    .velocity_stop = slows_down ? draft->stop : draft->peak,
	    .accelerate_ticks = (uint32_t)draft->accelerate.ticks,
	    .cruise_ticks = (uint32_t)draft->cruise,
	    .decelerate_ticks = (uint32_t)draft->decelerate.ticks,
	    .sigmoid_alpha = draft->sigmoid_alpha,
	    .steps_to_stop = steps_to_stop(draft),
	};

	if (plan->velocity_start > 0)
		add_jump(plan, plan->velocity_start);
	if (speeds_up)
		add_change(plan, draft, draft->accelerate, draft->start, draft->peak);
	if (draft->cruise > 0)
		passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, draft->peak, draft->cruise);
	if (slows_down)
		add_change(plan, draft, draft->decelerate, draft->peak, draft->stop);
	if (plan->velocity_stop > 0)
		add_jump(plan, 0);
	plan->ramps[plan->ramp_count - 1].last = true;
}
