/* SPDX-License-Identifier: MIT
 * The reference model of the core: what each clock must do, bit for bit what rtl/passo_core.v does.
 *
 * passo_core_clock() is one rising edge. Pins given to it are the pins as they stand at that edge; outputs
 * are the pins after it. No heap, no floating point; a core is a plain struct that may be copied.
 */
#ifndef PASSO_CORE_H
#define PASSO_CORE_H

#include "passo_model.h"

/* Input pins. Each level of spi_sclk must last at least one clock, and chip select must not change together
 * with it. */
struct passo_inputs {
	bool spi_sclk;
	bool spi_mosi;
	bool spi_cs_n;
	bool sync;
	bool rst;
};

/* Output pins; bit channel * AXES + axis, or a bit per channel. */
struct passo_outputs {
	uint64_t step;
	uint64_t dir;
	uint64_t enable;
	uint8_t running;
	bool irq;
	bool spi_miso;
};

struct passo_core {
	struct passo_parameters parameters;
	struct passo_spi spi;
	struct passo_link link;
	struct passo_registers registers;
	struct passo_tables tables;
	struct passo_response response;
	struct passo_channel channel[PASSO_CHANNELS_MAX];
	uint8_t sync_q;
	uint32_t slew_count;
	bool slew_tick;
	struct passo_inputs inputs; /* of the last clock: SCLK edges are found by comparing */
	struct passo_outputs outputs;
};

/* As it is when the FPGA has been configured and rst has been high, chip select too. False if a parameter is
 * out of range; then the core must not be used. */
bool passo_core_reset(struct passo_core *core, const struct passo_parameters *parameters);

/* One rising edge of the clock. */
void passo_core_clock(struct passo_core *core, const struct passo_inputs *inputs);

/* Advances over at most `limit` clocks in which no output pin changes, the inputs staying as they are.
 * Returns how many; after 0 the next clock may not be quiet: use passo_core_clock(). The core is then in the
 * very state that so many calls of passo_core_clock() would have led to. */
uint64_t passo_core_advance(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit);

const struct passo_outputs *passo_core_outputs(const struct passo_core *core);

/* For callers that see the struct as opaque. */
uint64_t passo_core_size(void);

#endif
