/* SPDX-License-Identifier: MIT
 * Skipping quiet time: passo_core_advance().
 *
 * While a profile runs, a clock is quiet if it only changes counters and sums whose later values can be
 * computed directly: the tick counter, the phase, e of each DDA, the substep count of the line, timers. It is
 * not quiet if a step is made, a line or a tick ends, a ramp is chosen, or an input changes.
 *
 * Two groups of units need not be quiet, since they mostly act on each other: the link with the SPI slave,
 * and a running profile with its axes. They are executed by their own functions, while the rest is skipped.
 * While the link acts on the rest, but not on a channel, these are skipped if they are quiet.
 */
#include "passo_advance.h"

#include <stddef.h>

#include "passo_registers_core.h"

/* Latency from a slew tick to the change of rate; see passo_timescale_clock(). */
enum { SLEW_CLOCKS = 6 };

static bool pins_quiet(const struct passo_core *core, const struct passo_inputs *inputs)
{
	return !inputs->rst && core->sync_q == (inputs->sync ? 7 : 0)
	    && core->outputs.irq == passo_registers_any_stopped(core);
}

static struct passo_channel_inputs inputs_of(
    const struct passo_core *core, unsigned channel, const struct passo_inputs *inputs)
{
	struct passo_channel_inputs made = {
	    .parameters = &core->parameters,
	    .tables = &core->tables,
	    .bus = &core->link.bus,
	    .run = (core->registers.run >> channel & 1u) != 0u,
	    .wait_sync = (core->registers.wait_sync >> channel & 1u) != 0u,
	    .machine = &core->machine,
	};

	if (core->parameters.encoders != 0u)
		passo_encoders_pins(&made, inputs, channel);
	if (core->parameters.inputs != 0u)
		passo_core_take_pins(core, channel, inputs, &made);
	return made;
}

/* The link side before a run, to go back to. */
struct before {
	struct passo_spi spi;
	struct passo_link link;
	struct passo_inputs inputs;
	uint64_t clock;
	uint32_t received;
};

static struct before look_back(const struct passo_core *core, const struct passo_shift *shift)
{
	return (struct before){.spi = core->spi,
	    .link = core->link,
	    .inputs = core->inputs,
	    .clock = shift ? shift->clock : 0u,
	    .received = shift ? *passo_shift_word(shift) : 0u};
}

static void go_back(struct passo_core *core, struct passo_shift *shift, const struct before *before)
{
	core->spi = before->spi;
	core->link = before->link;
	core->inputs = before->inputs;
	core->outputs.spi_miso = core->spi.miso;
	if (shift) {
		shift->clock = before->clock;
		*passo_shift_word(shift) = before->received;
	}
}

/* The first channel with a profile that runs at full rate; the number of channels if there is none. */
static unsigned moving_channel(const struct passo_core *core)
{
	unsigned i = 0;

	while (i < core->parameters.channels && !passo_advance_profile_counts(&core->channel[i]))
		i++;
	return i;
}

/* Clocks for which all is quiet but the link side and the profile of the moving channel. */
static uint64_t rest_quiet(
    const struct passo_core *core, const struct passo_inputs *inputs, unsigned moving, uint64_t limit)
{
	const uint32_t tick = 1u << core->parameters.tick_log2;
	const uint64_t clocks_to_slew = core->slew_tick ? 0u : tick - core->slew_count;
	const struct passo_machine_wires machine_wires = {
	    .tick_log2 = core->parameters.tick_log2,
	    .moving = passo_core_any_moving(core),
	    .slew_tick = core->slew_tick,
	};
	uint64_t clocks = limit;

	if (core->parameters.inputs != 0u)
		clocks = passo_least(
		    clocks, passo_machine_quiet(&core->machine, inputs, &machine_wires, clocks_to_slew));
	for (unsigned i = 0; i < core->parameters.channels && clocks != 0u; i++) {
		const struct passo_channel_inputs channel_inputs = inputs_of(core, i, inputs);
		const struct passo_channel *channel = &core->channel[i];

		/* other moving channels are only skipped within their ticks */
		clocks = passo_least(clocks,
		    i == moving
			? passo_advance_surroundings_quiet(channel, &channel_inputs, clocks_to_slew)
			: passo_advance_channel_quiet(channel, &channel_inputs, clocks_to_slew, clocks));
	}
	return clocks;
}

/* The channels, too, note the register in the address of the bus. */
static void skip_channels(struct passo_core *core, unsigned moving, uint64_t clocks, uint16_t address)
{
	for (unsigned i = 0; i < core->parameters.channels; i++) {
		core->channel[i].written_register = (uint8_t)((uint8_t)address - PASSO_CHANNEL_AXIS_BASE);
		if (i != moving)
			passo_advance_channel_skip(&core->channel[i], clocks);
	}
}

static void skip_rest(struct passo_core *core, uint64_t clocks)
{
	const uint32_t tick = 1u << core->parameters.tick_log2;
	const uint64_t slew_ticks = (core->slew_tick ? 1u : 0u) + (core->slew_count + clocks - 1u) / tick;

	if (core->parameters.inputs != 0u)
		passo_machine_skip(&core->machine, clocks, slew_ticks);
	core->slew_tick = (core->slew_count + clocks - 1u) % tick == tick - 1u;
	core->slew_count = (uint32_t)((core->slew_count + clocks) % tick);
	/* a skipped slew tick may still be in progress */
	for (unsigned i = 0; i < core->parameters.channels; i++)
		if (core->channel[i].motion.state == PASSO_STATE_RUN && core->slew_count <= SLEW_CLOCKS
		    && core->slew_count <= clocks)
			core->channel[i].timescale.after = (uint8_t)core->slew_count;
	core->tables.slot = (uint8_t)((core->tables.slot + clocks) % (2u * core->parameters.channels));
}

/* Whether the link does nothing in a channel: it answers, reads, or writes to another register. */
static bool spares_channels(const struct passo_core *core)
{
	const struct passo_bus *bus = &core->link.bus;
	const unsigned block = (unsigned)bus->address >> 8;

	return !bus->frame && !passo_spi_wires(&core->spi).frame_start
	    && !((bus->check || bus->write) && block >= 1u && block <= core->parameters.channels);
}

/* A clock in which the link acts on the rest of the core. */
static uint64_t clock_bus(
    struct passo_core *core, const struct passo_inputs *inputs, struct passo_shift *shift)
{
	const struct passo_parameters *parameters = &core->parameters;
	const uint16_t address = core->link.bus.address;
	struct passo_inputs pins = *inputs;

	if (parameters->inputs + parameters->encoders + parameters->outputs + parameters->trackers != 0u
	    || !spares_channels(core) || rest_quiet(core, inputs, parameters->channels, 1) == 0u)
		return 0;
	if (shift) {
		passo_shift_pins(shift, &pins, core->spi.miso);
		shift->clock++;
	}
	passo_core_clock_bus(core, &pins);
	skip_channels(core, parameters->channels, 1, address);
	return 1;
}

/* The link side goes first: how far is known only then. If the channel does not follow it goes back. */
static uint64_t advance(struct passo_core *core, const struct passo_inputs *inputs, struct passo_shift *shift,
    uint64_t limit, bool *changed)
{
	const unsigned moving = moving_channel(core);
	const uint16_t address = core->link.bus.address;
	uint64_t clocks;

	if (!pins_quiet(core, inputs))
		return 0;
	if (!passo_advance_link_is_alone(core))
		return clock_bus(core, inputs, shift);
	clocks = rest_quiet(core, inputs, moving, limit);
	if (clocks == 0u)
		return 0;
	const bool rests = !shift && passo_advance_link_rests(core, inputs);
	if (moving == core->parameters.channels) {
		clocks = rests ? clocks : passo_advance_link(core, inputs, shift, clocks);
	} else if (rests) {
		const struct passo_channel_inputs channel_inputs = inputs_of(core, moving, inputs);

		clocks = passo_advance_run(&core->channel[moving], &channel_inputs, clocks, changed);
	} else {
		const struct before before = look_back(core, shift);
		const struct passo_channel_inputs channel_inputs = inputs_of(core, moving, inputs);
		const uint64_t most = passo_advance_link(core, inputs, shift, clocks);

		clocks = passo_advance_run(&core->channel[moving], &channel_inputs, most, changed);
		if (clocks != most) {
			go_back(core, shift, &before);
			passo_advance_link(core, inputs, shift, clocks);
		}
	}
	if (clocks != 0u) {
		skip_channels(core, moving, clocks, address);
		skip_rest(core, clocks);
	}
	return clocks;
}

uint64_t passo_core_advance(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit)
{
	const uint64_t clocks = advance(core, inputs, NULL, limit, NULL);

	if (clocks != 0u)
		core->inputs = *inputs;
	return clocks;
}

uint64_t passo_core_run(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit)
{
	bool changed = false;
	const uint64_t clocks = advance(core, inputs, NULL, limit, &changed);

	if (clocks == 0u) {
		passo_core_clock(core, inputs);
		return 1;
	}
	core->inputs = *inputs;
	if (changed)
		passo_core_gather_outputs(core);
	return clocks;
}

/* Clocks of the present word that are left, or the limit. */
static uint64_t clocks_of_word(const struct passo_shift *shift, uint64_t limit)
{
	const uint64_t bit = 2u * (uint64_t)shift->half_period, word = 32u * bit;
	const uint64_t left = passo_least(word - shift->clock % word, bit * shift->bits - shift->clock);

	return passo_least(limit, left);
}

static void take_pins(struct passo_core *core, struct passo_inputs *inputs)
{
	inputs->spi_sclk = core->inputs.spi_sclk;
	inputs->spi_mosi = core->inputs.spi_mosi;
	core->inputs = *inputs;
}

uint64_t passo_core_shift(
    struct passo_core *core, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit)
{
	const uint64_t clocks = advance(core, inputs, shift, clocks_of_word(shift, limit), NULL);

	if (clocks != 0u)
		take_pins(core, inputs);
	return clocks;
}

uint64_t passo_core_exchange(
    struct passo_core *core, struct passo_inputs *inputs, struct passo_shift *shift, uint64_t limit)
{
	bool changed = false;
	const uint64_t clocks = advance(core, inputs, shift, clocks_of_word(shift, limit), &changed);

	if (clocks == 0u) {
		passo_shift_pins(shift, inputs, core->spi.miso);
		passo_core_clock(core, inputs);
		shift->clock++;
		return 1;
	}
	take_pins(core, inputs);
	if (changed)
		passo_core_gather_outputs(core);
	return clocks;
}
