/* SPDX-License-Identifier: MIT
 * Goes through a history: pin rows and facts in order of their clocks.
 */
#include "judge.h"

#include "judge_state.h"

/* Latency of a reset to the pins. */
#define RESET_CLOCKS 4u

static void reset(struct judge *judge)
{
	judge->counts->resets++;
	judge->run = 0;
	for (unsigned c = 0; c < judge_channels(judge); c++) {
		struct channel *channel = &judge->channel[c];

		channel->silent = "a reset";
		channel->silent_from = judge->now + 1u;
		channel->still = false;
		channel->stopped = channel->exact = channel->ramps_known = false;
		channel->fresh = true;
		channel->lines = channel->ramps = 0;
		channel->plain_ramps = 0;
		channel->gated_until = 0;
		channel->rate_slew = PASSO_CHANNEL_RATE_SLEW_RESET;
		channel->slowed = channel->last_rate = UINT32_MAX;
		judge_forget_stop(channel, judge);
		for (unsigned a = 0; a < judge_axes(judge); a++) {
			struct axis *axis = &channel->axis[a];

			axis->enabled = false;
			axis->position = axis->lowest = axis->highest = 0;
			axis->owed = axis->owed_from = 0;
			axis->exact = false;
		}
	}
	judge->enable_unknown_until = judge->now + RESET_CLOCKS;
	if (judge->world->machine)
		judge_machine_reset(judge, false);
}

static void do_fact(struct judge *judge, const struct world_fact *fact, const struct passo_outputs *pins)
{
	switch (fact->kind) {
	case FACT_WRITE:
		judge_write(judge, fact, pins);
		break;
	case FACT_LINE:
		judge_line(judge, fact);
		break;
	case FACT_RAMP:
		judge_ramp(judge, fact);
		break;
	case FACT_BUSY:
		judge_busy(judge, fact);
		break;
	case FACT_STATE:
		judge_state(judge, fact);
		break;
	case FACT_READS:
		judge_reads(judge, fact);
		break;
	case FACT_POSITION:
		judge_position(judge, fact);
		break;
	case FACT_STATUS:
		judge_status(judge, fact);
		break;
	case FACT_RESET:
		reset(judge);
		break;
	case FACT_RESET_DONE:
		if (judge->world->machine)
			judge_machine_reset(judge, true);
		break;
	case FACT_PIN:
		judge_pin(judge, fact);
		break;
	case FACT_FED:
		judge_feed(judge, fact);
		break;
	case FACT_TRIGGER:
		judge_trigger_state(judge, fact);
		break;
	case FACT_LATCH:
		judge_latched(judge, fact);
		break;
	case FACT_COUNTS:
		judge_counts_read(judge, fact);
		break;
	case FACT_FLAGS:
		judge_flags(judge, fact);
		break;
	}
}

static void power_up(struct judge *judge)
{
	const struct passo_parameters *parameters = &judge->world->model.parameters;

	for (unsigned c = 0; c < judge_channels(judge); c++) {
		struct channel *channel = &judge->channel[c];

		for (unsigned a = 0; a < judge_axes(judge); a++) {
			const unsigned bit = c * judge_axes(judge) + a;

			channel->axis[a] = (struct axis){
			    .step_inverted = (parameters->step_reset >> bit & 1u) != 0u,
			    .direction_inverted = (parameters->dir_reset >> bit & 1u) != 0u,
			    .enable_inverted = (parameters->enable_reset >> bit & 1u) != 0u,
			    .step_high = PASSO_AXIS_STEP_TIMING_STEP_HIGH_RESET,
			    .step_low = PASSO_AXIS_STEP_TIMING_STEP_LOW_RESET,
			    .dir_setup = PASSO_AXIS_DIR_TIMING_DIR_SETUP_RESET,
			    .dir_hold = PASSO_AXIS_DIR_TIMING_DIR_HOLD_RESET,
			    .budget = UINT32_MAX,
			};
		}
	}
	if (judge->world->machine)
		judge_machine_power_up(judge);
	reset(judge);
	judge->counts->resets--;
	judge->enable_unknown_until = 0;
}

/* Stable insertion sort: the facts are nearly sorted. */
static void sort_facts(struct world *world)
{
	for (size_t i = 1; i < world->fact_count; i++) {
		const struct world_fact fact = world->facts[i];
		size_t at = i;

		for (; at != 0u && world->facts[at - 1u].clock > fact.clock; at--)
			world->facts[at] = world->facts[at - 1u];
		world->facts[at] = fact;
	}
}

/* What happens in a machine as time passes. */
static void go_on(struct judge *judge)
{
	judge_silence(judge);
	judge_latch(judge);
	judge_turns(judge);
}

/* Processes the pin rows before a clock. */
static void see_rows(struct judge *judge, uint64_t clock)
{
	struct world *world = judge->world;

	while (judge->row < world->row_count && world->rows[judge->row].clock < clock && !world->failed_at) {
		judge->now = world->rows[judge->row].clock;
		if (world->machine)
			go_on(judge);
		judge_pins(judge, &world->rows[judge->row++].pins);
	}
}

void judge_history(struct world *world, struct judge_counts *counts)
{
	struct judge judge = {.world = world, .counts = counts};

	sort_facts(world);
	power_up(&judge);
	const uint64_t until = world->judged_until != 0u ? world->judged_until : UINT64_MAX;

	for (size_t i = 0; i < world->fact_count && !world->failed_at; i++) {
		const struct world_fact *fact = &world->facts[i];

		if (fact->clock >= until)
			break;
		see_rows(&judge, fact->clock);
		const bool same = judge.row < world->row_count && world->rows[judge.row].clock == fact->clock;
		judge.now = fact->clock;
		judge.fact = i;
		if (world->machine)
			go_on(&judge);
		if (!world->failed_at)
			do_fact(&judge, fact, same ? &world->rows[judge.row].pins : &judge.pins);
	}
	see_rows(&judge, until);
}
