/* SPDX-License-Identifier: MIT
 * One axis to a target that may change while it moves, without a stop where the path allows it.
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
 * At every moment the core holds ramps that bring the axis to rest at the target or before it: a host that
 * falls silent is no danger. passo_poll() makes the rest of the way. Hold, resume, override, stop and abort
 * are as for all motions; passo_jog_cancel() ends it on its path, with nothing to clear. Other motions are
 * refused with UNDER_WAY.
 */
#ifndef PASSO_GOTO_H
#define PASSO_GOTO_H

#include "passo_home.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Goes to go->target, exactly. While a goto is under way: changes its target, speed and acceleration at once,
 * by a ramp from the present speed. If the axis cannot come to rest before the new target, it comes to rest
 * behind it and returns.
 *
 * From rest five frames, for a change three. A change is planned for a core that receives it within
 * late_clocks (the time of three frames and of planning; add the resolution of a coarse clock), and is
 * planned again if the microsecond clock shows more. The axis then comes to rest short of the target by the
 * way of that time and 5 steps, and goes on from there. Where the target is that near already, a new speed
 * has no effect.
 *
 * Errors: those of a move from rest; NO_CLOCK; TOO_FAST above a quarter of the clock, ABOVE_TOP, TOO_LONG
 * also for ramps of more than 2^22 ticks; UNDER_WAY for another axis, or while home or probe is in progress;
 * LATE: the change was not sent, and the motion goes on as it was, or it was sent too late and a soft stop
 * (STOPPED) follows; FULL on a core with 4 places for ramps. After a link error in the change a soft stop
 * replaces it, as in passo_turn_stop(). */
enum passo_error passo_goto(struct passo *passo, const struct passo_goto *go);

#ifdef __cplusplus
}
#endif

#endif
