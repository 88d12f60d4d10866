/* SPDX-License-Identifier: MIT
 * The grbl settings `$n=`, in grbl's units, and the other persistent data.
 */
#ifndef PASSO_GRBL_SETTINGS_H
#define PASSO_GRBL_SETTINGS_H

#include "passo_gcode.h"

/* Longest startup line, with its terminator. */
#define PASSO_GRBL_START_SIZE 80u
#define PASSO_GRBL_STARTS 2u

enum passo_grbl_setting {
	PASSO_GRBL_PULSE,            /* $0: us that STEP is active, and inactive, at least */
	PASSO_GRBL_IDLE_DELAY,       /* $1: ms until idle drives are disabled; 255: never */
	PASSO_GRBL_STEPS_INVERTED,   /* $2: a bit per axis */
	PASSO_GRBL_DIRS_INVERTED,    /* $3 */
	PASSO_GRBL_ENABLES_INVERTED, /* $4: all axes */
	PASSO_GRBL_LIMITS_INVERTED,  /* $5: limit and home switches of all axes */
	PASSO_GRBL_PROBE_INVERTED,   /* $6 */
	PASSO_GRBL_REPORT,           /* $10: a bit for MPos, WPos without; a bit for Bf */
	PASSO_GRBL_DEVIATION,        /* $11: junction deviation, mm */
	PASSO_GRBL_ARC_TOLERANCE,    /* $12: mm */
	PASSO_GRBL_INCHES,           /* $13: reports in inches */
	PASSO_GRBL_SOFT_LIMITS,      /* $20 */
	PASSO_GRBL_HARD_LIMITS,      /* $21 */
	PASSO_GRBL_HOMING,           /* $22 */
	PASSO_GRBL_HOMES_LOW,        /* $23: a bit per axis whose switch is at its low end */
	PASSO_GRBL_HOME_FEED,        /* $24: mm/min */
	PASSO_GRBL_HOME_SEEK,        /* $25: mm/min */
	PASSO_GRBL_DEBOUNCE,         /* $26: ms */
	PASSO_GRBL_PULL_OFF,         /* $27: mm */
	PASSO_GRBL_TURN,             /* $29: us from DIR to STEP, and from the end of STEP to DIR */
	PASSO_GRBL_SPINDLE,          /* $30: rpm of full power */
	PASSO_GRBL_SPINDLE_LEAST,    /* $31: rpm, minimum of a running spindle */
	PASSO_GRBL_LASER,            /* $32 */
#ifndef PASSO_PLAIN_GCODE
	PASSO_GRBL_TOUCH_DISTANCE, /* $342: of $TPW, mm */
	PASSO_GRBL_TOUCH_FEED,     /* $343: mm/min, as the next two */
	PASSO_GRBL_TOUCH_SEEK,     /* $344 */
	PASSO_GRBL_TOUCH_PULL_OFF, /* $345 */
	PASSO_GRBL_SPIN_UP,        /* $394: s until the spindle is at its speed */
#endif
	PASSO_GRBL_SETTINGS
};

enum passo_grbl_axis_setting {
	PASSO_GRBL_STEPS,        /* $100: per mm */
	PASSO_GRBL_SPEED,        /* $110: mm/min */
	PASSO_GRBL_ACCELERATION, /* $120: mm/s^2 */
	PASSO_GRBL_TRAVEL,       /* $130: mm */
#ifndef PASSO_WITHOUT_TRACKERS
	PASSO_GRBL_BACKLASH, /* $160: mm */
	PASSO_GRBL_TAKE_UP,  /* $810: mm/s^2 by which it is taken up; 0: $120 */
#endif
#ifndef PASSO_LINEAR_PATHS
	PASSO_GRBL_JERK, /* $800: mm/s^3; profile jerk if no axis has 0, else not */
#endif
#ifndef PASSO_CARTESIAN
	PASSO_GRBL_OFFSET, /* $170, of motors that square: mm, the edge from that of the axis; signed */
#endif
	PASSO_GRBL_AXIS_SETTINGS
};

/* In millionths. */
struct passo_grbl_settings {
	int64_t value[PASSO_GRBL_SETTINGS];
	int64_t axis[PASSO_GRBL_AXIS_SETTINGS][PASSO_GCODE_AXES_MAX];
};

struct passo_grbl_stored {
	struct passo_grbl_settings settings;
	struct passo_gcode_offsets offsets;
	char start[PASSO_GRBL_STARTS][PASSO_GRBL_START_SIZE];
};

/* Its size in storage, in words. */
#define PASSO_GRBL_STORED_WORDS (sizeof(struct passo_grbl_stored) / sizeof(uint32_t))

/* How many settings of a kind there are. */
struct passo_grbl_counts {
	uint8_t axes;
#ifndef PASSO_CARTESIAN
	uint8_t offsets; /* motors of a machine that squares; else 0 */
#endif
};

/* The value of `$n`; null: this machine has no such setting. */
int64_t *passo_grbl_setting(
    struct passo_grbl_settings *settings, unsigned number, struct passo_grbl_counts counts);

/* Sets `$n` to a number in millionths. Errors: STATEMENT (no such setting, out of range), NEGATIVE, NUMBER
 * (not whole), PULSE_TOO_SHORT, SOFT_LIMITS_NEED_HOMING. */
enum passo_gcode_error passo_grbl_set(
    struct passo_grbl_settings *settings, unsigned number, struct passo_grbl_counts counts, int64_t value);

/* Largest value of `$n`, and whether 0 is none. */
uint32_t passo_grbl_setting_most(unsigned number, struct passo_grbl_counts counts, bool *positive);

/* The settings in the order of their numbers: the number of each, and whether it is whole; 0xFF: no more. */
#define PASSO_GRBL_NO_SETTING 0xFFu
unsigned passo_grbl_setting_number(unsigned index, struct passo_grbl_counts counts, bool *whole);

/* Whether the bit of an axis is set in a mask setting. */
bool passo_grbl_has_axis(
    const struct passo_grbl_settings *settings, enum passo_grbl_setting mask, unsigned axis);
bool passo_grbl_is_on(const struct passo_grbl_settings *settings, enum passo_grbl_setting setting);

#endif
