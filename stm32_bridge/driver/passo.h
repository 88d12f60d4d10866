/* SPDX-License-Identifier: MIT
 * The driver: what a program does with one channel of a Passo core.
 *
 *     static struct passo_host host;
 *     static struct passo passo;
 *
 *     passo_open(&passo, &host, &hardware, &(struct passo_options){.clock_hz = 72000000});
 *     passo_configure_axis(&passo, 0, &(struct passo_axis_config){.step_high_ns = 2000});
 *     passo_enable(&passo, 0, true);
 *     passo_move_by_speed(&passo, &move); // queued: the core makes it by itself
 *     while (passo_is_moving(&passo))
 *             passo_poll(&passo); // at most one frame each
 *
 * Every function returns an enum passo_error (passo_error_text() has a sentence for it), checks its
 * arguments, and leaves nothing half done: a move whose error is not one of the wire was not begun. No heap,
 * no floating point; RAM is the two structs (passo_host.h).
 *
 * After an error of the wire (or TRANSFER) it is not known whether the core has executed the last frame:
 *   - a stop or abort is sent again by every passo_poll() until it is acknowledged (NOT_STOPPED until then);
 *   - hold, resume, override, wait for sync: the slower of before and now is, in the same way (NOT_HELD);
 *   - during a move or a stream the driver is BROKEN: what was queued before may run on;
 *   - the pins of an axis are not known (NOT_CONFIGURED) until it is configured again.
 * New moves are refused with these errors; passo_clear() ends the first three. Nothing else is done later.
 *
 * A call costs one frame (chip select) unless its comment says otherwise; on a disturbed wire up to `tries`.
 * Units: speeds, accelerations, rpm are UQ32.32 (PASSO_UNIT_Q32 is 1); lengths and angles are Q31.32.
 */
#ifndef PASSO_H
#define PASSO_H

#ifdef __cplusplus
extern "C" {
#endif

#include "passo_error.h"
#include "passo_host.h"
#include "passo_plan.h"

#define PASSO_RATE_FULL UINT32_C(0x10000)

/* -------------------------------------------------------------------------------------------- open ---- */

/* What the program expects. Zeros mean: whatever the core has. */
struct passo_options {
	uint32_t clock_hz; /* of the core; cannot be read from it, must be given */
	uint8_t channel;   /* which one this driver is for */
	uint8_t channels;  /* of the core: 0: any number; otherwise it must match */
	uint8_t axes;      /* of each channel: 0: any number; otherwise it must match */
	uint8_t tick_log2; /* 0: any; otherwise it must match */
};

/* What passo_poll() saw last. */
struct passo_snapshot {
	enum passo_state state;
	enum passo_cause cause;
	bool quiet;                    /* no motion is prepared or runs, and all steps have left the pins */
	bool stopping;                 /* a soft stop is under way */
	uint8_t overrun;               /* bit i: axis i has lost steps */
	uint16_t drained;              /* substeps made at drain velocity, since reset */
	uint32_t rate;                 /* time scale in force, UQ1.16 */
	uint16_t line_room, ramp_room; /* free places in the queues */
	uint32_t velocity;             /* UQ0.32 substeps per clock, before the time scale */
};

/* Where a stream gets its items. Each fills in one and returns true, or returns false if there is none at the
 * moment. Called from passo_poll() only when there is room. An item is asked for once; after one with `last`
 * its function is not called again. They must not call the driver. */
struct passo_source {
	bool (*line)(void *context, struct passo_line *line);
	bool (*ramp)(void *context, struct passo_ramp *ramp);
	void *context;
};

/* What the driver remembers of an axis. */
struct passo_axis_memory {
	uint64_t steps_per_unit;  /* UQ32.32 */
	uint32_t shortest_clocks; /* of a step; 0: not known */
	int32_t expected;         /* position when all that is queued has been made */
};

/* What the driver believes of the channel. docs/driver.md shows what leads from state to state. */
enum passo_belief {
	PASSO_BELIEF_NOT_OPEN,
	PASSO_BELIEF_READY,         /* it takes moves */
	PASSO_BELIEF_STOPPED,       /* it is stopped, or a stop was commanded: nothing but clear helps */
	PASSO_BELIEF_BROKEN,        /* what a command has done is not known: nothing but clear helps */
	PASSO_BELIEF_BROKEN_STOPPED /* both */
};

/* What is still to be seen of what was queued. */
enum passo_expectation {
	PASSO_EXPECT_NOTHING,
	PASSO_EXPECT_POSITIONS, /* an end, where the axes are at the positions expected of them */
	PASSO_EXPECT_END,       /* an end; nobody knows where */
	PASSO_EXPECT_TURNING,   /* turning without end, until a speed or the end is commanded */
	PASSO_EXPECT_TURN_END   /* the end of it, which is queued */
};

/* The stop that was commanded and has not been acknowledged, and so is sent by every poll. */
enum passo_due { PASSO_DUE_NOTHING, PASSO_DUE_STOP, PASSO_DUE_ABORT };

/* What the frame is that was posted last, until its result has been seen to. */
enum passo_post {
	PASSO_POST_NONE,
	PASSO_POST_ITEMS, /* of a stream */
	PASSO_POST_START, /* lets a stream begin */
	PASSO_POST_RUN,
	PASSO_POST_RATE,
	PASSO_POST_STOP,
	PASSO_POST_ABORT
};

/* A stream: there is none; its queues are filled behind a closed gate; it runs and is fed. */
enum passo_stream_phase { PASSO_STREAM_NONE, PASSO_STREAM_FILLS, PASSO_STREAM_RUNS };

/* What a stream's source has of lines, and of ramps: more, nothing at the moment, nothing any more. */
enum passo_supply { PASSO_SUPPLY_MORE, PASSO_SUPPLY_DRY, PASSO_SUPPLY_DONE };

/* Whether motions may start. */
enum passo_gate { PASSO_GATE_OPEN, PASSO_GATE_SYNC, PASSO_GATE_CLOSED };

/* One channel. All fields are private; use the functions. */
struct passo {
	struct passo_host *host;
	struct passo_machine machine;
	uint16_t base; /* address of the channel's registers */
	uint16_t line_places, ramp_places;
	uint8_t channel;
	uint8_t misses;     /* looks in a row that failed */
	uint8_t idle_looks; /* in a row that found everything at an end */
	bool held;          /* the rate is 0, whatever the override */
	bool rate_due;      /* the rate has not been acknowledged, and so is sent by every poll */
	enum passo_due stop_due;
	enum passo_belief belief;
	enum passo_expectation expects;
	enum passo_stream_phase stream;
	enum passo_supply lines : 8, ramps : 8; /* of the stream */
	enum passo_gate gate;                   /* when no stream is being prepared */
	enum passo_error fault;
	enum passo_post post;
	enum passo_error posted; /* result of the posted frame */
	struct passo_axis_memory axis[PASSO_AXES_MAX];
	struct passo_snapshot snapshot; /* its room is never too much */
	uint32_t looked_at;             /* microseconds */
	uint32_t rate_target;           /* UQ1.16: the override, kept over a hold */
	uint32_t oversampling;          /* of the last plan */
	uint64_t velocity_peak;
	struct passo_turning turning;
	struct passo_source source;
};

/* Makes contact with the core and takes over a channel: checks identification, version and parameters, throws
 * away what waits in the queues of a channel at rest, clears a stopped one, reads the positions. The position
 * counters are kept. A channel in motion (this host was reset) is left alone: the result is MOVING, and
 * state, positions, hold, stop and abort work; moves do after its end, or stop, and passo_clear(). Each axis
 * is to be configured before it moves. What a stop had left to do before is forgotten. About
 * ten frames. Errors: ARGUMENT, those of the wire, NOT_PASSO, VERSION, PARAMETERS, MOVING. */
enum passo_error passo_open(struct passo *passo, struct passo_host *host,
    const struct passo_hardware *hardware, const struct passo_options *options);
/* A further channel of a core that is open already. */
enum passo_error passo_open_channel(
    struct passo *passo, struct passo_host *host, const struct passo_options *options);

/* ---------------------------------------------------------------------------------------- settings ---- */

/* Longest time of the pins in clocks. */
#define PASSO_PIN_CLOCKS_MAX ((UINT32_C(1) << PASSO_AXIS_STEP_TIMING_STEP_HIGH_BITS) - 1u)
/* Pins of an axis. Times are rounded up to clocks, at least one, at most PASSO_PIN_CLOCKS_MAX. */
struct passo_axis_config {
	uint32_t step_high_ns, step_low_ns; /* STEP active, and inactive before the next step */
	uint32_t dir_setup_ns;              /* DIR change to the active edge of STEP */
	uint32_t dir_hold_ns;               /* after the low time, before DIR changes */
	bool in_clocks;                     /* the four above are clocks, not nanoseconds */
	bool step_inverted, direction_inverted, enable_inverted;
	bool both_edges;         /* every edge of STEP is a step */
	uint64_t steps_per_unit; /* UQ32.32 steps per millimetre, degree ...; 0: none */
};

/* Sets pins and units of an axis; the drive stays enabled or not. Before it, an axis makes no steps. At rest
 * only: waits for the times of the pins. Errors: ARGUMENT, MOVING. */
enum passo_error passo_configure_axis(
    struct passo *passo, uint8_t axis, const struct passo_axis_config *config);
/* Drive enable output. It is switched on at any time; off only at rest or when stopped, after the last step
 * has left the pins (for which it waits): MOVING while a motion runs or waits. To switch off at once,
 * passo_abort() first: then that is only a pulse that has begun. One frame, three for off. */
enum passo_error passo_enable(struct passo *passo, uint8_t axis, bool on);
/* How long hold and resume, and a soft stop, take from full speed, in microseconds; 0: at once. Both are
 * rounded to what the core can do. And the velocity (UQ0.32 substeps per clock) of substeps
 * that are missing at the end of a profile: 0: leave it. */
enum passo_error passo_configure_motion(
    struct passo *passo, uint32_t hold_microseconds, uint32_t stop_microseconds, uint32_t drain_velocity);

/* ------------------------------------------------------------------------------------------- moves ---- */

/* Each plans a move, checks it against the pin timing, loads a shape table if it needs one that the core does
 * not hold (five frames and the time to compute it), and queues it: three frames. It starts at once, or after
 * what is queued already. A planner's error is passed on as PASSO_ERROR_PLAN + error. Errors: FULL (try again
 * later), STOPPED, NOT_STOPPED, NOT_HELD, BROKEN, STREAMING, MOVING (while turning without end), TABLE,
 * NOT_CONFIGURED, PINS_TOO_SLOW. */
enum passo_error passo_move_in_time(struct passo *passo, const struct passo_move_in_time *move);
enum passo_error passo_move_by_speed(struct passo *passo, const struct passo_move_by_speed *move);
enum passo_error passo_move_below_speed(struct passo *passo, const struct passo_move_below_speed *move);
enum passo_error passo_move_at_speed(struct passo *passo, const struct passo_move_at_speed *move);
enum passo_error passo_move_axes(struct passo *passo, const struct passo_move_axes *move);
enum passo_error passo_move_turn(struct passo *passo, const struct passo_move_turn *move);
enum passo_error passo_move_sigmoid(struct passo *passo, const struct passo_move_sigmoid *move);
enum passo_error passo_move_jerk(struct passo *passo, const struct passo_move_jerk *move);
/* limits[i].steps_per_mm of 0 stands for the axis' steps per unit. */
enum passo_error passo_move_straight(struct passo *passo, const struct passo_move_straight *move);
/* The user's own table goes into the bank that `shape` names. It is recognized when used again. */
enum passo_error passo_move_user_in_time(
    struct passo *passo, const struct passo_move_in_time *move, const struct passo_user_shape *shape);
enum passo_error passo_move_user_by_speed(
    struct passo *passo, const struct passo_move_by_speed *move, const struct passo_user_shape *shape);
/* A plan made before with passo_machine(); the shape is null unless it came from passo_plan_user_...(). */
enum passo_error passo_move_plan(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape);
/* Loads PASSO_TABLE_SIZE points into the bank of a shape: those of the planner's functions, of a stream.
 * Null: those after reset. Five frames, none if it holds them. At rest only. Errors: ARGUMENT, TABLE. */
enum passo_error passo_load_table(struct passo *passo, enum passo_shape bank, const uint16_t *points);
/* For the planner's functions: clock, ticks and axes of this channel. */
const struct passo_machine *passo_machine(const struct passo *passo);

/* Turning without end: start it from rest, change the speed, end it. See passo_plan.h. If the end is not
 * acknowledged a soft stop takes its place, as after passo_stop(). */
enum passo_error passo_turn_start(struct passo *passo, const struct passo_turning *turning, uint64_t rpm);
enum passo_error passo_turn_speed(struct passo *passo, uint64_t rpm);
enum passo_error passo_turn_stop(struct passo *passo);

/* A path of many lines under many ramps. The source is copied and read by passo_poll(), which keeps the
 * queues filled. The motion starts when the queues are full or all is sent; passo_stream_start() starts it
 * earlier. A path ends with the items that have `last`. Items are checked before they are sent (SUPPLY). At
 * rest only. */
enum passo_error passo_stream(struct passo *passo, const struct passo_source *source);
enum passo_error passo_stream_start(struct passo *passo);
/* Not everything has been sent yet. */
bool passo_is_streaming(const struct passo *passo);

/* --------------------------------------------------------------------------------------- main loop ---- */

/* To be called often: sends what the stream has, looks at the state, at most one frame; without anything to
 * do it looks every millisecond. Errors are told once, by the first call that sees them (CORE_RESET by all),
 * and passo_fault() keeps them: LINE_UNDERRUN, RAMP_UNDERRUN, STEP_OVERRUN, POSITION, SUPPLY, those of the
 * wire. A stream that fails for reasons of the host is stopped softly. What was not acknowledged goes first:
 * as long as a stop or hold does not get through nothing else is done, and NOT_STOPPED or NOT_HELD is told
 * once in `tries` polls. */
enum passo_error passo_poll(struct passo *passo);
/* Microseconds until passo_poll() has something to do; no frame. */
uint32_t passo_idle_time(const struct passo *passo);
/* Something that was queued has not ended yet, as far as passo_poll() has seen. */
bool passo_is_moving(const struct passo *passo);
/* What passo_poll() saw last; no frame. */
const struct passo_snapshot *passo_snapshot(const struct passo *passo);
/* NOT_STOPPED or NOT_HELD as long as it is so; the error that passo_poll() has told, until passo_clear(); OK
 * if none. */
enum passo_error passo_fault(const struct passo *passo);
/* Polls until everything has ended. 0: no limit. Errors: TIMEOUT, and those of passo_poll(). */
enum passo_error passo_wait(struct passo *passo, uint32_t timeout_microseconds);

/* --------------------------------------------------------------------------------------- influence ---- */

/* Feed hold and resume: the same pulses, later. The override is kept over a hold. If one of these three is
 * not acknowledged, the slower of before and now is sent by every poll: a hold that failed comes later, a
 * resume does not. */
enum passo_error passo_hold(struct passo *passo);
enum passo_error passo_resume(struct passo *passo);
/* Feed override, 1 .. 100 percent, or in UQ1.16, 1 .. PASSO_RATE_FULL. While held it counts after resume. */
enum passo_error passo_override(struct passo *passo, uint32_t percent);
enum passo_error passo_override_q16(struct passo *passo, uint32_t rate);
/* Soft and hard stop. What is queued is thrown away, a stream ends; then passo_clear(). After an error of the
 * wire every poll sends it again before anything else; an abort takes the place of a stop. */
enum passo_error passo_stop(struct passo *passo);
enum passo_error passo_abort(struct passo *passo);
/* Leaves the stopped state with empty queues and reads the positions: about four frames. A stop that was not
 * acknowledged gets through first, and steps that have not left the pins are waited for. Errors: MOVING while
 * a soft stop is still slowing down, or while a motion that nobody stopped goes on. */
enum passo_error passo_clear(struct passo *passo);
/* Sets all positions to 0. At rest only. */
enum passo_error passo_zero(struct passo *passo);
/* Motions wait, prepared, until the core's sync input rises or this is taken back. If it is not acknowledged
 * they wait, and that is sent by every poll. */
enum passo_error passo_wait_for_sync(struct passo *passo, bool on);

/* ----------------------------------------------------------------------------------------- reading ---- */

/* Reads the state now. */
enum passo_error passo_read_state(struct passo *passo, struct passo_snapshot *snapshot);
/* Steps made by each axis, all of one moment: positions[0 .. axes - 1]. */
enum passo_error passo_positions(struct passo *passo, int32_t *positions);
/* Position of an axis in its units, Q31.32. */
enum passo_error passo_position_units(struct passo *passo, uint8_t axis, int64_t *units);
/* Degrees (Q31.32) of an axis; speed of the longest axis in rpm (UQ32.32), the override included. Both take
 * the steps per turn. The speed is that of the move queued last: two moves queued at a time may differ. */
enum passo_error passo_angle(struct passo *passo, uint8_t axis, uint32_t steps_per_turn, int64_t *degrees);
enum passo_error passo_rpm(struct passo *passo, uint32_t steps_per_turn, uint64_t *rpm);
/* Steps that an axis has lost by overrun, 0 .. 15 (15: or more). */
enum passo_error passo_lost_steps(struct passo *passo, uint8_t axis, uint32_t *lost);

/* Name and sentence of a state and of a cause. Never null. */
const char *passo_state_name(enum passo_state state);
const char *passo_cause_text(enum passo_cause cause);

#ifdef __cplusplus
}
#endif

#endif
