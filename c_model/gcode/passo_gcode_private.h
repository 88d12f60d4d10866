/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the interpreter.
 */
#ifndef PASSO_GCODE_PRIVATE_H
#define PASSO_GCODE_PRIVATE_H

#include "passo_gcode.h"

/* A line being checked: its words, and the modes once it is accepted. */
struct passo_gcode_check {
	const struct passo_gcode *gcode; /* as it was before the line, but for its job */
	struct passo_gcode_job *job;
	struct passo_gcode_block block;
	passo_gcode_command mode[PASSO_GCODE_MODES];
	uint32_t axis_words;
	uint32_t unused;     /* words not used by a command yet */
	bool moves;          /* the axis words are those of a motion, given or in force */
	int64_t feed;        /* nm/min, of G94; 0: none */
	int64_t inverse;     /* millionths of 1/min, of G93 */
	uint64_t tolerance;  /* UQ32.32 mm, of G61 and G64 */
	int64_t tool_length; /* nm */
	uint8_t loaded;      /* the tool in the spindle */
#ifndef PASSO_PLAIN_GCODE
	uint8_t digital; /* the output of M62 to M65, as a bit */
	uint32_t power;  /* of M67 and M68 */
	int64_t spindle, surface, fastest;
#endif
	struct passo_gcode_drill drill;
	unsigned system;          /* that is set by G10 L2, L20 */
	unsigned entry;           /* of the tool table, that is set by G10 L1; 0: none */
	passo_gcode_position set; /* by G10, G92 */
};

/* The command of a group that is in force at first: of the planes the one that the machine has. */
passo_gcode_command passo_gcode_power_up(const struct passo_gcode *gcode, unsigned group);

/* The axes of a position. */
void passo_gcode_copy(const struct passo_gcode *gcode, const int64_t *from, int64_t *to);

/* Whether a word is present; marks it as used. */
bool passo_gcode_take(struct passo_gcode_check *check, char letter);
static inline bool passo_gcode_has_word(const struct passo_gcode_check *check, char letter)
{
	return (check->block.words & PASSO_GCODE_WORD(letter)) != 0;
}
/* Value of a word in nanometers, with the active units. */
int64_t passo_gcode_length_of(const struct passo_gcode_check *check, char letter);
/* Whether X, Y or Z, 0 to 2, may be in an arc: not if an axis behind it is there without it. */
bool passo_gcode_is_linear(const struct passo_gcode *gcode, unsigned letter);
/* Its place among the axes of the machine; without such an axis a free one. */
unsigned passo_gcode_linear(const struct passo_gcode *gcode, unsigned letter);
bool passo_gcode_has_axis(const struct passo_gcode_check *check, unsigned axis);
int64_t passo_gcode_axis_value(const struct passo_gcode_check *check, unsigned axis);
bool passo_gcode_in_range(int64_t nanometres);
/* Machine less work coordinates, with the coordinate system of the line. */
int64_t passo_gcode_offset_of(const struct passo_gcode_check *check, unsigned axis);

/* Everything except the motion. */
enum passo_gcode_error passo_gcode_check_words(struct passo_gcode_check *check);
/* The motion: fills in the job. */
enum passo_gcode_error passo_gcode_check_motion(struct passo_gcode_check *check);
bool passo_gcode_is_arc(passo_gcode_command motion);
/* Whether a motion is a drilling cycle, and the checks of its words: fills in the job. */
bool passo_gcode_is_cycle(passo_gcode_command motion);
enum passo_gcode_error passo_gcode_check_cycle(struct passo_gcode_check *check);
/* In X, Y and Z. */
struct passo_gcode_plane passo_gcode_plane_of(const struct passo_gcode_check *check);
#ifndef PASSO_PLAIN_GCODE
/* The words of a lathe: S, D, G95, G96, G97. */
enum passo_gcode_error passo_gcode_check_spindle(struct passo_gcode_check *check);
enum passo_gcode_error passo_gcode_check_turning(const struct passo_gcode_check *check);
/* Millionths of rpm that the program asks for with X at a machine coordinate. */
int64_t passo_gcode_wanted_speed(const struct passo_gcode *gcode, int64_t x);
/* Output and feed of an action of a motion, and the target of its next piece. */
void passo_gcode_turn(struct passo_gcode *gcode, struct passo_gcode_action *action);
#endif
#ifndef PASSO_WITHOUT_THREADS
/* Whether a motion is in step with the spindle, the checks of its words, and its action. */
bool passo_gcode_is_thread(passo_gcode_command motion);
enum passo_gcode_error passo_gcode_check_thread(struct passo_gcode_check *check);
void passo_gcode_thread(const struct passo_gcode *gcode, struct passo_gcode_action *action);
#endif
/* Millionths of rpm that the spindle has when so much is wanted, and the output word. */
uint64_t passo_gcode_speed(const struct passo_gcode *gcode, int64_t wanted);
uint32_t passo_gcode_output_at(const struct passo_gcode *gcode, int64_t wanted);
/* UQ32.32 mm/s, at least 1, of nm/min. */
uint64_t passo_gcode_feed(uint64_t per_minute);
/* The target of the axis words. Error: TARGET. */
enum passo_gcode_error passo_gcode_find_target(const struct passo_gcode_check *check, int64_t *target);

#endif
