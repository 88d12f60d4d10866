/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the driver.
 */
#ifndef PASSO_DRIVER_H
#define PASSO_DRIVER_H

#include "passo_encoder.h"
#include "passo_goto.h"
#include "passo_home.h"
#include "passo_outputs.h"
#include "passo_track.h"
#include "passo_words.h"

/* ARGUMENT for null, NOT_OPEN for a channel that is not open. */
enum passo_error passo_driver_check(const struct passo *passo);
/* The same, and ARGUMENT for an axis that the channel does not have. */
enum passo_error passo_driver_check_axis(const struct passo *passo, uint8_t axis);
/* Whether an error is a link error. */
bool passo_driver_is_link_error(enum passo_error error);
/* Present time in microseconds; 0 if the port has no clock. */
uint32_t passo_driver_now(const struct passo *passo);
/* A timeout in microseconds. It accumulates the time between calls, so it can exceed the range of the
 * microsecond clock. */
struct passo_deadline {
	uint64_t left;
	uint32_t looked_at;
};
/* The limit in clocks; 0: none. */
struct passo_deadline passo_driver_deadline(const struct passo *passo, uint64_t clocks);
/* Microseconds left; 0 when it is over. Call it at least once in 2^32 microseconds. */
uint64_t passo_driver_left(const struct passo *passo, struct passo_deadline *deadline);

/* Writes consecutive registers of the channel. */
enum passo_error passo_driver_write(
    struct passo *passo, uint16_t address, const uint32_t *words, size_t length);
enum passo_error passo_driver_command(struct passo *passo, struct passo_channel_command command);
/* The value of the RUN register for a gate, and the write of it; no frame if the gate is already set. */
uint32_t passo_driver_run(const struct passo *passo, enum passo_gate gate);
enum passo_error passo_driver_gate(struct passo *passo, enum passo_gate gate);

/* Reads the state into the snapshot; `once`: with a single attempt. */
enum passo_error passo_driver_look(struct passo *passo, bool once);
/* The same, repeated while only the pins are busy: with the last steps, or with the timing restarted by the
 * configuration of an axis. */
enum passo_error passo_driver_look_at_rest(struct passo *passo);
/* MOVING unless two reads in a row find the channel at rest, or stopped with all steps made. */
enum passo_error passo_driver_require_rest(struct passo *passo);
/* Reads the positions of the core that are due to the path, without the offsets. */
enum passo_error passo_driver_positions(struct passo *passo, int32_t *positions, bool once);
/* Leaves the steps of the path of positions of the core; while a zero is due, those of the trackers are the
 * places that they are counted from. */
#ifdef PASSO_WITHOUT_TRACKERS
static inline enum passo_error passo_driver_take_off_trackers(
    struct passo *passo, uint32_t *positions, bool once)
{
	(void)passo, (void)positions, (void)once;
	return PASSO_OK;
}
#else
enum passo_error passo_driver_take_off_trackers(struct passo *passo, uint32_t *positions, bool once);
/* Before a task: trackers that follow a target now go on after the stops of its trigger. */
enum passo_error passo_driver_note_trackers(struct passo *passo);
/* Sends a tracker that is at rest `steps` further, as fast and steep as that; the channel moves meanwhile. */
enum passo_error passo_driver_track_by(
    struct passo *passo, uint8_t axis, int32_t steps, uint64_t speed, uint64_t acceleration);
/* A tracker that is at its target is at `position` now. */
enum passo_error passo_driver_track_is_at(struct passo *passo, uint8_t axis, int32_t position);
/* The path has ended, and has moved these axes: those at a limit take up their backlash as all others. */
void passo_driver_unpark(struct passo *passo, uint8_t moved);
#endif
/* A position of the core as the program counts it. */
int32_t passo_driver_offset(const struct passo *passo, unsigned axis, int32_t position);
/* Steps in units of a scale (UQ32.32), Q31.32, to nearest. PASSO_NO_UNITS if the scale is 0, or beyond 2^31.
 */
int64_t passo_driver_units(int32_t steps, uint64_t scale);
/* Whether nothing moves or is queued according to the snapshot. Free entries are sampled some hundred clocks
 * after the state, so only a second consecutive read is conclusive. */
bool passo_driver_at_rest(const struct passo *passo);
/* In motion, or not known to have ended; a task that waits does not count. */
bool passo_driver_in_motion(const struct passo *passo);
/* The error of a cause; OK if it was a command. */
enum passo_error passo_driver_fault_of(enum passo_cause cause);
/* Maps REFUSED + BUSY of a command that requires rest to MOVING; other errors are unchanged. */
enum passo_error passo_driver_moving(enum passo_error error);

/* Whether the channel is BROKEN or BROKEN_STOPPED; STOPPED or BROKEN_STOPPED; in continuous rotation or its
 * final deceleration. */
bool passo_driver_is_broken(const struct passo *passo);
bool passo_driver_is_stopped(const struct passo *passo);
bool passo_driver_is_turning(const struct passo *passo);
/* Adds STOPPED or BROKEN to the assumed state. */
void passo_driver_assume_worse(struct passo *passo, enum passo_assumed worse);
/* The effect of a command is unknown: it may have queued something. */
void passo_driver_break(struct passo *passo);
/* Adds a line to the expected end positions; of an endless one the end is unknown. */
void passo_driver_expect(struct passo *passo, const struct passo_line *line);
/* All motions have ended, at these positions. */
void passo_driver_ended(struct passo *passo, const int32_t *positions);
/* Disarms whatever a previous connection armed; the channel is quiet. */
enum passo_error passo_driver_disown(struct passo *passo);
/* Flushes the queues of a channel that does not move, clears it, and reads the positions. The snapshot must
 * be current, and the gate closed if something is queued. */
enum passo_error passo_driver_take_over(struct passo *passo);
/* Reads the state and returns why a new motion cannot be queued, or OK; `needs_rest`: MOVING unless at
 * rest. */
enum passo_error passo_driver_ready(struct passo *passo, bool needs_rest);

/* Loads the tables that a plan needs unless the core holds them; TABLE if that is required but the core is
 * not at rest. */
enum passo_error passo_driver_tables(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape);
/* Records that all banks have their contents after reset. */
void passo_driver_tables_fresh(struct passo_host *host);

/* Queues a checked plan; does not change the clock source of motions. */
enum passo_error passo_driver_queue(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape);
/* Queues another line of the same motion, with the output of passo_set_output(). */
enum passo_error passo_driver_queue_line(struct passo *passo, const struct passo_plan *plan);
/* Whether the pins of all axes are fast enough for the line of a plan. */
bool passo_driver_pins_suffice(const struct passo *passo, const struct passo_plan *plan);
/* At rest: the next motion has the counts of an encoder as its clock, up to `top_speed` (UQ32.32 counts/s).
 * Converts plan->velocity_peak from substeps per enabled clock to substeps per clock. Error: FOLLOW_SPEED. */
enum passo_error passo_driver_follow(struct passo *passo, const struct passo_channel_follow *follow,
    uint64_t top_speed, struct passo_plan *plan);
/* Selects the core's clock for motions, if an encoder may be selected. Errors: those of a motion at rest. */
enum passo_error passo_driver_unfollow(struct passo *passo);
/* ARGUMENT, NOT_OPEN, or NO_ENCODERS of a core without. */
enum passo_error passo_driver_check_encoders(const struct passo *passo);
/* Reads the levels of a core with outputs. */
enum passo_error passo_driver_recall_outputs(struct passo *passo);
/* The word of an output that was checked. */
uint32_t passo_driver_word_of(const struct passo_output *output);
/* The words of a line, with its output if the core has outputs; returns their number. DIR of an axis
 * without steps does not toggle: that would delay its next step. */
size_t passo_driver_line_words(const struct passo *passo, uint32_t *words, const struct passo_line *line);
/* The output word of a planned move. Errors: REFERENCE, ABOVE_REFERENCE. */
enum passo_error passo_driver_output(
    const struct passo *passo, const struct passo_plan *plan, uint32_t *word);
/* NO_OUTPUTS or SUPPLY if a line of a stream must not have this output word. */
enum passo_error passo_driver_check_output(const struct passo *passo, uint32_t word);
/* Pushes the ramps of a plan; the queue must have free entries for them. */
enum passo_error passo_driver_push_ramps(struct passo *passo, const struct passo_plan *plan);
/* Whether all axes that a line moves are configured. */
bool passo_driver_pins_known(const struct passo *passo, const struct passo_line *line);

/* Whether the source may have items and enough entries are free to justify a frame. */
bool passo_driver_wants_lines(const struct passo *passo);
bool passo_driver_wants_ramps(const struct passo *passo);
/* Whether the core holds fewer frames of lines than of ramps: a frame of either lasts for some polls. */
bool passo_driver_lines_are_urgent(const struct passo *passo);
/* Retries a source that had no items. */
void passo_driver_ask_again(struct passo *passo);
/* Append items from the source to the payload, after its first *length words, as many as fit into queue and
 * frame. */
enum passo_error passo_driver_take_lines(struct passo *passo, size_t *length);
enum passo_error passo_driver_take_ramps(struct passo *passo, size_t *length);
/* Whether a frame of this channel is posted, or prepared. */
bool passo_driver_is_sending(const struct passo *passo);
/* The stream's part of a poll: at most one frame. *sent: whether there was one. */
enum passo_error passo_driver_feed(struct passo *passo, bool *sent);
/* Handles the result of the stream's posted frame. */
enum passo_error passo_driver_settle_stream(struct passo *passo);
void passo_driver_end_stream(struct passo *passo);
/* Microseconds between two reads of the state. */
uint32_t passo_driver_interval(const struct passo *passo);

/* The rate to be set, UQ1.16: 0 during a hold, otherwise the override. */
uint32_t passo_driver_rate(const struct passo *passo);
/* Makes a stop or abort due and ends a stream. */
void passo_driver_halt(struct passo *passo, enum passo_due due);
/* NOT_STOPPED or NOT_HELD while a command is unacknowledged. */
enum passo_error passo_driver_due(const struct passo *passo);
/* Sends the due command of highest priority: at most one chip select. PENDING until no command is due, or the
 * error of a frame after its last attempt. */
enum passo_error passo_driver_send_due(struct passo *passo);
/* The same until no command of priority `least` or higher is due, or until an error ... */
enum passo_error passo_driver_send_due_until(struct passo *passo, enum passo_post least);
/* ... which is then returned as NOT_STOPPED or NOT_HELD (or CORE_RESET). */
enum passo_error passo_driver_require_sent(struct passo *passo, enum passo_post least);
/* Abandons this channel's posted frame, if there is one. */
void passo_driver_drop(struct passo *passo);

/* ARGUMENT, NOT_OPEN, or NO_INPUTS of a core without. */
enum passo_error passo_driver_check_inputs(const struct passo *passo);
/* Writes the watchdog of the core. */
enum passo_error passo_driver_watchdog(struct passo *passo, uint64_t stop_clocks, uint64_t disable_clocks);
/* Arms and disarms the trigger for a task. */
enum passo_error passo_driver_arm(struct passo *passo, const struct passo_trigger_config *config);
enum passo_error passo_driver_disarm(struct passo *passo);
/* Waits until the trigger is armed, at most for 2^20 clocks or 0.1 s: INPUTS_UNKNOWN. *active: whether its
 * source was active then. */
enum passo_error passo_driver_armed(struct passo *passo, bool *active);
/* Whether the inputs of the channel are unknown, or its trigger is being armed: no motion starts. */
enum passo_error passo_driver_is_blind(struct passo *passo, bool *blind);
/* NO_SOURCE, ARGUMENT, or NO_SWITCH unless the source is configured. */
enum passo_error passo_driver_check_source(
    const struct passo *passo, enum passo_trigger_source source, uint8_t axis);
/* Starts a task at rest: with a trigger and a motion, or with the first motion of homing or goto. */
enum passo_error passo_driver_begin(struct passo *passo, struct passo_task task,
    const struct passo_trigger_config *trigger, const struct passo_move_by_speed *move);
/* Advances a task, after a poll with this result. */
enum passo_error passo_driver_task(struct passo *passo, enum passo_error error);
/* Starts the next motion of a task: PENDING, or an error. With a trigger, unless null, it ends at its edge;
 * SWITCH_LEVEL if the source already has the level. */
enum passo_error passo_driver_seek(
    struct passo *passo, const struct passo_trigger_config *trigger, const struct passo_move_by_speed *move);
/* The first motion of homing, and the following ones: PENDING, OK at the end, or an error. */
enum passo_error passo_driver_home_first(struct passo *passo);
enum passo_error passo_driver_home_next(struct passo *passo, const struct passo_trigger_report *report);
#ifndef PASSO_CARTESIAN
/* The same of an axis whose motors have a switch each; OK: it is homed. */
bool passo_driver_squares(const struct passo_home *home);
enum passo_error passo_driver_check_square(const struct passo *passo, const struct passo_home *home);
enum passo_error passo_driver_square_first(struct passo *passo);
enum passo_error passo_driver_square_next(struct passo *passo, const struct passo_trigger_report *report);
#endif
/* Changes the ramps of a running motion: attempts until one is in time.
 *
 *     while (error == LATE && passo_driver_steers(passo, &steering)) {
 *             passo_driver_sight() ... plan ... passo_driver_steer()
 *     }
 * `stop`: to rest; a slow host then gets more time, and after a link error a soft stop replaces it.
 */
struct passo_steering {
	bool stop;
	bool overdue;   /* the core has ramps planned for an earlier moment */
	unsigned tries; /* attempts so far */
	uint32_t since; /* microseconds: the first read */
	uint32_t late;  /* longest time from there until the core has the change, microseconds */
};
/* Bounds that hold until then. */
struct passo_sight {
	uint64_t low, high; /* bounds of the velocity, UQ0.48 */
	uint64_t way;       /* of a motion with a target: remaining steps, UQ48.16; 0: none */
};
bool passo_driver_steers(struct passo *passo, struct passo_steering *steering);
enum passo_error passo_driver_sight(
    struct passo *passo, struct passo_steering *steering, uint64_t acceleration, struct passo_sight *sight);
/* Sends the ramps: LATE if the time is exceeded, before or after. NOT_TURNING: the end is already in
 * progress. */
enum passo_error passo_driver_steer(
    struct passo *passo, struct passo_steering *steering, const struct passo_plan *plan);
/* The result of the attempts: a stop that was never in time becomes a soft stop. */
enum passo_error passo_driver_steered(
    struct passo *passo, const struct passo_steering *steering, enum passo_error error);
/* UQ32.32 steps/s of a velocity, rounded up. */
uint64_t passo_driver_speed_of(const struct passo *passo, uint64_t velocity);
/* A motion whose ramps can be changed has been queued; `aim` is null for one without a target. */
void passo_driver_turns(struct passo *passo, const struct passo_turning *turning, bool backward,
    const struct passo_plan *plan, const int32_t *aim);
/* The snapshot shows a stop: axes that may have lost steps in it are no longer homed. */
void passo_driver_forget_home(struct passo *passo);
/* The same before a clear, if the cause does not show it: three frames if an axis is homed, or in a task.
 * There LIMIT or ALARM, unless by the switch that is sought. */
enum passo_error passo_driver_check_home(struct passo *passo);
/* The same for all axes. */
void passo_driver_forget_all(struct passo *passo);

#endif
