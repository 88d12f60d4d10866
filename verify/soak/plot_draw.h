/* SPDX-License-Identifier: MIT
 * Internal: random parts of a plot.
 */
#ifndef SOAK_PLOT_DRAW_H
#define SOAK_PLOT_DRAW_H

#include "address.h"
#include "passo_words.h"
#include "plot.h"

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
struct action plot_frame(struct plot *plot, enum passo_operation operation, uint16_t address);
void plot_add_word(struct action *action, uint32_t word);
struct action plot_write_word(struct plot *plot, uint16_t address, uint32_t word);
unsigned plot_any_channel(struct plot *plot);

/* Random register values. */
uint32_t plot_some_pins(struct plot *plot);
uint32_t plot_some_step_timing(struct plot *plot);
uint32_t plot_some_dir_timing(struct plot *plot);
uint32_t plot_some_rate(struct plot *plot);
uint32_t plot_some_slew(struct plot *plot);
uint32_t plot_some_drain(struct plot *plot);
/* COMMAND, rate, slews and drain velocity in one frame. */
struct action plot_rates(struct plot *plot, unsigned channel, uint32_t command);
/* What a trigger waits for; home and probe have no other effect. */
uint32_t plot_some_trigger(struct plot *plot);
/* RUN of all channels. */
uint32_t plot_all_run(const struct plot *plot);

/* `speed` is the number of times the velocity is halved; `constant`: constant velocity with evenly spaced
 * steps. */
void plot_add_ramp(struct motion *motion, uint64_t velocity, uint32_t ticks, enum passo_shape shape);
void plot_draw_ramps(struct plot *plot, struct motion *motion, bool constant, unsigned speed);
void plot_draw_lines(struct plot *plot, struct motion *motion, unsigned channel, bool constant,
    unsigned speed, const uint32_t *timing);
struct action plot_push_lines(struct plot *plot, unsigned channel, const struct motion *motion);
struct action plot_push_ramps(struct plot *plot, unsigned channel, const struct motion *motion);
/* Several motions in sequence, as far as the queues have room. */
void plot_draw_motions(struct plot *plot, unsigned channel, bool constant, const uint32_t *timing);

#endif
