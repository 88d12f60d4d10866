/* SPDX-License-Identifier: MIT
 * Executes a G-code program line by line without a sender: from a file, or a memory card.
 *
 *     passo_program_open(&program, &passo, &settings, items, 48); // passo: open, its axes configured
 *     while (!passo_program_is_done(&program)) {
 *             if (passo_program_is_ready(&program)) {
 *                     if (there is a line)
 *                             answer = passo_program_line(&program, text, length);
 *                     else
 *                             passo_program_end(&program);
 *             }
 *             error = passo_program_poll(&program); // instead of passo_poll()
 *     }
 * M0 does not wait. There are no travel limits. No call blocks.
 */
#ifndef PASSO_PROGRAM_H
#define PASSO_PROGRAM_H

#include "passo_gcode_line.h"
#include "passo_player.h"

struct passo_program_settings {
	struct passo_path_settings path;
	struct passo_gcode_settings gcode;
	const uint16_t
	    *inputs;      /* of a simulation, see struct passo_player_machine; NULL: those of the core */
	uint32_t spin_up; /* see there; so is the next one */
	uint8_t at_speed;
};

/* All members but player.chords and `slow` are private. */
struct passo_program {
	struct passo_path_planner path;
	struct passo_path_feed feed;
	struct passo_gcode gcode;
	struct passo_path_axis axis[PASSO_AXES_MAX];
	struct passo_player_machine machine;
	struct passo_player player;
	bool ends; /* no more lines */
	bool slow; /* the spindle was not at its speed in time: the rest of a line was dropped */
};

/* `items` and `capacity`: the look-ahead, see passo_path_open(). The settings are copied. Errors:
 * PINS_TOO_SLOW: the speed limit of a motor exceeds passo_highest_speed(); PASSO_ERROR_PLAN + those of
 * passo_path_open(). */
enum passo_error passo_program_open(struct passo_program *program, struct passo *passo,
    const struct passo_program_settings *settings, struct passo_path_item *items, uint32_t capacity);

/* Whether another line can be executed. */
bool passo_program_is_ready(const struct passo_program *program);

/* Executes a line, with or without its end, when ready; an error changes nothing. A text has the lines of
 * passo_gcode_line_count(). */
enum passo_gcode_error passo_program_line(struct passo_program *program, const char *text, size_t length);

/* No more lines: the path ends with the last one. */
void passo_program_end(struct passo_program *program);

/* Accepts as many actions as fit, and polls the driver. Errors: those of passo_player_poll(). */
enum passo_error passo_program_poll(struct passo_program *program);

/* Whether the program and all its motions have ended. */
bool passo_program_is_done(const struct passo_program *program);

#endif
