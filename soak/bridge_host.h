/* SPDX-License-Identifier: MIT
 * What the host of a history does with the driver, and what it compares with the pins.
 */
#ifndef SOAK_BRIDGE_HOST_H
#define SOAK_BRIDGE_HOST_H

#include "bridge_wire.h"
#include "passo.h"

/* Of the core, so that a microsecond of the driver is one clock. */
#define CLOCK_HZ 1000000u
#define HOLD_MICROSECONDS 600u
#define STOP_MICROSECONDS 900u

struct bridge {
	struct wire wire;
	struct world *world;
	struct plot_random *random;
	struct bridge_counts *counts;
	FILE *print;
	struct passo passo;
	struct passo_host host;
	struct passo_axis_config config[PASSO_AXES_MAX];
	size_t row; /* of the pins, counted so far */
	int64_t made[PASSO_AXES_MAX], pulses[PASSO_AXES_MAX];
	int64_t wanted[PASSO_AXES_MAX], wanted_pulses[PASSO_AXES_MAX];
	bool disabled[PASSO_AXES_MAX];
	bool slow_turns; /* DIR set-up lasts longer than some steps */
};

/* Counts the edges of the pins up to now. */
void bridge_count_pins(struct bridge *bridge);
/* From here on: what left the pins so far is what is wanted. */
void bridge_agree(struct bridge *bridge);
void bridge_check_positions(struct bridge *bridge);

/* Prints what a call returned; the second fails the world unless it was OK. */
void bridge_note(struct bridge *bridge, const char *what, enum passo_error error);
void bridge_must(struct bridge *bridge, const char *what, enum passo_error error);

void bridge_poll(struct bridge *bridge, unsigned times);
struct passo_move_by_speed bridge_draw_move(struct bridge *bridge);
/* The steps of a move that was taken are wanted. */
void bridge_want(struct bridge *bridge, const struct passo_move_by_speed *move);
/* Queues a move; false if it was not taken, for whatever reason. */
bool bridge_move(struct bridge *bridge, enum passo_error *error);
/* Everything that was queued ends, at what is wanted. */
void bridge_finish(struct bridge *bridge);
/* A stop that the driver was told of has taken place, or still does. */
void bridge_check_stopped(struct bridge *bridge, const char *what);
/* From STOPPED, or from whatever is left after an error, to rest. */
void bridge_recover(struct bridge *bridge);

/* Histories on a noisy wire, and on one that dies. */
void bridge_play_noise(struct bridge *bridge);
void bridge_play_death(struct bridge *bridge);

#endif
