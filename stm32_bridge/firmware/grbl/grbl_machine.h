/* SPDX-License-Identifier: MIT
 * The machine at the core: what the settings cannot say, and the settings before the first `$n=`. Each value
 * can be given to the makefile: MACHINE="-DAXES=3 -DPROBE=1".
 */
#ifndef GRBL_MACHINE_H
#define GRBL_MACHINE_H

#include "passo.h"
#include "passo_grbl.h"

/* Of the serial line to the host. */
#ifndef BAUD
#define BAUD 115200
#endif

/* Axes that G-code has, of those of the core: 1 .. GRBL_AXES_MAX; 0: all. */
#ifndef AXES
#define AXES 0
#endif
#define GRBL_AXES_MAX                                                                                        \
	(PASSO_PATH_AXES_MAX < PASSO_GCODE_AXES_MAX ? PASSO_PATH_AXES_MAX : PASSO_GCODE_AXES_MAX)

/* Those that it leaves out, a bit for each letter of XYZABC: of X Y Z only the last ones. Not in an image
 * with PASSO_PLAIN_GCODE. */
#ifndef AXES_LEFT_OUT
#define AXES_LEFT_OUT 0
#endif

/* Fitted switches, a bit per axis; and whether there is a probe. */
#ifndef LIMITS_LOW
#define LIMITS_LOW 0
#endif
#ifndef LIMITS_HIGH
#define LIMITS_HIGH 0
#endif
#ifndef HOMES
#define HOMES 0
#endif
#ifndef PROBE
#define PROBE 0
#endif

/* Whether there is a spindle, laser or coolant. */
#ifndef OUTPUTS
#define OUTPUTS 0
#endif

/* Motors, if not one for each axis, and the axes that each moves the same way and the other way: a byte for
 * each motor, the first one is the lowest (passo_motors.h). Limits of those that move two axes, in mm/s and
 * mm/s^2 (0: the larger one of the axes). Not in an image with PASSO_CARTESIAN. */
#ifndef MOTORS
#define MOTORS 0
#endif
#ifndef MOTORS_PLUS
#define MOTORS_PLUS 0
#endif
#ifndef MOTORS_MINUS
#define MOTORS_MINUS 0
#endif
#ifndef MOTORS_SPEED
#define MOTORS_SPEED 0
#endif
#ifndef MOTORS_ACCELERATION
#define MOTORS_ACCELERATION 0
#endif
#ifndef MOTORS_JERK
#define MOTORS_JERK 0
#endif

/* Axes that `$H` squares, and the most that their motors are apart, um. */
#ifndef SQUARED
#define SQUARED 0
#endif
#ifndef RACKING
#define RACKING 0
#endif

/* Encoders: for each motor counts per mm, UQ32.32 (0: it has none), and those of following error that stop
 * the machine, as in ENCODERS=0,0,42949672960,5. Not in an image with PASSO_CARTESIAN. */
#ifdef ENCODERS
#define HAS_ENCODERS 1
#else
#define HAS_ENCODERS 0
#endif
#ifndef ENCODERS
#define ENCODERS 0
#endif

/* Counts per turn of the encoder of the spindle, at the inputs of the core behind those of the motors; 0: it
 * has none, and there are no threads. Not in an image with PASSO_WITHOUT_THREADS. */
#ifndef TURN_COUNTS
#define TURN_COUNTS 0
#endif

/* Input P of M66, 1 and up, that says that the spindle is at its speed; 0: the time of $394 alone. Not in an
 * image with PASSO_PLAIN_GCODE. */
#ifndef AT_SPEED
#define AT_SPEED 0
#endif

/* Axes that `$H` homes, by their home or limit switch. */
#ifndef HOMED
#define HOMED HOMES
#endif

/* Whether the core has what the machine needs. Errors: PARAMETERS (fewer axes), NO_INPUTS, NO_OUTPUTS,
 * NO_ENCODERS. */
enum passo_error grbl_machine_check(struct passo *passo);

/* The setup of the core that is open. `pages` is where settings are kept. */
void grbl_machine(
    struct passo_grbl_setup *setup, const struct passo *passo, const struct passo_storage_pages *pages);

#endif
