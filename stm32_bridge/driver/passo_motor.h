/* SPDX-License-Identifier: MIT
 * One motor with the simplest interface: target or angle, rpm, start, stop. Thin wrappers around passo.h,
 * whose errors they return.
 *
 *     passo_motor_init(&motor, &passo, 0, 200 * 16, PASSO_RPM(10), PASSO_RPM_PER_S(600));
 *     passo_motor_set_target(&motor, PASSO_DEGREES(-90), PASSO_RPM(60));
 *     passo_motor_start(&motor);
 *     while (passo_motor_is_turning(&motor))
 *             passo_poll(&passo);
 */
#ifndef PASSO_MOTOR_H
#define PASSO_MOTOR_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

struct passo_motor {
	struct passo *passo;
	uint8_t axis;
	uint32_t steps_per_turn; /* steps per revolution */
	uint64_t minimum_rpm;    /* UQ32.32: initial and final speed */
	uint64_t acceleration;   /* UQ32.32 steps/s^2 */
	int64_t angle;           /* Q31.32 degrees: of the next start */
	bool absolute;           /* the angle is counted from position 0, not from the end of the last move */
	uint64_t rpm;            /* UQ32.32: of the next start */
};

/* Initializes a motor on an axis of an open channel. `steps_per_turn` is full steps times microsteps;
 * `minimum_rpm` in rpm and `acceleration` in rpm per second, both UQ32.32. No frame. Error: ARGUMENT. */
enum passo_error passo_motor_init(struct passo_motor *motor, struct passo *passo, uint8_t axis,
    uint32_t steps_per_turn, uint64_t minimum_rpm, uint64_t acceleration);

/* Sets the angle (Q31.32 degrees) and the speed (UQ32.32 rpm) of the next start. A target is absolute,
 * counted from position 0 over full turns as well; an angle is relative to the end of the move before, its
 * sign is the direction. No frame. */
enum passo_error passo_motor_set_target(struct passo_motor *motor, int64_t degrees, uint64_t rpm);
enum passo_error passo_motor_set_angle(struct passo_motor *motor, int64_t degrees, uint64_t rpm);
/* Rotates to the target, or by the angle, whichever was set last. Already at the target: OK, no rotation. */
enum passo_error passo_motor_start(struct passo_motor *motor);
/* Starts continuous rotation. top_rpm limits the speeds that passo_motor_set_speed() can set later. */
enum passo_error passo_motor_start_endless(
    struct passo_motor *motor, bool backward, uint64_t rpm, uint64_t top_rpm);
/* During continuous rotation: changes the speed. Otherwise: sets the speed of the next start. */
enum passo_error passo_motor_set_speed(struct passo_motor *motor, uint64_t rpm);
/* Decelerates to rest: continuous rotation with its own ramp, a move to an angle with a soft stop, after
 * which passo_clear() is needed. After a link error both become a soft stop, which passo_poll() resends until
 * it is acknowledged. */
enum passo_error passo_motor_stop(struct passo_motor *motor);
/* Whether the motor rotates, as of the last passo_poll(). */
bool passo_motor_is_turning(const struct passo_motor *motor);
/* Angle from position 0 in degrees (Q31.32), and the current speed in rpm (UQ32.32). One frame each. */
enum passo_error passo_motor_angle(struct passo_motor *motor, int64_t *degrees);
enum passo_error passo_motor_speed(struct passo_motor *motor, uint64_t *rpm);

#ifdef __cplusplus
}
#endif

#endif
