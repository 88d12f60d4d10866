/* SPDX-License-Identifier: MIT
 * Path-synchronized outputs: digital outputs, laser power, raster, position-compare pulses.
 *
 *     passo_configure_outputs(&passo, &(struct passo_outputs_config){.pwm_hz = 20000});
 *     passo_set_output(&passo, &(struct passo_output){.levels = 1, .power = 30000, .proportional = true,
 *         .speed = PASSO_STEPS_PER_S(20000)});
 *     passo_move_by_speed(&passo, &move); // with that output, like the moves after it
 * See docs/machine.md. Every call can also return NO_OUTPUTS and the errors common to the calls of passo.h.
 */
#ifndef PASSO_DRIVER_OUTPUTS_H
#define PASSO_DRIVER_OUTPUTS_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PASSO_POWER_FULL 65535u /* the power is always on */

/* -------------------------------------------------------------------------------------- each move ---- */

/* Sets the outputs of the moves queued from now on. passo_open() takes over the levels of the core;
 * passo_open() and passo_clear() set the power to 0. Homing, probing, jogging and continuous rotation have
 * these levels and no power. No frame. Error: POWER. A move with proportional power also returns REFERENCE
 * before passo_configure_outputs(), and ABOVE_REFERENCE if it is faster than `speed` or the reference. */
enum passo_error passo_set_output(struct passo *passo, const struct passo_output *output);
/* Sets the digital outputs immediately, and for the moves from now on. Three frames. Error: MOVING. */
enum passo_error passo_set_levels(struct passo *passo, uint8_t levels);
/* The word of an output, for struct passo_line of a stream and struct passo_path_move of a path; `speed` is
 * not used. 0 is all outputs low and no power. No frame. Error: POWER. */
enum passo_error passo_output_word(
    const struct passo *passo, const struct passo_output *output, uint32_t *word);

/* --------------------------------------------------------------------------------------- settings ---- */

struct passo_outputs_config {
	uint32_t pwm_hz; /* frequency of the power pin */
	uint32_t
	    reference; /* velocity at which a proportional power is the power of its line, UQ0.32
	                  substeps per clock: passo_path_velocity() for a path; 0: 1/2, for single moves */
	uint32_t lag;  /* output delay in clocks, 0 .. 65535 */
};

/* At rest. Three frames. Errors: PWM, REFERENCE, LAG_TOO_LONG, MOVING. */
enum passo_error passo_configure_outputs(struct passo *passo, const struct passo_outputs_config *config);

struct passo_outputs_state {
	uint8_t levels;       /* of the digital outputs */
	bool overflow;        /* more than 256 changes were delayed: no power until passo_clear() */
	bool raster_empty;    /* raster underrun since passo_clear(): the power was 0 */
	uint16_t raster_room; /* free entries of the raster queue, in values */
};
enum passo_error passo_read_outputs(struct passo *passo, struct passo_outputs_state *state);

/* ----------------------------------------------------------------------------------------- raster ---- */

/* Sets the substeps from one value of a raster line to the next, from the next value on: steps of the
 * dominant axis times plan.oversampling, or passo_path_substeps() of a path. Error: PITCH. */
enum passo_error passo_set_pitch(struct passo *passo, uint32_t substeps);
/* Queues values of raster lines: as many of the `count` as fit into the queue and one frame, *taken. Value
 * 255 is full power. A line begins with the first value of a call, so give each line its own calls, each but
 * its last with a multiple of 4 values. A stop empties the queue. Two frames. Errors: STOPPED; after a link
 * error it is unknown whether they were taken: stop. */
enum passo_error passo_push_raster(struct passo *passo, const uint8_t *values, size_t count, size_t *taken);

/* ---------------------------------------------------------------------------------------- compare ---- */

struct passo_compare_config {
	uint8_t axis;
	int32_t position; /* the first point, as passo_positions() counts */
	int32_t interval; /* steps from one point to the next, not 0; the sign is the direction */
	uint32_t width;   /* clocks of a pulse, 1 .. 65535 */
};

/* Outputs a pulse with the step onto each point. The points stay armed through stops and later moves until
 * passo_disarm_compare(). At rest. Four frames, three to disarm. Errors: INTERVAL, PULSE, MOVING. */
enum passo_error passo_arm_compare(struct passo *passo, const struct passo_compare_config *config);
enum passo_error passo_disarm_compare(struct passo *passo);

#ifdef __cplusplus
}
#endif

#endif
