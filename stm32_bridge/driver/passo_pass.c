/* SPDX-License-Identifier: MIT
 * Passes: lines whose substeps are a power of two for each count, under common ramps.
 */
#include "passo_driver.h"
#include "passo_math.h"
#include "passo_plan_draft.h"

#ifndef PASSO_WITHOUT_THREADS

#define SCALE_MAX ((1u << PASSO_CHANNEL_FOLLOW_SCALE_BITS) - 1u)
#define SCALE_MIN 3u      /* so that half a count is a whole number of substeps */
#define SUBSTEPS_LOG2 2u  /* clocks of the profile per substep: the peak may be twice as fast */
#define RUN_IN_TICKS 5u   /* at least: the lead is then made within PASSO_PASS_PEAK_TENTHS */
#define CATCH_UP_TICKS 8u /* at least */

static enum passo_error of_plan(enum passo_plan_error error)
{
	return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)error);
}

/* The largest one at which a count is over before the next. */
static uint8_t scale_of(const struct passo *passo, uint64_t top_speed)
{
	uint8_t scale = SCALE_MAX;

	while (scale > SCALE_MIN && top_speed >> (32u - scale) >= passo->machine.clock_hz / 2u)
		scale--;
	return scale;
}

/* The line of a plan; returns false if it has more steps than substeps. */
static bool take_line(const struct passo_pass_line *given, uint8_t scale, struct passo_plan *plan)
{
	plan->line = (struct passo_line){.substeps = given->half_counts << (scale - SUBSTEPS_LOG2 - 1u)};
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		plan->line.steps[i] = (uint32_t)passo_size64(given->steps[i]);
		plan->line.directions =
		    (uint8_t)(plan->line.directions | (given->steps[i] < 0 ? 1u << i : 0u));
		if (plan->line.steps[i] > plan->line.substeps)
			return false;
	}
	return true;
}

/* In half counts; 0 if it is too much, or a line is empty. */
static uint64_t length_of(const struct passo_pass *pass, uint8_t scale)
{
	uint64_t sum = 0;

	for (unsigned i = 0; i < pass->lines; i++) {
		const uint64_t own = pass->line[i].half_counts;

		if (own == 0 || own << (scale - SUBSTEPS_LOG2 - 1u) > PASSO_SUBSTEPS_MAX)
			return 0;
		sum += own;
	}
	return sum;
}

static uint64_t ticks_of(const struct passo *passo, uint64_t counts, uint8_t scale)
{
	const uint8_t tick = passo->machine.tick_log2;

	return ((counts << scale) + (UINT64_C(1) << tick) - 1u) >> tick;
}

/* Two ramps of equal length to one and a half times the speed and back to it make what both would have made
 * at the speed. The first one goes a little higher, for what is behind. */
static enum passo_error add_ramps(
    const struct passo *passo, const struct passo_pass *pass, uint8_t scale, struct passo_plan *plan)
{
	const uint8_t tick = passo->machine.tick_log2;
	const uint64_t speed = PASSO_ONE_Q48 >> SUBSTEPS_LOG2, half_count = UINT64_C(1) << (scale - 1u);
	const uint64_t behind = pass->run_in > 0u ? 1u : pass->behind, length = length_of(pass, scale);
	const uint64_t out = ticks_of(passo, pass->run_out, scale);
	uint64_t in = ticks_of(passo, pass->run_in, scale);

	if (pass->run_in > 0u)
		in = in > RUN_IN_TICKS ? in : RUN_IN_TICKS;
	else
		in = ticks_of(passo, 2u * behind, scale) + CATCH_UP_TICKS;
	const uint64_t extra = passo_mul_div(behind * half_count, speed, in) >> tick;
	const uint64_t before = behind * half_count + (pass->run_in > 0u ? in << (tick + 1u) : in << tick);
	const uint64_t all = length * half_count, after = out << (tick - 1u);

	if (length == 0u)
		return PASSO_ERROR_NO_COUNTS;
	if (all < before + after)
		return of_plan(PASSO_PLAN_RAMP_TOO_LONG);
	const uint64_t steady = ((all - before - after) >> tick) + 1u;
	if (steady > UINT32_MAX)
		return of_plan(PASSO_PLAN_TOO_LONG);
	if (pass->run_in > 0u) {
		plan->velocity_peak = speed + speed / 2u + extra;
		passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, plan->velocity_peak, in);
	} else {
		plan->velocity_peak = speed + 2u * extra;
		passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, plan->velocity_peak, 0);
	}
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, speed, in);
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, speed, steady);
	if (out > 0u)
		passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, 0, out);
	plan->ramps[plan->ramp_count - 1u].last = true;
	return PASSO_OK;
}

static enum passo_error check(const struct passo *passo, const struct passo_pass *pass)
{
	const enum passo_error error = passo_driver_check_encoders(passo);

	if (error != PASSO_OK)
		return error;
	if (!pass)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (pass->lines == 0u || pass->lines > PASSO_PASS_LINES_MAX)
		return PASSO_ERROR_ARGUMENT;
	for (unsigned i = passo->machine.axes; i < PASSO_AXES_MAX; i++) {
		for (unsigned line = 0; line < pass->lines; line++)
			if (pass->line[line].steps[i] != 0)
				return PASSO_ERROR_ARGUMENT_AXIS;
	}
	return pass->encoder < passo->axes ? PASSO_OK : PASSO_ERROR_ARGUMENT_AXIS;
}

/* Behind the first line. The next motion has the output that was set before. */
static enum passo_error queue_rest(
    struct passo *passo, const struct passo_pass *pass, uint8_t scale, struct passo_plan *plan)
{
	const struct passo_output before = passo->output;
	enum passo_error error = PASSO_OK;

	if (pass->then)
		passo->output = *pass->then;
	for (unsigned i = 1; i < pass->lines && error == PASSO_OK; i++) {
		take_line(&pass->line[i], scale, plan);
		plan->line.last = i + 1u == pass->lines;
		error = passo_driver_queue_line(passo, plan);
	}
	passo->output = before;
	return error;
}

enum passo_error passo_pass(struct passo *passo, const struct passo_pass *pass)
{
	struct passo_plan plan = {.ramp_count = 0};
	enum passo_error error = check(passo, pass);

	if (error != PASSO_OK)
		return error;
	const uint8_t scale = scale_of(passo, pass->top_speed);
	const struct passo_channel_follow follow = {
	    .follow = true, .wait_index = pass->wait_index, .source = pass->encoder, .scale = scale};
	error = add_ramps(passo, pass, scale, &plan);
	if (error != PASSO_OK)
		return error;
	const uint64_t peak = plan.velocity_peak;
	for (unsigned i = pass->lines; i-- > 0u;) {
		if (!take_line(&pass->line[i], scale, &plan))
			return PASSO_ERROR_STEEP;
		plan.velocity_peak =
		    passo_mul_div_ceil(peak, pass->top_speed >> (32u - scale), passo->machine.clock_hz);
		if (!passo_driver_pins_suffice(passo, &plan))
			return PASSO_ERROR_PINS_TOO_SLOW;
	}
	plan.line.last = pass->lines == 1u;
	plan.oversampling = 1;
	plan.velocity_peak = peak;
	error = passo_driver_follow(passo, &follow, pass->top_speed, &plan);
	if (error == PASSO_OK)
		error = passo_driver_queue(passo, &plan, NULL);
	return error == PASSO_OK ? queue_rest(passo, pass, scale, &plan) : error;
}

#endif
