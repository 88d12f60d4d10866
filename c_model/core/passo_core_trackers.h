/* SPDX-License-Identifier: MIT
 * State of the trackers of a channel. See rtl/passo_trackers.v.
 */
#ifndef PASSO_CORE_TRACKERS_H
#define PASSO_CORE_TRACKERS_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_command.h"

/* What the host has written, and what the unit takes of it once a turn. */
struct passo_tracker_settings {
	uint32_t target[2];           /* up, down: signed steps */
	uint32_t speed, acceleration; /* UQ0.32 steps per tick, per tick^2 */
};

struct passo_tracker_axis {
	struct passo_tracker_settings host;
	uint32_t target, speed, acceleration;
	uint64_t position; /* Q32.32, and half a step */
	uint64_t stopping; /* t, UQ32.32 */
	uint32_t velocity; /* v */
	uint32_t shown;    /* position that a read sees */
	bool enabled, negative, at_target;
	bool moves;     /* as others see it, one clock late */
	bool step_made; /* strobe */
};

/* How the steps of path and tracker of an axis meet. */
struct passo_tracker_join {
	int8_t owed;
	bool turned, went_down;
	bool ready; /* decided one clock ago */
};

/* What has been read and found in the turn of an axis. */
struct passo_tracker_turn {
	bool negative, target_down, brakes, rests, cleared, cleared_position;
	bool slow, slower, behind, near, close, there;
	uint32_t acceleration, reduction; /* of the speed: up, down */
};

struct passo_trackers {
	bool present; /* TRACKERS */
	struct passo_tracker_axis axis[PASSO_AXES_MAX];
	struct passo_tracker_join join[PASSO_AXES_MAX];
	uint8_t slot, turn; /* clock of a turn, and whose it is */
	bool odd;           /* tick */
	uint8_t clears; /* 0: v and t are used; 1: from the next tick on; 2: not before the one after an odd
	                   one */
	bool clears_position;
	bool step_down;
	bool busy;
	bool writes_enable, writes_setting; /* bus write strobes, one clock late */
	uint8_t written;                    /* address within the channel */
	bool hold, path_runs;               /* in the previous clock */
	struct passo_tracker_turn now;
};

struct passo_tracker_wires {
	bool halt, zero, brake, hold;
};

struct passo_tracker_join_wires {
	bool halt, made, made_down;
	bool path_step, path_down, path_moves;
	bool waits; /* a step waits in the axis */
};

struct passo_tracker_join_result {
	bool step_request, direction;
	bool against, joins; /* what is owed goes against the path; a step of it is made */
};

struct passo_tracker_join_result passo_tracker_join_wires(
    const struct passo_tracker_join *join, const struct passo_tracker_join_wires *wires);
void passo_tracker_join_clock(struct passo_tracker_join *join, const struct passo_tracker_join_wires *wires);

#endif
