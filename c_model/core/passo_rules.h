/* SPDX-License-Identifier: MIT
 * Internal: what each access of a frame is answered. See rtl/passo_rules.v.
 */
#ifndef PASSO_RULES_H
#define PASSO_RULES_H

#include "passo_model.h"
#include "passo_register_rules.h"

/* The rule of the register at an address; no access if there is none with these parameters. */
struct passo_rule passo_rule_at(const struct passo_parameters *parameters, uint16_t address);
bool passo_rule_exists(const struct passo_rule *rule);
/* Refusal of the check or read on the bus; a pushed word is judged by its queue. `bad_value`: the block of
 * the register objects to the word. */
uint8_t passo_rule_refusal(const struct passo_rule *rule, const struct passo_bus *bus, bool bad_value);

#endif
