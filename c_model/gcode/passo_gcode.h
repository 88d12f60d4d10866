/* SPDX-License-Identifier: MIT
 * The G-code interpreter: from lines to actions, in integer arithmetic. See docs/gcode.md.
 *
 *     passo_gcode_open(&gcode, &settings);
 *     if (!passo_gcode_is_busy(&gcode))
 *             error = passo_gcode_execute(&gcode, "G1X10F600");
 *     while (passo_gcode_next(&gcode, &action))
 *             ... one line, dwell or pause, in this order
 *
 * A line is checked completely before it takes effect; a line with an error changes nothing.
 * Lengths are nanometers, Q63.0; degrees of A, B, C are treated as millimeters. No heap, no floating point.
 */
#ifndef PASSO_GCODE_H
#define PASSO_GCODE_H

#include "passo_gcode_arc.h"
#include "passo_gcode_block.h"
#include "passo_gcode_cycle.h"
#include "passo_path.h"

#define PASSO_GCODE_SYSTEMS 6u /* G54 .. G59 */

/* Whether there is a tool change. */
#ifdef PASSO_PLAIN_GCODE
#define PASSO_GCODE_HAS_TOOLS false
#else
#define PASSO_GCODE_HAS_TOOLS true
#endif

/* Tools of the table, T1 and up; T may be any number up to 255. */
#ifndef PASSO_GCODE_TOOLS
#define PASSO_GCODE_TOOLS 100u
#endif

typedef int64_t passo_gcode_position[PASSO_GCODE_AXES_MAX];

struct passo_gcode_settings {
	uint8_t axes;             /* 1 .. PASSO_GCODE_AXES_MAX */
	uint32_t arc_tolerance;   /* nm, at least 1 */
	uint32_t spindle_maximum; /* rpm at full power; 0: S has no effect */
	bool laser;               /* M4: speed-proportional power, not reverse */
	uint32_t spindle_minimum; /* rpm, minimum of a running spindle */
	uint8_t left_out;         /* mask of axes of passo_gcode_block.h */
	uint8_t inputs;           /* of M66: P is below it */
	bool power;               /* there is the output of M67 and M68, E0 */
#ifndef PASSO_WITHOUT_THREADS
	uint32_t turn_counts; /* of the encoder of the spindle; 0: none, no threads */
#endif
};

/* Offsets that survive a reset: stored by the caller, if at all. */
struct passo_gcode_offsets {
	passo_gcode_position system[PASSO_GCODE_SYSTEMS];
	passo_gcode_position home[2]; /* G28, G30 */
#ifndef PASSO_PLAIN_GCODE
	int32_t tool_length[PASSO_GCODE_TOOLS]; /* of T1 and up: nm */
#endif
};

/* The output word of the lines: that of the core with OUTPUTS. */
#define PASSO_GCODE_OUTPUT_SPINDLE (UINT32_C(1) << 16)
#define PASSO_GCODE_OUTPUT_REVERSE (UINT32_C(1) << 17)
#define PASSO_GCODE_OUTPUT_FLOOD (UINT32_C(1) << 18)
#define PASSO_GCODE_OUTPUT_MIST (UINT32_C(1) << 19)
#define PASSO_GCODE_OUTPUT_DIGITAL (UINT32_C(1) << 20) /* M62 to M65: P0, and the following ones */
#define PASSO_GCODE_DIGITALS 4u
#define PASSO_GCODE_OUTPUTS_DIGITAL                                                                          \
	(PASSO_GCODE_OUTPUT_DIGITAL * ((UINT32_C(1) << PASSO_GCODE_DIGITALS) - 1u))
#define PASSO_GCODE_OUTPUT_PROPORTIONAL (UINT32_C(1) << 24)
#define PASSO_GCODE_POWER_FULL 65535u /* the power is in the lower half */
#define PASSO_GCODE_POWER_OF_SPINDLE UINT32_MAX

/* What M66 waits for: L. */
enum passo_gcode_wanted {
	PASSO_GCODE_WANTED_NOW, /* nothing: the level is read */
	PASSO_GCODE_WANTED_RISE,
	PASSO_GCODE_WANTED_FALL,
	PASSO_GCODE_WANTED_HIGH,
	PASSO_GCODE_WANTED_LOW
};

enum passo_gcode_kind {
	PASSO_GCODE_LINE,
	PASSO_GCODE_PROBE, /* to the target, until the probe triggers; `probe` is 382 .. 385 */
	PASSO_GCODE_DWELL,
	PASSO_GCODE_OUTPUT,  /* levels or power have changed; `stops`: now, M64, M65 and M68 */
	PASSO_GCODE_PAUSE,   /* M0: wait for the operator after the preceding lines */
	PASSO_GCODE_END,     /* M2, M30: of the program */
	PASSO_GCODE_OFFSETS, /* struct passo_gcode_offsets has changed */
	PASSO_GCODE_CHANGE,  /* M6: a pause with spindle and coolant off, until passo_gcode_load() */
	PASSO_GCODE_INPUT,   /* M66: at rest, until input `input` is as `wanted` or the time is over */
	PASSO_GCODE_THREAD   /* G33, G33.1: a line in step with the spindle, and back if it is rigid */
};

struct passo_gcode_action {
	enum passo_gcode_kind kind;
	passo_gcode_position target; /* machine coordinates */
	uint64_t feed;               /* UQ32.32 mm/s, or PASSO_PATH_RAPID */
	uint64_t tolerance;          /* for passo_path_tolerance(), before the line is added */
	bool stops;                  /* at the end of the line, or of the one before */
	uint64_t microseconds;       /* of a dwell; most time of M66 */
	uint8_t input, wanted;       /* P and L of M66 */
	uint32_t output;
	uint32_t line; /* N; 0: none */
	passo_gcode_command probe;
	uint8_t tool; /* to be loaded */
#ifndef PASSO_WITHOUT_THREADS
	uint64_t pitch; /* of a thread: nm along its line per turn */
	uint64_t speed; /* of the spindle: millionths of rpm; `feed` is that of this speed */
	bool rigid;     /* the spindle reverses at the target, and the line is made back as well */
#endif
};

/* Pending actions of a line. */
struct passo_gcode_job {
	bool change, output, dwell, offsets, via, motion, pause, end; /* in this order */
	bool turns;                                                   /* the motion is an arc */
	bool drills;                                                  /* the motion is a cycle */
#ifndef PASSO_PLAIN_GCODE
	bool settles; /* the output changes at rest */
	bool listens; /* M66 */
	uint8_t input, wanted;
	uint64_t timeout; /* us */
#endif
	passo_gcode_command probe; /* the motion is a probe; else PASSO_GCODE_NONE */
	uint64_t microseconds;
	uint64_t feed;                              /* UQ32.32 mm/s, or PASSO_PATH_RAPID */
	passo_gcode_position stopover, destination; /* machine coordinates */
#ifndef PASSO_PLAIN_GCODE
	passo_gcode_position from; /* where the motion begins */
	int64_t at;                /* X at the end of the last action */
	bool per_turn;             /* the feed is that of G95 */
#endif
#ifndef PASSO_WITHOUT_THREADS
	uint64_t pitch; /* of a thread, nm; 0: the motion is none */
#endif
	union {
		struct passo_gcode_arc arc;     /* if it turns */
		struct passo_gcode_cycle cycle; /* if it drills */
	};
};

/* All members except spindle_percent are read-only for users. */
struct passo_gcode {
	struct passo_gcode_settings settings;
	struct passo_gcode_offsets offsets;
	passo_gcode_command mode[PASSO_GCODE_MODES];
	bool flood, mist;
#ifndef PASSO_PLAIN_GCODE
	uint8_t digital; /* of M62 to M65: P0 is bit 0 */
	uint32_t power;  /* of M67 and M68, or PASSO_GCODE_POWER_OF_SPINDLE */
#endif
	passo_gcode_position position;  /* programmed end, machine coordinates */
	passo_gcode_position shift;     /* G92 */
	int64_t tool_length;            /* G43, G43.1, G43.2 */
	struct passo_gcode_drill drill; /* of the cycle in force */
	uint64_t tolerance;             /* of G61 and G64 */
	int64_t feed;                   /* nm/min, after G95 nm per revolution; 0: none yet */
	int64_t spindle;                /* millionths of rpm, of G97 */
#ifndef PASSO_PLAIN_GCODE
	int64_t surface; /* nm/min, of G96 */
	int64_t fastest; /* its limit, millionths of rpm; 0: none */
#endif
	uint32_t line;           /* N of the last line that had one */
	uint8_t tool;            /* T: the next one */
	uint8_t loaded;          /* the one in the spindle; 0: none */
	uint8_t spindle_percent; /* override of S: may be set by the caller, for the following actions */
	struct passo_gcode_job job;
};

/* Power-up modes, position 0, no offsets. */
void passo_gcode_open(struct passo_gcode *gcode, const struct passo_gcode_settings *settings);

/* Changes the settings; only while not busy. The axes stay. */
void passo_gcode_configure(struct passo_gcode *gcode, const struct passo_gcode_settings *settings);

/* Changes the stored offsets; only while not busy. */
void passo_gcode_set_offsets(struct passo_gcode *gcode, const struct passo_gcode_offsets *offsets);

/* Power-up modes; offsets, position and the loaded tool stay, G92 and tool lengths are cleared. */
void passo_gcode_reset(struct passo_gcode *gcode);

/* Sets the position after a stop, homing or probing. Drops the rest of the line. */
void passo_gcode_set_position(struct passo_gcode *gcode, const int64_t *position);

/* Executes a line of passo_gcode_line.h; only while not busy. An error changes nothing. */
enum passo_gcode_error passo_gcode_execute(struct passo_gcode *gcode, const char *text);

/* The same for the words after `$J=`: modes and feed are unchanged. Error: also JOG. */
enum passo_gcode_error passo_gcode_jog(struct passo_gcode *gcode, const char *text);

/* The next action of the line; false: none left. */
bool passo_gcode_next(struct passo_gcode *gcode, struct passo_gcode_action *action);
bool passo_gcode_is_busy(const struct passo_gcode *gcode);

/* A measured length in force, as by G43.1, nm. */
void passo_gcode_set_length(struct passo_gcode *gcode, int64_t length);

/* As by M5, for the following lines. */
void passo_gcode_stop_spindle(struct passo_gcode *gcode);

/* The tool is in the spindle. */
void passo_gcode_load(struct passo_gcode *gcode, uint8_t tool);

/* The output word of the following lines. */
uint32_t passo_gcode_output(const struct passo_gcode *gcode);

/* Machine minus work coordinate of an axis: the sum of all offsets. */
int64_t passo_gcode_offset(const struct passo_gcode *gcode, unsigned axis);

/* Converts nanometers to Q31.32 mm, to nearest. */
int64_t passo_gcode_millimetres(int64_t nanometres);

#endif
