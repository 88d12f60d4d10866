/* SPDX-License-Identifier: MIT
 * The planner: from a move to one line and a few ramps.
 *
 * Every plan is made in the same order:
 *
 *   1. phases        how many ticks the move speeds up, keeps its speed and slows down
 *   2. oversampling  how many substeps a step is worth: as many as the highest velocity allows
 *   3. peak          the one velocity at which exactly these ticks cover exactly these substeps
 *
 * Step 3 alone decides where the move ends, and it reckons with the numbers the core will use: ticks,
 * velocities and progress as they are after rounding. What comes before need only be on the safe side.
 *
 * What remains between the distance under the ramps and M, in substeps, for moves of less than 2^44 clocks:
 *
 *   peak to the nearest 2^-48                at most 2^44 / 2 * 2^-48 = 1/32
 *   velocities inside ramps down to 2^-48    at most 2^44     * 2^-48 = 1/16, as a rule half of that
 *   weights of ramps down to 2^-24           at most 2^-9, where a tick has 2^16 clocks
 *
 * That is less than 0.1 after days and less than 0.001 after minutes. The core bears 1/4: a motion starts
 * with a quarter of a substep in its phase.
 *
 * One thing is out of the planner's reach. The core knows progress to 24 bits, so a ramp can come out longer
 * or shorter by up to 2^-24 (as a rule below 2^-30) of ticks * change of velocity. Where both ramps have the
 * same ticks and speeds the second takes back what the first has added; otherwise it can show in ramps of
 * some ten seconds. No step is lost by it: the core makes missing substeps at the end, and none beyond M.
 */
#include "passo_plan.h"

#include <stddef.h>

#include "passo_math.h"

/* Weights are ticks in units of 2^-24. */
#define WEIGHT_BITS 24u

/* Longest move, two days at 100 MHz; see above. */
#define MOVE_CLOCKS_LOG2 44u

/* Flattest slope: so long from rest to the full speed. Keeps the sums of reachable_speed() below 2^128. */
#define SLOPE_CLOCKS_MAX (UINT64_C(1) << 62)

/* A move on its way to a plan. */
struct draft {
	const struct passo_machine *machine;
	const int32_t *steps;
	enum passo_profile profile;
	uint32_t longest;                        /* steps of the longest axis */
	uint32_t oversampling;                   /* substeps in one of them */
	uint64_t accelerate, cruise, decelerate; /* ticks; 64 bits to notice what is too long */
	uint64_t start, peak, stop;              /* UQ0.48 substeps per clock */
};

/* How steep a ramp is: it changes the speed by `speed` (UQ32.32 steps/s) in `clocks`. */
struct slope {
	uint64_t clocks, speed;
};

/* Any change of speed in no time. */
static const struct slope VERTICAL = {0, 1};

/* The profiles' shapes. A jerk-limited ramp eases in and, mirrored, out. */
static const enum passo_shape SHAPES[] = {
    [PASSO_PROFILE_LINEAR] = PASSO_SHAPE_LINEAR,
    [PASSO_PROFILE_COSINE] = PASSO_SHAPE_COSINE,
    [PASSO_PROFILE_SIGMOID] = PASSO_SHAPE_SIGMOID,
    [PASSO_PROFILE_JERK] = PASSO_SHAPE_EASE,
};

static uint64_t smaller(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static uint32_t magnitude(int32_t steps)
{
	return steps < 0 ? 0u - (uint32_t)steps : (uint32_t)steps;
}

/* ----------------------------------------------------------------------------------------- 1. phases ---- */

static enum passo_plan_error start_draft(struct draft *draft, const struct passo_machine *machine,
    const int32_t *steps, enum passo_profile profile)
{
	if (machine->clock_hz == 0 || machine->tick_log2 < 7 || machine->tick_log2 > 16)
		return PASSO_PLAN_BAD_CLOCK;
	if (machine->axes < 1 || machine->axes > PASSO_AXES_MAX)
		return PASSO_PLAN_BAD_AXES;
	if ((unsigned)profile > PASSO_PROFILE_JERK)
		return PASSO_PLAN_BAD_PROFILE;

	*draft = (struct draft){.machine = machine, .steps = steps, .profile = profile};
	for (uint32_t axis = 0; axis < machine->axes; axis++) {
		if (steps[axis] == INT32_MIN)
			return PASSO_PLAN_TOO_MANY_STEPS;
		if (draft->longest < magnitude(steps[axis]))
			draft->longest = magnitude(steps[axis]);
	}
	return draft->longest > 0 ? PASSO_PLAN_OK : PASSO_PLAN_NO_STEPS;
}

static bool is_too_long(const struct draft *draft)
{
	uint64_t ticks = draft->accelerate + draft->cruise + draft->decelerate;
	return draft->accelerate > UINT32_MAX || draft->cruise > UINT32_MAX || draft->decelerate > UINT32_MAX ||
	    ticks >> (MOVE_CLOCKS_LOG2 - draft->machine->tick_log2) > 0;
}

static uint64_t nearest_ticks(const struct draft *draft, uint64_t clocks)
{
	return (clocks >> draft->machine->tick_log2) + (clocks >> (draft->machine->tick_log2 - 1) & 1);
}

/* The two halves of a jerk-limited ramp are equal, which makes its mean speed exactly that of its ends. */
static uint64_t halvable(const struct draft *draft, uint64_t ticks)
{
	return draft->profile == PASSO_PROFILE_JERK ? ticks + (ticks & 1) : ticks;
}

static uint64_t clocks_floor(struct slope slope, uint64_t change)
{
	return passo_mul_div(change, slope.clocks, slope.speed);
}

static uint64_t clocks_ceil(struct slope slope, uint64_t change)
{
	return passo_mul_div_ceil(change, slope.clocks, slope.speed);
}

/* Rounded up: a longer ramp is a gentler one. */
static uint64_t ramp_ticks(const struct draft *draft, struct slope slope, uint64_t low, uint64_t high)
{
	uint64_t clocks = low < high ? clocks_ceil(slope, high - low) : 0;
	uint64_t ticks = clocks >> draft->machine->tick_log2;
	return halvable(draft, ticks + (ticks << draft->machine->tick_log2 < clocks));
}

/* ----------------------------------------------------------------------------------- 2. oversampling ---- */

/* As many substeps per step as `fit` and 32 bits of M allow. An even number, because a line starts in the
 * middle between two steps: then each step of the longest axis is due on a whole substep. */
static void oversample(struct draft *draft, uint64_t fit)
{
	uint32_t oversampling = (uint32_t)smaller(fit, UINT32_MAX / draft->longest);
	draft->oversampling = oversampling > 1 ? oversampling & ~UINT32_C(1) : oversampling;
}

/* Substeps per step that make at most half a substep per clock at this speed (UQ32.32 steps/s). */
static uint64_t oversampling_at(const struct passo_machine *machine, uint64_t speed)
{
	return PASSO_UNIT_Q32 / 2 * machine->clock_hz / speed;
}

/* Rounded down: no velocity is above the speed it stands for. */
static uint64_t velocity_of(const struct draft *draft, uint64_t speed)
{
	const uint64_t units = PASSO_ONE_Q48 / PASSO_UNIT_Q32;
	return passo_mul_div(speed, units * draft->oversampling, draft->machine->clock_hz);
}

/* ------------------------------------------------------------------------------------------- 3. peak ---- */

/* Rounding to the nearest would take very long ramps' progress beyond 1. */
static uint64_t progress_step(uint64_t ticks)
{
	if (ticks == 0)
		return 0;
	uint64_t half = ticks <= UINT64_C(1) << 24 ? ticks / 2 : 0;
	return smaller((PASSO_ONE_Q48 + half) / ticks, PASSO_PROGRESS_STEP_MAX);
}

/* How much a ramp's distance owes to the velocity it leads to; the rest of its ticks count at the velocity
 * it comes from. All shapes are symmetric, so it is the ticks times half the progress at the end, which is
 * 1 but for the rounding of progress_step. The second half of a jerk-limited ramp stands, throughout, on
 * what the first has gained. */
static uint64_t weight_of_end(const struct draft *draft, uint64_t ticks)
{
	bool in_halves = draft->profile == PASSO_PROFILE_JERK;
	uint64_t part = in_halves ? ticks / 2 : ticks;
	uint64_t progress = part * progress_step(part) + (in_halves ? PASSO_ONE_Q48 : 0);
	struct passo_u128 weight = passo_multiply(part, progress);
	const uint32_t surplus = 48 + 1 - WEIGHT_BITS;
	return weight.high << (64 - surplus) | weight.low >> surplus;
}

/* Weight of the peak in the distance of all phases. */
static uint64_t weight_of_peak(const struct draft *draft)
{
	return weight_of_end(draft, draft->accelerate) +
	    ((draft->cruise + draft->decelerate) << WEIGHT_BITS) - weight_of_end(draft, draft->decelerate);
}

/* The distance that the peak has to cover: the whole line without what is owed to the start and stop
 * velocities. In units of velocity times weight. */
static struct passo_u128 distance_of_peak(const struct draft *draft)
{
	struct passo_u128 line = {0, (uint64_t)draft->longest * draft->oversampling};
	line = passo_u128_shift_left(line, 48 + WEIGHT_BITS - draft->machine->tick_log2);

	uint64_t start_weight = (draft->accelerate << WEIGHT_BITS) - weight_of_end(draft, draft->accelerate);
	uint64_t stop_weight = weight_of_end(draft, draft->decelerate);
	struct passo_u128 ends =
	    passo_u128_add(passo_multiply(draft->start, start_weight), passo_multiply(draft->stop, stop_weight));

	return passo_u128_less(line, ends) ? (struct passo_u128){0, 0} : passo_u128_subtract(line, ends);
}

static void solve_peak(struct draft *draft)
{
	uint64_t weight = weight_of_peak(draft);
	struct passo_u128 half = {0, weight / 2};
	draft->peak = passo_divide(passo_u128_add(distance_of_peak(draft), half), weight, NULL);
}

/* -------------------------------------------------------------------------------------------- result ---- */

static void add_ramp(struct passo_plan *plan, enum passo_shape shape, bool mirror, uint64_t velocity_end,
    uint64_t ticks)
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
	add_ramp(plan, PASSO_SHAPE_LINEAR, false, velocity, 0);
}

static void add_change(struct passo_plan *plan, enum passo_profile profile, uint64_t from, uint64_t to,
    uint64_t ticks)
{
	bool in_halves = profile == PASSO_PROFILE_JERK;
	if (in_halves) {
		ticks /= 2;
		add_ramp(plan, SHAPES[profile], false, (from + to) / 2, ticks);
	}
	add_ramp(plan, SHAPES[profile], in_halves, to, ticks);
}

static struct passo_line line_of(const struct draft *draft)
{
	struct passo_line line = {.last = true, .substeps = draft->longest * draft->oversampling};
	for (uint32_t axis = 0; axis < draft->machine->axes; axis++) {
		line.steps[axis] = magnitude(draft->steps[axis]);
		if (draft->steps[axis] < 0)
			line.directions |= (uint8_t)(1u << axis);
	}
	return line;
}

static void finish_plan(const struct draft *draft, struct passo_plan *plan)
{
	*plan = (struct passo_plan){
	    .line = line_of(draft),
	    .oversampling = draft->oversampling,
	    .velocity_start = draft->accelerate > 0 ? draft->start : draft->peak,
	    .velocity_peak = draft->peak,
	    .velocity_stop = draft->decelerate > 0 ? draft->stop : draft->peak,
	    .accelerate_ticks = (uint32_t)draft->accelerate,
	    .cruise_ticks = (uint32_t)draft->cruise,
	    .decelerate_ticks = (uint32_t)draft->decelerate,
	};

	if (plan->velocity_start > 0)
		add_jump(plan, plan->velocity_start);
	if (draft->accelerate > 0)
		add_change(plan, draft->profile, draft->start, draft->peak, draft->accelerate);
	if (draft->cruise > 0)
		add_ramp(plan, PASSO_SHAPE_LINEAR, false, draft->peak, draft->cruise);
	if (draft->decelerate > 0)
		add_change(plan, draft->profile, draft->peak, draft->stop, draft->decelerate);
	if (plan->velocity_stop > 0)
		add_jump(plan, 0);
	plan->ramps[plan->ramp_count - 1].last = true;
}

/* ------------------------------------------------------------------------------------------- in time ---- */

enum passo_plan_error passo_plan_in_time(
    const struct passo_machine *machine, const struct passo_move_in_time *move, struct passo_plan *plan)
{
	struct draft draft;
	enum passo_plan_error error = start_draft(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	if (move->total_clocks >> machine->tick_log2 == 0)
		return PASSO_PLAN_NO_TIME;
	if (move->ramp_clocks > move->total_clocks / 2)
		return PASSO_PLAN_RAMP_TOO_LONG;

	/* Ramps of half the time can round to more than half the ticks; less than 2 ticks cannot be halved. */
	uint64_t total = nearest_ticks(&draft, move->total_clocks);
	uint64_t ramp = halvable(&draft, nearest_ticks(&draft, move->ramp_clocks));
	uint64_t longest_ramp = draft.profile == PASSO_PROFILE_JERK ? total / 4 * 2 : total / 2;
	draft.accelerate = draft.decelerate = smaller(ramp, longest_ramp);
	draft.cruise = total - 2 * draft.accelerate;
	if (is_too_long(&draft))
		return PASSO_PLAN_TOO_LONG;

	/* M = peak * weight, and the peak is at most 1/2. */
	oversample(&draft, (weight_of_peak(&draft) >> (WEIGHT_BITS + 1 - machine->tick_log2)) / draft.longest);
	if (draft.oversampling == 0)
		return PASSO_PLAN_TOO_FAST;

	solve_peak(&draft);
	finish_plan(&draft, plan);
	return PASSO_PLAN_OK;
}

/* ------------------------------------------------------------------------------------------ by speed ---- */

/* The slope between an end's speed and the full speed: given by an acceleration or, where that is 0, by
 * the duration of the ramp. */
static enum passo_plan_error find_slope(struct slope *slope, const struct passo_move_by_speed *move,
    uint64_t acceleration, uint32_t clock_hz, uint64_t end_speed)
{
	uint64_t change = move->speed - end_speed;
	if (change == 0)
		*slope = VERTICAL;
	else if (acceleration > 0)
		*slope = (struct slope){clock_hz, acceleration};
	else if (move->ramp_clocks > 0)
		*slope = (struct slope){move->ramp_clocks, change};
	else
		return PASSO_PLAN_NO_ACCELERATION;
	return clocks_floor(*slope, move->speed) > SLOPE_CLOCKS_MAX ? PASSO_PLAN_TOO_LONG : PASSO_PLAN_OK;
}

/* The highest speed, up to a limit, that a move of this length can reach. With a, d the slopes as
 * accelerations:
 *
 *   length = (peak^2 - start^2) / 2a + (peak^2 - stop^2) / 2d
 *   peak^2 = (2 length + start * start/a + stop * stop/d) / (1/a + 1/d)
 *
 * Any speed divided by an acceleration is a number of clocks. So that 1/a and 1/d are numbers of clocks
 * too, numerator and denominator are multiplied by the limit. Rounded up: too high a peak costs a little
 * time, nothing else. */
static uint64_t reachable_speed(const struct draft *draft, uint64_t limit, struct slope up, uint64_t start,
    struct slope down, uint64_t stop)
{
	uint64_t length = (uint64_t)draft->longest * draft->machine->clock_hz;
	struct passo_u128 sum = passo_multiply(length, 2 * PASSO_UNIT_Q32);
	sum = passo_u128_add(sum, passo_multiply(start, clocks_ceil(up, start)));
	sum = passo_u128_add(sum, passo_multiply(stop, clocks_ceil(down, stop)));

	uint64_t quotient = passo_divide(sum, clocks_floor(up, limit) + clocks_floor(down, limit), NULL);
	if (quotient >= limit)
		return limit;
	return smaller(limit, passo_isqrt128(passo_multiply(quotient + 1, limit)) + 1);
}

/* The distance the ramps leave over, in ticks at a velocity that the peak must not exceed; rounded up. */
static uint64_t cruise_ticks(const struct draft *draft, uint64_t velocity)
{
	uint64_t remainder;
	uint64_t weight = passo_divide(distance_of_peak(draft), velocity, &remainder);
	uint64_t ramps = weight_of_peak(draft);
	if (weight < ramps)
		return 0;
	uint64_t missing = weight - ramps;
	uint64_t ticks = missing >> WEIGHT_BITS;
	return ticks + (ticks << WEIGHT_BITS < missing || remainder > 0);
}

/* In moves of a few ticks, rounding up to whole ticks can let the peak fall below the start or stop
 * velocity. Then that ramp's ticks are run at the peak instead. This lifts the peak, but not above the
 * velocity it was below, so no limit is exceeded if the higher velocity goes first. True if the peak must
 * be solved anew. */
static bool flatten_ramp(struct draft *draft)
{
	bool below_start = draft->accelerate > 0 && draft->peak < draft->start;
	bool below_stop = draft->decelerate > 0 && draft->peak < draft->stop;
	uint64_t *ramp;
	if (below_start && (!below_stop || draft->start >= draft->stop))
		ramp = &draft->accelerate;
	else if (below_stop)
		ramp = &draft->decelerate;
	else
		return false;
	draft->cruise += *ramp;
	*ramp = 0;
	return true;
}

enum passo_plan_error passo_plan_by_speed(
    const struct passo_machine *machine, const struct passo_move_by_speed *move, struct passo_plan *plan)
{
	struct draft draft;
	enum passo_plan_error error = start_draft(&draft, machine, move->steps, move->profile);
	if (error != PASSO_PLAN_OK)
		return error;
	if (move->speed == 0)
		return PASSO_PLAN_NO_SPEED;
	if (oversampling_at(machine, move->speed) == 0)
		return PASSO_PLAN_TOO_FAST;
	if (move->start_speed > move->speed)
		return PASSO_PLAN_START_ABOVE_SPEED;
	if (move->stop_speed > move->speed)
		return PASSO_PLAN_STOP_ABOVE_SPEED;

	struct slope up, down;
	uint64_t deceleration = move->deceleration > 0 ? move->deceleration : move->acceleration;
	error = find_slope(&up, move, move->acceleration, machine->clock_hz, move->start_speed);
	if (error == PASSO_PLAN_OK)
		error = find_slope(&down, move, deceleration, machine->clock_hz, move->stop_speed);
	if (error != PASSO_PLAN_OK)
		return error;

	/* A move too short for its start speed, or for its stop speed, does without that ramp: it jumps to less,
	 * or from less. It cannot be too short for both, the peak lies above the lower of the two. */
	uint64_t peak = reachable_speed(&draft, move->speed, up, move->start_speed, down, move->stop_speed);
	if (peak < move->start_speed) {
		up = VERTICAL;
		peak = reachable_speed(&draft, move->start_speed, up, 0, down, move->stop_speed);
	} else if (peak < move->stop_speed) {
		down = VERTICAL;
		peak = reachable_speed(&draft, move->stop_speed, up, move->start_speed, down, 0);
	}
	draft.accelerate = ramp_ticks(&draft, up, move->start_speed, peak);
	draft.decelerate = ramp_ticks(&draft, down, move->stop_speed, peak);
	if (is_too_long(&draft))
		return PASSO_PLAN_TOO_LONG;

	oversample(&draft, oversampling_at(machine, peak));
	draft.start = velocity_of(&draft, move->start_speed);
	draft.stop = velocity_of(&draft, move->stop_speed);
	draft.cruise = cruise_ticks(&draft, velocity_of(&draft, peak));
	do {
		if (is_too_long(&draft))
			return PASSO_PLAN_TOO_LONG;
		solve_peak(&draft);
	} while (flatten_ramp(&draft));

	finish_plan(&draft, plan);
	return PASSO_PLAN_OK;
}

/* -------------------------------------------------------------------------------------------- errors ---- */

static const struct {
	const char *name, *text;
} ERRORS[] = {
    [PASSO_PLAN_OK] = {"OK", "The plan is good."},
    [PASSO_PLAN_BAD_CLOCK] = {"BAD_CLOCK", "The clock must be above 0 Hz and a tick 2^7 to 2^16 clocks."},
    [PASSO_PLAN_BAD_AXES] = {"BAD_AXES", "A move has 1 to 8 axes."},
    [PASSO_PLAN_BAD_PROFILE] = {"BAD_PROFILE", "The profile must be linear, cosine, sigmoid or jerk."},
    [PASSO_PLAN_NO_STEPS] = {"NO_STEPS", "No axis has a step to make."},
    [PASSO_PLAN_TOO_MANY_STEPS] = {"TOO_MANY_STEPS", "An axis can make at most 2^31 - 1 steps in one move."},
    [PASSO_PLAN_NO_TIME] = {"NO_TIME", "The total time is less than one tick."},
    [PASSO_PLAN_RAMP_TOO_LONG] = {"RAMP_TOO_LONG", "The ramp time is more than half the total time."},
    [PASSO_PLAN_TOO_LONG] = {"TOO_LONG", "A phase takes 2^32 ticks or more, or the move 2^44 clocks."},
    [PASSO_PLAN_TOO_FAST] = {"TOO_FAST", "The longest axis would make more than a step every two clocks."},
    [PASSO_PLAN_NO_SPEED] = {"NO_SPEED", "The speed is 0."},
    [PASSO_PLAN_NO_ACCELERATION] = {"NO_ACCELERATION", "A change of speed needs acceleration or ramp time."},
    [PASSO_PLAN_START_ABOVE_SPEED] = {"START_ABOVE_SPEED", "The start speed is above the speed."},
    [PASSO_PLAN_STOP_ABOVE_SPEED] = {"STOP_ABOVE_SPEED", "The stop speed is above the speed."},
};

static bool is_known(enum passo_plan_error error)
{
	return (unsigned)error < sizeof(ERRORS) / sizeof(ERRORS[0]);
}

const char *passo_plan_error_name(enum passo_plan_error error)
{
	return is_known(error) ? ERRORS[error].name : "UNKNOWN";
}

const char *passo_plan_error_text(enum passo_plan_error error)
{
	return is_known(error) ? ERRORS[error].text : "This is not a planner error.";
}
