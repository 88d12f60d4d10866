/* SPDX-License-Identifier: MIT
 * Internal: random parts of a scenario.
 */
#ifndef SOAK_PLOT_DRAW_H
#define SOAK_PLOT_DRAW_H

#include "address.h"
#include "passo_words.h"
#include "scenario.h"

#define TICK_CLOCKS 128u /* TICK_LOG2 is 7 in all sets */

#define AXES 3u /* of a machine */

/* Most lines and ramps of one frame. */
#define LINES_MAX 20u
#define RAMPS_MAX 12u

/* A random motion whose lines are about as long as the area under its ramps. */
struct motion {
	struct passo_line lines[LINES_MAX];
	struct passo_ramp ramps[RAMPS_MAX];
	unsigned line_count, ramp_count;
};

/* Creates an empty frame, appends a word, and creates a write of one word. */
struct action scenario_frame(struct scenario *scenario, enum passo_operation operation, uint16_t address);
void scenario_add_word(struct action *action, uint32_t word);
struct action scenario_write_word(struct scenario *scenario, uint16_t address, uint32_t word);
unsigned scenario_any_channel(struct scenario *scenario);

/* Random register values. */
uint32_t scenario_some_pins(struct scenario *scenario);
uint32_t scenario_some_step_timing(struct scenario *scenario);
uint32_t scenario_some_dir_timing(struct scenario *scenario);
uint32_t scenario_some_rate(struct scenario *scenario);
uint32_t scenario_some_slew(struct scenario *scenario);
uint32_t scenario_some_drain(struct scenario *scenario);
/* COMMAND, rate, slews and drain velocity in one frame. */
struct action scenario_rates(struct scenario *scenario, unsigned channel, uint32_t command);
/* What a trigger waits for; home and probe have no other effect. */
uint32_t scenario_some_trigger(struct scenario *scenario);
/* RUN of all channels. */
uint32_t scenario_all_run(const struct scenario *scenario);

/* `speed` is the number of times the velocity is halved; `constant`: constant velocity with evenly spaced
 * steps. */
void scenario_add_ramp(struct motion *motion, uint64_t velocity, uint32_t ticks, enum passo_shape shape);
void scenario_draw_ramps(struct scenario *scenario, struct motion *motion, bool constant, unsigned speed);
void scenario_draw_lines(struct scenario *scenario, struct motion *motion, unsigned channel, bool constant,
    unsigned speed, const uint32_t *timing);
struct action scenario_push_lines(struct scenario *scenario, unsigned channel, const struct motion *motion);
struct action scenario_push_ramps(struct scenario *scenario, unsigned channel, const struct motion *motion);
/* Several motions in sequence, as far as the queues have room. */
void scenario_draw_motions(
    struct scenario *scenario, unsigned channel, bool constant, const uint32_t *timing);

#endif
