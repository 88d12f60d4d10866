/* SPDX-License-Identifier: MIT
 * Homing, probing and jogging. passo_poll() advances homing and probing: it costs at most one frame until one
 * of their motions has ended, then the frames of the calls that start the next one, at most fifteen.
 *
 *     passo_home(&passo, homes, 2);
 *     while (passo_is_moving(&passo))
 *             if (passo_poll(&passo) != PASSO_OK)
 *                     ... passo_fault(&passo) says why it ended
 * Meanwhile hold, resume and override work; stop and abort end it; other motions are rejected with UNDER_WAY.
 * After a stop call passo_clear(), as after any other; nothing moves before the next command.
 */
#ifndef PASSO_HOME_H
#define PASSO_HOME_H

#include "passo_inputs.h"
#include "passo_track.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Homing cycle: approach until the switch triggers, back off, approach slowly; the edge of the slow approach
 * becomes `position`. An already active switch is left first. The stops on the switch take the time of
 * passo_configure_motion(). */
struct passo_home {
	uint8_t axis; /* of the switch */
#ifndef PASSO_CARTESIAN
	uint8_t forward, backward; /* bits of the motors that move, the same way or the other way; 0: the axis
	                              alone. Its position is the mean of theirs, with these signs */
	/* Squaring, if above 0: each motor of `forward` by its own limit switch, the source. The most steps
	 * by which any of them moves further than another one, to its edge and with its offset to the end; at
	 * least back_off, and twice what slow_speed takes to stop. */
	uint32_t racking;
	const int32_t *offset; /* of motors, at most pull_off: position of its edge from that of the axis,
	                          steps; null: 0 */
#endif
	enum passo_trigger_source source; /* HOME, LIMIT_LOW or LIMIT_HIGH */
	int32_t distance;                 /* longest travel to the switch, steps; the sign is the direction */
	uint32_t back_off; /* steps from the edge before the slow approach: above hysteresis and filter */
	uint32_t pull_off; /* steps from the edge at the end; 0: the axis stays where it stops */
	uint64_t speed, slow_speed; /* UQ32.32 steps/s */
	uint64_t acceleration;      /* UQ32.32 steps/s^2 */
	int32_t position;           /* of the edge */
#ifndef PASSO_WITHOUT_TRACKERS
	/* Of a motor without lines: its tracker homes it, with these limits in the end. `position` is that of
	 * passo_track_to() then; null: the path homes it. It is not for squaring. */
	const struct passo_track *track;
#endif
};

/* Homes `count` axes, one after the other; homes[] must stay valid until the end. Two frames, and two periods
 * of the filter until the switch is known. Errors: of the call NO_SWITCH, NO_STOP_TIME, NO_DISTANCE,
 * TOO_MANY_STEPS, NO_SPEED, NO_ACCELERATION, those of a move; of passo_poll() also SWITCH_MISSED,
 * SWITCH_LEVEL if the switch stays active, INPUTS_UNKNOWN if it is not stable. */
enum passo_error passo_home(struct passo *passo, const struct passo_home *homes, uint8_t count);
#ifndef PASSO_CARTESIAN
/* After SWITCH_MISSED of passo_poll(): whether a motor did not reach its switch within `racking`, and which.
 */
bool passo_home_is_skewed(const struct passo *passo, uint8_t *motor);
#endif

/* Whether an axis is homed. It is not after its drive is disabled, after a stop by e-stop, alarm, watchdog or
 * following error, after any other hard stop of the axis at speed, after a core reset, and after
 * passo_open(); see the table in docs/machine.md. No frame. */
bool passo_is_homed(const struct passo *passo, uint8_t axis);

/* Probing move: toward a workpiece until the probe triggers, or away until it releases. */
struct passo_probe {
	int32_t steps[PASSO_AXES_MAX]; /* the end of the move if it does not trigger */
	uint64_t speed, acceleration;  /* UQ32.32 steps/s, steps/s^2, of the dominant axis */
	bool away;                     /* until the probe becomes inactive */
	bool optional;                 /* reaching the end is not an error */
};

/* Afterwards passo_read_trigger() returns the positions at the touch; the axes have stopped beyond it.
 * Errors: of the call NO_SWITCH, NO_STOP_TIME, SWITCH_LEVEL if the probe already has that level, those of a
 * move; of passo_poll() also SWITCH_MISSED unless it is optional. */
enum passo_error passo_probe(struct passo *passo, const struct passo_probe *probe);

/* Jog of one axis, from rest. */
struct passo_jog {
	uint8_t axis;
	bool backward;         /* of an endless jog */
	int32_t steps;         /* of a jog by distance, the sign is the direction; 0: endless */
	uint64_t speed;        /* UQ32.32 steps/s */
	uint64_t top_speed;    /* of an endless jog: highest for passo_jog_speed(); 0: speed */
	uint64_t acceleration; /* UQ32.32 steps/s^2 */
};

/* Errors: those of a move; TOO_FAST above a quarter of the clock. */
enum passo_error passo_jog(struct passo *passo, const struct passo_jog *jog);
/* Changes the speed of an endless jog, with a ramp from the current one. Errors: NOT_TURNING; those of a
 * move. */
enum passo_error passo_jog_speed(struct passo *passo, uint64_t speed);
/* Decelerates a jog or goto to rest immediately, with its acceleration and never past its end: if the end is
 * within the stopping distance, the motion continues to it. passo_clear() is not needed. OK if it has already
 * ended. After a link error a soft stop replaces it, as in passo_turn_stop(); also if the host is too slow
 * (LATE, docs/driver.md). */
enum passo_error passo_jog_cancel(struct passo *passo);

#ifdef __cplusplus
}
#endif

#endif
