/* SPDX-License-Identifier: MIT
 * Skipping clocks during an SPI transfer: passo_core_shift() and passo_core_exchange().
 *
 * Between the ends of two halves of a word an edge of SCLK only changes the SPI slave's own registers. A skip
 * therefore jumps over the rest of the core and processes the edges within it one by one.
 */
#include "passo_core.h"

/* An edge of SCLK that does not end a half; the synchronizers of the SPI slave are settled. */
static void take_edge(struct passo_core *core, struct passo_inputs *inputs, const struct passo_shift *shift)
{
	passo_shift_pins(shift, inputs, core->spi.miso);
	passo_spi_clock(&core->spi, core->inputs.spi_sclk, inputs->spi_sclk, inputs->spi_mosi, false,
	    core->link.reply_word);
	core->inputs.spi_sclk = inputs->spi_sclk;
	core->inputs.spi_mosi = inputs->spi_mosi;
}

uint64_t passo_core_shift(
    struct passo_core *core, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit)
{
	const uint64_t half = 32u * (uint64_t)shift->half_period;
	const uint64_t end = 2u * (uint64_t)shift->half_period * shift->bits;
	const uint64_t begin = shift->clock;
	uint64_t most = half - begin % half;

	if (begin % half == 0u)
		return 0; /* a half may end in this clock */
	if (most > end - begin)
		most = end - begin;
	const uint64_t clocks = passo_core_advance(core, inputs, limit < most ? limit : most);

	if (clocks == 0u)
		return 0;
	while (shift->clock < begin + clocks) {
		if (shift->clock % shift->half_period == 0u)
			take_edge(core, inputs, shift);
		shift->clock += passo_shift_constant(shift);
	}
	shift->clock = begin + clocks;
	core->outputs.spi_miso = core->spi.miso;
	return clocks;
}

uint64_t passo_core_exchange(
    struct passo_core *core, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit)
{
	const uint64_t clocks = passo_core_shift(core, inputs, shift, limit);

	if (clocks != 0u)
		return clocks;
	passo_shift_pins(shift, inputs, core->spi.miso);
	passo_core_clock(core, inputs);
	shift->clock++;
	return 1;
}
