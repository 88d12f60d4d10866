/* SPDX-License-Identifier: MIT
 * Replies: facts for the judge, and refusals that must not occur.
 */
#include <string.h>

#include "history_player.h"

/* Maximum age of a position that is read. */
#define POSITION_CLOCKS 140u

static void note_writes(struct player *player, const struct action *action, uint64_t begin)
{
	struct world *world = player->world;

	for (unsigned i = 0; i < action->length; i++) {
		const uint16_t address = (uint16_t)(action->address + i);
		const struct world_fact fact = {.clock = player_executed_at(world, begin, action, i),
		    .kind = FACT_WRITE,
		    .channel = channel_of(address),
		    .words = {address, action->payload[i]}};

		world_add_fact(world, &fact);
	}
}

static void note_pushes(struct player *player, const struct action *action, uint64_t begin)
{
	struct world *world = player->world;
	const bool lines = place_of(action->address) == PASSO_CHANNEL_LINE;
	const unsigned size = lines ? world_line_words(&player->world->model.parameters) : PASSO_RAMP_WORDS;

	for (unsigned i = 0; i + size <= action->length; i += size) {
		/* counts from the first word of the frame, because its effects come later */
		struct world_fact fact = {.clock = player_executed_at(world, begin, action, 0) - 8u,
		    .kind = lines ? FACT_LINE : FACT_RAMP,
		    .channel = channel_of(action->address),
		    .words = {action->payload[i]}};

		for (unsigned a = 0; lines && a + 2u < size; a++)
			fact.words[1u + a] = action->payload[i + 2u + a];
		world_add_fact(world, &fact);
	}
}

static void note_read(struct player *player, const struct action *action, uint64_t begin)
{
	struct world *world = player->world;
	const uint32_t *data = player->miso + PASSO_FRAME_DATA;
	struct world_fact fact = {.channel = channel_of(action->address)};
	const unsigned place = place_of(action->address);

	memcpy(fact.words, data, sizeof *data * (action->length > 9u ? 9u : action->length));
	fact.words[action->length] = (uint32_t)(world->clock - begin);
	if (!in_channel(action->address))
		return;
	if (place == PASSO_CHANNEL_STATE) {
		fact.kind = FACT_STATE;
		fact.clock = begin + world->setup + 2u * 64u * world->half_period + 91u;
		world_add_fact(world, &fact);
	} else if (place == PASSO_CHANNEL_TRIGGER_STATE || place == PASSO_CHANNEL_TRIGGER_POSITION_BASE
	           || place == PASSO_CHANNEL_INPUT_FLAGS) {
		fact.kind = place == PASSO_CHANNEL_TRIGGER_STATE ? FACT_TRIGGER
		          : place == PASSO_CHANNEL_INPUT_FLAGS   ? FACT_FLAGS
		                                                 : FACT_LATCH;
		fact.clock = world->clock;
		world_add_fact(world, &fact);
	} else if (place == PASSO_CHANNEL_POSITION_BASE || place == PASSO_CHANNEL_ENCODER_POSITION_BASE) {
		fact.kind = place == PASSO_CHANNEL_POSITION_BASE ? FACT_POSITION : FACT_COUNTS;
		fact.clock = begin + POSITION_CLOCKS;
		world_add_fact(world, &fact);
		fact.kind = FACT_READS;
		fact.clock = begin - 1u;
		world_add_fact(world, &fact);
	}
}

static void note_status(struct player *player, uint64_t begin)
{
	const uint32_t word = player->miso[0];
	const struct world_fact fact = {.clock = begin,
	    .kind = FACT_STATUS,
	    .channel = passo_unpack_status(word).channel,
	    .words = {word}};

	if (!passo_frame_is_status(word) || fact.channel >= player_channels(player))
		world_fail(player->world, begin, "status word is %08x", word);
	else
		world_add_fact(player->world, &fact);
}

/* Whether a frame may be refused as BUSY: it requires rest, or a channel that is not stopped. */
static bool may_be_busy(const struct action *action)
{
	if (action->operation == PASSO_OPERATION_PUSH || passo_bank_at(action->address) != 0u)
		return true;
	for (unsigned i = 0; i < action->length && in_channel(action->address); i++) {
		const unsigned place = place_of(action->address) + i;

		const struct passo_channel_command command = passo_unpack_channel_command(action->payload[i]);
		if (place == PASSO_CHANNEL_COMMAND && !command.abort && !command.stop
		    && (command.clear || command.zero))
			return true;
		if (in_axis(action->address) && place % PASSO_CHANNEL_AXIS_STRIDE == PASSO_AXIS_PINS)
			return true;
	}
	return false;
}

static void check_refusal(
    struct player *player, const struct action *action, uint64_t begin, enum passo_verdict verdict)
{
	struct world *world = player->world;
	const bool push = action->operation == PASSO_OPERATION_PUSH;
	const bool lines = place_of(action->address) == PASSO_CHANNEL_LINE;
	const struct passo_status status = passo_unpack_status(player->miso[0]);
	const unsigned room = lines ? status.line_room : status.ramp_room;
	const unsigned size = lines ? world_line_words(&player->world->model.parameters) : PASSO_RAMP_WORDS;

	player->counts->refused++;
	if (action->fault == FAULT_CRC && verdict == PASSO_VERDICT_BAD_CRC)
		return;
	if (action->fault == FAULT_VALUE && verdict == PASSO_VERDICT_BAD_VALUE)
		return;
	if (push && verdict == PASSO_VERDICT_QUEUE_FULL
	    && (status.channel != channel_of(action->address) || action->length / size > room))
		return;
	if (verdict == PASSO_VERDICT_BUSY && may_be_busy(action)) {
		const struct world_fact fact = {.clock = player_executed_at(world, begin, action, 0) - 8u,
		    .kind = FACT_BUSY,
		    .channel = channel_of(action->address),
		    .words = {action->address}};

		player->counts->busy++;
		if (action->length == 1u && !push)
			world_add_fact(world, &fact);
		return;
	}
	world_fail(world, world->clock, "%03x was refused with verdict %u", action->address, verdict);
}

void player_note_reply(
    struct player *player, const struct action *action, const uint32_t *mosi, size_t count, uint64_t begin)
{
	struct world *world = player->world;
	const bool reads = action->operation == PASSO_OPERATION_READ;
	enum passo_verdict verdict = PASSO_VERDICT_OK;
	const enum passo_reply reply = reads ? passo_frame_read_reply(mosi, player->miso, count, &verdict)
	                                     : passo_frame_write_reply(mosi, player->miso, count, &verdict);

	note_status(player, begin);
	if (reply == PASSO_REPLY_REFUSED) {
		check_refusal(player, action, begin, verdict);
		return;
	}
	if (reply != PASSO_REPLY_OK) {
		world_fail(world, world->clock, "no sane reply to %03x: %d", action->address, reply);
		return;
	}
	if ((verdict == PASSO_VERDICT_DUPLICATE) != (action->fault == FAULT_REPEATED)
	    || action->fault == FAULT_CRC || action->fault == FAULT_VALUE) {
		world_fail(
		    world, world->clock, "%03x was acknowledged with verdict %u", action->address, verdict);
		return;
	}
	if (verdict == PASSO_VERDICT_DUPLICATE)
		return;
	if (world->machine) {
		const uint64_t from = begin + 64u * world->half_period * (reads ? 1u : action->length + 2u);
		const struct world_fact fact = {
		    .clock = from, .kind = FACT_FED, .words = {(uint32_t)(world->clock - from)}};

		world_add_fact(world, &fact);
	}
	if (reads)
		note_read(player, action, begin);
	else if (action->operation == PASSO_OPERATION_PUSH)
		note_pushes(player, action, begin);
	else
		note_writes(player, action, begin);
}
