/* SPDX-License-Identifier: MIT
 * One motor: thin wrappers around the driver.
 */
#include "passo_motor.h"

#include <stddef.h>

#include "passo_driver.h"
#include "passo_math.h"

#define SECONDS_PER_MINUTE 60u

static enum passo_error check(const struct passo_motor *motor)
{
	if (!motor)
		return PASSO_ERROR_ARGUMENT_POINTER;
	return motor->passo ? PASSO_OK : PASSO_ERROR_NOT_OPEN;
}

enum passo_error passo_motor_init(struct passo_motor *motor, struct passo *passo, uint8_t axis,
    uint32_t steps_per_turn, uint64_t minimum_rpm, uint64_t acceleration)
{
	if (!motor || !passo)
		return PASSO_ERROR_ARGUMENT_POINTER;
	if (steps_per_turn == 0u)
		return PASSO_ERROR_ARGUMENT_STEPS_PER_TURN;
	if (axis >= PASSO_AXES_MAX)
		return PASSO_ERROR_ARGUMENT_AXIS;
	*motor = (struct passo_motor){
	    .passo = passo,
	    .axis = axis,
	    .steps_per_turn = steps_per_turn,
	    .minimum_rpm = minimum_rpm,
	    .acceleration = passo_mul_div(acceleration, steps_per_turn, SECONDS_PER_MINUTE),
	};
	return PASSO_OK;
}

static enum passo_error set(struct passo_motor *motor, bool absolute, int64_t degrees, uint64_t rpm)
{
	enum passo_error error = check(motor);

	if (error != PASSO_OK)
		return error;
	motor->absolute = absolute;
	motor->angle = degrees;
	motor->rpm = rpm;
	return PASSO_OK;
}

enum passo_error passo_motor_set_target(struct passo_motor *motor, int64_t degrees, uint64_t rpm)
{
	return set(motor, true, degrees, rpm);
}

enum passo_error passo_motor_set_angle(struct passo_motor *motor, int64_t degrees, uint64_t rpm)
{
	return set(motor, false, degrees, rpm);
}

enum passo_error passo_motor_start(struct passo_motor *motor)
{
	enum passo_error error = check(motor);

	if (error != PASSO_OK)
		return error;
	const struct passo_move_turn move = {
	    .axis = motor->axis,
	    .steps_per_turn = motor->steps_per_turn,
	    .angle = motor->angle,
	    .rpm = motor->rpm,
	    .minimum_rpm = motor->minimum_rpm < motor->rpm ? motor->minimum_rpm : motor->rpm,
	    .acceleration = motor->acceleration,
	};
	return motor->absolute ? passo_move_to_turn(motor->passo, &move)
	                       : passo_move_turn(motor->passo, &move);
}

enum passo_error passo_motor_start_endless(
    struct passo_motor *motor, bool backward, uint64_t rpm, uint64_t top_rpm)
{
	enum passo_error error = check(motor);

	if (error != PASSO_OK)
		return error;
	const struct passo_turning turning = {
	    .axis = motor->axis,
	    .steps_per_turn = motor->steps_per_turn,
	    .backward = backward,
	    .top_rpm = top_rpm,
	    .minimum_rpm = motor->minimum_rpm,
	    .acceleration = motor->acceleration,
	};
	return passo_turn_start(motor->passo, &turning, rpm);
}

/* Whether continuous rotation is in progress, or its end, as far as known. */
static bool is_endless(const struct passo_motor *motor)
{
	const struct passo *passo = motor->passo;

	return passo_is_moving(passo) && passo_driver_is_turning(passo) && !passo->has_aim
	    && passo->turning.axis == motor->axis;
}

/* The result of a change, which comes too late for a rotation that is ending. */
static enum passo_error unless_ending(enum passo_error error)
{
	return error == PASSO_ERROR_NOT_TURNING ? PASSO_OK : error;
}

enum passo_error passo_motor_set_speed(struct passo_motor *motor, uint64_t rpm)
{
	enum passo_error error = check(motor);

	if (error == PASSO_OK && is_endless(motor))
		error = unless_ending(passo_turn_speed(motor->passo, rpm));
	if (error == PASSO_OK)
		motor->rpm = rpm;
	return error;
}

enum passo_error passo_motor_stop(struct passo_motor *motor)
{
	enum passo_error error = check(motor);

	if (error != PASSO_OK)
		return error;
	return is_endless(motor) ? unless_ending(passo_turn_stop(motor->passo)) : passo_stop(motor->passo);
}

bool passo_motor_is_turning(const struct passo_motor *motor)
{
	return check(motor) == PASSO_OK && passo_is_moving(motor->passo);
}

enum passo_error passo_motor_angle(struct passo_motor *motor, int64_t *degrees)
{
	enum passo_error error = check(motor);

	return error != PASSO_OK ? error
	                         : passo_angle(motor->passo, motor->axis, motor->steps_per_turn, degrees);
}

enum passo_error passo_motor_speed(struct passo_motor *motor, uint64_t *rpm)
{
	enum passo_error error = check(motor);

	return error != PASSO_OK ? error : passo_rpm(motor->passo, motor->steps_per_turn, rpm);
}
