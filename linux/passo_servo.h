/* SPDX-License-Identifier: MIT
 * Follows a program that says every period where the axes are to be, such as the servo thread of LinuxCNC.
 *
 *     static struct passo_servo servo;
 *
 *     // `problem` and `axis` of it say what is wrong with the options
 *     passo_servo_check(&servo, &passo, &options);
 *     // again while it returns MOVING
 *     passo_servo_start(&servo);
 *     // once in a period
 *     passo_servo_write(&servo, commands);
 *
 * Each period becomes a line of the core. The axes follow `lag` periods later, which is constant: the clocks
 * of program and core may differ, and a loop on the depth of the core's queue makes the lines longer or
 * shorter. The speed of the path is held for `buffer` to 2 `buffer` periods, after which the core decelerates
 * along the lines that it knows; each call that comes in time prolongs it. So the path is kept when the
 * program is late: it slows down, holds, and continues when the program does. Nothing is dropped.
 *
 * What the core has cannot be taken back, only added to. So the way to standstill is always in its queue, and
 * the lag in periods is 2 `buffer` + PASSO_SERVO_MARGIN + (speed / stop / 2) / period, for the axis that
 * needs the longest; up to a few more where that is long.
 *
 * Integers alone, no heap. Positions are steps of the core in Q31.32.
 */
#ifndef PASSO_SERVO_H
#define PASSO_SERVO_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PASSO_SERVO_BUFFER 2u          /* periods, unless another number is given */
#define PASSO_SERVO_MARGIN 3u          /* lines */
#define PASSO_SERVO_LINES 1024u        /* that wait for the core after a gap */
#define PASSO_SERVO_PERIOD_MIN 100000u /* ns */
#define PASSO_SERVO_PERIOD_MAX 50000000u
#define PASSO_SERVO_TRIM_MAX 10000 /* ppm by which the lines are made longer or shorter */

struct passo_servo_axis {
	uint64_t speed;        /* UQ32.32 steps/s; up to 1 % above it while a lag is made up */
	uint64_t acceleration; /* UQ32.32 steps/s^2, of the commands */
	uint64_t
	    stop; /* UQ32.32 steps/s^2 beyond it that the axis bears while a late program slows the path */
};

struct passo_servo_options {
	uint32_t period_ns; /* of the calls, PASSO_SERVO_PERIOD_MIN .. _MAX */
	uint32_t buffer;    /* periods by which a call may be late without effect; 0: PASSO_SERVO_BUFFER */
	uint8_t axes;       /* the first ones of the channel */
	struct passo_servo_axis axis[PASSO_AXES_MAX];
};

enum passo_servo_problem {
	PASSO_SERVO_OK,
	PASSO_SERVO_PERIOD,       /* the period is out of range */
	PASSO_SERVO_AXES,         /* none, or more than the channel has */
	PASSO_SERVO_SPEED,        /* the speed of an axis is 0 */
	PASSO_SERVO_ACCELERATION, /* its acceleration is 0 */
	PASSO_SERVO_STOP,         /* its deceleration is 0 */
	PASSO_SERVO_PINS,         /* its pins do not make that speed, or are not configured */
	PASSO_SERVO_LAG           /* the queue of the core is shorter than the lag */
};

/* Private. */
struct passo_servo_line {
	int32_t steps[PASSO_AXES_MAX];
	uint32_t output;
};
enum passo_servo_phase { PASSO_SERVO_OFF, PASSO_SERVO_FILLS, PASSO_SERVO_RUNS };

struct passo_servo {
	uint32_t output; /* word of the lines from now on: passo_output_word() */
	/* for users to read */
	enum passo_servo_problem problem;
	uint8_t axis;     /* of the problem */
	uint32_t lag;     /* periods from a command to the axes */
	uint32_t places;  /* of the core for lines; the lag must leave some of them free */
	uint32_t stop;    /* periods in which the path decelerates from full speed */
	uint32_t depth;   /* lines in the core after the last call */
	int32_t trim;     /* ppb by which the lines are longer than a period */
	uint32_t slowed;  /* times that the path was below its speed because a call was late; wraps */
	uint32_t limited; /* bits of the axes whose last command was beyond speed or acceleration */
	/* private */
	struct passo *passo;
	struct passo_servo_options options;
	enum passo_servo_phase phase;
	uint64_t substeps, part; /* of a period, UQ32.32; what is left of the lines so far */
	uint64_t top[PASSO_AXES_MAX], change[PASSO_AXES_MAX]; /* Q31.32 steps per period; per period^2 */
	int64_t command[PASSO_AXES_MAX], place[PASSO_AXES_MAX], speed[PASSO_AXES_MAX];
	int32_t steps[PASSO_AXES_MAX]; /* of the lines so far */
	uint8_t directions;
	uint32_t rest;                  /* lines without steps, before the first one */
	uint32_t head, tail;            /* of the ring */
	uint32_t cover;                 /* periods for which a ramp holds the speed, UQ16.16 */
	uint32_t pushed_at, decided_at; /* microseconds */
	uint32_t due, ramps;            /* of one push; of them still to be sent */
	uint32_t from, to;              /* of them: parts of the full speed, UQ16.16 */
	uint32_t calls;                 /* since ramps were sent */
	uint32_t looked;                /* calls since the state was read */
	bool full;                      /* the path has its full speed, as far as is known */
	int64_t error, sum;             /* of the loop: lines, Q31.32; their sum */
	struct passo_servo_line line[PASSO_SERVO_LINES];
};

/* Checks the options and computes the lag. Reads the state: one frame. `passo` must be open, at rest, its
 * axes configured, and its hardware must have `microseconds`. *servo and *passo must stay valid. Errors:
 * those of passo_read_state(); ARGUMENT if `problem` says what is wrong; MOVING. */
enum passo_error passo_servo_check(
    struct passo_servo *servo, struct passo *passo, const struct passo_servo_options *options);

/* Takes over from rest, clears a stopped channel, and takes the positions as the first commands. The axes
 * follow after some calls of passo_servo_write(), which fill the queue. About eight frames. Errors: those of
 * passo_clear(), passo_configure_motion(), passo_positions() and passo_stream(). */
enum passo_error passo_servo_start(struct passo_servo *servo);

/* The next position of each axis, from which the next line is made; a command beyond speed or acceleration is
 * approached within both. One frame for the line, one every `buffer` calls for the ramps, one every
 * PASSO_SERVO_LOOK calls for the state. Errors: NOT_PREPARED before passo_servo_start(); FULL after a gap of
 * more than PASSO_SERVO_LINES periods; those of passo_poll(). After an error the axes have stopped, or do so.
 */
enum passo_error passo_servo_write(struct passo_servo *servo, const int64_t *commands);
#define PASSO_SERVO_LOOK 64u

/* Ends with a soft stop along the lines. Errors: those of passo_stop(). */
enum passo_error passo_servo_stop(struct passo_servo *servo);

/* Whether passo_servo_write() is to be called. */
bool passo_servo_is_on(const struct passo_servo *servo);

#ifdef __cplusplus
}
#endif

#endif
