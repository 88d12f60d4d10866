/* SPDX-License-Identifier: MIT
 * Registers of the core, for passo_core.c.
 */
#ifndef PASSO_REGISTERS_CORE_H
#define PASSO_REGISTERS_CORE_H

#include "passo_core.h"

uint32_t passo_registers_status(const struct passo_core *core);
bool passo_registers_any_stopped(const struct passo_core *core);
bool passo_registers_any_occupied(const struct passo_core *core);
/* Answer to the strobe on the bus, if a register of the core or a table is meant. */
struct passo_response passo_registers_respond(const struct passo_core *core);
/* What stands in a register of the core. */
uint32_t passo_registers_value(const struct passo_core *core, uint16_t address);
void passo_registers_clock(struct passo_core *core);

#endif
