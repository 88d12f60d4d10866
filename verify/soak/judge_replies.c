/* SPDX-License-Identifier: MIT
 * Checks of replies: state, positions, room and refusals.
 */
#include "judge_state.h"

static void see_quiet(struct judge *judge, unsigned c, enum passo_state state, struct passo_channel_room room)
{
	const struct passo_parameters *parameters = &judge->world->model.parameters;
	struct channel *channel = &judge->channel[c];
	const uint32_t line_places = 1u << parameters->line_queue_log2;
	const uint32_t ramp_places = 1u << parameters->ramp_queue_log2;
	const bool no_lines = room.line_room == line_places;
	const bool no_ramps = room.ramp_room == ramp_places;

	judge->counts->quiets++;
	if ((no_lines || no_ramps || (judge->run >> c & 1u) == 0u) && !channel->silent) {
		channel->silent = "a state that said quiet";
		channel->silent_from = judge->now;
		channel->still = true;
	}
	if (no_ramps && no_lines) {
		channel->plain_ramps = 0;
		channel->ramps_known = true;
	} else if (channel->ramps_known && ramp_places - room.ramp_room > channel->plain_ramps) {
		FAIL(judge, "channel %u: a NOW ramp stayed behind", c);
	}
	if (state != PASSO_STATE_IDLE || !no_lines)
		return;
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		struct axis *axis = &channel->axis[a];

		if (channel->exact && axis->position != axis->owed_from + axis->owed)
			FAIL(judge, "channel %u axis %u: %lld steps of lines were accepted, %lld were made",
			    c, a, (long long)axis->owed, (long long)(axis->position - axis->owed_from));
		axis->owed_from = axis->position;
		axis->owed = 0;
	}
	judge->counts->paths += channel->exact ? 1u : 0u;
	channel->exact = true;
	judge_forget_stop(channel, judge);
}

void judge_state(struct judge *judge, const struct world_fact *fact)
{
	const struct passo_channel_state now = passo_unpack_channel_state(fact->words[0]);
	struct channel *channel = &judge->channel[fact->channel];

	if (now.state == PASSO_STATE_STOPPED) {
		for (unsigned a = 0; a < judge_axes(judge) && !channel->stopped; a++)
			channel->axis[a].budget = STEPS_AFTER_STOP;
		channel->stopped = true;
		channel->exact = false;
	}
	if (now.stopping && channel->last_rate != UINT32_MAX) {
		if (channel->last_rate > channel->slowed)
			FAIL(judge, "channel %u: RATE was %u and is %u after a stop was commanded",
			    fact->channel, channel->slowed, channel->last_rate);
		channel->slowed = channel->last_rate;
	} else {
		channel->slowed = UINT32_MAX;
	}
	channel->last_rate = now.stopping ? fact->words[1] : UINT32_MAX;
	if (judge->world->machine)
		judge_machine_state(judge, now, fact->words[1]);
	if (now.quiet)
		see_quiet(judge, fact->channel, now.state, passo_unpack_channel_room(fact->words[2]));
}

/* A position read from here on was sampled now or later. */
void judge_reads(struct judge *judge, const struct world_fact *fact)
{
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		struct axis *axis = &judge->channel[fact->channel].axis[a];

		axis->lowest = axis->highest = axis->position;
		judge->machine.shafts[a].lowest = judge->machine.shafts[a].highest =
		    judge->machine.shafts[a].count;
	}
}

void judge_position(struct judge *judge, const struct world_fact *fact)
{
	for (unsigned a = 0; a < judge_axes(judge); a++) {
		const struct axis *axis = &judge->channel[fact->channel].axis[a];
		const int64_t position = (int32_t)fact->words[a];

		judge->counts->positions++;
		if (position < axis->lowest || position > axis->highest)
			FAIL(judge, "channel %u axis %u: position %lld after %lld steps", fact->channel, a,
			    (long long)position, (long long)axis->position);
	}
}

/* A refusal as BUSY is wrong if the channel was quiet and nothing has been accepted since. */
void judge_busy(struct judge *judge, const struct world_fact *fact)
{
	const struct channel *channel = &judge->channel[fact->channel];

	if (channel->still && !channel->stopped && judge->now > channel->silent_from
	    && judge_channels(judge) == 1u)
		FAIL(judge, "channel %u: %03x was refused as BUSY although it was quiet", fact->channel,
		    fact->words[0]);
}

/* While nothing can have left the queues, their room is known. */
void judge_status(struct judge *judge, const struct world_fact *fact)
{
	const struct passo_parameters *parameters = &judge->world->model.parameters;
	const struct channel *channel = &judge->channel[fact->channel];
	const struct passo_status status = passo_unpack_status(fact->words[0]);
	const uint32_t lines = (1u << parameters->line_queue_log2) - channel->lines;
	const uint32_t ramps = (1u << parameters->ramp_queue_log2) - channel->ramps;

	if (channel->fresh && (status.line_room > lines || status.ramp_room > ramps))
		FAIL(judge,
		    "channel %u: status says room for %u lines and %u ramps, there is room for %u and %u",
		    fact->channel, status.line_room, status.ramp_room, lines, ramps);
}
