/* SPDX-License-Identifier: MIT
 * Home, probe and jog. passo_poll() moves home and probe on: it costs at most one frame until a motion of
 * theirs has ended, and then the frames of the calls that begin the next one, fifteen at most.
 *
 *     passo_home(&passo, homes, 2);
 *     while (passo_is_moving(&passo))
 *             if (passo_poll(&passo) != PASSO_OK)
 *                     ... passo_fault(&passo) says why it has ended
 * Meanwhile hold, resume and override work; stop and abort end it; other motions are refused with UNDER_WAY.
 * After a stop go on as after any other: passo_clear(), and nothing moves before the next command.
 */
#ifndef PASSO_HOME_H
#define PASSO_HOME_H

#include "passo_inputs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Approach until the switch acts, back off, approach slowly; the edge of the slow approach becomes
 * `position`. A switch that is active already is left first. The stops on the switch take the time of
 * passo_configure_motion(). */
struct passo_home {
	uint8_t axis;
	enum passo_trigger_source source; /* HOME, LIMIT_LOW or LIMIT_HIGH */
	int32_t distance;                 /* most steps to the switch; the sign is the direction */
	uint32_t back_off;          /* steps from the edge before the slow approach: above its hysteresis */
	uint32_t pull_off;          /* steps from the edge at the end; 0: stays where it stops */
	uint64_t speed, slow_speed; /* UQ32.32 steps/s */
	uint64_t acceleration;      /* UQ32.32 steps/s^2 */
	int32_t position;           /* of the edge */
};

/* Homes `count` axes, one after the other; homes[] must live until the end. Two frames, and until the switch
 * is known: two periods of the filter. Errors: of the call
 * NO_SWITCH, NO_STOP_TIME, NO_DISTANCE, TOO_MANY_STEPS, NO_SPEED, NO_ACCELERATION, those of a move; of
 * passo_poll() also SWITCH_MISSED, SWITCH_LEVEL if the switch stays active, INPUTS_UNKNOWN if it does not
 * stand still. */
enum passo_error passo_home(struct passo *passo, const struct passo_home *homes, uint8_t count);
/* Whether the position of an axis is that of its home: until the drive is switched off, e-stop, alarm,
 * watchdog or a following error stop the channel, the axis is stopped at speed by anything else, the core is
 * reset, or it is opened; docs/machine.md has the table. No frame. */
bool passo_is_homed(const struct passo *passo, uint8_t axis);

/* Moves until the probe acts: toward a workpiece until it touches, or away until it is free. */
struct passo_probe {
	int32_t steps[PASSO_AXES_MAX]; /* the end if it does not act */
	uint64_t speed, acceleration;  /* UQ32.32 steps/s, steps/s^2, of the longest axis */
	bool away;                     /* until the probe becomes inactive */
	bool optional;                 /* to reach the end is no error */
};

/* passo_read_trigger() has the positions at the touch afterwards; the axes have stopped behind it. Errors: of
 * the call NO_SWITCH, NO_STOP_TIME, SWITCH_LEVEL if the probe has that level already, those of a move; of
 * passo_poll() also SWITCH_MISSED unless it is optional. */
enum passo_error passo_probe(struct passo *passo, const struct passo_probe *probe);

/* One axis by hand, from rest. */
struct passo_jog {
	uint8_t axis;
	bool backwards;        /* of an endless jog */
	int32_t steps;         /* of a jog by distance, the sign is the direction; 0: endless */
	uint64_t speed;        /* UQ32.32 steps/s */
	uint64_t top_speed;    /* of an endless jog: highest for passo_jog_speed(); 0: speed */
	uint64_t acceleration; /* UQ32.32 steps/s^2 */
};

/* Errors: those of a move; TOO_FAST above a quarter of the clock. */
enum passo_error passo_jog(struct passo *passo, const struct passo_jog *jog);
/* A new speed of an endless jog, by a ramp from the present one. Errors: NOT_TURNING; those of a move. */
enum passo_error passo_jog_speed(struct passo *passo, uint64_t speed);
/* Slows a jog or goto down to rest at once, with its acceleration and never past its end: one that is as near
 * to its end goes on to it. No passo_clear() is needed. One that has ended: OK. After a link error a soft
 * stop replaces it, as in passo_turn_stop(); also for a host that is too slow (LATE, docs/driver.md). */
enum passo_error passo_jog_cancel(struct passo *passo);

#ifdef __cplusplus
}
#endif

#endif
