/* SPDX-License-Identifier: MIT
 * Executing the link and the SPI slave, while the link does not act on the rest of the core. See
 * passo_advance.c.
 */
#include "passo_advance.h"

#include <stddef.h>

#include "passo_registers_core.h"

bool passo_advance_link_is_alone(const struct passo_core *core)
{
	const struct passo_bus *bus = &core->link.bus;
	const struct passo_response *response = &core->response;

	return !bus->frame && !bus->check && !bus->write && !bus->read && !core->link.refused
	    && !response->claim && !response->reads && response->refusal == 0u && response->read_data == 0u
	    && !passo_spi_wires(&core->spi).frame_start;
}

/* The slave in the next clock, in which the pins may change. */
static void clock_spi(struct passo_core *core, const struct passo_inputs *pins, uint32_t reply_word)
{
	passo_spi_clock(
	    &core->spi, core->inputs.spi_sclk, pins->spi_sclk, pins->spi_mosi, pins->spi_cs_n, reply_word);
	core->inputs.spi_sclk = pins->spi_sclk;
	core->inputs.spi_mosi = pins->spi_mosi;
	core->inputs.spi_cs_n = pins->spi_cs_n;
}

static void clock_both(struct passo_core *core, struct passo_inputs *pins, struct passo_shift *shift,
    struct passo_link_wires *wires)
{
	const uint32_t reply_word = core->link.reply_word;
	const uint8_t sequence = core->link.last_sequence;

	wires->spi = passo_spi_wires(&core->spi);
	wires->half_low = core->spi.half_low;
	wires->half = core->spi.half;
	passo_link_clock(&core->link, wires);
	if (core->link.last_sequence != sequence)
		wires->status = passo_registers_status(core);
	if (shift)
		passo_shift_pins(shift, pins, core->spi.miso);
	clock_spi(core, pins, reply_word);
	if (shift)
		shift->clock++;
}

/* Clocks in which the link only counts, and no edge of SCLK ends a half. */
static uint64_t quiet(const struct passo_core *core, const struct passo_inputs *pins,
    const struct passo_shift *shift, uint32_t status)
{
	const struct passo_spi *spi = &core->spi;
	const uint64_t clocks = passo_link_quiet(&core->link);

	if (core->link.status != status || spi->select_sync != (pins->spi_cs_n ? 0 : 7)
	    || spi->toggle_sync != (spi->half_toggle ? 7 : 0))
		return 0;
	if (!shift)
		return core->inputs.spi_sclk == pins->spi_sclk ? clocks : 0u;
	const uint64_t half = 32u * (uint64_t)shift->half_period;
	return passo_least(clocks, (half - shift->clock % half) % half);
}

/* Skips these clocks: the slave sees the edges. */
static void skip(
    struct passo_core *core, struct passo_inputs *pins, struct passo_shift *shift, uint64_t clocks)
{
	passo_link_skip(&core->link, clocks);
	if (!shift)
		return;
	const uint64_t begin = shift->clock + shift->half_period - 1u;
	const uint64_t end = (begin + clocks) / shift->half_period;
	for (uint64_t level = begin / shift->half_period; level < end; level++) {
		passo_shift_to(shift, level, true, pins, core->spi.miso);
		clock_spi(core, pins, core->link.reply_word);
	}
	shift->clock += clocks;
}

bool passo_advance_link_rests(const struct passo_core *core, const struct passo_inputs *inputs)
{
	return quiet(core, inputs, NULL, passo_registers_status(core)) == UINT64_MAX;
}

uint64_t passo_advance_link(
    struct passo_core *core, const struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit)
{
	const struct passo_bus before = core->link.bus;
	struct passo_link_wires wires = {.incomplete = passo_core_any_incomplete(core),
	    .busy = passo_core_any_busy(core),
	    .status = passo_registers_status(core)};
	struct passo_inputs pins = *inputs;
	uint64_t clocks = 0;

	/* the trackers note a frame that is being executed */
	while (clocks < limit && core->link.bus.address == before.address
	       && core->link.bus.commit == before.commit && passo_advance_link_is_alone(core)) {
		const uint64_t skipped = passo_least(quiet(core, &pins, shift, wires.status), limit - clocks);

		if (skipped != 0u)
			skip(core, &pins, shift, skipped);
		else
			clock_both(core, &pins, shift, &wires);
		clocks += skipped != 0u ? skipped : 1u;
	}
	core->outputs.spi_miso = core->spi.miso;
	return clocks;
}
