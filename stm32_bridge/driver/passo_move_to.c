/* SPDX-License-Identifier: MIT
 * Moves to absolute positions: the distance from the end of the motions queued before.
 */
#include "passo_driver.h"

/* Checks that an absolute move can be queued, and finds where it starts. */
static enum passo_error find_start(struct passo *passo, const void *move, uint8_t axes, int32_t *start)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!move)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (axes == 0u || (unsigned)axes >> passo->machine.axes != 0u)
		return PASSO_ERROR_ARGUMENT_AXIS;
	error = passo_driver_ready(passo, false);
	return error != PASSO_OK ? error : passo_target(passo, start);
}

/* The shorter distance from a start to an end around 2^32 steps. */
static int32_t way(int32_t start, int32_t end)
{
	return (int32_t)((uint32_t)end - (uint32_t)start);
}

/* Converts end positions to distances. Returns false if all are 0. */
static bool aim(int32_t *steps, uint8_t axes, const int32_t *start)
{
	bool remains = false;

	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		steps[i] = ((unsigned)axes >> i & 1u) != 0u ? way(start[i], steps[i]) : 0;
		remains |= steps[i] != 0;
	}
	return remains;
}

/* Defines passo_move_to_METHOD() from passo_move_METHOD(). */
#define MOVE_TO_BY_STEPS(method, METHOD)                                                                     \
	enum passo_error passo_move_to_##method(                                                             \
	    struct passo *passo, uint8_t axes, const struct passo_move_##method *move)                       \
	{                                                                                                    \
		int32_t start[PASSO_AXES_MAX];                                                               \
		enum passo_error error = find_start(passo, move, axes, start);                               \
		if (error != PASSO_OK)                                                                       \
			return error;                                                                        \
		struct passo_move_##method relative = *move;                                                 \
		return aim(relative.steps, axes, start) ? passo_move_##method(passo, &relative) : PASSO_OK;  \
	}
PASSO_MOVES_BY_STEPS(MOVE_TO_BY_STEPS)

/* Defines passo_move_to_user_METHOD() from passo_move_user_METHOD(). */
#define MOVE_TO_BY_SHAPE(method, METHOD)                                                                     \
	enum passo_error passo_move_to_user_##method(struct passo *passo, uint8_t axes,                      \
	    const struct passo_move_##method *move, const struct passo_user_shape *shape)                    \
	{                                                                                                    \
		int32_t start[PASSO_AXES_MAX];                                                               \
		enum passo_error error = find_start(passo, move, axes, start);                               \
		if (error != PASSO_OK)                                                                       \
			return error;                                                                        \
		struct passo_move_##method relative = *move;                                                 \
		return aim(relative.steps, axes, start) ? passo_move_user_##method(passo, &relative, shape)  \
		                                        : PASSO_OK;                                          \
	}
PASSO_MOVES_BY_SHAPE(MOVE_TO_BY_SHAPE)

/* An end in units, rounded to steps. */
static enum passo_error round_end(int64_t steps, int32_t *end)
{
	*end = (int32_t)steps;
	return steps >= INT32_MIN && steps <= INT32_MAX
	         ? PASSO_OK
	         : (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)PASSO_PLAN_TOO_MANY_STEPS);
}

enum passo_error passo_move_to_turn(struct passo *passo, const struct passo_move_turn *move)
{
	int32_t start[PASSO_AXES_MAX], end;
	enum passo_error error = passo_driver_check_axis(passo, move ? move->axis : PASSO_AXES_MAX);

	if (error == PASSO_OK)
		error = find_start(passo, move, (uint8_t)(1u << move->axis), start);
	if (error == PASSO_OK)
		error = round_end(passo_steps_of_angle(move->angle, move->steps_per_turn), &end);
	if (error != PASSO_OK)
		return error;
	const int32_t steps = way(start[move->axis], end);
	struct passo_move_turn relative = *move;
	relative.angle = passo_angle_of(steps, move->steps_per_turn); /* rounds back to the same steps */
	return steps != 0 ? passo_move_turn(passo, &relative) : PASSO_OK;
}

enum passo_error passo_move_to_straight(
    struct passo *passo, uint8_t axes, const struct passo_move_straight *move)
{
	int32_t start[PASSO_AXES_MAX], end;
	enum passo_error error = find_start(passo, move, axes, start);
	bool remains = false;

	if (error != PASSO_OK)
		return error;
	struct passo_move_straight relative = *move;
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		uint64_t *scale = &relative.limits[i].steps_per_mm;
		relative.distance[i] = 0;
		if (((unsigned)axes >> i & 1u) == 0u)
			continue;
		if (*scale == 0u)
			*scale = passo->axis[i].steps_per_unit;
		if (*scale == 0u)
			return (enum passo_error)((unsigned)PASSO_ERROR_PLAN + (unsigned)PASSO_PLAN_NO_SCALE);
		error = round_end(passo_steps_of_length(move->distance[i], *scale), &end);
		if (error != PASSO_OK)
			return error;
		/* rounds back to the same steps */
		relative.distance[i] = passo_driver_units(way(start[i], end), *scale);
		if (relative.distance[i] == PASSO_NO_UNITS)
			return PASSO_ERROR_UNITS;
		remains |= relative.distance[i] != 0;
	}
	return remains ? passo_move_straight(passo, &relative) : PASSO_OK;
}
