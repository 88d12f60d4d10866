/* SPDX-License-Identifier: MIT
 * Moves: plan, check, queue. The ramps are sent first, because the line starts the motion.
 */
#include "passo_driver.h"
#include "passo_math.h"

#define VELOCITY_BITS 48u
/* Implausible values: below 1/65536 per second, mm or degree, or a move below 1/10000 s. */
#define RATE_ABSURD (PASSO_UNIT_Q32 >> 16)
#define MOVES_PER_S_ABSURD 10000u

/* Rejects plans that exceed the pin timing of an axis. */
bool passo_driver_pins_suffice(const struct passo *passo, const struct passo_plan *plan)
{
	const struct passo_u128 path =
	    passo_u128_shift_left((struct passo_u128){0, plan->line.substeps}, VELOCITY_BITS);

	for (unsigned i = 0; i < passo->machine.axes; i++) {
		struct passo_u128 busy = passo_multiply(
		    plan->velocity_peak, (uint64_t)plan->line.steps[i] * passo->axis[i].shortest_clocks);
		if (passo_u128_less(path, busy))
			return false;
	}
	return true;
}

/* Converts the result of a push to an error of the driver. After a link error it is unknown whether the core
 * executed it. */
static enum passo_error push_result(struct passo *passo, enum passo_error error, bool half_done)
{
	if ((unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_BUSY)
		return PASSO_ERROR_STOPPED; /* it just stopped, which flushed the queues */
	if ((unsigned)error == PASSO_ERROR_REFUSED + PASSO_VERDICT_QUEUE_FULL && !half_done)
		return PASSO_ERROR_FULL;
	if (error != PASSO_OK && (half_done || passo_driver_is_link_error(error)))
		passo_driver_break(passo);
	return error;
}

enum passo_error passo_driver_push_ramps(struct passo *passo, const struct passo_plan *plan)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_RAMP);
	uint32_t words[PASSO_PLAN_RAMPS_MAX * PASSO_RAMP_WORDS];
	size_t length = 0;

	for (uint32_t i = 0; i < plan->ramp_count; i++)
		length += passo_ramp_words(words + length, &plan->ramps[i]);
	return push_result(passo, passo_host_push(passo->host, address, words, length), false);
}

static enum passo_error push_line(struct passo *passo, const struct passo_line *line)
{
	const uint16_t address = (uint16_t)(passo->base + PASSO_CHANNEL_LINE);
	uint32_t words[PASSO_LINE_WORDS(PASSO_AXES_MAX) + 1u];
	size_t length = passo_driver_line_words(passo, words, line);

	return push_result(passo, passo_host_push(passo->host, address, words, length), true);
}

enum passo_error passo_driver_queue(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape)
{
	struct passo_line line = plan->line;
	enum passo_error error = passo_driver_output(passo, plan, &line.output);

	if (error != PASSO_OK)
		return error;
	if (!passo_driver_pins_suffice(passo, plan))
		return PASSO_ERROR_PINS_TOO_SLOW;
	error = passo_driver_ready(passo, plan->line.endless);
	if (error == PASSO_OK && !passo_driver_pins_known(passo, &plan->line))
		error = PASSO_ERROR_NOT_CONFIGURED;
	if (error == PASSO_OK
	    && (passo->snapshot.line_room == 0u || passo->snapshot.ramp_room < plan->ramp_count))
		error = PASSO_ERROR_FULL;
	if (error == PASSO_OK)
		error = passo_driver_tables(passo, plan, shape);
	if (error == PASSO_OK)
		error = passo_driver_gate(passo, passo->gate);
	if (error == PASSO_OK)
		error = passo_driver_push_ramps(passo, plan);
	if (error == PASSO_OK)
		error = push_line(passo, &line);
	if (error != PASSO_OK)
		return error;
	passo->oversampling = plan->oversampling;
	passo->velocity_peak = plan->velocity_peak;
	passo_driver_expect(passo, &plan->line);
	return PASSO_OK;
}

enum passo_error passo_driver_queue_line(struct passo *passo, const struct passo_plan *plan)
{
	struct passo_line line = plan->line;
	enum passo_error error = passo_driver_output(passo, plan, &line.output);

	if (error == PASSO_OK)
		error = push_line(passo, &line);
	if (error == PASSO_OK)
		passo_driver_expect(passo, &plan->line);
	return error;
}

enum passo_error passo_move_plan(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!plan || (shape && !shape->table))
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (plan->ramp_count == 0u || plan->ramp_count > PASSO_PLAN_RAMPS_MAX)
		return PASSO_ERROR_ARGUMENT_PLAN;
	error = passo_driver_unfollow(passo);
	return error != PASSO_OK ? error : passo_driver_queue(passo, plan, shape);
}

/* Whether a speed, acceleration, jerk or scale, UQ32.32, lacks its factor. */
static bool is_slow(uint64_t rate)
{
	return rate != 0u && rate < RATE_ABSURD;
}

/* Whether a length or angle, Q31.32, lacks its factor. */
static bool is_short(int64_t length)
{
	return length != 0 && length < (int64_t)RATE_ABSURD && length > -(int64_t)RATE_ABSURD;
}

/* For each form: whether it has such a number, and its time in clocks, 0 if none. */
#define SLOW_in_time(move) false
#define SLOW_by_speed(move)                                                                                  \
	(is_slow((move)->speed) || is_slow((move)->acceleration) || is_slow((move)->deceleration))
#define SLOW_below_speed(move) is_slow((move)->speed)
#define SLOW_at_speed(move) is_slow((move)->speed)
#define SLOW_axes(move) is_slow((move)->speed)
#define SLOW_sigmoid(move) is_slow((move)->speed)
#define SLOW_jerk(move) (is_slow((move)->speed) || is_slow((move)->acceleration) || is_slow((move)->jerk))
#define TIME_in_time(move) (move)->total_clocks
#define TIME_by_speed(move) 0u
#define TIME_below_speed(move) (move)->total_clocks
#define TIME_at_speed(move) 0u
#define TIME_axes(move) 0u
#define TIME_sigmoid(move) 0u
#define TIME_jerk(move) 0u

/* Whether the planner's error is that of a number without its unit. */
static bool is_absurd(
    const struct passo *passo, enum passo_plan_error error, bool slow, uint64_t total_clocks)
{
	const bool brief = total_clocks != 0u && total_clocks < passo->machine.clock_hz / MOVES_PER_S_ABSURD;

	switch (error) {
	case PASSO_PLAN_TOO_LONG:
		return slow;
	case PASSO_PLAN_SPEED_TOO_LOW:
		return slow || brief;
	case PASSO_PLAN_NO_TIME:
	case PASSO_PLAN_TOO_FAST:
	case PASSO_PLAN_RAMP_TOO_LONG:
		return brief;
	default:
		return false;
	}
}

/* Queues a plan, or converts the error of the planner. */
static enum passo_error move_planned(struct passo *passo, enum passo_plan_error error,
    const struct passo_plan *plan, const struct passo_user_shape *shape, bool slow, uint64_t total_clocks)
{
	if (error == PASSO_PLAN_OK)
		return passo_move_plan(passo, plan, shape);
	const enum passo_error base =
	    is_absurd(passo, error, slow, total_clocks) ? PASSO_ERROR_ABSURD : PASSO_ERROR_PLAN;
	return (enum passo_error)((unsigned)base + (unsigned)error);
}

static enum passo_error check(const struct passo *passo, const void *move)
{
	enum passo_error error = passo_driver_check(passo);

	return error == PASSO_OK && !move ? PASSO_ERROR_ARGUMENT_POINTER : error;
}

/* Steps on axes that the channel does not have are an error. */
static enum passo_error check_steps(const struct passo *passo, const void *move, const int32_t *steps)
{
	enum passo_error error = check(passo, move);

	for (unsigned i = error == PASSO_OK ? passo->machine.axes : PASSO_AXES_MAX; i < PASSO_AXES_MAX; i++) {
		if (steps[i] != 0)
			return PASSO_ERROR_ARGUMENT_AXIS;
	}
	return error;
}

/* Defines passo_move_METHOD() from passo_plan_METHOD(). */
#define MOVE_BY_STEPS(method, METHOD)                                                                        \
	enum passo_error passo_move_##method(struct passo *passo, const struct passo_move_##method *move)    \
	{                                                                                                    \
		struct passo_plan plan;                                                                      \
		enum passo_error error = check_steps(passo, move, move ? move->steps : NULL);                \
		if (error != PASSO_OK)                                                                       \
			return error;                                                                        \
		return move_planned(passo, passo_plan_##method(&passo->machine, move, &plan), &plan, NULL,   \
		    SLOW_##method(move), TIME_##method(move));                                               \
	}
PASSO_MOVES_BY_STEPS(MOVE_BY_STEPS)

/* Defines passo_move_user_METHOD() from passo_plan_user_METHOD(). */
#define MOVE_BY_SHAPE(method, METHOD)                                                                        \
	enum passo_error passo_move_user_##method(struct passo *passo,                                       \
	    const struct passo_move_##method *move, const struct passo_user_shape *shape)                    \
	{                                                                                                    \
		struct passo_plan plan;                                                                      \
		enum passo_error error = check_steps(passo, move, move ? move->steps : NULL);                \
		if (error != PASSO_OK || !shape || !shape->table)                                            \
			return error != PASSO_OK ? error : PASSO_ERROR_ARGUMENT_POINTER;                     \
		return move_planned(passo, passo_plan_user_##method(&passo->machine, move, shape, &plan),    \
		    &plan, shape, SLOW_##method(move), TIME_##method(move));                                 \
	}
PASSO_MOVES_BY_SHAPE(MOVE_BY_SHAPE)

enum passo_error passo_move_turn(struct passo *passo, const struct passo_move_turn *move)
{
	struct passo_plan plan;
	enum passo_error error = check(passo, move);

	if (error != PASSO_OK)
		return error;
	const enum passo_plan_error result = passo_plan_turn(&passo->machine, move, &plan);
	if (result == PASSO_PLAN_NO_STEPS && is_short(move->angle))
		return (enum passo_error)(PASSO_ERROR_ABSURD + PASSO_PLAN_NO_STEPS);
	return move_planned(passo, result, &plan, NULL, is_slow(move->rpm) || is_slow(move->acceleration), 0);
}

enum passo_error passo_move_straight(struct passo *passo, const struct passo_move_straight *move)
{
	struct passo_plan plan;
	enum passo_error error = check(passo, move);

	if (error != PASSO_OK)
		return error;
	struct passo_move_straight scaled = *move;
	bool slow = is_slow(move->feed), is_tiny = false;
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		if (i >= passo->machine.axes && move->distance[i] != 0)
			error = PASSO_ERROR_ARGUMENT_AXIS;
		if (scaled.limits[i].steps_per_mm == 0u)
			scaled.limits[i].steps_per_mm = passo->axis[i].steps_per_unit;
		slow |= is_slow(scaled.limits[i].speed) || is_slow(scaled.limits[i].acceleration)
		     || is_slow(scaled.limits[i].steps_per_mm);
		is_tiny |= is_short(move->distance[i]);
	}
	if (error != PASSO_OK)
		return error;
	const enum passo_plan_error result = passo_plan_straight(&passo->machine, &scaled, &plan);
	if (result == PASSO_PLAN_NO_STEPS && is_tiny)
		return (enum passo_error)(PASSO_ERROR_ABSURD + PASSO_PLAN_NO_STEPS);
	return move_planned(passo, result, &plan, NULL, slow, 0);
}
