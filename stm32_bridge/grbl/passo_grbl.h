/* SPDX-License-Identifier: MIT
 * The serial protocol of grbl 1.1: lines with their answers, real-time bytes, status reports.
 *
 *     passo_grbl_open(&grbl, &player, &sink, &setup);
 *     passo_grbl_receive(&grbl, byte); // each byte from the host, also from an interrupt
 *     passo_grbl_poll(&grbl);          // in the main loop; does not wait
 */
#ifndef PASSO_GRBL_H
#define PASSO_GRBL_H

#include "passo_gcode_line.h"
#include "passo_grbl_settings.h"
#include "passo_player.h"
#include "passo_storage.h"

/* Bytes from the host that wait, at most one less; senders that count characters need at least 128. */
#define PASSO_GRBL_RECEIVED 256u

/* Bytes of overrides that wait, at most. */
#define PASSO_GRBL_CHANGES 16u

/* Status reports from one with offsets to the next. */
#define PASSO_GRBL_REPORTS 30u

/* Where answers go. */
struct passo_grbl_sink {
	void (*write)(void *context, const char *text);
	void *context;
};

enum passo_grbl_alarm {
	PASSO_GRBL_NO_ALARM,
	PASSO_GRBL_HARD_LIMIT,
	PASSO_GRBL_SOFT_LIMIT,
	PASSO_GRBL_ABORTED,
	PASSO_GRBL_PROBE_LEVEL,
	PASSO_GRBL_PROBE_MISSED,
	PASSO_GRBL_HOME_RESET,
	PASSO_GRBL_HOME_DOOR,
	PASSO_GRBL_HOME_PULL_OFF,
	PASSO_GRBL_HOME_MISSED
};

/* The machine; must live as long as the console. Masks have a bit per axis. */
struct passo_grbl_setup {
	struct passo_path_settings path; /* but for what the settings say */
	struct passo_axis_config pins;   /* the same; in clocks, of all axes */
	struct passo_grbl_settings defaults;
	uint8_t limits_low, limits_high, homes; /* switches that are there */
	uint8_t homed; /* axes that have a home; without a home switch by their limits */
	bool probe;    /* it is there */
	const struct passo_storage_pages *pages; /* null: nothing outlasts the end of the program */
};

/* All members are private. */
struct passo_grbl {
	struct passo_player *player;
	struct passo_grbl_sink sink;
	const struct passo_grbl_setup *setup;
	struct passo_storage storage;
	struct passo_grbl_stored stored;
	struct passo_path_settings path; /* in force */
	struct passo_player_machine limits;
	struct passo_home home[PASSO_GCODE_AXES_MAX];
	struct passo_gcode_line line;
	char received[PASSO_GRBL_RECEIVED];
	volatile uint8_t head, tail; /* of the ring: next to be written, next to be read */
	volatile bool asks, pauses, opens, resumes, resets, cancels, lost;
	volatile uint8_t change[PASSO_GRBL_CHANGES]; /* bytes of overrides */
	volatile uint8_t changed;
	uint8_t heeded;
	uint8_t feed, rapid, spindle; /* overrides in percent */
	uint8_t reports;              /* until the next one with offsets */
	bool locked;                  /* since an alarm, or before the first home */
	uint8_t starts;               /* start lines that have been executed */
	bool held, jogs, checks, homes, door;
	bool keeps;            /* the offsets have changed and are not stored yet */
	bool stopping, greets; /* a soft stop is under way; the greeting follows it */
};

/* The player is open, its path and its interpreter with any settings: they get those stored. Writes the
 * greeting. */
void passo_grbl_open(struct passo_grbl *grbl, struct passo_player *player, const struct passo_grbl_sink *sink,
    const struct passo_grbl_setup *setup);
void passo_grbl_receive(struct passo_grbl *grbl, char byte);
void passo_grbl_poll(struct passo_grbl *grbl);

/* Nothing moves or waits. */
bool passo_grbl_is_idle(const struct passo_grbl *grbl);

#endif
