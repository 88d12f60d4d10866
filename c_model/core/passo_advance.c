/* SPDX-License-Identifier: MIT
 * Skipping quiet time: passo_core_advance().
 *
 * While a profile runs, a clock is quiet if it only changes counters and sums whose later values can be
 * computed directly: the tick counter, the phase, e of each DDA, the substep count of the line, timers. It is
 * not quiet if a step is made, a line or a tick ends, a ramp is chosen, or an input changes.
 */
#include "passo_advance.h"

#include "passo_registers_core.h"

/* Latency from a slew tick to the change of rate; see passo_timescale_clock(). */
enum { SLEW_CLOCKS = 6 };

static bool link_side_quiet(const struct passo_core *core, const struct passo_inputs *inputs)
{
	const uint8_t selected = inputs->spi_cs_n ? 0 : 7;
	const uint8_t toggled = core->spi.half_toggle ? 7 : 0;
	const uint8_t synced = inputs->sync ? 7 : 0;

	return PASSO_SAME_INPUTS(inputs, &core->inputs) && core->spi.select_sync == selected
	    && core->spi.toggle_sync == toggled && core->sync_q == synced
	    && core->link.status == passo_registers_status(core) && !core->response.claim
	    && core->response.refusal == 0u && core->response.read_data == 0u && !core->response.reads
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

	passo_encoders_pins(&made, inputs, channel);
	passo_core_take_pins(core, channel, inputs, &made);
	return made;
}

uint64_t passo_core_advance(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit)
{
	const uint32_t tick = 1u << core->parameters.tick_log2;
	const uint64_t clocks_to_slew = core->slew_tick ? 0u : tick - core->slew_count;
	const unsigned channels = core->parameters.channels;
	unsigned moving = channels; /* the first moving channel; `channels`: none */
	uint64_t clocks = passo_advance_least(limit, passo_link_quiet(&core->link));

	if (clocks == 0u || inputs->rst || !link_side_quiet(core, inputs))
		return 0;
	if (core->parameters.inputs != 0u)
		clocks = passo_advance_least(
		    clocks, passo_machine_quiet(&core->machine, inputs, passo_core_any_moving(core)));
	if (clocks == 0u)
		return 0;
	for (unsigned i = 0; i < channels; i++) {
		const struct passo_channel_inputs channel_inputs = inputs_of(core, i, inputs);
		if (moving == channels && passo_advance_profile_counts(&core->channel[i])) {
			moving = i;
			continue;
		}
		clocks = passo_advance_least(clocks,
		    passo_advance_channel_quiet(&core->channel[i], &channel_inputs, clocks_to_slew, clocks));
		if (clocks == 0u)
			return 0;
	}
	if (moving != channels) {
		const struct passo_channel_inputs channel_inputs = inputs_of(core, moving, inputs);
		struct passo_channel *channel = &core->channel[moving];
		const uint64_t quiet = passo_advance_least(
		    clocks, passo_advance_surroundings_quiet(channel, &channel_inputs, clocks_to_slew));
		/* other moving channels are only skipped within their ticks */
		uint64_t skipped = passo_advance_skip_ticks(channel, &channel_inputs, quiet);
		if (skipped == 0u) {
			skipped =
			    quiet == 0u ? 0u : passo_advance_profile_quiet(channel, &core->parameters, quiet);
			if (skipped == 0u)
				return 0;
			passo_advance_channel_skip(channel, skipped);
		}
		clocks = skipped;
	}
	for (unsigned i = 0; i < channels; i++)
		if (i != moving)
			passo_advance_channel_skip(&core->channel[i], clocks);

	core->slew_tick = (core->slew_count + clocks - 1u) % tick == tick - 1u;
	core->slew_count = (uint32_t)((core->slew_count + clocks) % tick);
	/* a skipped slew tick may still be in progress */
	for (unsigned i = 0; i < channels; i++)
		if (core->channel[i].motion.state == PASSO_STATE_RUN && core->slew_count <= SLEW_CLOCKS
		    && core->slew_count <= clocks)
			core->channel[i].timescale.after = (uint8_t)core->slew_count;
	if (core->parameters.inputs != 0u)
		passo_machine_skip(&core->machine, clocks);
	passo_link_skip(&core->link, clocks);
	core->tables.slot = (uint8_t)((core->tables.slot + clocks) % (2u * channels));
	return clocks;
}
