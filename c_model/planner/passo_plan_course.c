/* SPDX-License-Identifier: MIT
 * Courses: one axis to a target that can change during the motion.
 *
 * Distances are in half ticks of velocity: a linear ramp from a to b of T ticks covers (a + b) T of them.
 */
#include <stddef.h>

#include "passo_math.h"
#include "passo_plan_draft.h"

#define PHASE_START (PASSO_ONE_Q48 / 4u) /* of a motion, in substeps */
#define UNIT_BITS 32u
#define VELOCITY_BITS 48u
#define WAY_BITS 16u
#define OVERSAMPLING_MIN 2u /* the last step then comes before what rounding adds to the distance */

/* Bounds of the current speed, and of the velocity. */
struct present {
	uint64_t low, high, velocity;
};

static uint64_t apart(uint64_t a, uint64_t b)
{
	return a < b ? b - a : a - b;
}

static uint64_t larger(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

static enum passo_plan_error start(struct passo_draft *draft, int32_t steps[PASSO_AXES_MAX],
    const struct passo_machine *machine, const struct passo_course *course)
{
	if (course->axis >= machine->axes || course->axis >= PASSO_AXES_MAX)
		return PASSO_PLAN_BAD_AXIS;
	steps[course->axis] = course->backward ? -1 : 1;
	enum passo_plan_error error = passo_draft_start(draft, machine, steps, PASSO_PROFILE_LINEAR);
	if (error != PASSO_PLAN_OK)
		return error;
	if (course->speed > course->top_speed)
		return PASSO_PLAN_ABOVE_TOP;
	if (course->speed == 0)
		return PASSO_PLAN_NO_SPEED;
	if (passo_draft_oversample(draft, course->top_speed) < OVERSAMPLING_MIN)
		return PASSO_PLAN_TOO_FAST;
	if (passo_draft_velocity(draft, course->speed) == 0)
		return PASSO_PLAN_NO_SPEED;
	return course->acceleration > 0 ? PASSO_PLAN_OK : PASSO_PLAN_NO_ACCELERATION;
}

/* The highest speed from which the axis stops within the distance: with low <= v <= high at the beginning,
 *
 *   way = (top - low) (top + high) / 2a + top^2 / 2a
 *   2 top^2 + (high - low) top - low high = 2 a way */
static uint64_t reachable(const struct passo_course *course, struct present present, uint64_t way)
{
	const struct passo_u128 area = passo_multiply(course->acceleration, way);
	const uint64_t spread = present.high - present.low;

	if (passo_bits(area) > 128u - 21u) /* headroom for the factors and the other terms */
		return UINT64_MAX;
	struct passo_u128 sum = passo_u128_shift_left(area, 1u + UNIT_BITS - WAY_BITS);
	sum = passo_u128_add(sum, passo_multiply(present.low, present.high));
	sum = passo_u128_add(passo_u128_shift_left(sum, 3), passo_multiply(spread, spread));
	return (passo_isqrt128(sum) - spread) / 4u;
}

static uint64_t ticks_of(const struct passo_draft *draft, const struct passo_course *course, uint64_t change)
{
	return passo_ticks_ceil(
	    draft->machine, passo_mul_div_ceil(change, draft->machine->clock_hz, course->acceleration));
}

static struct passo_u128 distance_of(const struct passo_draft *draft, uint64_t way)
{
	return passo_u128_shift_left(passo_multiply(way, draft->oversampling),
	    VELOCITY_BITS - WAY_BITS + 1u - draft->machine->tick_log2);
}

static void add(struct passo_plan *plan, uint64_t velocity, uint64_t ticks)
{
	passo_plan_add_ramp(plan, PASSO_SHAPE_LINEAR, false, velocity, ticks);
}

enum passo_plan_error passo_plan_course(const struct passo_machine *machine,
    const struct passo_course *course, uint32_t steps, struct passo_plan *plan)
{
	struct passo_draft draft;
	int32_t sign[PASSO_AXES_MAX] = {0};
	const struct present rest = {0, 0, 0};
	const uint64_t way = (uint64_t)steps << WAY_BITS;
	enum passo_plan_error error = start(&draft, sign, machine, course);

	if (error == PASSO_PLAN_OK && steps == 0)
		error = PASSO_PLAN_NO_STEPS;
	if (error != PASSO_PLAN_OK)
		return error;
	const uint64_t top = passo_smaller(reachable(course, rest, way), course->speed);
	const uint64_t ramp = ticks_of(&draft, course, top);
	const struct passo_u128 distance = passo_u128_subtract(
	    distance_of(&draft, way), (struct passo_u128){0, PHASE_START >> (machine->tick_log2 - 1u)});
	/* rounded up: the speed is not exceeded; then the peak that fits the ticks */
	const uint64_t least = larger(passo_draft_velocity(&draft, top), 1u);
	uint64_t remainder;
	uint64_t ticks = passo_divide(distance, 2u * least, &remainder);
	ticks += remainder != 0u;
	const uint64_t cruise = ticks > ramp ? ticks - ramp : 0u;
	if (ramp > PASSO_COURSE_RAMP_TICKS_MAX || cruise > UINT32_MAX)
		return PASSO_PLAN_TOO_LONG;
	const uint64_t peak = passo_divide(distance, 2u * (ramp + cruise), NULL);
	const uint32_t count = PASSO_SUBSTEPS_MAX / draft.oversampling;
	struct passo_plan made = {
	    .line = {.endless = true,
		.substeps = count * draft.oversampling,
		.directions = (uint8_t)(course->backward ? 1u << course->axis : 0u)},
	    .oversampling = draft.oversampling,
	    .velocity_peak = peak,
	    .accelerate_ticks = (uint32_t)ramp,
	    .cruise_ticks = (uint32_t)cruise,
	    .decelerate_ticks = (uint32_t)ramp,
	};
	made.line.steps[course->axis] = count;
	add(&made, peak, ramp);
	if (cruise != 0u)
		add(&made, peak, cruise);
	add(&made, 0, ramp);
	made.ramps[made.ramp_count - 1u].last = true;
	*plan = made;
	return PASSO_PLAN_OK;
}

/* One ramp to rest. */
static enum passo_plan_error to_rest(const struct passo_draft *draft, const struct passo_course *course,
    struct present present, uint64_t way, struct passo_plan *plan)
{
	const uint64_t ticks = ticks_of(draft, course, present.high);

	if (ticks > PASSO_COURSE_RAMP_TICKS_MAX)
		return PASSO_PLAN_TOO_LONG;
	if (way != 0u && passo_u128_less(distance_of(draft, way), passo_multiply(ticks, present.velocity)))
		return PASSO_PLAN_TOO_NEAR;
	plan->decelerate_ticks = (uint32_t)ticks;
	add(plan, 0, ticks);
	return PASSO_PLAN_OK;
}

/* Three ramps: to a speed, cruise, to rest. False: the distance is too short. */
static bool along(const struct passo_draft *draft, const struct passo_course *course, struct present present,
    uint64_t way, struct passo_plan *plan)
{
	uint64_t top = course->speed;

	if (top >= present.high) {
		top = passo_smaller(top, reachable(course, present, way));
		if (top < present.high)
			return false;
	}
	const uint64_t change = larger(apart(top, present.low), apart(top, present.high));
	const uint64_t first = ticks_of(draft, course, change), last = ticks_of(draft, course, top);
	if (first > PASSO_COURSE_RAMP_TICKS_MAX || last > PASSO_COURSE_RAMP_TICKS_MAX)
		return false;
	const struct passo_u128 distance = distance_of(draft, way);
	const struct passo_u128 entry = passo_multiply(present.velocity, first);
	if (passo_u128_less(distance, entry))
		return false;
	const struct passo_u128 rest = passo_u128_subtract(distance, entry);
	/* rounding to ticks may exceed the distance: then the peak that fits, which is between the bounds
	 * of the present speed and the top */
	const uint64_t fits = passo_divide(rest, first + last, NULL);
	const uint64_t peak = passo_smaller(passo_draft_velocity(draft, top), fits);
	if (peak == 0u
	    || (peak == fits && peak <= passo_draft_velocity(draft, passo_smaller(present.low, top))))
		return false;
	const uint64_t cruise = passo_smaller(
	    passo_divide(passo_u128_subtract(rest, passo_multiply(peak, first + last)), 2u * peak, NULL),
	    UINT32_MAX);
	plan->velocity_peak = peak;
	plan->accelerate_ticks = (uint32_t)first;
	plan->cruise_ticks = (uint32_t)cruise;
	plan->decelerate_ticks = (uint32_t)last;
	add(plan, peak, first);
	if (cruise != 0u)
		add(plan, peak, cruise);
	add(plan, 0, last);
	return true;
}

enum passo_plan_error passo_plan_course_change(const struct passo_machine *machine,
    const struct passo_course *course, uint64_t low, uint64_t high, uint64_t way, struct passo_plan *plan)
{
	struct passo_draft draft;
	int32_t sign[PASSO_AXES_MAX] = {0};
	enum passo_plan_error error = start(&draft, sign, machine, course);

	if (error != PASSO_PLAN_OK)
		return error;
	const struct present present = {
	    passo_smaller(low, high), high, passo_draft_velocity(&draft, high) + 1u};
	struct passo_plan made = {.oversampling = draft.oversampling,
	    .velocity_start = present.velocity,
	    .velocity_peak = present.velocity};
	if (way == 0u || !along(&draft, course, present, way, &made))
		error = to_rest(&draft, course, present, way, &made);
	if (error != PASSO_PLAN_OK)
		return error;
	made.ramps[0].now = true;
	made.ramps[made.ramp_count - 1u].last = true;
	*plan = made;
	return PASSO_PLAN_OK;
}
