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
#include "passo_grbl_state.h"
#include "passo_player.h"
#include "passo_storage.h"

/* Bytes from the host that wait, at most one less; senders that count characters need at least 128. */
#define PASSO_GRBL_RECEIVED 256u

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
	void (*defaults)(struct passo_grbl_settings *settings);
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
	/* written by passo_grbl_receive(), also in an interrupt */
	char received[PASSO_GRBL_RECEIVED];
	volatile uint8_t head, tail; /* of the ring: next to be written, next to be read */
	volatile bool asked[PASSO_GRBL_ASKS];
	volatile uint8_t mark;                 /* `head` at the last request that cancels a jog */
	volatile bool full;                    /* all is lost until what is there has been read */
	volatile bool lost_part;               /* the end of what was lost is not that of a line */
	volatile uint16_t lost_lines;          /* ends of lines that were lost; wraps */
	volatile uint8_t feed, rapid, spindle; /* overrides in percent */
	/* the line that comes in */
	uint16_t found_lines; /* of lost_lines */
	uint8_t late;         /* bytes received before a jog was cancelled */
	bool begun, dropped;  /* it has a byte; its first one is one of these */
	/* the state */
	uint8_t feed_now, rapid_now, spindle_now; /* overrides in force */
	uint8_t rate;                             /* of the core, percent */
	uint8_t reports;                          /* until the next one with offsets */
	uint8_t starts;                           /* start lines that have been executed */
	uint8_t accessories;                      /* those told last */
	bool locked;                              /* since an alarm, or before the first home */
	bool held, jogs, checks, homes, door, sleeps;
	bool owes;             /* the answer to the last line */
	bool keeps;            /* the offsets have changed and are not stored yet */
	bool stopping, greets; /* a soft stop is under way; the greeting follows it */
	bool driven;           /* drives are on */
	uint32_t moved_at;     /* the time when something moved last */
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
