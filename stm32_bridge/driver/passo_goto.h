/* SPDX-License-Identifier: MIT
 * Moves one axis to a target that can change during the motion, without a stop where possible.
 *
 *     struct passo_goto go = {.axis = 0, .target = 50000, .speed = PASSO_STEPS_PER_S(8000),
 *         .top_speed = PASSO_STEPS_PER_S(20000), .acceleration = PASSO_STEPS_PER_S2(40000)};
 *
 *     passo_goto(&passo, &go);
 *     ...
 *     go.target = 62000;
 *     go.speed = PASSO_STEPS_PER_S(20000);
 *     passo_goto(&passo, &go); // at any time
 *     while (passo_is_moving(&passo))
 *             passo_poll(&passo);
 * At every moment the core holds ramps that bring the axis to rest at or before the target: a host timeout is
 * safe. passo_poll() completes the remaining distance. Hold, resume, override, stop and abort work as in any
 * motion; passo_jog_cancel() decelerates to rest without the need for passo_clear(). Other motions are
 * rejected with UNDER_WAY.
 */
#ifndef PASSO_GOTO_H
#define PASSO_GOTO_H

#include "passo_home.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Moves to go->target, exactly. During a goto: changes target, speed and acceleration immediately, with a
 * ramp from the current speed. If the axis cannot stop before the new target, it stops beyond it and returns.
 *
 * Five frames from rest, three for a change. A change is planned to reach the core within late_clocks (the
 * time of three frames and of planning; add the resolution of a coarse clock), and is planned again if the
 * microsecond clock shows more. The axis then stops short of the target by the distance covered in that time
 * plus 5 steps, and continues from there. If the target is already that near, a new speed has no effect.
 *
 * Errors: those of a move from rest; NO_CLOCK; TOO_FAST above a quarter of the clock, ABOVE_TOP, TOO_LONG
 * also for ramps of more than 2^22 ticks; UNDER_WAY for another axis, or during homing or probing;
 * LATE: the change was not sent and the motion continues unchanged, or it was sent too late and a soft stop
 * (STOPPED) follows; FULL on a core with a ramp queue of 4. After a link error in the change a soft stop
 * replaces it, as in passo_turn_stop(). */
enum passo_error passo_goto(struct passo *passo, const struct passo_goto *go);

#ifdef __cplusplus
}
#endif

#endif
