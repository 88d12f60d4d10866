/* SPDX-License-Identifier: MIT
 * Motors and axes. G-code, targets and limits are those of axes, lines of the core and their positions those
 * of motors: a motor is the sum of the axes in `plus` less those in `minus`, in mm.
 *
 *     Cartesian          X, Y, Z                 count 0
 *     ganged Y           X, Y, Z, Y              plus {1, 2, 4, 2}
 *     CoreXY, H-bot      X + Y, X - Y, Z         plus {3, 1, 4}, minus {0, 2, 0}
 *     CoreXZ             X + Z, Y, X - Z         plus {5, 2, 1}, minus {0, 0, 4}
 *
 * This is where other kinematics go. The planner asks for three things: the place of a motor, that of an
 * axis, and the direction in space along which a mixed motor has a limit. For a machine that is not linear,
 * such as a delta, passo_motor_place() becomes its inverse kinematics and passo_axis_place() the forward
 * ones; lines are cut into chords first, as arcs are, and the directions are those at each chord.
 */
#ifndef PASSO_MOTORS_H
#define PASSO_MOTORS_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_command.h"

/* Bits are axes. */
struct passo_motors {
	uint8_t count; /* 0: one for each axis, and no map */
	uint8_t plus[PASSO_AXES_MAX], minus[PASSO_AXES_MAX];
};

/* Whether a map has its inverse: a motor moves one axis or two, and of the motors that two axes share half go
 * the same way for both, so that each axis is the mean of its motors; and whether a core can have that
 * number of motors. Motor i moves axis i, those behind the axes any. */
bool passo_motors_fit(const struct passo_motors *motors, uint32_t axes);

/* The place of a motor, of those of the axes in any unit. */
int64_t passo_motor_place(const struct passo_motors *motors, uint32_t motor, const int64_t *axes);

/* The place of an axis, of those of the motors: their sum, to be divided by *parts. */
int64_t passo_axis_place(
    const struct passo_motors *motors, uint32_t axis, const int32_t *places, uint32_t *parts);

/* The axis of a motor, or the first of two. */
uint32_t passo_motor_axis(const struct passo_motors *motors, uint32_t motor);

/* Whether a motor moves two axes. */
bool passo_motor_is_mixed(const struct passo_motors *motors, uint32_t motor);

/* Bits of the motors that an axis is named after: its own, and those behind the `axes` that move it. */
uint8_t passo_motors_of(const struct passo_motors *motors, uint32_t axes, uint32_t axis);

#endif
