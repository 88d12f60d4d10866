/* SPDX-License-Identifier: MIT
 * A draft, its phases and its oversampling; see passo_plan.c.
 */
#include "passo_plan_draft.h"

/* Shape of each profile. A jerk-limited ramp uses its shape for the first curve and, mirrored, for the
 * second. */
static const enum passo_shape SHAPES[] = {
#define SHAPE(profile, shape, name) [PASSO_PROFILE_##profile] = (shape),
    PASSO_PROFILES(SHAPE)
#undef SHAPE
};

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
		if (passo_magnitude(steps[axis]) > PASSO_SUBSTEPS_MAX)
			return PASSO_PLAN_TOO_MANY_STEPS;
		if (draft->longest < passo_magnitude(steps[axis]))
			draft->longest = passo_magnitude(steps[axis]);
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
