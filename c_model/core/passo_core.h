/* SPDX-License-Identifier: MIT
 * The reference model of the core: bit-exact and cycle-exact with rtl/passo_core.v.
 *
 * passo_core_clock() is one rising edge of clk: the inputs are the pin levels at that edge, the outputs those
 * after it. No heap, no floating point; a core is a plain struct and can be copied. Pointers must not be
 * null.
 */
#ifndef PASSO_CORE_H
#define PASSO_CORE_H

#include "passo_model.h"
#include "passo_shift.h"

struct passo_core {
	struct passo_parameters parameters;
	struct passo_spi spi;
	struct passo_link link;
	struct passo_registers registers;
	struct passo_tables tables;
	struct passo_response response;
	struct passo_channel channel[PASSO_CHANNELS_MAX];
	uint8_t sync_q; /* synchronizer of the sync input */
	struct passo_machine_unit machine;
	uint32_t slew_count;
	bool slew_tick;
	struct passo_inputs inputs; /* at the previous clock, to detect SCLK edges */
	struct passo_outputs outputs;
};

/* Initializes a core to its state after FPGA configuration and a reset with chip select high. Returns false
 * if a parameter is out of range; the core is then not initialized. */
bool passo_core_reset(struct passo_core *core, const struct passo_parameters *parameters);

/* One rising edge of the clock. */
void passo_core_clock(struct passo_core *core, const struct passo_inputs *inputs);

/* Skips at most `limit` clocks in which no output pin changes, with constant inputs. Returns the number of
 * clocks skipped; after 0, continue with passo_core_clock(). The resulting state is identical to that many
 * calls of passo_core_clock(). */
uint64_t passo_core_advance(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit);

/* Executes at least one and at most `limit` clocks with constant inputs, the last of them the first one in
 * which an output pin changes. Returns their number. */
uint64_t passo_core_run(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit);

/* The same two during an SPI transfer, for output pins except MISO. `inputs` has the levels of the previous
 * clock and is updated to the last one executed. */
uint64_t passo_core_shift(
    struct passo_core *core, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit);
uint64_t passo_core_exchange(
    struct passo_core *core, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit);

/* Sets the EN and power outputs for this level of estop_n, which acts asynchronously. */
void passo_core_estop(const struct passo_core *core, bool estop_n, struct passo_outputs *outputs);

const struct passo_outputs *passo_core_outputs(const struct passo_core *core);

/* sizeof(struct passo_core), for callers to which the struct is opaque. */
uint64_t passo_core_size(void);

#endif
