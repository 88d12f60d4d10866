/* SPDX-License-Identifier: MIT
 * Frames and pin edges in sequence, kept clear of resets.
 */
#include <string.h>

#include "history_player.h"

static size_t build(struct player *player, const struct action *action, uint32_t *mosi)
{
	struct world *world = player->world;
	size_t count;

	if (action->operation == PASSO_OPERATION_READ)
		return passo_frame_read(mosi, 0, action->address, action->length);
	if (action->fault == FAULT_REPEATED) {
		memcpy(mosi, player->repeat, player->repeat_count * sizeof *mosi);
		return player->repeat_count;
	}
	world->sequence = world->sequence == 255u ? 1u : (uint8_t)(world->sequence + 1u);
	count =
	    action->operation == PASSO_OPERATION_PUSH
		? passo_frame_push(mosi, world->sequence, action->address, action->payload, action->length)
		: passo_frame_write(mosi, world->sequence, action->address, action->payload, action->length);
	if (action->fault == FAULT_CRC)
		mosi[action->length + 1u] ^= 0x40u;
	return count;
}

/* Delays a write whose execution would race with a reset, and a frame that would start at its end, until
 * after the reset. */
static void avoid_reset(struct player *player, const struct action *action, size_t count)
{
	struct world *world = player->world;
	const uint64_t length = world->setup + 64u * world->half_period * count + 8u;

	for (size_t i = world->pin_next; i < world->pin_count; i++) {
		const struct world_pin *pin = &world->pins[i];

		if (pin->input != PASSO_INPUT_RST)
			continue;
		const bool keeps = pin->level && (in_axis(action->address) || action->fault == FAULT_REPEATED)
		                && pin->clock < world->clock + length;
		const bool begins = !pin->level && pin->clock + RESET_MARGIN > world->clock
		                 && pin->clock < world->clock + RESET_MARGIN;
		if (keeps || begins)
			world_run(world, pin->clock + 2u * RESET_MARGIN - world->clock);
	}
	if (world->reset_until != 0u && world->reset_until != UINT64_MAX
	    && world->clock < world->reset_until + RESET_MARGIN)
		world_run(world, world->reset_until + RESET_MARGIN - world->clock);
}

static void print_frame(struct player *player, const struct action *action, uint64_t begin, bool lost)
{
	char text[WORLD_TEXT];
	const struct passo_ack ack = passo_unpack_ack(player->miso[action->length + 3u]);

	if (!player->print)
		return;
	scenario_print(action, text, sizeof text);
	fprintf(player->print, "%8llu  %s", (unsigned long long)begin, text);
	if (action->operation == PASSO_OPERATION_READ)
		for (unsigned i = 0; i < action->length; i++)
			fprintf(player->print, " %x", player->miso[PASSO_FRAME_DATA + i]);
	else if (action->fault != FAULT_CUT)
		fprintf(player->print, " -> verdict %u, executed at %llu", (unsigned)ack.verdict,
		    (unsigned long long)player_executed_at(player->world, begin, action, 0));
	if (lost)
		fprintf(player->print, " (reset)");
	if (action->event < EVENT_KINDS)
		fprintf(player->print, "   [%s at %llu %+d, %c]", scenario_event_name(action->event),
		    (unsigned long long)action->event_clock, action->offset, action->point);
	fprintf(player->print, "\n");
}

void player_frame(struct player *player, const struct action *action)
{
	struct world *world = player->world;
	uint32_t mosi[PASSO_FRAME_WORDS_MAX];

	if (action->fault == FAULT_REPEATED && player->repeat_count == 0u)
		return;
	world_run(world, action->clocks);
	if (world->clock < action->at)
		world_run(world, action->at - world->clock);
	const size_t count = build(player, action, mosi);
	avoid_reset(player, action, count);
	if (action->fault == FAULT_REPEATED && world->reset_at > player->repeat_at)
		return; /* the core has forgotten its sequence number */
	const uint64_t begin = world->clock;
	if (action->at == begin && action->event < EVENT_KINDS)
		player->counts->hit++;
	const size_t bits = action->fault == FAULT_CUT ? action->bits : 32u * count;
	world_exchange(world, mosi, player->miso, count, bits);
	player->counts->frames++;

	/* a frame hit by a reset is lost */
	const bool lost = world->reset_at != 0u
	               && (world->reset_until == UINT64_MAX || world->reset_until + RESET_MARGIN > begin);
	print_frame(player, action, begin, lost);
	if (lost) {
		player->repeat_count = 0;
		return;
	}
	if (action->fault == FAULT_CUT)
		return;
	player_note_reply(player, action, mosi, count, begin);
	const struct passo_ack ack = passo_unpack_ack(player->miso[count - 1u]);
	if (action->operation != PASSO_OPERATION_READ && ack.verdict == PASSO_VERDICT_OK) {
		memcpy(player->repeat, mosi, count * sizeof *mosi);
		player->repeat_count = count;
		player->repeat_at = begin;
	}
}

static void print_pin(struct player *player, const struct action *action)
{
	char text[WORLD_TEXT];

	if (!player->print)
		return;
	scenario_print(action, text, sizeof text);
	fprintf(player->print, "%8llu  %s   [%s at %llu %+d]\n", (unsigned long long)action->at, text,
	    scenario_event_name(action->event), (unsigned long long)action->event_clock, action->offset);
}

/* Schedules the edges of an action. */
static void player_pin(struct world *world, const struct action *action)
{
	struct world_pin pin = {.clock = action->at,
	    .input = action->kind == ACTION_RESET ? PASSO_INPUT_RST : PASSO_INPUT_SYNC,
	    .level = true};

	if (action->kind == ACTION_INPUT)
		pin = (struct world_pin){
		    .clock = action->at, .input = action->input, .mask = action->mask, .turn = action->turn};
	world_add_pin(world, pin);
	for (unsigned i = 1; action->kind == ACTION_INPUT && i < action->edges; i++) {
		pin.clock += action->clocks;
		world_add_pin(world, pin);
	}
	if (action->kind == ACTION_INPUT)
		return;
	pin.clock += action->clocks;
	pin.level = false;
	world_add_pin(world, pin);
}

void player_actions(struct player *player, const struct scenario *scenario, size_t scout_from)
{
	struct world *world = player->world;

	for (size_t i = 0; i < scenario->count; i++) {
		const struct action *action = &scenario->actions[i];
		if (action->kind == ACTION_FRAME)
			continue;
		print_pin(player, action);
		player->counts->hit += action->event < EVENT_KINDS ? 1u : 0u;
		player_pin(world, action);
	}
	for (size_t i = 0; i < scenario->count; i++) {
		if (i == scout_from)
			world->events_from = world->clock;
		if (scenario->actions[i].kind == ACTION_FRAME)
			player_frame(player, &scenario->actions[i]);
	}
	if (scout_from >= scenario->count && scout_from != SIZE_MAX)
		world->events_from = world->clock;
	/* pin edges still to come */
	if (world->pin_next < world->pin_count && world->pins[world->pin_count - 1u].clock > world->clock)
		world_run(world, world->pins[world->pin_count - 1u].clock - world->clock + 8u);
}
