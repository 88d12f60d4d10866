/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the driver.
 */
#ifndef PASSO_DRIVER_H
#define PASSO_DRIVER_H

#include "passo.h"
#include "passo_words.h"

/* ARGUMENT for null, NOT_OPEN for a channel that is not open. */
enum passo_error passo_driver_check(const struct passo *passo);
/* The same, and ARGUMENT for an axis that the channel does not have. */
enum passo_error passo_driver_check_axis(const struct passo *passo, uint8_t axis);
/* Whether an error is a link error. */
bool passo_driver_is_wire(enum passo_error error);
/* Present time in microseconds; 0 without a clock. */
uint32_t passo_driver_now(const struct passo *passo);

/* Writes consecutive registers of the channel. */
enum passo_error passo_driver_write(
    struct passo *passo, uint16_t address, const uint32_t *words, size_t length);
enum passo_error passo_driver_command(struct passo *passo, struct passo_channel_command command);
/* The value of the RUN register for a gate, and the write of it; no frame if the gate is already set. */
uint32_t passo_driver_run(const struct passo *passo, enum passo_gate gate);
enum passo_error passo_driver_gate(struct passo *passo, enum passo_gate gate);

/* Reads the state into the snapshot; `once`: with a single try. */
enum passo_error passo_driver_look(struct passo *passo, bool once);
/* The same, repeated while only the pins are busy: with the last steps, or with the times that restart when
 * an axis is configured. */
enum passo_error passo_driver_look_at_rest(struct passo *passo);
/* Reads the positions of the core, without the offsets. */
enum passo_error passo_driver_positions(struct passo *passo, int32_t *positions, bool once);
/* A position of the core as the program counts it. */
int32_t passo_driver_offset(const struct passo *passo, unsigned axis, int32_t position);
/* Steps in units of a scale (UQ32.32), Q31.32, to nearest. PASSO_NO_UNITS if the scale is 0, or beyond 2^31.
 */
int64_t passo_driver_units(int32_t steps, uint64_t scale);
/* Whether nothing moves or is queued according to the snapshot. Its room is sampled some hundred clocks after
 * its state, so only a second consecutive read is conclusive. */
bool passo_driver_at_rest(const struct passo *passo);
/* Maps REFUSED + BUSY of a command that requires rest to MOVING; other errors are unchanged. */
enum passo_error passo_driver_moving(enum passo_error error);

/* Whether the channel is BROKEN or BROKEN_STOPPED; STOPPED or BROKEN_STOPPED; in continuous rotation or its
 * final deceleration. */
bool passo_driver_is_broken(const struct passo *passo);
bool passo_driver_is_stopped(const struct passo *passo);
bool passo_driver_is_turning(const struct passo *passo);
/* Adds STOPPED or BROKEN to the assumed state. */
void passo_driver_doubt(struct passo *passo, enum passo_belief worse);
/* The effect of a command is unknown: it may have queued something. */
void passo_driver_break(struct passo *passo);
/* Adds a line to the expected end positions. */
void passo_driver_expect(struct passo *passo, const struct passo_line *line);
/* All motions have ended, at these positions. */
void passo_driver_ended(struct passo *passo, const int32_t *positions);
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

/* Pushes the ramps of a plan; there must be room for them. */
enum passo_error passo_driver_push_ramps(struct passo *passo, const struct passo_plan *plan);
/* Whether all axes that a line moves are configured. */
bool passo_driver_pins_known(const struct passo *passo, const struct passo_line *line);

/* Whether the source may have items and there is enough room to justify a frame. */
bool passo_driver_wants_lines(const struct passo *passo);
bool passo_driver_wants_ramps(const struct passo *passo);
/* Retries a source that had no items. */
void passo_driver_ask_again(struct passo *passo);
/* Append items from the source to the payload, after its first *length words, as far as room and frame
 * allow. */
enum passo_error passo_driver_take_lines(struct passo *passo, size_t *length);
enum passo_error passo_driver_take_ramps(struct passo *passo, size_t *length);
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
/* NOT_STOPPED or NOT_HELD while a command is due. */
enum passo_error passo_driver_due(const struct passo *passo);
/* Sends the due command of highest priority: at most one chip select. PENDING until no command is due, or the
 * error of a frame after its last try. */
enum passo_error passo_driver_insist(struct passo *passo);
/* The same until no command of priority `least` or higher is due, or until an error ... */
enum passo_error passo_driver_insist_on(struct passo *passo, enum passo_post least);
/* ... which is then returned as NOT_STOPPED or NOT_HELD (or CORE_RESET). */
enum passo_error passo_driver_restrain(struct passo *passo, enum passo_post least);
/* Abandons this channel's posted frame, if there is one. */
void passo_driver_drop(struct passo *passo);

#endif
