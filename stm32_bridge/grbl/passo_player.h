/* SPDX-License-Identifier: MIT
 * Plays the actions of the G-code interpreter (gcode/passo_gcode.h) on a path that is fed to the core.
 *
 *     passo_player_open(&player, &gcode, &feed, &settings);
 *     for (;;) {
 *             if (passo_player_is_ready(&player) && there is a line)
 *                     answer = passo_gcode_execute(&gcode, line);
 *             error = passo_player_poll(&player, &event); // instead of passo_path_feed_poll()
 *     }
 * No call waits.
 */
#ifndef PASSO_PLAYER_H
#define PASSO_PLAYER_H

#include "passo_gcode.h"
#include "passo_home.h"
#include "passo_path_feed.h"

enum passo_player_event {
	PASSO_PLAYER_NOTHING,
	PASSO_PLAYER_OFFSETS, /* struct passo_gcode_offsets is to be stored */
	PASSO_PLAYER_PAUSED,  /* M0: at rest until passo_player_go_on() */
	PASSO_PLAYER_ENDED,   /* M2, M30: all lines have been taken */
	PASSO_PLAYER_TRAVEL,  /* a target outside of the travel; it and what follows in its line is dropped */
	PASSO_PLAYER_PROBED,  /* the probe has acted, or was optional: passo_player.touch, touched */
	PASSO_PLAYER_NO_PROBE,  /* no probe is fitted */
	PASSO_PLAYER_UNTOUCHED, /* the probe has not acted */
	PASSO_PLAYER_UNEXPECTED /* it had acted before */
};

/* Of the machine; must live as long as the player. */
struct passo_player_machine {
	const struct passo_path_axis *axis; /* as given to passo_path_open() */
	bool limited;                       /* targets must be within low .. high, machine coordinates */
	passo_gcode_position low, high;
};

/* All members but those of the probe are private. */
struct passo_player {
	struct passo_gcode *gcode;
	struct passo_path_feed *feed;
	const struct passo_player_machine *machine;
	struct passo_gcode_action action;
	bool waits;  /* the action has not been taken yet */
	bool probes; /* a probe is under way */
	bool paused;
	uint32_t chords; /* taken since passo_player_open() */
	bool touched;
	passo_gcode_position touch; /* machine coordinates */
};

void passo_player_open(struct passo_player *player, struct passo_gcode *gcode, struct passo_path_feed *feed,
    const struct passo_player_machine *machine);

/* Whether another line can be executed. */
bool passo_player_is_ready(const struct passo_player *player);
/* Whether nothing moves, and nothing is left to be done. */
bool passo_player_is_idle(const struct passo_player *player);

/* Takes what there is room for, and polls the driver. Errors: those of passo_path_feed_poll(), passo_probe(),
 * and PASSO_ERROR_PLAN + those of passo_path_add(); its line is dropped then. */
enum passo_error passo_player_poll(struct passo_player *player, enum passo_player_event *event);

/* Whether a target is within the travel of all axes. */
bool passo_player_allows(const struct passo_player *player, const int64_t *target);

void passo_player_go_on(struct passo_player *player);

/* After a stop and passo_clear(), or after homing: drops all that is left, and begins at the present position
 * of the core. One frame. Errors: those of passo_positions(). */
enum passo_error passo_player_restart(struct passo_player *player);

/* Nanometres of a number of steps, to the nearest. */
int64_t passo_player_nanometres(const struct passo_player *player, unsigned axis, int32_t steps);

#endif
