/* SPDX-License-Identifier: MIT
 * Encoders of a core that was built with them: counts, following error, threads.
 *
 * See docs/machine.md, also for recovery after FOLLOWING. Every call can also return NO_ENCODERS and the
 * errors common to the calls of passo.h.
 */
#ifndef PASSO_DRIVER_ENCODER_H
#define PASSO_DRIVER_ENCODER_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------- encoder ---- */

/* Counts per step as a ratio of constants, UQ16.16, rounded down: 4000 counts and 3200 steps per turn. */
#define PASSO_COUNTS_PER_STEP(counts, steps) ((uint32_t)(((uint64_t)(counts) << 16) / (steps)))

/* Action at the following-error limit. */
enum passo_following_stop {
	PASSO_FOLLOWING_SHOW, /* only `exceeded` */
	PASSO_FOLLOWING_SOFT, /* soft stop, in the time of passo_configure_motion() */
	PASSO_FOLLOWING_HARD  /* hard stop */
};

struct passo_encoder_config {
	bool inverted;       /* counts up while B leads */
	bool index_inverted; /* the index is active low */
	bool index_gated;    /* the index counts only while A and B are high */
	uint32_t ratio;      /* counts per step, UQ16.16, not 0 */
	uint16_t limit;      /* counts of following error, not 0 */
	enum passo_following_stop stop;
};

/* Configures the encoder of an axis and zeroes its following error. At rest or stopped. Three frames. Errors:
 * RATIO, FOLLOWING_LIMIT, MOVING. */
enum passo_error passo_configure_encoder(
    struct passo *passo, uint8_t axis, const struct passo_encoder_config *config);
/* Sets the glitch filter of all encoders of the channel, in clocks, PASSO_US(1). Shorter changes do nothing.
 * Error: ENCODER_FILTER above 255. */
enum passo_error passo_configure_encoder_filter(struct passo *passo, uint64_t clocks);

/* Zero it before the first reading of an axis. */
struct passo_encoder_reading {
	int32_t counts;    /* since the core's reset or passo_zero(); wraps */
	int64_t speed;     /* Q31.32 counts/s, average since the last reading into this struct;
	                      PASSO_NO_UNITS if there was none, or the port has no clock */
	int32_t error;     /* following error, Q23.8 counts: positive if the encoder lags */
	uint32_t greatest; /* largest magnitude, counts, since passo_clear(), passo_zero() or configuration */
	bool exceeded;     /* the error is at its limit */
	uint16_t latch;    /* counts at the last index, their lower 16 bits */
	uint8_t indexes;   /* number of indexes; wraps */
	uint8_t illegal;   /* illegal transitions (A and B together), saturates at 255: noise, or too fast */
	uint32_t at;       /* microseconds: time of the reading */
	bool valid;        /* there was a reading */
};
/* Two frames. */
enum passo_error passo_read_encoder(struct passo *passo, uint8_t axis, struct passo_encoder_reading *reading);

/* Recovery from FOLLOWING: sets the position of the axis from its encoder, to the nearest step, and the
 * following error to 0. Nothing moves. At rest or stopped, before passo_clear(). Four frames.
 * Errors: RATIO if the encoder is not configured; OFF_SCALE if the error is 2^16 counts or more; MOVING. */
enum passo_error passo_adopt_encoder(struct passo *passo, uint8_t axis);

/* ----------------------------------------------------------------------------------------- thread ---- */

/* Spindle-synchronized pass: a straight line clocked by an encoder. */
struct passo_thread {
	uint8_t encoder;               /* its axis: that of the spindle */
	bool wait_index;               /* starts at the index, so that every pass has the same phase */
	bool endless;                  /* electronic gearing: continues until passo_stop() */
	int32_t steps[PASSO_AXES_MAX]; /* of each axis during `counts`: exact, at most 64 per count */
	uint32_t counts;
	uint64_t top_speed; /* UQ32.32 counts/s, upper limit of the encoder speed; also the speed for
	                       catching up after a hold or reverse counts */
};

/* Queues it, from rest; passo_poll() detects its end, up to a tick (128 counts by default) after the last
 * step. The axes start with the spindle, without a ramp, and wait while it is stopped or reversing. Later
 * motions use the core's clock again. Four frames and those of a move. Errors: NO_STEPS, TOO_MANY_STEPS and
 * TOO_LONG of the planner, NO_COUNTS, STEEP, FOLLOW_SPEED, PINS_TOO_SLOW at `top_speed`, those of a move at
 * rest. */
enum passo_error passo_thread(struct passo *passo, const struct passo_thread *thread);

/* A pass of several lines in step with a spindle that runs in and out, and is half a count ahead of the last
 * count seen: each step is within half a count of the angle at which it belongs. */
struct passo_pass_line {
	int32_t steps[PASSO_AXES_MAX];
	uint32_t half_counts; /* in which they are made: not 0 */
};

#define PASSO_PASS_LINES_MAX 4u /* they fit into the queue of any core */

struct passo_pass {
	uint8_t encoder;
	bool wait_index;
	uint8_t lines; /* 1 .. PASSO_PASS_LINES_MAX */
	struct passo_pass_line line[PASSO_PASS_LINES_MAX];
	const struct passo_output *then; /* output of all lines but the first one; NULL: as that */
	uint32_t
	    run_in; /* counts in which it comes up to speed; it catches up in as many. 0: it has the speed */
	uint32_t run_out; /* counts in which it comes to rest; they end half as many later. 0: none */
	uint32_t behind;  /* half counts that it is late where it begins; catches up in four times as many */
	uint64_t top_speed; /* UQ32.32 counts/s: see struct passo_thread */
};

/* Speed of the pass over that of the thread while it catches up, at most. */
#define PASSO_PASS_PEAK_TENTHS 16u

/* Queues it, from rest, like passo_thread(). Two frames and one for each line. Errors: those of
 * passo_thread(); RAMP_TOO_LONG of the planner if it is too short for run_in and run_out. */
enum passo_error passo_pass(struct passo *passo, const struct passo_pass *pass);

/* State of the running thread; `behind` and `lost` also of the last one. */
struct passo_thread_state {
	int32_t owed;    /* counts times 2^scale that the path lags; negative: the path is ahead */
	bool behind;     /* it lagged by two counts or more */
	bool lost;       /* loss of synchronization, stopped with FOLLOWING: it lagged by 2^22 clocks of the
	                    profile, or the spindle encoder had an illegal transition */
	uint8_t illegal; /* illegal transitions since passo_clear(), saturates at 255 */
};
/* Two frames. */
enum passo_error passo_read_thread(struct passo *passo, struct passo_thread_state *state);

#ifdef __cplusplus
}
#endif

#endif
