/* SPDX-License-Identifier: MIT
 * Angles and rotations in integers. An angle is a fraction of a turn, UQ0.64, with natural wraparound.
 */
#ifndef PASSO_GCODE_ANGLE_H
#define PASSO_GCODE_ANGLE_H

#include <stdint.h>

/* 1.0 of a component of a unit vector, Q1.62. */
#define PASSO_GCODE_UNIT (INT64_C(1) << 62)

struct passo_gcode_vector {
	int64_t x, y;
};

/* The unit vector at an angle; each component is off by less than 2^-53. */
struct passo_gcode_vector passo_gcode_unit_vector(uint64_t angle);

/* Angle of a vector with components below 2^62, off by less than 2^-50 turn; of (0, 0): 0. */
uint64_t passo_gcode_angle(struct passo_gcode_vector vector);

/* The vector, below 2^62, turned by the angle of a unit vector, to the nearest integers. */
struct passo_gcode_vector passo_gcode_rotate(
    struct passo_gcode_vector vector, struct passo_gcode_vector unit);

/* floor of the length; components below 2^62. */
uint64_t passo_gcode_length(struct passo_gcode_vector vector);

#endif
