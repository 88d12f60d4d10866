/* SPDX-License-Identifier: MIT
 * From a draft to a plan: the stages shared by all methods; see passo_plan.c.
 */
#include "passo_plan_draft.h"

#include <stddef.h>

#include "passo_math.h"

/* Shape of each profile. A jerk-limited ramp uses its shape for the first curve and, mirrored, for the
 * second. */
static const enum passo_shape SHAPES[] = {
#define SHAPE(profile, shape, name) [PASSO_PROFILE_##profile] = (shape),
    PASSO_PROFILES(SHAPE)
#undef SHAPE
};

static uint32_t magnitude(int32_t steps)
{
	return steps < 0 ? 0u - (uint32_t)steps : (uint32_t)steps;
}

/* ----------------------------------------------------------------------------------------- 1. phases ---- */

enum passo_plan_error passo_draft_start(struct passo_draft *draft, const struct passo_machine *machine,
    const int32_t *steps, enum passo_profile profile)
{
	if (machine->clock_hz == 0 || machine->tick_log2 < PASSO_TICK_LOG2_MIN
	    || machine->tick_log2 > PASSO_TICK_LOG2_MAX)
		return PASSO_PLAN_BAD_CLOCK;
	if (machine->axes < 1 || machine->axes > PASSO_AXES_MAX)
		return PASSO_PLAN_BAD_AXES;
	if ((unsigned)profile >= PASSO_PROFILE_COUNT)
		return PASSO_PLAN_BAD_PROFILE;

	*draft = (struct passo_draft){
	    .machine = machine,
	    .steps = steps,
	    .profile = profile,
	    .shape = SHAPES[profile],
	    .sigmoid_alpha = profile == PASSO_PROFILE_SIGMOID ? PASSO_SIGMOID_ALPHA_RESET : 0,
	    .mean = PASSO_MEAN_HALF,
	};
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		if (magnitude(steps[axis]) > PASSO_SUBSTEPS_MAX)
			return PASSO_PLAN_TOO_MANY_STEPS;
		if (draft->longest < magnitude(steps[axis]))
			draft->longest = magnitude(steps[axis]);
	}
	return draft->longest > 0 ? PASSO_PLAN_OK : PASSO_PLAN_NO_STEPS;
}

bool passo_draft_is_too_long(const struct passo_draft *draft)
{
	uint64_t up = draft->accelerate.ticks, down = draft->decelerate.ticks, cruise = draft->cruise;
	return up > UINT32_MAX || cruise > UINT32_MAX || down > UINT32_MAX
	    || (up + cruise + down) >> (PASSO_MOVE_CLOCKS_LOG2 - draft->machine->tick_log2) > 0;
}

uint64_t passo_ticks_nearest(const struct passo_machine *machine, uint64_t clocks)
{
	return (clocks >> machine->tick_log2) + (clocks >> (machine->tick_log2 - 1) & 1);
}

/* Equal halves give a jerk-limited ramp exactly the mean speed of its ends. */
uint64_t passo_draft_halvable(const struct passo_draft *draft, uint64_t ticks)
{
	return draft->profile == PASSO_PROFILE_JERK ? ticks + (ticks & 1) : ticks;
}

uint64_t passo_ticks_ceil(const struct passo_machine *machine, uint64_t clocks)
{
	uint64_t ticks = clocks >> machine->tick_log2;
	return ticks + (ticks << machine->tick_log2 < clocks);
}

/* ----------------------------------------------------------------------------------- 2. oversampling ---- */

/* As many substeps per step as `fit` and the longest line allow. The number is even because a line starts
 * midway between two steps: each step of the longest axis then falls on a whole substep. */
void passo_draft_oversample_to(struct passo_draft *draft, uint64_t fit)
{
	uint32_t oversampling = (uint32_t)passo_smaller(fit, PASSO_SUBSTEPS_MAX / draft->longest);
	draft->oversampling = oversampling > 1 ? oversampling & ~UINT32_C(1) : oversampling;
}

/* Highest oversampling at this speed (UQ32.32 steps/s): at most half a substep per clock. */
uint64_t passo_oversampling_at(const struct passo_machine *machine, uint64_t speed)
{
	return PASSO_UNIT_Q32 / 2 * machine->clock_hz / speed;
}

uint32_t passo_draft_oversample(struct passo_draft *draft, uint64_t speed)
{
	passo_draft_oversample_to(draft, passo_oversampling_at(draft->machine, speed));
	return draft->oversampling;
}

uint64_t passo_draft_velocity(const struct passo_draft *draft, uint64_t speed)
{
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	return passo_mul_div(speed, units * draft->oversampling, draft->machine->clock_hz);
}

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
		line.steps[axis] = magnitude(draft->steps[axis]);
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
