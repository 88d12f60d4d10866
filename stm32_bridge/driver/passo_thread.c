/* SPDX-License-Identifier: MIT
 * Threads: an encoder count is a clock of the profile, or 2^scale clocks, and the velocity is the path per
 * count.
 */
#include "passo_driver.h"
#include "passo_math.h"
#include "passo_plan_draft.h"

#define SCALE_MAX ((1u << PASSO_CHANNEL_FOLLOW_SCALE_BITS) - 1u)
#define LIMIT_MAX (UINT32_C(1) << 31)
#define OWED_SIGN (UINT32_C(1) << (PASSO_CHANNEL_FOLLOW_STATE_OWED_BITS - 1u))

static enum passo_error of_plan(enum passo_plan_error error)
{
	return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)error);
}

static uint32_t magnitude(int32_t steps)
{
	return steps < 0 ? 0u - (uint32_t)steps : (uint32_t)steps;
}

/* Fills in the steps of the line; returns those of the dominant axis. */
static uint32_t take_steps(const struct passo_thread *thread, struct passo_line *line)
{
	uint32_t longest = 0;

	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		line->steps[i] = magnitude(thread->steps[i]);
		line->directions = (uint8_t)(line->directions | (thread->steps[i] < 0 ? 1u << i : 0u));
		longest = line->steps[i] > longest ? line->steps[i] : longest;
	}
	return longest;
}

/* Substeps per step: as many as the clocks, two for a substep, allow; 1 or even. */
static uint32_t oversampling_of(uint32_t longest, uint64_t clocks)
{
	const uint64_t fit = clocks / 2u / longest;
	const uint64_t most = PASSO_SUBSTEPS_MAX / longest;
	const uint32_t oversampling = (uint32_t)(fit < most ? fit : most);

	return oversampling > 1u ? oversampling & ~UINT32_C(1) : oversampling;
}

/* Line and ramps, with the smallest possible scale. */
static enum passo_error plan_thread(
    const struct passo *passo, const struct passo_thread *thread, struct passo_plan *plan, uint8_t *scale)
{
	const uint8_t tick_log2 = passo->machine.tick_log2;
	const uint32_t longest = take_steps(thread, &plan->line);

	if (longest == 0u)
		return of_plan(PASSO_PLAN_NO_STEPS);
	if (longest > PASSO_SUBSTEPS_MAX)
		return of_plan(PASSO_PLAN_TOO_MANY_STEPS);
	if (thread->counts == 0u)
		return PASSO_ERROR_NO_COUNTS;
	for (*scale = 0; (uint64_t)thread->counts << *scale < 2u * (uint64_t)longest; ++*scale) {
		if (*scale == SCALE_MAX)
			return PASSO_ERROR_STEEP;
	}
	const uint64_t clocks = (uint64_t)thread->counts << *scale;
	const uint64_t ticks = (clocks + (UINT64_C(1) << tick_log2) - 1u) >> tick_log2;
	if (ticks > UINT32_MAX)
		return of_plan(PASSO_PLAN_TOO_LONG);
	plan->oversampling = oversampling_of(longest, clocks);
	plan->line.substeps = longest * plan->oversampling;
	plan->line.endless = thread->endless;
	plan->line.last = !thread->endless;
	const uint64_t velocity = passo_mul_div_ceil(PASSO_ONE_Q48, plan->line.substeps, clocks);
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, velocity, 0);
	if (!thread->endless) {
		passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, velocity, ticks);
		plan->ramps[1].last = true;
	}
	return PASSO_OK;
}

enum passo_error passo_driver_follow(struct passo *passo, const struct passo_channel_follow *follow,
    uint64_t top_speed, struct passo_plan *plan)
{
	const uint64_t limit =
	    passo_mul_div_ceil(top_speed, UINT64_C(1) << follow->scale, passo->machine.clock_hz);
	const uint32_t words[] = {passo_pack_channel_follow(follow), (uint32_t)limit};

	if (limit == 0u || limit > LIMIT_MAX)
		return PASSO_ERROR_FOLLOW_SPEED;
	plan->velocity_peak = passo_mul_div_ceil(plan->velocity_peak, limit, UINT64_C(1) << 32);
	const enum passo_error error = passo_driver_ready(passo, true);
	if (error != PASSO_OK)
		return error;
	passo->follows = true;
	passo->spindle = follow->source;
	return passo_driver_moving(
	    passo_driver_write(passo, PASSO_CHANNEL_FOLLOW, words, sizeof words / sizeof words[0]));
}

enum passo_error passo_thread(struct passo *passo, const struct passo_thread *thread)
{
	struct passo_plan plan = {.ramp_count = 0};
	uint8_t scale = 0;
	enum passo_error error = passo_driver_check_encoders(passo);

	if (error == PASSO_OK && !thread)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK && thread->encoder >= passo->axes)
		error = PASSO_ERROR_ARGUMENT_AXIS;
	if (error != PASSO_OK)
		return error;
	for (unsigned i = passo->machine.axes; i < PASSO_AXES_MAX; i++) {
		if (thread->steps[i] != 0)
			return PASSO_ERROR_ARGUMENT_AXIS;
	}
	error = plan_thread(passo, thread, &plan, &scale);
	if (error != PASSO_OK)
		return error;
	const struct passo_channel_follow follow = {
	    .follow = true, .wait_index = thread->wait_index, .source = thread->encoder, .scale = scale};
	plan.velocity_peak = plan.ramps[0].velocity_end;
	error = passo_driver_follow(passo, &follow, thread->top_speed, &plan);
	return error == PASSO_OK ? passo_driver_queue(passo, &plan, NULL) : error;
}

enum passo_error passo_read_thread(struct passo *passo, struct passo_thread_state *state)
{
	uint32_t word, edges;
	enum passo_error error = passo_driver_check_encoders(passo);

	if (error == PASSO_OK && !state)
		error = PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_host_read(
		    passo->host, (uint16_t)(passo->base + PASSO_CHANNEL_FOLLOW_STATE), &word, 1);
	if (error != PASSO_OK)
		return error;
	const unsigned index =
	    PASSO_CHANNEL_ENCODER_BASE + passo->spindle * PASSO_CHANNEL_ENCODER_STRIDE + PASSO_ENCODER_INDEX;
	error = passo_host_read(passo->host, (uint16_t)(passo->base + index), &edges, 1);
	if (error != PASSO_OK)
		return error;
	const struct passo_channel_follow_state now = passo_unpack_channel_follow_state(word);
	*state = (struct passo_thread_state){.owed = (int32_t)((now.owed ^ OWED_SIGN) - OWED_SIGN),
	    .behind = now.behind,
	    .lost = now.lost,
	    .illegal = passo_unpack_encoder_index(edges).illegal};
	return PASSO_OK;
}
