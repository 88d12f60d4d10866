/* SPDX-License-Identifier: MIT
 * The driver: controls one channel of a Passo core.
 *
 *     static struct passo_host host;
 *     static struct passo passo;
 *
 *     passo_open(&passo, &host, &hardware, &(struct passo_options){0});
 *     passo_configure_axis(&passo, 0, &(struct passo_axis_config){.step_high_ns = 2000});
 *     passo_enable(&passo, 0, true);
 *     passo_move_by_speed(&passo, &move); // queued; the core executes it on its own
 *     while (passo_is_moving(&passo))
 *             passo_poll(&passo); // at most one frame per call
 * Every function returns an enum passo_error (passo_error_text() describes it), checks its arguments, and is
 * atomic: a move that returns an error other than a link error was not started. No heap, no floating point;
 * all RAM is in struct passo and struct passo_host. Not reentrant.
 *
 * After a link error it is unknown whether the core has executed the last frame:
 *   - a stop or abort is resent by every passo_poll() until it is acknowledged (NOT_STOPPED until then);
 *   - for hold, resume, override and wait for sync, the slower of the old and the new setting is resent
 *     in the same way (NOT_HELD until then);
 *   - during a move or a stream the driver becomes BROKEN: motions that were queued before may continue;
 *   - the pin settings of an axis are unknown (NOT_CONFIGURED) until it is configured again.
 * New moves are rejected with these errors; passo_clear() ends the first three. No other command is resent.
 *
 * A call costs one frame (chip select) unless its comment says otherwise; on a noisy link up to `tries`
 * frames. Every call can return ARGUMENT, NOT_OPEN, link errors, CORE_RESET and REFUSED +
 * verdict; comments list the other errors. Speeds, accelerations and rpm are UQ32.32, lengths and angles
 * Q31.32, times of moves are core clocks: see the macros of passo_units.h.
 */
#ifndef PASSO_H
#define PASSO_H

#ifdef __cplusplus
extern "C" {
#endif

#include "passo_error.h"
#include "passo_host.h"
#include "passo_plan.h"
#include "passo_units.h"

#define PASSO_RATE_FULL UINT32_C(0x10000) /* 100 % override, UQ1.16 */

/* -------------------------------------------------------------------------------------------- open ---- */

/* Properties of the core that the program expects. */
struct passo_options {
	uint32_t clock_hz; /* clock of the core, must match; 0: what the core tells */
	uint8_t channel;   /* the channel to control, 0 .. channels - 1 */
	uint8_t channels;  /* CHANNELS of the core, must match; 0: any */
	uint8_t axes;      /* AXES per channel, must match; 0: any */
	uint8_t tick_log2; /* TICK_LOG2 of the core, must match; 0: any */
	/* On a core with inputs: a running motion is soft-stopped if no frame arrives for this time; 0: half
	 * a second, or the longest time that the core can count; PASSO_NO_WATCHDOG for a program that does
	 * not poll. */
	uint64_t watchdog_clocks;
};
#define PASSO_NO_WATCHDOG UINT64_MAX

/* State of the channel when it was last read. */
struct passo_snapshot {
	enum passo_state state;
	enum passo_cause cause; /* of the last stop */
	bool quiet;             /* no motion is prepared or running, and all steps have left the pins */
	bool stopping;          /* a soft stop is in progress */
	uint8_t overrun;        /* bit i: axis i has lost steps */
	uint16_t drained;       /* substeps output at drain velocity since reset; wraps */
	uint32_t rate;          /* current time scale, UQ1.16 */
	uint16_t line_room, ramp_room; /* free queue entries */
	uint32_t velocity;             /* UQ0.32 substeps per clock, before the time scale */
};

/* Source of a stream. Each function fills in one item and returns true, or returns false if none is available
 * yet. passo_poll() calls them only when the queue has free entries. Each item is requested once; after an
 * item with `last`, its function is not called again. The functions must not call the driver. */
struct passo_source {
	bool (*line)(void *context, struct passo_line *line);
	bool (*ramp)(void *context, struct passo_ramp *ramp);
	void *context;
};

/* Driver state of an axis. */
struct passo_axis_memory {
	uint64_t steps_per_unit;  /* UQ32.32 */
	uint32_t shortest_clocks; /* shortest step period; 0: pin settings unknown */
	uint32_t ratio;           /* counts per step of its encoder, UQ16.16; 0: not configured */
	int32_t expected;         /* position of the core after all queued motions */
	uint32_t offset;          /* position of the program minus that of the core; wraps */
	uint8_t switches;         /* fitted switches, one bit per enum passo_trigger_source */
	bool limit_soft;          /* its limit switches stop softly */
	bool homed;
	bool backward; /* direction of the last line that moves it */
#ifndef PASSO_WITHOUT_TRACKERS
	uint16_t backlash; /* of its tracker, and the target of that while the path goes up, in the core */
	int32_t track;
	uint32_t tracked_from; /* position of the tracker in the core where it is 0 for the program; wraps */
#endif
};

/* A target that can change during the motion; see passo_goto.h. */
struct passo_goto {
	uint8_t axis;
	int32_t target;        /* position in steps */
	uint64_t speed;        /* UQ32.32 steps/s */
	uint64_t top_speed;    /* highest speed of all changes, given from rest; 0: speed */
	uint64_t acceleration; /* UQ32.32 steps/s^2 */
	uint64_t late_clocks;  /* time limit for a change to reach the core; 0: 1 ms */
};

/* Homing, probing or goto in progress; see passo_home.h, passo_goto.h. */
enum passo_task_kind { PASSO_TASK_NONE, PASSO_TASK_HOME, PASSO_TASK_PROBE, PASSO_TASK_GOTO };
enum passo_home_phase {
	PASSO_HOME_RELEASE,  /* leaves a switch that is already active */
	PASSO_HOME_APPROACH, /* seeks the switch */
	PASSO_HOME_BACK_OFF,
	PASSO_HOME_SLOW, /* seeks the edge slowly */
	PASSO_HOME_PULL_OFF,
	/* squaring: the motors are in line; one leaves its switch, goes further, and seeks its edge */
	PASSO_HOME_LINE,
	PASSO_HOME_LEAVE,
	PASSO_HOME_LEFT,
	PASSO_HOME_SEEK
};
#ifndef PASSO_CARTESIAN
/* Motors of an axis that are homed one by one. */
struct passo_square {
	uint8_t first;                /* to reach its switch */
	uint8_t motor;                /* whose switch ends the motion */
	uint8_t stopped;              /* bits of those whose limits have ended it */
	uint8_t known;                /* bits of those whose edges are known */
	uint8_t rounds;               /* slow approaches */
	int32_t line[PASSO_AXES_MAX]; /* positions of the motors at the first switch */
	int32_t edge[PASSO_AXES_MAX]; /* and at their own */
	int32_t least, most;          /* steps from the line to where those end whose edges are known */
};
#endif
struct passo;
struct passo_task {
	enum passo_task_kind kind;
	enum passo_home_phase phase;
	bool inside;   /* the driver's own calls */
	bool armed;    /* its trigger may be armed */
	bool optional; /* of a probe */
#ifndef PASSO_WITHOUT_TRACKERS
	bool settles; /* its trigger has stopped trackers, which go on to their targets */
#endif
	uint8_t left; /* axes to home, including the current one */
	const struct passo_home *home;
	/* of a goto: its next motion, from rest; a program without a goto does not link it */
	enum passo_error (*go_on)(struct passo *passo);
};

/* Outputs during a move; see passo_outputs.h. */
struct passo_output {
	uint8_t levels;    /* bit i: digital output i */
	bool proportional; /* the power is speed-proportional, else constant */
	bool raster;       /* it comes from the raster queue; `power` is 0 */
	uint32_t power;    /* 0 .. PASSO_POWER_FULL */
	uint64_t speed; /* UQ32.32 steps/s of the dominant axis at which a proportional power is `power`; 0:
	                   the reference of passo_configure_outputs() */
};

/* Assumed state of the channel. docs/driver.md shows the transitions. */
enum passo_assumed {
	PASSO_ASSUMED_NOT_OPEN,
	PASSO_ASSUMED_READY,         /* accepts moves */
	PASSO_ASSUMED_STOPPED,       /* stopped, or a stop was commanded: must be cleared */
	PASSO_ASSUMED_BROKEN,        /* the effect of a command is unknown: must be cleared */
	PASSO_ASSUMED_BROKEN_STOPPED /* both */
};

/* How the queued motions are expected to end. */
enum passo_expectation {
	PASSO_EXPECT_NOTHING,
	PASSO_EXPECT_POSITIONS, /* at the expected positions */
	PASSO_EXPECT_END,       /* at unknown positions */
	PASSO_EXPECT_TURNING,   /* continuous rotation: only when commanded */
	PASSO_EXPECT_TURN_END   /* continuous rotation: with the queued deceleration */
};

/* A stop that was commanded but not acknowledged; every poll resends it. */
enum passo_due { PASSO_DUE_NOTHING, PASSO_DUE_STOP, PASSO_DUE_ABORT };

/* Purpose of the frame in flight, in ascending priority. */
enum passo_post {
	PASSO_POST_NONE,
	PASSO_POST_ITEMS, /* lines or ramps of a stream */
	PASSO_POST_START, /* opens the gate for a stream */
	PASSO_POST_RUN,
	PASSO_POST_RATE,
	PASSO_POST_STOP,
	PASSO_POST_ABORT
};

/* Phase of a stream: none, filling the queues behind the closed gate, running. */
enum passo_stream_phase { PASSO_STREAM_NONE, PASSO_STREAM_FILLS, PASSO_STREAM_RUNS };

/* State of a stream's source, for lines and for ramps: may have more, starved, finished. */
enum passo_supply { PASSO_SUPPLY_MORE, PASSO_SUPPLY_DRY, PASSO_SUPPLY_DONE };

/* Whether motions may start: yes, at the sync edge, no. */
enum passo_gate { PASSO_GATE_OPEN, PASSO_GATE_SYNC, PASSO_GATE_CLOSED };

/* One channel. All members are private; use the functions. */
struct passo {
	struct passo_host *host;
	struct passo_machine machine;
	uint16_t base;                     /* address of the channel's registers */
	uint16_t line_places, ramp_places; /* depths of the queues */
	uint8_t channel;
	uint8_t axes;           /* of the channel; lines move the first ones, machine.axes */
	uint8_t misses;         /* consecutive status reads that failed */
	uint8_t idle_looks;     /* consecutive status reads that found all motions ended */
	uint8_t movers;         /* axes moved since the last rest */
	bool aborts;            /* an abort was commanded since then */
	bool hard_trigger;      /* the last armed trigger stops hard */
	bool inherits;          /* settings armed before passo_open() are still active */
	bool unbegun;           /* the last status read found a queued motion that has not started ... */
	uint32_t unbegun_since; /* ... since this time, microseconds */
	bool held;              /* feed hold: rate 0, the override is kept */
	bool rate_due;          /* the rate is not acknowledged; every poll resends it */
	bool zero_due;          /* zero is not acknowledged: the positions read next count as 0 */
	enum passo_due stop_due;
	enum passo_assumed assumed;
	enum passo_expectation expects;
	enum passo_stream_phase stream;
	enum passo_supply lines : 8, ramps : 8; /* of the stream */
	uint8_t packed_lines, packed_ramps;     /* of the stream, in the prepared frame */
	enum passo_gate gate;                   /* outside the filling phase of a stream */
	enum passo_error fault;
	enum passo_post post;
	enum passo_error posted; /* result of the posted frame */
	struct passo_axis_memory axis[PASSO_AXES_MAX];
	struct passo_snapshot snapshot; /* its free entries are a lower bound */
	uint32_t looked_at;             /* microseconds: time of the last status read */
	uint32_t rate_target;           /* UQ1.16: the override, kept during a hold */
	uint32_t oversampling;          /* of the last plan */
	uint64_t velocity_peak;         /* of the last plan */
	uint64_t velocity_top;          /* highest peak of the plans of this motion */
	bool has_inputs, has_outputs, has_encoders, has_trackers; /* the core has */
	bool has_raster, has_compare;
	bool follows;               /* motions may be clocked by an encoder */
	uint8_t spindle;            /* its axis */
	bool stop_time_known;       /* the soft-stop time is configured */
	uint32_t reference;         /* power reference, UQ0.32 substeps per clock; 0: unknown */
	struct passo_output output; /* of moves queued from now on */
	bool probe_fitted;          /* the probe is configured */
	bool probe_inverted;
	struct passo_task task;
#ifndef PASSO_WITHOUT_TRACKERS
	uint8_t tracked; /* axes whose trackers follow a target, or did until they were stopped */
	uint8_t parked;  /* of these, axes that wait at a limit until the path leaves it */
#endif
#ifndef PASSO_CARTESIAN
	struct passo_square square;
#endif
	struct passo_turning turning;
	struct passo_goto go; /* in progress */
	/* for a motion whose ramps can be changed */
	bool backward; /* its direction */
	bool has_aim;  /* it has a target, `aim`, in core positions */
	bool aimed;    /* it ends at or before the target */
	int32_t aim;
	uint32_t late; /* longest time in microseconds until the core has a change */
	struct passo_source source;
};

/* Connects to the core and takes over a channel: checks identification, version and parameters, flushes the
 * queues of a channel at rest, clears a stopped one, disarms whatever a previous connection armed, and reads
 * the positions, which are kept; see the table in docs/driver.md. A channel in motion (the host was reset)
 * keeps running, with its trigger: the result is MOVING; state, positions, hold, stop and abort work
 * immediately, moves only after the motion has ended or stopped and passo_clear(), which takes it over. Each
 * axis must be configured before it moves. A pending stop of a previous connection is dropped. ESTOP and
 * ALARM: these keep the channel stopped; it is open, and passo_clear() works when they are over. About ten
 * frames. Errors: NOT_PASSO, VERSION, PARAMETERS, CLOCK, CLOCK_UNKNOWN, WATCHDOG_TOO_LONG, MOVING,
 * ESTOP, ALARM. */
enum passo_error passo_open(struct passo *passo, struct passo_host *host,
    const struct passo_hardware *hardware, const struct passo_options *options);
/* Takes over another channel of a core that is already open. Error: also STREAMING while the next frame of
 * a stream is prepared (passo_host.h, `spare`); with several channels no frame is prepared ahead. */
enum passo_error passo_open_channel(
    struct passo *passo, struct passo_host *host, const struct passo_options *options);

/* ---------------------------------------------------------------------------------------- settings ---- */

/* Longest pin time in clocks. */
#define PASSO_PIN_CLOCKS_MAX ((UINT32_C(1) << PASSO_AXIS_STEP_TIMING_STEP_HIGH_BITS) - 1u)
/* Pin settings of an axis. Times are rounded up to clocks, 1 .. PASSO_PIN_CLOCKS_MAX. */
struct passo_axis_config {
	uint32_t step_high_ns, step_low_ns; /* minimum time of STEP active, and of STEP inactive */
	uint32_t dir_setup_ns;              /* minimum time from a DIR change to the active edge of STEP */
	uint32_t dir_hold_ns;               /* minimum time from the end of step_low to a DIR change */
	bool in_clocks;                     /* the four times are in clocks, not nanoseconds */
	bool step_inverted, direction_inverted, enable_inverted;
	bool both_edges;         /* every edge of STEP is a step */
	uint64_t steps_per_unit; /* UQ32.32 steps per millimeter, degree, ...; 0: no units */
};

/* Sets the pins and units of an axis; the drive enable is not changed. An axis must be configured before it
 * can move. Only at rest; waits until the pin timing of the last steps has elapsed. Error: MOVING. */
enum passo_error passo_configure_axis(
    struct passo *passo, uint8_t axis, const struct passo_axis_config *config);
/* The highest speed that the pin timing of an axis allows, UQ32.32 units/s, rounded up: without a limit it is
 * UINT64_MAX; not configured, or no such axis: 0. `steps_per_unit` is UQ32.32. */
uint64_t passo_highest_speed(const struct passo *passo, uint8_t axis, uint64_t steps_per_unit);
/* Sets the drive enable output. Enabling works at any time. Disabling works only at rest or when stopped, and
 * waits until the last step has left the pins; to disable immediately, call passo_abort() first, after
 * which at most the current pulse is finished. One frame, three to disable. Error: MOVING while a motion is
 * running or queued. */
enum passo_error passo_enable(struct passo *passo, uint8_t axis, bool on);
/* Sets the duration of hold and resume, and of a soft stop, from full rate, in clocks, PASSO_MS(100); 0:
 * immediate. Both are rounded to the resolution of the core. Also sets the velocity (UQ0.32 substeps per
 * clock, up to 1/2) of the substeps that remain at the end of a profile; 0: unchanged. */
enum passo_error passo_configure_motion(
    struct passo *passo, uint64_t hold_clocks, uint64_t stop_clocks, uint32_t drain_velocity);

/* ------------------------------------------------------------------------------------------- moves ---- */

/* Each plans a move, checks it against the pin timing, loads a shape table if the core does not hold the
 * required one (five frames and the time to compute it), and queues the move: three frames. It starts
 * immediately or after the motions queued before it. Errors: PASSO_ERROR_PLAN + enum passo_plan_error, or
 * ABSURD for a value without its unit macro, such as .speed = 10000 for PASSO_STEPS_PER_S(10000); FULL (try
 * again later), STOPPED, NOT_STOPPED, NOT_HELD, BROKEN, STREAMING, MOVING (in continuous rotation), TABLE,
 * NOT_CONFIGURED, PINS_TOO_SLOW. */
enum passo_error passo_move_in_time(struct passo *passo, const struct passo_move_in_time *move);
enum passo_error passo_move_by_speed(struct passo *passo, const struct passo_move_by_speed *move);
enum passo_error passo_move_below_speed(struct passo *passo, const struct passo_move_below_speed *move);
enum passo_error passo_move_at_speed(struct passo *passo, const struct passo_move_at_speed *move);
enum passo_error passo_move_axes(struct passo *passo, const struct passo_move_axes *move);
enum passo_error passo_move_turn(struct passo *passo, const struct passo_move_turn *move);
enum passo_error passo_move_sigmoid(struct passo *passo, const struct passo_move_sigmoid *move);
enum passo_error passo_move_jerk(struct passo *passo, const struct passo_move_jerk *move);
/* A limits[i].steps_per_mm of 0 means the steps per unit of the axis. */
enum passo_error passo_move_straight(struct passo *passo, const struct passo_move_straight *move);
/* With a user-defined shape. Its table is loaded into shape->bank, unless that bank already holds it. */
enum passo_error passo_move_user_in_time(
    struct passo *passo, const struct passo_move_in_time *move, const struct passo_user_shape *shape);
enum passo_error passo_move_user_by_speed(
    struct passo *passo, const struct passo_move_by_speed *move, const struct passo_user_shape *shape);
/* The same to absolute positions: `steps`, `distance` and `angle` are those of the end. Bit i of `axes` moves
 * axis i; the values of other axes are ignored. The distance is counted from passo_target(), the end of the
 * moves queued before, in the shorter direction around 2^32 steps. An end in millimeters or degrees is
 * rounded to the nearest step of the axis, so that errors do not accumulate. If no axis has any distance
 * left, nothing is queued: OK. One frame more. Errors: those of a move; ARGUMENT also if `axes` is 0 or has
 * an axis that the channel does not have; MOVING also while passo_target() is unknown. */
enum passo_error passo_move_to_in_time(
    struct passo *passo, uint8_t axes, const struct passo_move_in_time *move);
enum passo_error passo_move_to_by_speed(
    struct passo *passo, uint8_t axes, const struct passo_move_by_speed *move);
enum passo_error passo_move_to_below_speed(
    struct passo *passo, uint8_t axes, const struct passo_move_below_speed *move);
enum passo_error passo_move_to_at_speed(
    struct passo *passo, uint8_t axes, const struct passo_move_at_speed *move);
enum passo_error passo_move_to_axes(struct passo *passo, uint8_t axes, const struct passo_move_axes *move);
enum passo_error passo_move_to_sigmoid(
    struct passo *passo, uint8_t axes, const struct passo_move_sigmoid *move);
enum passo_error passo_move_to_jerk(struct passo *passo, uint8_t axes, const struct passo_move_jerk *move);
enum passo_error passo_move_to_straight(
    struct passo *passo, uint8_t axes, const struct passo_move_straight *move);
enum passo_error passo_move_to_user_in_time(struct passo *passo, uint8_t axes,
    const struct passo_move_in_time *move, const struct passo_user_shape *shape);
enum passo_error passo_move_to_user_by_speed(struct passo *passo, uint8_t axes,
    const struct passo_move_by_speed *move, const struct passo_user_shape *shape);
/* To an angle from position 0, over full turns as well. */
enum passo_error passo_move_to_turn(struct passo *passo, const struct passo_move_turn *move);

/* Queues a plan made with passo_machine(); `shape` is null unless it is a plan of passo_plan_user_...(). */
enum passo_error passo_move_plan(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape);
/* Loads PASSO_TABLE_SIZE points into the bank of a shape, for streams and plans; null: the points after
 * reset. Only at rest. Five frames, none if the bank holds them already. Error: TABLE. */
enum passo_error passo_load_table(struct passo *passo, enum passo_shape bank, const uint16_t *points);
/* Converts microseconds to core clocks at run time, rounded down; 0 before passo_open(). */
uint64_t passo_clocks(const struct passo *passo, uint32_t microseconds);
/* Whether the core was built with inputs; see passo_inputs.h. */
bool passo_has_inputs(const struct passo *passo);
/* Clock, ticks and axes of this channel, for the functions of the planner: the axes that lines can move. */
const struct passo_machine *passo_machine(const struct passo *passo);
/* AXES of this channel: those of passo_machine() and, behind them, those that only their trackers move. */
uint8_t passo_axes(const struct passo *passo);

/* Continuous rotation: start it from rest, change the speed, decelerate to rest. See passo_plan.h. If
 * passo_turn_stop() is not acknowledged, a soft stop replaces it, like passo_stop(). A change must reach the
 * core within 1 ms. Errors: those of a move, NOT_TURNING; LATE: a new speed was not sent,
 * a stop became a soft one. */
enum passo_error passo_turn_start(struct passo *passo, const struct passo_turning *turning, uint64_t rpm);
enum passo_error passo_turn_speed(struct passo *passo, uint64_t rpm);
enum passo_error passo_turn_stop(struct passo *passo);

/* Streams a path of many lines and ramps. *source is copied; passo_poll() reads from it and keeps the queues
 * filled. The motion starts when the queues are full or everything is sent; passo_stream_start() starts it
 * earlier. The path ends with the items that have `last`. Items are checked before they are sent (SUPPLY).
 * Only at rest. Error of passo_stream_start(): NOT_PREPARED if no stream waits for its start. */
enum passo_error passo_stream(struct passo *passo, const struct passo_source *source);
enum passo_error passo_stream_start(struct passo *passo);
/* True until everything has been sent. */
bool passo_is_streaming(const struct passo *passo);

/* --------------------------------------------------------------------------------------- main loop ---- */

/* Call it often: feeds the stream or reads the state with at most one frame, two with trackers; an idle
 * driver reads the state every millisecond. Errors are returned once, by the first call that detects them
 * (CORE_RESET by every call), and kept for passo_fault(): LINE_UNDERRUN, RAMP_UNDERRUN, STEP_OVERRUN,
 * POSITION, SUPPLY, LIMIT, ALARM, TRIGGER, WATCHDOG, ESTOP, FOLLOWING, INPUTS_UNKNOWN, link errors, those of
 * passo_home() and passo_probe(), which it advances. A stream that fails on the host's side is stopped with a
 * soft stop. Commands that were not acknowledged have priority: until a stop or hold gets through, nothing
 * else is sent, and NOT_STOPPED or NOT_HELD is returned once every `tries` polls. */
enum passo_error passo_poll(struct passo *passo);
/* Microseconds until passo_poll() has something to do. No frame. */
uint32_t passo_idle_time(const struct passo *passo);
/* True until all queued motions have ended, as of the last passo_poll(). No frame. */
bool passo_is_moving(const struct passo *passo);
/* The state that was read last. No frame. */
const struct passo_snapshot *passo_snapshot(const struct passo *passo);
/* NOT_STOPPED or NOT_HELD while that applies; otherwise the last error of passo_poll(), kept until
 * passo_clear(), or OK. Of a channel that is not open: the error of passo_open(), such as STUCK_LOW, or
 * NOT_OPEN if that has not been called. No frame. */
enum passo_error passo_fault(const struct passo *passo);
/* Polls until all motions have ended, at most for a time in clocks, PASSO_S(2); 0: no timeout. Errors:
 * TIMEOUT, those of passo_poll(). */
enum passo_error passo_wait(struct passo *passo, uint64_t timeout_clocks);

/* ----------------------------------------------------------------------------------------- control ---- */

/* Feed hold and resume: the same pulse sequence, stretched in time. A hold keeps the override. If hold,
 * resume or override is not acknowledged, every poll resends the slower of the old and the new rate: a failed
 * hold still takes effect, a failed resume does not. Errors: NOT_STOPPED. */
enum passo_error passo_hold(struct passo *passo);
enum passo_error passo_resume(struct passo *passo);
/* Feed override in percent, 1 .. 100, or in UQ1.16, 1 .. PASSO_RATE_FULL. During a hold it takes effect with
 * the resume. */
enum passo_error passo_override(struct passo *passo, uint32_t percent);
enum passo_error passo_override_q16(struct passo *passo, uint32_t rate);
/* Soft and hard stop. The queues are flushed and a stream ends, in a soft stop when the axes are at rest:
 * until then polls feed it. passo_clear() is needed afterwards. After a link error every poll resends the
 * stop before anything else; an abort replaces a pending stop. */
enum passo_error passo_stop(struct passo *passo);
enum passo_error passo_abort(struct passo *passo);
/* Leaves the stopped state with empty queues and reads the positions: about four frames. Sends a pending stop
 * first and waits until all steps have left the pins. Errors: NOT_STOPPED, NOT_HELD, MOVING during a soft
 * stop or a motion that was not stopped; ESTOP and ALARM while these keep the channel stopped. Ends homing
 * and probing. */
enum passo_error passo_clear(struct passo *passo);
/* While on, prepared motions wait for a rising edge of the core's sync input. Switching it off starts them.
 * If it is not acknowledged, motions wait and every poll resends it. */
enum passo_error passo_wait_for_sync(struct passo *passo, bool on);
/* Whether wait for sync is on. No frame. */
bool passo_waits_for_sync(const struct passo *passo);
/* Starts, on one clock, the motions held back by passo_wait_for_sync() on these channels of one core, and
 * switches wait for sync off for them: one write, after reading each channel until its motion is armed. A
 * stream is armed when passo_poll() has filled the queues. On an error nothing has started; after a link
 * error in the write all motions have, or none. Errors: NOT_PREPARED if one of the channels has no waiting
 * motion, or an earlier one is still running; STOPPED, NOT_STOPPED, NOT_HELD, BROKEN. */
enum passo_error passo_start_together(struct passo *const *channels, unsigned count);

/* --------------------------------------------------------------------------------------- positions ----
 *
 * Positions are steps, -2^31 .. 2^31 - 1, and wrap. The core counts them from its reset or the last
 * passo_zero(); passo_set_position() adds an offset that is kept in struct passo. Clear, stop, abort and link
 * errors keep it; passo_open() and passo_zero() set it to 0. */

/* Position of an axis without units, or beyond 2^31 units. */
#define PASSO_NO_UNITS INT64_MIN

/* Positions of all axes at one instant, in steps and, Q31.32, in the units of each axis: [0 .. axes - 1].
 * `steps` may be null. */
enum passo_error passo_positions(struct passo *passo, int32_t *steps);
enum passo_error passo_positions_units(struct passo *passo, int32_t *steps, int64_t *units);
/* Position of one axis in its units, Q31.32. Error: UNITS. */
enum passo_error passo_position_units(struct passo *passo, uint8_t axis, int64_t *units);
/* End positions of all axes after the queued motions; at rest, their positions. No frame. Errors: STOPPED
 * or BROKEN until passo_clear(), which makes the real positions the target; MOVING while the end is unknown:
 * during continuous rotation, or an endless line. */
enum passo_error passo_target(const struct passo *passo, int32_t *steps);
/* Steps from the present position to passo_target(), of all axes at one instant; the sign is the direction.
 * One frame. Errors: those of passo_target(). */
enum passo_error passo_distance_to_go(struct passo *passo, int32_t *steps);
/* Converts steps of an axis, such as a target, to its units, Q31.32. No frame. Error: UNITS. */
enum passo_error passo_to_units(const struct passo *passo, uint8_t axis, int32_t steps, int64_t *units);
/* Sets the current position of one axis to `steps`; other axes are unchanged. Only at rest: MOVING. Three
 * frames. */
enum passo_error passo_set_position(struct passo *passo, uint8_t axis, int32_t steps);
/* Sets all positions to 0, in the core as well. Only at rest: MOVING. After a link error they are
 * either unchanged or 0 for the driver, whether the core executed it or not: call it again. */
enum passo_error passo_zero(struct passo *passo);

/* ----------------------------------------------------------------------------------------- reading ---- */

/* Reads the current state. */
enum passo_error passo_read_state(struct passo *passo, struct passo_snapshot *snapshot);
/* Angle of an axis in degrees (Q31.32), and speed of the axis with the most steps in rpm (UQ32.32), override
 * included. `steps_per_turn` is steps per revolution. The speed is scaled for the move queued last and can be
 * wrong while an earlier one is running. */
enum passo_error passo_angle(struct passo *passo, uint8_t axis, uint32_t steps_per_turn, int64_t *degrees);
enum passo_error passo_rpm(struct passo *passo, uint32_t steps_per_turn, uint64_t *rpm);
/* Steps lost by STEP_OVERRUN on an axis, 0 .. 15; saturates. */
enum passo_error passo_lost_steps(struct passo *passo, uint8_t axis, uint32_t *lost);

/* Name of a state and description of a cause, for any value. Never null. */
const char *passo_state_name(enum passo_state state);
const char *passo_cause_text(enum passo_cause cause);

#ifdef __cplusplus
}
#endif

#endif
