/* SPDX-License-Identifier: MIT
 * One motor, in the words of a first lesson: target angle, rpm, start, stop. Thin functions over passo.h.
 *
 *     passo_motor_init(&motor, &passo, 0, 200 * 16, PASSO_RPM(10), PASSO_RPM_PER_SECOND(600));
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

/* Whole degrees as Q31.32; whole rpm, and rpm per second, as UQ32.32. */
#define PASSO_DEGREES(n) ((int64_t)(n) * (int64_t)PASSO_UNIT_Q32)
#define PASSO_RPM(n) ((uint64_t)(n) * PASSO_UNIT_Q32)
#define PASSO_RPM_PER_SECOND(n) PASSO_RPM(n)

struct passo_motor {
	struct passo *passo;
	uint8_t axis;
	uint32_t steps_per_turn;
	uint64_t minimum_rpm;  /* jumped to from rest, and from to rest */
	uint64_t acceleration; /* UQ32.32 steps/s^2 */
	int64_t angle;         /* of the next start, from where the motor stands */
	uint64_t rpm;
	bool endless;
};

/* `steps_per_turn` is full steps times microsteps; `acceleration` in rpm per second. No frame. */
enum passo_error passo_motor_init(struct passo_motor *motor, struct passo *passo, uint8_t axis,
    uint32_t steps_per_turn, uint64_t minimum_rpm, uint64_t acceleration);

/* What the next start does: turn by an angle, its sign is the direction. No frame. */
enum passo_error passo_motor_set_target(struct passo_motor *motor, int64_t degrees, uint64_t rpm);
/* What the next start does: turn without end. `top_rpm` in passo_motor_start_endless(). */
enum passo_error passo_motor_start(struct passo_motor *motor);
/* Turns without end, at no more than top_rpm whatever passo_motor_set_speed() will ask for. */
enum passo_error passo_motor_start_endless(
    struct passo_motor *motor, bool backwards, uint64_t rpm, uint64_t top_rpm);
/* While turning without end: another speed. Otherwise: the speed of the next start. */
enum passo_error passo_motor_set_speed(struct passo_motor *motor, uint64_t rpm);
/* Slows down and stops: a motor that turns without end by its ramp; one on its way to an angle by the soft
 * stop, after which passo_clear() is needed. After an error of the wire both are stopped softly: passo_poll()
 * sends that until it is acknowledged. */
enum passo_error passo_motor_stop(struct passo_motor *motor);
/* As far as passo_poll() has seen. */
bool passo_motor_is_turning(const struct passo_motor *motor);
/* Degrees since the position was 0 (Q31.32), and the present rpm (UQ32.32). */
enum passo_error passo_motor_angle(struct passo_motor *motor, int64_t *degrees);
enum passo_error passo_motor_speed(struct passo_motor *motor, uint64_t *rpm);

#ifdef __cplusplus
}
#endif

#endif
