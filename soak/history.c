/* SPDX-License-Identifier: MIT */
#include "history.h"

#include <string.h>

/* How long the motions run, after the last action, while they are looked at for clocks to aim at; and at most
 * without any. */
#define SCOUT_CLOCKS 5000u
/* The model of a position read may be as old. */
#define POSITION_CLOCKS 140u
/* Before and after a reset nothing may be written of which it is not certain whether it counts. */
#define RESET_MARGIN 3u
#define ABORT (1u << PASSO_CHANNEL_COMMAND_ABORT_LSB)
#define STOP (1u << PASSO_CHANNEL_COMMAND_STOP_LSB)
#define CLEAR (1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB)
#define ZERO (1u << PASSO_CHANNEL_COMMAND_ZERO_LSB)
/* Polls until something must have come to an end. */
#define POLLS_MAX 400u
#define LAST_MOVE_STEPS 8u

struct player {
	struct world *world;
	struct history_counts *counts;
	FILE *print;
	uint32_t miso[PASSO_FRAME_WORDS_MAX];
	uint32_t repeat[PASSO_FRAME_WORDS_MAX]; /* the last write that was accepted */
	size_t repeat_count;
	uint64_t repeat_at;
};

static unsigned channels_of(const struct player *player)
{
	return player->world->model.parameters.channels;
}

static unsigned axes_of(const struct player *player)
{
	return player->world->model.parameters.axes;
}

/* ---- what a reply tells ---- */

static bool in_channel(uint16_t address)
{
	return address >= PASSO_ADDRESS_CHANNEL_BASE && address < PASSO_ADDRESS_COSINE_BASE;
}

static bool is_axis(uint16_t address)
{
	return in_channel(address) && (address & 0xFFu) >= PASSO_CHANNEL_AXIS_BASE;
}

static uint8_t channel_of(uint16_t address)
{
	return in_channel(address) ? (uint8_t)((address >> 8) - 1u) : 0u;
}

static uint64_t executed_at(
    const struct world *world, uint64_t begin, const struct action *action, unsigned index)
{
	return begin + (uint64_t)world_executes(world, action->length, index);
}

static void note_writes(struct player *player, const struct action *action, uint64_t begin)
{
	struct world *world = player->world;

	for (unsigned i = 0; i < action->length; i++) {
		const uint16_t address = (uint16_t)(action->address + i);
		const struct world_fact fact = {.clock = executed_at(world, begin, action, i),
		    .kind = FACT_WRITE,
		    .channel = channel_of(address),
		    .words = {address, action->payload[i]}};

		world_add_fact(world, &fact);
	}
}

static void note_pushes(struct player *player, const struct action *action, uint64_t begin)
{
	struct world *world = player->world;
	const bool lines = (action->address & 0xFFu) == PASSO_CHANNEL_LINE;
	const unsigned size = lines ? PASSO_LINE_WORDS(axes_of(player)) : PASSO_RAMP_WORDS;

	for (unsigned i = 0; i + size <= action->length; i += size) {
		/* it counts from the first word of the frame on: what it leads to comes later */
		struct world_fact fact = {.clock = executed_at(world, begin, action, 0) - 8u,
		    .kind = lines ? FACT_LINE : FACT_RAMP,
		    .channel = channel_of(action->address),
		    .words = {action->payload[i]}};

		for (unsigned a = 0; lines && a < axes_of(player); a++)
			fact.words[1u + a] = action->payload[i + 2u + a];
		world_add_fact(world, &fact);
	}
}

static void note_read(struct player *player, const struct action *action, uint64_t begin)
{
	struct world *world = player->world;
	const uint32_t *data = player->miso + PASSO_FRAME_DATA;
	struct world_fact fact = {.channel = channel_of(action->address)};
	const unsigned place = action->address & 0xFFu;

	memcpy(fact.words, data, sizeof *data * (action->length > 9u ? 9u : action->length));
	if (!in_channel(action->address))
		return;
	if (place == PASSO_CHANNEL_STATE) {
		fact.kind = FACT_STATE;
		fact.clock = begin + world->setup + 2u * 64u * world->half_period + 91u;
		world_add_fact(world, &fact);
	} else if (place == PASSO_CHANNEL_POSITION_BASE) {
		fact.kind = FACT_POSITION;
		fact.clock = begin + POSITION_CLOCKS;
		world_add_fact(world, &fact);
		fact.kind = FACT_READS;
		fact.clock = begin - 1u;
		world_add_fact(world, &fact);
	}
}

static void note_status(struct player *player, uint64_t begin)
{
	const uint32_t status = player->miso[0];
	const struct world_fact fact = {
	    .clock = begin, .kind = FACT_STATUS, .channel = (uint8_t)(status >> 24 & 7u), .words = {status}};

	if (status >> 30 != 2u || (status >> 27 & 1u) != 0u || fact.channel >= channels_of(player))
		world_fail(player->world, begin, "status word is %08x", status);
	else
		world_add_fact(player->world, &fact);
}

/* A frame may be refused as BUSY only if it needs rest, or a channel that is not stopped. */
static bool may_be_busy(const struct action *action)
{
	if (action->operation == PASSO_OPERATION_PUSH || action->address >= PASSO_ADDRESS_COSINE_BASE)
		return true;
	for (unsigned i = 0; i < action->length && in_channel(action->address); i++) {
		const unsigned place = (action->address & 0xFFu) + i;

		if (place == PASSO_CHANNEL_COMMAND && (action->payload[i] & (ABORT | STOP)) == 0u
		    && (action->payload[i] & (CLEAR | ZERO)) != 0u)
			return true;
		if (is_axis(action->address) && place % PASSO_CHANNEL_AXIS_STRIDE == PASSO_AXIS_PINS)
			return true;
	}
	return false;
}

static void check_refusal(
    struct player *player, const struct action *action, uint64_t begin, enum passo_verdict verdict)
{
	struct world *world = player->world;
	const bool push = action->operation == PASSO_OPERATION_PUSH;
	const bool lines = (action->address & 0xFFu) == PASSO_CHANNEL_LINE;
	const uint32_t status = player->miso[0];
	const uint32_t room = lines ? status >> 8 & 0xFFu : status & 0xFFu;
	const unsigned size = lines ? PASSO_LINE_WORDS(axes_of(player)) : PASSO_RAMP_WORDS;

	player->counts->refused++;
	if (action->fault == FAULT_CRC && verdict == PASSO_VERDICT_BAD_CRC)
		return;
	if (action->fault == FAULT_VALUE && verdict == PASSO_VERDICT_BAD_VALUE)
		return;
	if (push && verdict == PASSO_VERDICT_QUEUE_FULL
	    && ((status >> 24 & 7u) != channel_of(action->address) || action->length / size > room))
		return;
	if (verdict == PASSO_VERDICT_BUSY && may_be_busy(action)) {
		const struct world_fact fact = {.clock = executed_at(world, begin, action, 0) - 8u,
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

static void note_reply(
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
	if (reads)
		note_read(player, action, begin);
	else if (action->operation == PASSO_OPERATION_PUSH)
		note_pushes(player, action, begin);
	else
		note_writes(player, action, begin);
}

/* ---- frames ---- */

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

/* A write of which a reset would leave open whether it counts moves behind the reset; so does a frame that
 * begins while it ends. */
static void avoid_reset(struct player *player, const struct action *action, size_t count)
{
	struct world *world = player->world;
	const uint64_t length = world->setup + 64u * world->half_period * count + 8u;

	for (size_t i = world->pin_next; i < world->pin_count; i++) {
		const struct world_pin *pin = &world->pins[i];

		if (!pin->is_reset)
			continue;
		const bool keeps = pin->level && (is_axis(action->address) || action->fault == FAULT_REPEATED)
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
	const uint32_t ack = player->miso[action->length + 3u];

	if (!player->print)
		return;
	plot_print(action, text, sizeof text);
	fprintf(player->print, "%8llu  %s", (unsigned long long)begin, text);
	if (action->operation == PASSO_OPERATION_READ)
		for (unsigned i = 0; i < action->length; i++)
			fprintf(player->print, " %x", player->miso[PASSO_FRAME_DATA + i]);
	else if (action->fault != FAULT_CUT)
		fprintf(player->print, " -> verdict %u, executed at %llu", ack >> 16 & 0xFFu,
		    (unsigned long long)executed_at(player->world, begin, action, 0));
	if (lost)
		fprintf(player->print, " (reset)");
	if (action->event < EVENT_KINDS)
		fprintf(player->print, "   [%s at %llu %+d, %c]", plot_event_name(action->event),
		    (unsigned long long)action->event_clock, action->offset, action->point);
	fprintf(player->print, "\n");
}

static void play_frame(struct player *player, const struct action *action)
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
		return; /* the core does not know its number any more */
	const uint64_t begin = world->clock;
	if (action->at == begin && action->event < EVENT_KINDS)
		player->counts->hit++;
	const size_t bits = action->fault == FAULT_CUT ? action->bits : 32u * count;
	world_exchange(world, mosi, player->miso, count, bits);
	player->counts->frames++;

	/* what a reset falls into is lost */
	const bool lost = world->reset_at != 0u
	               && (world->reset_until == UINT64_MAX || world->reset_until + RESET_MARGIN > begin);
	print_frame(player, action, begin, lost);
	if (lost) {
		player->repeat_count = 0;
		return;
	}
	if (action->fault == FAULT_CUT)
		return;
	note_reply(player, action, mosi, count, begin);
	const uint32_t ack = player->miso[count - 1u];
	if (action->operation != PASSO_OPERATION_READ && (ack >> 16 & 0xFFu) == PASSO_VERDICT_OK) {
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
	plot_print(action, text, sizeof text);
	fprintf(player->print, "%8llu  %s   [%s at %llu %+d]\n", (unsigned long long)action->at, text,
	    plot_event_name(action->event), (unsigned long long)action->event_clock, action->offset);
}

static void play_actions(struct player *player, const struct plot *plot, size_t scout_from)
{
	struct world *world = player->world;

	for (size_t i = 0; i < plot->count; i++) {
		const struct action *action = &plot->actions[i];
		const bool resets = action->kind == ACTION_RESET;

		if (action->kind == ACTION_FRAME)
			continue;
		print_pin(player, action);
		world_add_pin(world, (struct world_pin){action->at, resets, true});
		world_add_pin(world, (struct world_pin){action->at + action->clocks, resets, false});
	}
	for (size_t i = 0; i < plot->count; i++) {
		if (i == scout_from)
			world->events_from = world->clock;
		if (plot->actions[i].kind == ACTION_FRAME)
			play_frame(player, &plot->actions[i]);
	}
	if (scout_from >= plot->count && scout_from != SIZE_MAX)
		world->events_from = world->clock;
	/* pins that are still to come */
	if (world->pin_next < world->pin_count && world->pins[world->pin_count - 1u].clock > world->clock)
		world_run(world, world->pins[world->pin_count - 1u].clock - world->clock + 8u);
}

/* ---- the end ---- */

static bool send(struct player *player, enum passo_operation operation, uint16_t address,
    const uint32_t *words, unsigned length)
{
	struct action action = {.kind = ACTION_FRAME,
	    .clocks = 2,
	    .operation = (uint16_t)operation,
	    .address = address,
	    .length = (uint16_t)length,
	    .event = EVENT_KINDS};

	if (words)
		memcpy(action.payload, words, length * sizeof *words);
	play_frame(player, &action);
	return operation == PASSO_OPERATION_READ
	    || (player->miso[length + 3u] >> 16 & 0xFFu) == PASSO_VERDICT_OK;
}

static bool write_one(struct player *player, uint16_t address, uint32_t word)
{
	return send(player, PASSO_OPERATION_WRITE, address, &word, 1);
}

static uint16_t at_channel(unsigned channel, unsigned place)
{
	return (uint16_t)(PASSO_ADDRESS_CHANNEL_BASE + channel * PASSO_ADDRESS_CHANNEL_STRIDE + place);
}

static uint32_t state_of(struct player *player, unsigned channel)
{
	send(player, PASSO_OPERATION_READ, at_channel(channel, PASSO_CHANNEL_STATE), NULL, 3);
	return player->miso[PASSO_FRAME_DATA];
}

static bool is_occupied(uint32_t state)
{
	return (state & 7u) != PASSO_STATE_IDLE && (state & 7u) != PASSO_STATE_STOPPED;
}

static bool is_quiet(uint32_t state)
{
	return (state >> PASSO_CHANNEL_STATE_QUIET_LSB & 1u) != 0u;
}

static void command(struct player *player, unsigned channel, uint32_t bits, const char *why)
{
	if (!write_one(player, at_channel(channel, PASSO_CHANNEL_COMMAND), bits))
		world_fail(player->world, player->world->clock, "channel %u: command %x was refused %s",
		    channel, bits, why);
}

static uint32_t empty_room(const struct player *player)
{
	const struct passo_parameters *parameters = &player->world->model.parameters;

	return (1u << parameters->line_queue_log2) << 16 | 1u << parameters->ramp_queue_log2;
}

static void read_positions(struct player *player, unsigned channel)
{
	send(player, PASSO_OPERATION_READ, at_channel(channel, PASSO_CHANNEL_POSITION_BASE), NULL,
	    axes_of(player));
}

/* Whatever goes on: a stop or an abort ends it, in time. */
static uint32_t end_motion(struct player *player, struct plot_random *random, unsigned channel)
{
	struct world *world = player->world;
	uint32_t state = state_of(player, channel);
	const uint32_t slew = 8192;

	for (unsigned i = plot_draw(random, 6); is_occupied(state) && i != 0u; i--)
		state = state_of(player, channel);
	if (is_occupied(state) && plot_chance(random, 60)) {
		write_one(player, at_channel(channel, PASSO_CHANNEL_STOP_SLEW), slew);
		command(player, channel, STOP, "");
		/* the rate needs so many ticks; a read takes longer than five */
		for (unsigned i = 0; i < PASSO_RATE_ONE / slew / 5u + 3u; i++)
			state = state_of(player, channel);
		if (is_occupied(state))
			world_fail(world, world->clock,
			    "channel %u: a stop does not end the motion, state %x", channel, state);
	}
	if (is_occupied(state) || plot_chance(random, 20)) {
		command(player, channel, ABORT | (plot_chance(random, 30) ? CLEAR : 0u), "");
		state = state_of(player, channel);
		if ((state & 7u) != PASSO_STATE_STOPPED)
			world_fail(
			    world, world->clock, "channel %u: state %x after an abort", channel, state);
	}
	return state;
}

static uint32_t come_to_rest(struct player *player, struct plot_random *random, unsigned channel)
{
	struct world *world = player->world;
	uint32_t state = end_motion(player, random, channel);

	for (unsigned i = 0; i < POLLS_MAX && !is_quiet(state) && !world->failed_at; i++) {
		state = state_of(player, channel);
		if (is_occupied(state)) /* another motion was queued */
			state = end_motion(player, random, channel);
	}
	if (!is_quiet(state))
		world_fail(world, world->clock, "channel %u: never quiet, state %x", channel, state);
	read_positions(player, channel);
	return state;
}

/* Empty queues, IDLE, quiet, position 0, full rate. */
static void start_again(struct player *player, struct plot_random *random, unsigned channel, uint32_t state)
{
	struct world *world = player->world;
	const uint32_t rates[4] = {ZERO, PASSO_RATE_ONE, PASSO_RATE_ONE, PASSO_RATE_ONE};

	if ((state & 7u) == PASSO_STATE_IDLE && plot_chance(random, 50)) {
		command(player, channel, plot_chance(random, 50) ? STOP : ABORT, "");
		state = state_of(player, channel);
	}
	if ((state & 7u) != PASSO_STATE_IDLE)
		command(player, channel, CLEAR, "in STOPPED");
	state = state_of(player, channel);
	for (unsigned i = 0; i < POLLS_MAX && !is_quiet(state); i++)
		state = state_of(player, channel);
	if ((state & 0xF8u) != 1u << PASSO_CHANNEL_STATE_QUIET_LSB || (state & 7u) != PASSO_STATE_IDLE)
		world_fail(world, world->clock, "channel %u: state %x after CLEAR", channel, state);
	if (player->miso[PASSO_FRAME_DATA + 2u] != empty_room(player)) {
		/* what waits there has no counterpart, and must not go with the last move */
		command(player, channel, ABORT, "");
		command(player, channel, CLEAR, "in STOPPED");
	}
	if (!send(player, PASSO_OPERATION_WRITE, at_channel(channel, PASSO_CHANNEL_COMMAND), rates, 4))
		world_fail(world, world->clock, "channel %u: ZERO was refused at rest", channel);
	read_positions(player, channel);
}

static void last_move(struct player *player, struct plot_random *random, unsigned channel)
{
	struct world *world = player->world;
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX];
	struct passo_line line = {
	    .last = true, .substeps = 2u * LAST_MOVE_STEPS, .directions = (uint8_t)channel};
	/* slow enough for all its steps that wait while DIR is set up */
	const bool slow = plot_chance(random, 20);
	const uint64_t velocity = PASSO_VELOCITY_MAX >> (slow ? 7 : 4);
	const uint32_t ticks = slow ? 33 : 5;
	const struct passo_ramp ramps[2] = {{.velocity_end = velocity},
	    {.last = true, .velocity_end = velocity, .ticks = ticks, .progress_step = PASSO_ONE_Q48 / ticks}};
	uint32_t state = 0;

	for (unsigned a = 0; a < axes_of(player); a++)
		line.steps[a] = LAST_MOVE_STEPS - a;
	size_t length = passo_ramp_words(words, &ramps[0]);
	length += passo_ramp_words(words + length, &ramps[1]);
	const bool ramps_taken = send(
	    player, PASSO_OPERATION_PUSH, at_channel(channel, PASSO_CHANNEL_RAMP), words, (unsigned)length);
	length = passo_line_words(words, &line, (uint8_t)axes_of(player));
	if (!send(player, PASSO_OPERATION_PUSH, at_channel(channel, PASSO_CHANNEL_LINE), words,
		(unsigned)length)
	    || !ramps_taken)
		world_fail(world, world->clock, "channel %u: the last move was refused", channel);
	for (unsigned a = 0; a < axes_of(player); a++) {
		/* from the change of the polarity to the first step it is less than this set-up */
		const uint32_t frames = 5u * 64u * world->half_period + world->setup;
		const uint32_t dir_setup = slow && a + 1u == axes_of(player) ? frames + 400u : 3u;
		const uint32_t timings[2] = {0x40004u, dir_setup << 16 | 3u};
		const unsigned place = PASSO_CHANNEL_AXIS_BASE + a * PASSO_CHANNEL_AXIS_STRIDE;

		send(player, PASSO_OPERATION_WRITE, at_channel(channel, place + PASSO_AXIS_STEP_TIMING),
		    timings, 2);
		if (!write_one(player, at_channel(channel, place), plot_draw(random, 16) << 1))
			world_fail(world, world->clock, "channel %u: PINS were refused at rest", channel);
	}
	write_one(player, PASSO_ADDRESS_RUN, 1u << channel);
	for (unsigned i = 0; i < POLLS_MAX && !(state != 0u && is_quiet(state)); i++)
		state = state_of(player, channel);
	if ((state & 7u) != PASSO_STATE_IDLE)
		world_fail(world, world->clock, "channel %u: state %x after the last move", channel, state);
	read_positions(player, channel);
	for (unsigned a = 0; a < axes_of(player); a++) {
		const int32_t steps = (int32_t)line.steps[a];
		const int32_t wanted = (line.directions >> a & 1u) != 0u ? -steps : steps;

		if ((int32_t)player->miso[PASSO_FRAME_DATA + a] != wanted)
			world_fail(world, world->clock,
			    "channel %u axis %u: the last move ended at %d instead of %d", channel, a,
			    (int32_t)player->miso[PASSO_FRAME_DATA + a], wanted);
	}
}

static void end(struct player *player, struct plot_random *random, bool brief)
{
	struct world *world = player->world;
	uint32_t states[PASSO_CHANNELS_MAX] = {0};

	if (plot_chance(random, 8)) { /* a reset leads there, too */
		world_add_pin(world, (struct world_pin){world->clock + 3u, true, true});
		world_add_pin(world, (struct world_pin){world->clock + 5u, true, false});
		world_run(world, 20);
	}
	for (unsigned c = 0; c < channels_of(player) && !world->failed_at; c++)
		states[c] = come_to_rest(player, random, c);
	if (brief)
		return;
	write_one(player, PASSO_ADDRESS_RUN, 0);
	for (unsigned c = 0; c < channels_of(player) && !world->failed_at; c++)
		start_again(player, random, c, states[c]);
	for (unsigned c = 0; c < channels_of(player) && !world->failed_at; c++)
		last_move(player, random, c);
	world_run(world, 300);
}

/* ---- aiming ---- */

#define BIT(event) (1u << EVENT_##event)

/* What each disturbance is aimed at most of the time. */
static const uint32_t wanted_events[PLOT_KINDS] = {
    [PLOT_STOP] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(RAMP) | BIT(LINE),
    [PLOT_ABORT] = BIT(STEP) | BIT(DIR) | BIT(WAITS) | BIT(STATE) | BIT(STOPPING) | BIT(LINE),
    [PLOT_CLEAR] = BIT(GAP) | BIT(STATE) | BIT(WAITS) | BIT(STOPPING),
    [PLOT_ZERO] = BIT(GAP) | BIT(STATE) | BIT(WAITS) | BIT(QUIET),
    [PLOT_COMMAND] = BIT(GAP) | BIT(STATE) | BIT(QUIET),
    [PLOT_RATE] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(STOPPING),
    [PLOT_RATES] = BIT(SLEW) | BIT(RATE) | BIT(STATE) | BIT(STOPPING),
    [PLOT_SLEW] = BIT(SLEW) | BIT(RATE) | BIT(STOPPING),
    [PLOT_DRAIN] = BIT(STATE),
    [PLOT_PINS] = BIT(GAP) | BIT(QUIET) | BIT(STATE) | BIT(DIR) | BIT(STEP),
    [PLOT_ENABLE] = BIT(STATE) | BIT(STEP),
    [PLOT_TIMING] = BIT(STEP) | BIT(DIR) | BIT(WAITS),
    [PLOT_RUN] = BIT(STATE) | BIT(LINE) | BIT(RAMP),
    [PLOT_SYNC] = BIT(STATE),
    [PLOT_RESET] = BIT(STEP) | BIT(DIR) | BIT(WAITS) | BIT(STATE) | BIT(TICK),
    [PLOT_NOW] = BIT(GAP) | BIT(RAMP) | BIT(TICK) | BIT(STATE) | BIT(STOPPING),
    [PLOT_MOTION] = BIT(LINE) | BIT(RAMP) | BIT(STATE) | BIT(STOPPING),
    [PLOT_TABLE] = BIT(GAP) | BIT(STATE),
    [PLOT_READ] = BIT(STEP) | BIT(STATE) | BIT(QUIET),
    [PLOT_BAD] = BIT(STATE) | BIT(STEP),
};

/* One of the events, all kinds among those wanted alike. */
static const struct world_event *choose_event(
    const struct world *scout, struct plot_random *random, uint32_t wanted)
{
	uint32_t count[EVENT_KINDS] = {0}, kinds = 0, kind = 0;

	for (size_t i = 0; i < scout->event_count; i++)
		count[scout->events[i].kind]++;
	for (unsigned i = 0; i < EVENT_KINDS; i++)
		kinds += (wanted >> i & 1u) != 0u && count[i] != 0u ? 1u : 0u;
	if (kinds == 0u)
		return NULL;
	for (uint32_t drawn = plot_draw(random, kinds);; kind++)
		if ((wanted >> kind & 1u) != 0u && count[kind] != 0u && drawn-- == 0u)
			break;
	uint32_t drawn = plot_draw(random, count[kind]);
	for (size_t i = 0;; i++)
		if (scout->events[i].kind == kind && drawn-- == 0u)
			return &scout->events[i];
}

/* What is allowed in some states only. */
static bool kind_is_gated(enum plot_kind kind)
{
	return kind == PLOT_CLEAR || kind == PLOT_ZERO || kind == PLOT_COMMAND || kind == PLOT_PINS
	    || kind == PLOT_TABLE || kind == PLOT_NOW;
}

/* From the moment of an action that is to fall on the event, to its beginning. */
static int64_t lead(
    const struct world *scout, struct plot_random *random, enum plot_kind kind, struct action *action)
{
	const unsigned index = plot_draw(random, action->length);

	if (action->kind != ACTION_FRAME) {
		action->point = 'p';
		return 0;
	}
	if (action->operation == PASSO_OPERATION_READ || plot_chance(random, 8)) {
		action->point = 's';
		return (int64_t)plot_draw(random, 140);
	}
	if (plot_chance(random, kind_is_gated(kind) ? 60 : 20)) {
		action->point = 'c';
		return world_checks(scout, index);
	}
	action->point = 'e';
	return world_executes(scout, action->length, index);
}

static void aim(
    const struct world *scout, struct plot_random *random, enum plot_kind kind, struct action *action)
{
	const uint32_t wanted = plot_chance(random, 80) ? wanted_events[kind] : ~0u;
	const int64_t from = (int64_t)scout->events_from;

	for (unsigned i = 0; i < 6u; i++) {
		const struct world_event *event = choose_event(scout, random, wanted);
		const int32_t range = plot_chance(random, 50) ? 4 : 16;
		const int32_t offset = (int32_t)plot_draw(random, 2u * (uint32_t)range + 1u) - range;

		if (!event)
			break;
		const int64_t at = (int64_t)event->clock + offset - lead(scout, random, kind, action);
		if (at < from + 2)
			continue;
		action->at = (uint64_t)at;
		action->event = event->kind;
		action->event_clock = event->clock;
		action->offset = offset;
		return;
	}
	action->at = (uint64_t)from + plot_draw(random, SCOUT_CLOCKS);
}

/* ---- all of it ---- */

static void open_world(
    struct world *world, const struct plot *plot, const struct world_rtl *rtl, FILE *record)
{
	world_open(world, &plot->parameters, rtl);
	world->record = record;
	world->half_period = plot->half_period;
	world->setup = plot->setup;
	memcpy(world->gap_enabled, plot->gap_enabled, sizeof world->gap_enabled);
	world_run(world, 8);
}

static void add(struct plot *plot, const struct action *action)
{
	if (plot->count < PLOT_ACTIONS_MAX)
		plot->actions[plot->count++] = *action;
}

void history_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    bool brief, FILE *record, FILE *print, struct history_counts *counts)
{
	static struct plot plot;
	static struct world scout;
	struct history_counts ignored = {0};
	struct player player = {.world = &scout, .counts = &ignored};

	scout.latency = world->latency;
	plot_begin(&plot, seed, number);
	const unsigned disturbances = 1u + plot_draw(&plot.random, 3);
	for (unsigned i = 0; i < disturbances; i++) {
		const enum plot_kind kind = i != 0u || !plot.waits        ? plot_kind(&plot)
		                          : plot_chance(&plot.random, 70) ? PLOT_SYNC
		                                                          : PLOT_RUN;
		struct action action = plot_disturbance(&plot, kind);

		open_world(&scout, &plot, NULL, NULL);
		play_actions(&player, &plot, plot.prologue + (i == 0u ? 0u : plot.count));
		world_run(&scout, SCOUT_CLOCKS);
		aim(&scout, &plot.random, kind, &action);
		add(&plot, &action);
		if (action.kind == ACTION_RESET && action.clocks > 4u * RESET_MARGIN) {
			/* a frame that begins within a reset is none */
			struct action within =
			    plot_disturbance(&plot, plot_chance(&plot.random, 50) ? PLOT_ENABLE : PLOT_RUN);

			within.at =
			    action.at + 1u + plot_draw(&plot.random, action.clocks - 2u * RESET_MARGIN);
			within.clocks = 2;
			add(&plot, &within);
		}
		counts->kinds[kind]++;
		counts->aimed += action.event < EVENT_KINDS ? 1u : 0u;
		counts->events[action.event] += action.event < EVENT_KINDS ? 1u : 0u;
	}

	struct plot_random random = plot.random;
	player = (struct player){.world = world, .counts = counts, .print = print};
	open_world(world, &plot, rtl, record);
	play_actions(&player, &plot, SIZE_MAX);
	end(&player, &random, brief);
	world_end_record(world);
	counts->clocks += world->clock;
	if (!world->failed_at)
		judge_history(world, &counts->judge);
	world_close(world);
}
