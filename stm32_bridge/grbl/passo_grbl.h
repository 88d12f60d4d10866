/* SPDX-License-Identifier: MIT
 * The grbl 1.1 serial protocol: lines and their responses, real-time bytes, status reports.
 *
 *     passo_grbl_open(&grbl, &player, &sink, &setup);
 *     passo_grbl_receive(&grbl, byte); // each byte from the host, also from an interrupt
 *     passo_grbl_poll(&grbl);          // in the main loop; does not block
 */
#ifndef PASSO_GRBL_H
#define PASSO_GRBL_H

#include "passo_gcode_line.h"
#include "passo_grbl_settings.h"
#include "passo_grbl_state.h"
#include "passo_player.h"
#include "passo_storage.h"

/* Size of the receive buffer, one more than it holds; character counting needs at least 128. */
#define PASSO_GRBL_RECEIVED 256u

/* Largest room that is reported, as by grbl: a sender may miscount by a line or two (cncjs, at each pause).
 */
#define PASSO_GRBL_TOLD_ROOM 128u

/* Interval of offsets (WCO) in status reports. */
#define PASSO_GRBL_REPORTS 30u

/* Destination of responses. */
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
	PASSO_GRBL_HOME_MISSED,
	PASSO_GRBL_SPINDLE_SLOW = 14 /* as in grblHAL: it is not at its speed in time */
};

/* Machine description; must outlive the console. Masks have a bit per axis. */
struct passo_grbl_setup {
	struct passo_path_settings path; /* defaults where a setting exists */
	void (*defaults)(struct passo_grbl_settings *settings);
	uint8_t limits_low, limits_high, homes; /* fitted switches */
	uint8_t homed; /* axes that home; without a home switch on their limit switch */
#ifndef PASSO_CARTESIAN
	uint8_t squared;  /* of these, axes each of whose motors has its own limit switch at that end */
	uint32_t racking; /* um: see passo_home.h */
	/* Two of each motor: counts of its encoder per mm, UQ32.32 (0: it has none), and those of following
	 * error that stop the machine; null: there is no encoder. */
	const uint64_t *encoders;
#endif
#ifndef PASSO_WITHOUT_THREADS
	uint16_t turn_counts; /* of the encoder of the spindle, at the inputs behind the motors; 0: none */
#endif
#ifndef PASSO_PLAIN_GCODE
	uint8_t at_speed; /* see struct passo_player_machine */
#endif
	bool probe;                              /* a probe is fitted */
	const struct passo_storage_pages *pages; /* null: no persistent storage */
	/* Takes the text of a `$` line that is the board's own, at rest; null: it has none. */
	bool (*take_line)(const char *text);
};

/* Messages of the program that wait for the motion before them. */
#define PASSO_GRBL_MESSAGES 2u

/* All members are private. */
struct passo_grbl {
	struct passo_player *player;
	struct passo_grbl_sink sink;
	const struct passo_grbl_setup *setup;
	struct passo_storage storage;
	struct passo_grbl_stored stored;
	struct passo_path_settings path; /* active */
	struct passo_player_machine limits;
	struct passo_home home[PASSO_GCODE_AXES_MAX];
#ifndef PASSO_CARTESIAN
	int32_t offset[PASSO_AXES_MAX]; /* of motors, in steps */
#endif
	struct passo_gcode_line line;
	/* written by passo_grbl_receive(), also in an interrupt */
	char received[PASSO_GRBL_RECEIVED];
	volatile uint8_t head, tail; /* of the ring: next to be written, next to be read */
	volatile bool asked[PASSO_GRBL_ASKS];
	volatile uint8_t mark;                 /* `head` at the last jog cancel */
	volatile bool full;                    /* overflow: bytes are lost until the buffer has been read */
	volatile bool lost_part;               /* the lost bytes do not end with a line */
	volatile uint16_t lost_lines;          /* lost line ends; wraps */
	volatile uint8_t feed, rapid, spindle; /* overrides in percent */
	/* the line being received */
	uint16_t found_lines; /* of lost_lines */
	uint8_t late;         /* bytes received before a jog cancel */
	bool begun, dropped;  /* it has a byte; its first one is one of these */
	/* the state */
	uint8_t feed_now, rapid_now, spindle_now; /* active overrides */
	uint8_t rate;                             /* of the core, percent */
	uint8_t reports;                          /* until the next one with offsets */
	uint8_t starts;                           /* executed startup lines */
	uint8_t accessories;                      /* last reported */
	bool locked;                              /* after an alarm, or before homing */
	bool held, jogs, checks, homes, door, sleeps;
	bool owes;             /* the response to the last line is pending */
	bool keeps;            /* changed offsets are not stored yet */
	bool stopping, greets; /* soft stop in progress; greeting afterwards */
	bool driven;           /* drives are enabled */
	uint32_t moved_at;     /* time of the last motion */
#ifndef PASSO_PLAIN_GCODE
	uint8_t loaded;                  /* the tool before check mode */
	uint8_t touch;                   /* step of `$TPW`; 0: none */
	bool measured;                   /* there is a reference of tool lengths */
	volatile bool admits;            /* other lines than those of the program are taken */
	volatile bool rejoins;           /* those are over: the next byte follows the program's */
	volatile uint8_t program, typed; /* of the ring: lines of the program, and behind them those others */
	int64_t reference;               /* nm */
	struct {
		char text[PASSO_GCODE_MESSAGE_SIZE];
		uint32_t before; /* this line of the path */
	} message[PASSO_GRBL_MESSAGES];
	uint8_t messages; /* that are to be said */
#endif
};

/* The player must be open, its path and interpreter with any settings: the stored ones are applied. Prints
 * the greeting. */
void passo_grbl_open(struct passo_grbl *grbl, struct passo_player *player, const struct passo_grbl_sink *sink,
    const struct passo_grbl_setup *setup);
void passo_grbl_receive(struct passo_grbl *grbl, char byte);
void passo_grbl_poll(struct passo_grbl *grbl);

/* Nothing moves or is pending. */
bool passo_grbl_is_idle(const struct passo_grbl *grbl);

#endif
