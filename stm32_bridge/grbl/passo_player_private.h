/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the player.
 */
#ifndef PASSO_PLAYER_PRIVATE_H
#define PASSO_PLAYER_PRIVATE_H

#include "passo_player.h"

/* The time of an action passes at rest, unless held; `waits` until it is over. */
void passo_player_dwell(struct passo_player *player);
/* Drops the rest of the line: the program continues from where the path ends. */
void passo_player_drop(struct passo_player *player);
/* The level of an input of M66. */
enum passo_error passo_player_hear(const struct passo_player *player, uint8_t input, bool *level);
/* M66, at rest: its event once it is over; `waits` until then. */
enum passo_error passo_player_listen(struct passo_player *player, enum passo_player_event *event);
/* At rest. An event if there is no probe, or if it has its level already. */
enum passo_error passo_player_begin_probe(struct passo_player *player, enum passo_player_event *event);
/* The motion has ended. */
enum passo_error passo_player_end_probe(struct passo_player *player, enum passo_player_event *event);
#ifndef PASSO_WITHOUT_THREADS
/* At rest: the action is a thread. */
enum passo_error passo_player_begin_thread(struct passo_player *player);
/* Whether the action continues the thread that waits for its spindle; then it is part of that pass. */
bool passo_player_continues(struct passo_player *player);
/* Its part of a poll. Errors: those of passo_pass(); FOLLOW_SPEED if an axis cannot follow the spindle. */
enum passo_error passo_player_follow(struct passo_player *player);
#endif
/* Whether another line could continue the motion in step with the spindle. */
bool passo_player_collects(const struct passo_player *player);
/* Keeps what the line of G-code says of a line of the path. */
void passo_player_note(struct passo_player *player, uint32_t index);

#endif
