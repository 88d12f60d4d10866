/* SPDX-License-Identifier: MIT
 * Internal: registers of the core, for passo_core.c.
 */
#ifndef PASSO_REGISTERS_CORE_H
#define PASSO_REGISTERS_CORE_H

#include "passo_core.h"

/* The status word of the link. */
uint32_t passo_registers_status(const struct passo_core *core);
bool passo_registers_any_stopped(const struct passo_core *core);
bool passo_registers_any_occupied(const struct passo_core *core);
/* Whether a core register objects to a word that its rule allows. */
bool passo_registers_object(const struct passo_core *core, uint16_t address, uint32_t data);
/* Value of a core register; 0 for those that cannot be read. */
uint32_t passo_registers_value(const struct passo_core *core, uint16_t address);
void passo_registers_clock(struct passo_core *core);

/* Writes of points, and whether the frame has any. */
void passo_tables_clock(struct passo_tables *tables, const struct passo_bus *bus);
/* The next turn at the tables; `channels` > 0. */
void passo_tables_turn(struct passo_tables *tables, uint8_t channels);

/* Levels at the inputs of a channel. */
void passo_core_take_pins(const struct passo_core *core, unsigned channel, const struct passo_inputs *inputs,
    struct passo_channel_inputs *made);
/* The levels of all output pins. */
void passo_core_gather_outputs(struct passo_core *core);
/* Of all channels: passo_channel_incomplete(), and whether the frame on the bus has to wait. */
bool passo_core_any_incomplete(const struct passo_core *core);
bool passo_core_any_busy(const struct passo_core *core);
/* Whether a motion runs. */
bool passo_core_any_moving(const struct passo_core *core);

#endif
