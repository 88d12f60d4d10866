/* SPDX-License-Identifier: MIT
 * What the sources of the driver share. Not for its users.
 */
#ifndef PASSO_DRIVER_H
#define PASSO_DRIVER_H

#include "passo.h"
#include "passo_words.h"

/* ARGUMENT or NOT_OPEN if there is no driver to speak of. */
enum passo_error passo_driver_check(const struct passo *passo);
bool passo_driver_is_wire(enum passo_error error);
/* 0 without a clock. */
uint32_t passo_driver_now(const struct passo *passo);

/* Writes consecutive registers of the channel. */
enum passo_error passo_driver_write(
    struct passo *passo, uint16_t address, const uint32_t *words, size_t length);
enum passo_error passo_driver_command(struct passo *passo, struct passo_channel_command command);
/* Lets motions start, or not: the word for the RUN register. No frame if it is so already. */
uint32_t passo_driver_run(const struct passo *passo, enum passo_gate gate);
enum passo_error passo_driver_gate(struct passo *passo, enum passo_gate gate);

/* Reads the state into the snapshot: `once` with a single try. */
enum passo_error passo_driver_look(struct passo *passo, bool once);
/* The same, and while nothing but the pins is busy, again: with the last steps, or with the times that begin
 * anew when an axis is configured. */
enum passo_error passo_driver_look_at_rest(struct passo *passo);
enum passo_error passo_driver_positions(struct passo *passo, int32_t *positions, bool once);
/* As the snapshot says: nothing moves and nothing waits. Its room is some hundred clocks younger than its
 * state: only the second look in a row is sure. */
bool passo_driver_at_rest(const struct passo *passo);
/* What is only possible at rest was refused because it is not: MOVING. */
enum passo_error passo_driver_moving(enum passo_error error);

/* It is BROKEN or BROKEN_STOPPED; it is STOPPED or BROKEN_STOPPED; it turns, or its turning ends. */
bool passo_driver_is_broken(const struct passo *passo);
bool passo_driver_is_stopped(const struct passo *passo);
bool passo_driver_is_turning(const struct passo *passo);
/* It is STOPPED, or BROKEN, beside what was believed so far. */
void passo_driver_doubt(struct passo *passo, enum passo_belief worse);
/* What a command has done is not known: it may be that something was queued. */
void passo_driver_break(struct passo *passo);
/* One more line will be made: where the motion ends. */
void passo_driver_expect(struct passo *passo, const struct passo_line *line);
/* Everything has ended, here: nothing is expected any more. */
void passo_driver_ended(struct passo *passo, const int32_t *positions);
/* Flushes the queues of a channel that does not move, clears it, and reads the positions. The snapshot must
 * be fresh and the gate closed if something waits. */
enum passo_error passo_driver_take_over(struct passo *passo);
/* Looks, and tells why a new motion cannot start, `needs_rest` first. */
enum passo_error passo_driver_ready(struct passo *passo, bool needs_rest);

/* Makes sure that the core holds the tables that a plan needs; they are loaded at rest only. */
enum passo_error passo_driver_tables(
    struct passo *passo, const struct passo_plan *plan, const struct passo_user_shape *shape);
/* All banks are as after reset. */
void passo_driver_tables_fresh(struct passo_host *host);

/* Pushes the ramps of a plan, for which there is room. */
enum passo_error passo_driver_push_ramps(struct passo *passo, const struct passo_plan *plan);
/* The axes that a line moves are configured. */
bool passo_driver_pins_known(const struct passo *passo, const struct passo_line *line);

/* The source may have something, and there is room that is worth a frame. */
bool passo_driver_wants_lines(const struct passo *passo);
bool passo_driver_wants_ramps(const struct passo *passo);
/* Asks a source again that had nothing. */
void passo_driver_ask_again(struct passo *passo);
/* Puts as many as there are, are wanted and have room behind `length` words of the payload. */
enum passo_error passo_driver_take_lines(struct passo *passo, size_t *length);
enum passo_error passo_driver_take_ramps(struct passo *passo, size_t *length);
/* The stream's share of a poll: at most one frame. *sent: there was one. */
enum passo_error passo_driver_feed(struct passo *passo, bool *sent);
/* Takes over what became of the stream's posted frame. */
enum passo_error passo_driver_settle_stream(struct passo *passo);
void passo_driver_end_stream(struct passo *passo);
/* Microseconds between two looks. */
uint32_t passo_driver_interval(const struct passo *passo);

/* The rate that is wanted, UQ1.16. */
uint32_t passo_driver_rate(const struct passo *passo);
/* A stop (or abort) is due; a stream ends. */
void passo_driver_halt(struct passo *passo, enum passo_due due);
/* NOT_STOPPED or NOT_HELD while something is due. */
enum passo_error passo_driver_due(const struct passo *passo);
/* Sends what is due, the most urgent first: at most one chip select. PENDING until nothing is due any more;
 * or the error of a frame after its last try. */
enum passo_error passo_driver_insist(struct passo *passo);
/* The same until nothing is due that is as urgent as `least`, or until an error ... */
enum passo_error passo_driver_insist_on(struct passo *passo, enum passo_post least);
/* ... which is then told as NOT_STOPPED or NOT_HELD (or CORE_RESET). */
enum passo_error passo_driver_restrain(struct passo *passo, enum passo_post least);
/* Gives up this channel's posted frame, if there is one. */
void passo_driver_drop(struct passo *passo);

#endif
