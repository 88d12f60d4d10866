/* SPDX-License-Identifier: MIT
 * Internal: what the registers of a channel answer to a check and to a read.
 */
#ifndef PASSO_ANSWER_H
#define PASSO_ANSWER_H

#include "passo_model.h"

struct passo_answer {
	bool known;
	uint8_t check, read;
	uint32_t value;
	bool late; /* the value is passo_channel_registers_value(), sampled in the clock of the response */
};

static inline struct passo_answer passo_write_only(uint8_t check)
{
	return (struct passo_answer){.known = true, .check = check, .read = PASSO_VERDICT_BAD_OPERATION};
}

static inline struct passo_answer passo_read_only(uint32_t value)
{
	return (struct passo_answer){
	    .known = true, .check = PASSO_VERDICT_READ_ONLY, .read = PASSO_VERDICT_OK, .value = value};
}

static inline struct passo_answer passo_read_late(void)
{
	return (struct passo_answer){
	    .known = true, .check = PASSO_VERDICT_READ_ONLY, .read = PASSO_VERDICT_OK, .late = true};
}

static inline uint8_t passo_value_check(bool bad)
{
	return bad ? PASSO_VERDICT_BAD_VALUE : PASSO_VERDICT_OK;
}

/* Of the parts that a core may have. */
struct passo_answer passo_inputs_answer(const struct passo_channel *channel, uint8_t address, uint32_t data);
struct passo_answer passo_encoder_registers_answer(
    const struct passo_channel *channel, uint8_t address, uint32_t data);

#endif
