/* SPDX-License-Identifier: MIT
 * Executes the actions of the G-code interpreter (c_model/gcode/passo_gcode.h) on a path that is fed to the
 * core.
 *
 *     passo_player_open(&player, &gcode, &feed, &settings);
 *     for (;;) {
 *             if (passo_player_is_ready(&player) && there is a line)
 *                     answer = passo_gcode_execute(&gcode, line);
 *             error = passo_player_poll(&player, &event); // instead of passo_path_feed_poll()
 *     }
 * No call blocks.
 *
 * A line is accepted when its actions are done or on the path; a dwell, a probe, a pause and the end of the
 * program wait for the preceding motion to end. At rest the core's digital outputs are those of the program.
 * Dwells between lines are ramps of the core, unless a sender must be answered when they are over.
 */
#ifndef PASSO_PLAYER_H
#define PASSO_PLAYER_H

#include "passo_encoder.h"
#include "passo_gcode.h"
#include "passo_home.h"
#include "passo_path_feed.h"

enum passo_player_event {
	PASSO_PLAYER_NOTHING,
	PASSO_PLAYER_OFFSETS,   /* struct passo_gcode_offsets must be stored */
	PASSO_PLAYER_PAUSED,    /* M0: at rest until passo_player_go_on() */
	PASSO_PLAYER_TOOL,      /* M6: the same, for tool passo_player.loads */
	PASSO_PLAYER_INPUT,     /* M66 is over: passo_player.input is the level, or -1: not what was wanted */
	PASSO_PLAYER_ENDED,     /* M2, M30: at rest */
	PASSO_PLAYER_TRAVEL,    /* a target outside the travel; the rest of its line is dropped */
	PASSO_PLAYER_PROBED,    /* the probe triggered, or was optional: passo_player.touch, touched */
	PASSO_PLAYER_NO_PROBE,  /* no probe is fitted */
	PASSO_PLAYER_UNTOUCHED, /* the probe did not trigger */
	PASSO_PLAYER_UNEXPECTED, /* it had already triggered */
	PASSO_PLAYER_SLOW /* the spindle is not at its speed in time; the rest of the line is dropped */
};

/* Machine description; must outlive the player. */
struct passo_player_machine {
	const struct passo_path_axis *axis; /* as passed to passo_path_open() */
	bool limited;                       /* targets must be within low .. high, machine coordinates */
	uint8_t at_speed; /* input of M66 that says that the spindle is at its speed; 0: none */
	passo_gcode_position low, high;
	uint32_t spin_up; /* us that a motion waits for the spindle, at most if it has an input; 0: none */
	const uint16_t *inputs; /* levels that M66 reads, P0 is bit 0; NULL: those of the core */
#ifndef PASSO_WITHOUT_THREADS
	uint8_t
	    spindle;    /* motor whose encoder inputs the spindle has; see passo_gcode_settings.turn_counts */
	bool rehearses; /* no spindle: threads are lines at the feed of its speed */
	uint64_t deviation; /* UQ32.32 mm: by which an axis may be off where lines of a thread meet */
#endif
};

/* Number of recent lines of the path whose numbers are kept. */
#ifndef PASSO_PLAYER_LINES
#define PASSO_PLAYER_LINES 512u
#endif
/* The same for rapids: more than core and look-ahead can hold. */
#define PASSO_PLAYER_WINDOW 512u

#define PASSO_PLAYER_UNSURE 0x100u

/* The line that is moving, or will move when the look-ahead starts. */
enum passo_player_motion { PASSO_PLAYER_AT_REST, PASSO_PLAYER_FEED, PASSO_PLAYER_RAPID, PASSO_PLAYER_SEEK };

/* Properties that a line of G-code passes on to its lines of the path. */
struct passo_player_line {
	uint32_t number; /* N; 0: none */
	uint32_t output;
};

#ifndef PASSO_WITHOUT_THREADS
enum passo_player_step {
	PASSO_PLAYER_FREE,
	PASSO_PLAYER_SET,  /* the encoder is to be configured */
	PASSO_PLAYER_SPIN, /* the spindle comes up to speed; lines that continue the thread are taken */
	PASSO_PLAYER_PASS,
	PASSO_PLAYER_PAST, /* behind the target of a rigid one, the spindle reverses */
	PASSO_PLAYER_STOP, /* counts came back */
	PASSO_PLAYER_TURN, /* to where the line is at the present count, by the clock */
	PASSO_PLAYER_BACK
};

/* A pass in step with the spindle. */
struct passo_player_thread {
	enum passo_player_step step;
	bool rigid;
	uint32_t line;      /* N of its last line */
	uint32_t output;    /* word of its lines */
	uint64_t speed;     /* counts/s that the program asks for, UQ32.32; this and the following too */
	uint64_t top_speed; /* that the axes can follow */
	uint64_t corner_speed[PASSO_PASS_LINES_MAX - 1u]; /* the same where each line meets the next */
	uint32_t run;                                     /* counts in which they come to rest */
	int32_t way[PASSO_AXES_MAX];                      /* steps of the axes in the last line */
	int32_t from[PASSO_AXES_MAX];                     /* where it begins, in steps of the motors */
	passo_gcode_position end;                         /* of the last line */
	struct passo_pass pass;
	struct passo_encoder_reading reading;
	int32_t began; /* count at which a rigid one began */
	int32_t left;  /* counts from there to where it turned */
};
#endif

/* Members up to `held` may be set by the caller; those of the probe may be read. All others are private.
 */
struct passo_player {
	bool answers; /* dwells wait for the motion, and end before the line is accepted */
	bool checks;  /* check mode: lines are not executed; targets outside the travel are reported */
	bool held;    /* dwells wait */
	struct passo_gcode *gcode;
	struct passo_path_feed *feed;
	const struct passo_player_machine *machine;
	struct passo_gcode_action action;
	bool waits;  /* the action has not been accepted yet */
	bool probes; /* probing in progress */
	bool paused;
	bool changes;    /* a tool is being changed: spindle and coolant are off */
	uint8_t loads;   /* that tool */
	uint16_t levels; /* of the core after the lines of the path; PASSO_PLAYER_UNSURE: or others */
	bool restores;   /* they are to be those of the program again */
	bool spins;      /* the spindle comes up to speed */
	uint32_t spins_at;
	bool listened; /* M66 has read its input */
	int8_t input;  /* that level */
	bool dwells;
	uint64_t dwell;     /* remaining microseconds */
	uint32_t dwells_at; /* time of that value */
	uint32_t chords;    /* taken since passo_player_open() */
	uint32_t
	    number[PASSO_PLAYER_LINES]; /* of the lines of the path: N, and the upper half of the output */
	uint16_t power[PASSO_PLAYER_LINES]; /* the lower half */
	uint8_t rapid[PASSO_PLAYER_WINDOW / 8u];
	uint64_t probe_scale; /* steps of the dominant axis per mm, UQ32.32 */
	bool touched;
	passo_gcode_position touch; /* machine coordinates */
#ifndef PASSO_WITHOUT_THREADS
	struct passo_player_thread thread;
	uint32_t threads; /* made since passo_player_open() */
#endif
};

void passo_player_open(struct passo_player *player, struct passo_gcode *gcode, struct passo_path_feed *feed,
    const struct passo_player_machine *machine);

/* Whether the last line has been accepted. */
bool passo_player_has_taken(const struct passo_player *player);
/* Whether another line can be executed. */
bool passo_player_is_ready(const struct passo_player *player);
/* Whether nothing moves and nothing is pending. */
bool passo_player_is_idle(const struct passo_player *player);

/* Whether a motion is in step with the spindle, or waits for it. */
bool passo_player_follows(const struct passo_player *player);

/* Accepts as many actions as fit, and polls the driver. Errors: those of passo_path_feed_poll(),
 * passo_probe(), and PASSO_ERROR_PLAN + those of passo_path_add(); the line is then dropped. */
enum passo_error passo_player_poll(struct passo_player *player, enum passo_player_event *event);

/* Whether a target is within the travel of all axes. */
bool passo_player_allows(const struct passo_player *player, const int64_t *target);

/* After a pause, or when the tool is changed. */
void passo_player_go_on(struct passo_player *player);
/* While a tool is being changed: lines are executed, without spindle and coolant. */
void passo_player_admit(struct passo_player *player);
/* A reset: the tool is not changed. */
void passo_player_give_up(struct passo_player *player);
/* An action that is of no line; when ready. */
void passo_player_take(struct passo_player *player, const struct passo_gcode_action *action);

/* Of the line that is moving; false: none is, or its number is no longer kept. */
bool passo_player_moving_line(const struct passo_player *player, struct passo_player_line *line);
enum passo_player_motion passo_player_motion(const struct passo_player *player);
/* Current speed along the path, mm/min, UQ48.16. */
uint64_t passo_player_speed(const struct passo_player *player);

/* After a stop and passo_clear(), or after homing: drops the rest and restarts at the current position of the
 * core. One frame. Errors: those of passo_positions(). */
enum passo_error passo_player_restart(struct passo_player *player);

/* Nanometers, to nearest, of steps at a scale in steps per mm, UQ32.32. */
int64_t passo_player_length(int64_t steps, uint64_t scale);
/* Places of the axes, in nanometers to nearest, of positions of the motors in steps. */
void passo_player_place(const struct passo_player *player, const int32_t *motors, passo_gcode_position place);

#endif
