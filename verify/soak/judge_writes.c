/* SPDX-License-Identifier: MIT
 * Accepted words: what must not happen after them, and from when on.
 */
#include "judge_state.h"

/* Minimum gap between steps, in enabled clocks, from which the rate can be derived. */
#define GAP_MIN 8u

void judge_may_move(struct channel *channel, const struct judge *judge, bool new_motion)
{
	channel->silent = NULL;
	channel->still = false;
	for (unsigned a = 0; new_motion && a < judge_axes(judge); a++)
		channel->axis[a].budget = UINT32_MAX;
}

void judge_forget_stop(struct channel *channel, const struct judge *judge)
{
	channel->stops = false;
	for (unsigned a = 0; a < judge_axes(judge); a++)
		channel->axis[a].gap_least = 0;
}

/* From here on the gaps must not shrink: sets their lower limit from the highest possible present rate. */
static void expect_slowing(struct judge *judge, unsigned c)
{
	struct channel *channel = &judge->channel[c];
	const uint64_t tick = UINT64_C(1) << judge->world->model.parameters.tick_log2;

	for (unsigned a = 0; a < judge_axes(judge) && !channel->stops; a++) {
		struct axis *axis = &channel->axis[a];
		const uint64_t enabled = judge->world->gap_enabled[c][a];

		if (enabled < GAP_MIN || axis->steps[GAPS] == 0u)
			continue;
		uint64_t gap = axis->steps[0] - axis->steps[1];
		for (unsigned i = 1; i < GAPS; i++)
			if (axis->steps[i] - axis->steps[i + 1u] < gap)
				gap = axis->steps[i] - axis->steps[i + 1u];
		/* the rate derived from this gap, UQ48.16, plus what the slew can have added since */
		const uint64_t ticks = (judge->now - axis->steps[GAPS]) / tick + 2u;
		const uint64_t rate = ((enabled + 2u) << 16) / gap + ticks * channel->rate_slew;
		const uint64_t most = rate < PASSO_RATE_ONE ? rate : PASSO_RATE_ONE;
		const uint64_t least = ((enabled - 2u) << 16) / most;

		axis->gap_least = least > 4u ? least - 4u : 0u;
	}
}

static void do_command(struct judge *judge, unsigned c, struct passo_channel_command command)
{
	struct channel *channel = &judge->channel[c];

	if (command.abort) {
		channel->silent = "an abort";
		channel->silent_from =
		    judge->now + (uint64_t)(judge->world->latency->command - judge->world->latency->pins);
		channel->exact = false;
		channel->stopped = true;
		channel->ramps_known = false;
		channel->fresh = false;
		judge->counts->aborts++;
		return;
	}
	if (command.stop) {
		expect_slowing(judge, c);
		channel->stops = true;
		channel->exact = false;
		channel->ramps_known = false;
		channel->fresh = false;
		judge->counts->stops++;
		return;
	}
	if (command.clear) {
		channel->stopped = false;
		channel->exact = false;
		channel->slowed = channel->last_rate = UINT32_MAX;
		judge_forget_stop(channel, judge);
	}
	if (command.zero)
		for (unsigned a = 0; a < judge_axes(judge); a++) {
			struct axis *axis = &channel->axis[a];

			axis->owed_from -= axis->position;
			axis->position = axis->lowest = axis->highest = 0;
		}
}

void judge_gate(struct judge *judge, unsigned c, bool pins)
{
	struct channel *channel = &judge->channel[c];

	judge->counts->gates++;
	if ((judge->pins.running >> c & 1u) != 0u)
		FAIL(judge, "channel %u runs while a frame is executed that needs rest", c);
	channel->gated_until = judge->now + GATE_CLOCKS;
	channel->gated_pins = pins;
}

static void do_run(struct judge *judge, uint32_t value)
{
	judge->run = passo_unpack_run(value).run;
	for (unsigned c = 0; c < judge_channels(judge); c++)
		if ((judge->run >> c & 1u) != 0u) {
			judge_may_move(&judge->channel[c], judge, false);
			judge->channel[c].fresh = false;
		}
}

void judge_write(struct judge *judge, const struct world_fact *fact, const struct passo_outputs *pins)
{
	const uint32_t address = fact->words[0], value = fact->words[1];
	const unsigned c = fact->channel, place = place_of(address);

	if (judge->world->machine)
		judge_machine_write(judge, address, value);
	if (address == PASSO_ADDRESS_RUN)
		do_run(judge, value);
	if (passo_bank_at(address) != 0u)
		for (unsigned i = 0; i < judge_channels(judge); i++)
			judge_gate(judge, i, false);
	if (!in_channel(address))
		return;
	if (place >= PASSO_CHANNEL_AXIS_BASE && place < PASSO_CHANNEL_ENCODER_BASE)
		judge_write_axis(judge, c, place - PASSO_CHANNEL_AXIS_BASE, value, pins);
	else if (place == PASSO_CHANNEL_RATE_SLEW)
		judge->channel[c].rate_slew = value == 0u ? 1u : value;
	else if (place == PASSO_CHANNEL_COMMAND) {
		const struct passo_channel_command command = passo_unpack_channel_command(value);
		if (!command.stop && !command.abort && (command.clear || command.zero))
			judge_gate(judge, c, command.zero);
		do_command(judge, c, command);
		if (judge->world->machine)
			judge_machine_command(judge, command);
	}
}

void judge_line(struct judge *judge, const struct world_fact *fact)
{
	const struct passo_line_control control = passo_unpack_line_control(fact->words[0]);
	struct channel *channel = &judge->channel[fact->channel];

	judge_may_move(channel, judge, true);
	if (judge->world->machine)
		judge_machine_line(judge, fact);
	channel->lines++;
	if (control.endless)
		channel->exact = false;
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		const int64_t steps = fact->words[1u + a];

		channel->axis[a].owed += (control.directions >> a & 1u) != 0u ? -steps : steps;
	}
}

void judge_ramp(struct judge *judge, const struct world_fact *fact)
{
	struct channel *channel = &judge->channel[fact->channel];

	judge_may_move(channel, judge, false);
	channel->ramps++;
	if (!passo_unpack_ramp_control(fact->words[0]).now) {
		channel->plain_ramps++;
		return;
	}
	if (channel->fresh)
		FAIL(
		    judge, "channel %u: a NOW ramp was accepted although there was no motion", fact->channel);
	channel->plain_ramps = 0;
}
