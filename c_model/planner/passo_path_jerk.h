/* SPDX-License-Identifier: MIT
 * Internal: ramps of the profile `jerk`. Velocities are UQ0.48, lengths UQ32.32 substeps.
 */
#ifndef PASSO_PATH_JERK_H
#define PASSO_PATH_JERK_H

#include "passo_path_private.h"

/* Limits of a ramp, as in struct passo_path_item. */
struct passo_path_law {
	uint64_t slope, jerk;
};

/* Length of the ramp between two velocities; UINT64_MAX: no such ramp. */
uint64_t passo_path_ramp_length(
    const struct passo_path_planner *path, const struct passo_path_law *law, uint64_t a, uint64_t b);

/* Length of a ramp up from `from` to `top`, of `pause` ticks there, and of a ramp down to `to`, if that is
 * lower; UINT64_MAX: no such ramps. */
uint64_t passo_path_detour(const struct passo_path_planner *path, const struct passo_path_law *law,
    uint64_t from, uint64_t top, uint64_t pause, uint64_t to);

/* The highest velocity, from `from` to `most`, that can be reached from `from`, kept for `pause` ticks, and
 * left for `to` within a length; `from`, if there is none. */
uint64_t passo_path_highest(const struct passo_path_planner *path, const struct passo_path_law *law,
    uint64_t from, uint64_t pause, uint64_t to, uint64_t length, uint64_t most);

/* Slope of a ramp that passes the start of an item: no more than those of both lines, less over a lone
 * corner. */
uint64_t passo_path_pass_slope(const struct passo_path_item *item, uint64_t slope);

/* Highest velocity at the end of an item. */
uint64_t passo_path_velocity_after(const struct passo_path_planner *path, uint32_t index);

#endif
