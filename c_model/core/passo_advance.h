/* SPDX-License-Identifier: MIT
 * Internal: quiet time of a channel, for passo_advance.c.
 */
#ifndef PASSO_ADVANCE_H
#define PASSO_ADVANCE_H

#include "passo_core.h"
#include "passo_least.h"

/* Latency from phase to DDA; no shorter time of a running profile is skipped. */
#define PASSO_ADVANCE_PIPELINE 4u

/* Clocks for which everything in the channel is quiet, except axes and profile; and skipping them. */
uint64_t passo_advance_surroundings_quiet(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew);
void passo_advance_surroundings_skip(struct passo_channel *channel, uint64_t clocks, uint32_t substeps);
uint64_t passo_advance_ramp_quiet(const struct passo_ramp_unit *ramp);
uint64_t passo_advance_axis_quiet(const struct passo_channel *channel, unsigned axis);
/* Whether no substep is in flight between path and DDA. */
bool passo_advance_slots_empty(const struct passo_channel *channel);

/* Whether a profile is running with its clock enable always on, so not by an encoder. */
bool passo_advance_profile_counts(const struct passo_channel *channel);
/* Clocks to the next event of a running profile, within its tick; and skipping them. */
uint64_t passo_advance_profile_quiet(
    const struct passo_channel *channel, const struct passo_parameters *parameters, uint64_t limit);
void passo_advance_profile_skip(struct passo_channel *channel, uint64_t clocks);
/* Skips whole ticks without events, from a point in a tick at which the next velocity is ready to the same
 * point in a later tick of the same ramp. Returns the clocks. */
uint64_t passo_advance_skip_ticks(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit);

/* Clocks for which the whole channel is quiet, and skipping them. */
uint64_t passo_advance_channel_quiet(const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew, uint64_t limit);
void passo_advance_channel_skip(struct passo_channel *channel, uint64_t clocks);

/* Executes at most `limit` clocks of a running profile and its axes while the rest of the channel is quiet,
 * up to one in which a pin or something else in the channel changes. Returns the clocks. With `changed` the
 * clock in which a pin changes is executed, too, if nothing else does; *changed tells so. */
uint64_t passo_advance_run(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit, bool *changed);

/* Whether link and SPI slave only act on each other in the next clock: no strobe of the bus, no answer to
 * one, and no snapshot. */
bool passo_advance_link_is_alone(const struct passo_core *core);
/* A clock of all units but the channels. */
void passo_core_clock_bus(struct passo_core *core, const struct passo_inputs *inputs);
/* Whether they do nothing at all until a pin or the status changes. */
bool passo_advance_link_rests(const struct passo_core *core, const struct passo_inputs *inputs);
/* Executes at most `limit` clocks of the link and the SPI slave, up to one in which the link acts on the rest
 * of the core. Returns the clocks. `shift`: the present exchange, or null: the pins are constant. */
uint64_t passo_advance_link(
    struct passo_core *core, const struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit);

#endif
