/* SPDX-License-Identifier: MIT
 * The host of a history through the driver: its actions, and its checks against the pins.
 */
#ifndef SOAK_BRIDGE_HOST_H
#define SOAK_BRIDGE_HOST_H

#include "bridge_wire.h"
#include "passo.h"

/* Clock of the core: a microsecond of the driver is one clock. */
#define CLOCK_HZ 1000000u
#define HOLD_MICROSECONDS 600u
#define STOP_MICROSECONDS 900u

struct bridge {
	struct wire wire;
	struct world *world;
	struct scenario_random *random;
	struct bridge_counts *counts;
	FILE *print;
	struct passo passo;
	struct passo_host host;
	struct passo_axis_config config[PASSO_AXES_MAX];
	size_t row; /* pin rows counted so far */
	int64_t made[PASSO_AXES_MAX], pulses[PASSO_AXES_MAX];
	int64_t wanted[PASSO_AXES_MAX], wanted_pulses[PASSO_AXES_MAX];
	bool disabled[PASSO_AXES_MAX];
	bool slow_turns; /* the DIR setup time exceeds some step periods */
};

/* Counts the edges of the pins up to now. */
void bridge_count_pins(struct bridge *bridge);
/* Takes the steps made so far as the expected ones. */
void bridge_agree(struct bridge *bridge);
void bridge_check_positions(struct bridge *bridge);

/* Prints the result of a call; bridge_must() fails the world unless it is OK. */
void bridge_note(struct bridge *bridge, const char *what, enum passo_error error);
void bridge_must(struct bridge *bridge, const char *what, enum passo_error error);

void bridge_poll(struct bridge *bridge, unsigned times);
struct passo_move_by_speed bridge_draw_move(struct bridge *bridge);
/* Adds the steps of an accepted move to the expected ones. */
void bridge_want(struct bridge *bridge, const struct passo_move_by_speed *move);
/* Queues a move; false if it was not accepted. */
bool bridge_move(struct bridge *bridge, enum passo_error *error);
/* Waits until all motions have ended, at the expected positions. */
void bridge_finish(struct bridge *bridge);
/* Checks that a commanded stop has taken effect or is in progress. */
void bridge_check_stopped(struct bridge *bridge, const char *what);
/* Recovers from STOPPED, or from an error, to rest. */
void bridge_recover(struct bridge *bridge);

/* Histories on a noisy link, and on one that dies. */
void bridge_play_noise(struct bridge *bridge);
void bridge_play_death(struct bridge *bridge);

#endif
