/* SPDX-License-Identifier: MIT
 * A host that sends valid and invalid frames to the model, for a build with sanitizers.
 *
 * Exits with 0 if all replies are correct. The moves themselves are checked elsewhere.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo_core.h"
#include "passo_frame.h"

static struct passo_core core;
static uint8_t sequence = 1;
static uint32_t random_state = 1;

static uint32_t random_word(void)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 17;
	random_state ^= random_state << 5;
	return random_state;
}

static void expect(bool good, const char *what)
{
	if (good)
		return;
	fprintf(stderr, "not so: %s\n", what);
	exit(1);
}

/* Runs with these inputs, sometimes with skipping. */
static void run(const struct passo_inputs *inputs, uint64_t clocks)
{
	while (clocks != 0u) {
		const uint64_t jump =
		    (random_word() & 1u) != 0u ? passo_core_advance(&core, inputs, clocks) : 0u;
		if (jump == 0u)
			passo_core_clock(&core, inputs);
		clocks -= jump == 0u ? 1u : jump;
	}
}

static void rest(uint64_t clocks)
{
	const struct passo_inputs inputs = PASSO_INPUTS_IDLE;
	run(&inputs, clocks);
}

/* One chip select of any number of bits. */
static void transfer_bits(const uint32_t *mosi, uint32_t *miso, size_t bits)
{
	struct passo_inputs inputs = PASSO_INPUTS_IDLE;
	struct passo_shift shift = {.mosi = mosi, .miso = miso, .bits = bits, .half_period = 2};

	inputs.spi_cs_n = false;

	run(&inputs, 4);
	while (!passo_shift_done(&shift))
		passo_core_exchange(&core, &inputs, &shift, random_word() % 64u);
	inputs.spi_sclk = false;
	run(&inputs, 4);
	rest(300);
}

static enum passo_verdict send(const uint32_t *frame, size_t count)
{
	uint32_t miso[PASSO_FRAME_WORDS_MAX] = {0};
	enum passo_verdict verdict = PASSO_VERDICT_OK;

	transfer_bits(frame, miso, count * 32);
	const enum passo_reply reply = passo_frame_write_reply(frame, miso, count, &verdict);
	expect(reply == PASSO_REPLY_OK || reply == PASSO_REPLY_REFUSED, "a write is answered");
	return verdict;
}

static enum passo_verdict write_words(uint16_t address, const uint32_t *words, size_t count)
{
	uint32_t frame[PASSO_FRAME_WORDS_MAX];
	return send(frame, passo_frame_write(frame, sequence++, address, words, count));
}

static enum passo_verdict write_word(uint16_t address, uint32_t word)
{
	return write_words(address, &word, 1);
}

static void read_words(uint16_t address, uint32_t *words, size_t count)
{
	uint32_t frame[PASSO_FRAME_WORDS_MAX];
	uint32_t miso[PASSO_FRAME_WORDS_MAX] = {0};
	enum passo_verdict verdict;
	const size_t length = passo_frame_read(frame, sequence++, address, count);

	transfer_bits(frame, miso, length * 32);
	expect(passo_frame_read_reply(frame, miso, length, &verdict) == PASSO_REPLY_OK, "a read is answered");
	memcpy(words, &miso[PASSO_FRAME_DATA], count * sizeof *words);
}

static uint16_t channel_base(unsigned channel)
{
	return (uint16_t)(PASSO_ADDRESS_CHANNEL_BASE + channel * PASSO_ADDRESS_CHANNEL_STRIDE);
}

static enum passo_verdict push_line(unsigned channel, const struct passo_line *line)
{
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX];
	uint32_t frame[PASSO_FRAME_WORDS_MAX];
	const size_t count = passo_line_words(words, line, core.parameters.axes);
	const uint16_t address = (uint16_t)(channel_base(channel) + PASSO_CHANNEL_LINE);

	return send(frame, passo_frame_push(frame, sequence++, address, words, count));
}

static enum passo_verdict push_ramp(unsigned channel, const struct passo_ramp *ramp)
{
	uint32_t words[PASSO_FRAME_PAYLOAD_MAX];
	uint32_t frame[PASSO_FRAME_WORDS_MAX];
	const size_t count = passo_ramp_words(words, ramp);
	const uint16_t address = (uint16_t)(channel_base(channel) + PASSO_CHANNEL_RAMP);

	return send(frame, passo_frame_push(frame, sequence++, address, words, count));
}

static uint32_t state_of(unsigned channel)
{
	uint32_t state;
	read_words((uint16_t)(channel_base(channel) + PASSO_CHANNEL_STATE), &state, 1);
	return state;
}

static struct passo_ramp ramp_of(
    uint64_t velocity, uint32_t ticks, enum passo_shape shape, bool mirror, bool last)
{
	return (struct passo_ramp){.velocity_end = velocity,
	    .ticks = ticks,
	    .shape = shape,
	    .mirror = mirror,
	    .last = last,
	    .progress_step = ticks == 1u ? PASSO_PROGRESS_STEP_MAX : PASSO_ONE_Q48 / ticks};
}

/* Acceleration, cruise and deceleration with a shape on every channel simultaneously, one of them with a
 * hold. */
static void move_every_channel(enum passo_shape shape)
{
	const unsigned channels = core.parameters.channels;
	const unsigned axes = core.parameters.axes;
	const uint64_t velocity = PASSO_ONE_Q48 / 30u;
	const struct passo_ramp ramps[] = {ramp_of(velocity, 100, shape, false, false),
	    ramp_of(velocity, 1, shape, true, false), ramp_of(0, 100, shape, true, true)};
	struct passo_line line = {
	    .last = true, .directions = (uint8_t)(0xAAu & ((1u << axes) - 1u)), .substeps = 400};
	uint32_t position[PASSO_AXES_MAX];

	for (unsigned axis = 0; axis < axes; axis++)
		line.steps[axis] = 400u - 57u * axis;
	for (unsigned i = 0; i < channels; i++) {
		expect(push_line(i, &line) == PASSO_VERDICT_OK, "a line is taken");
		for (size_t k = 0; k < sizeof ramps / sizeof *ramps; k++)
			expect(push_ramp(i, &ramps[k]) == PASSO_VERDICT_OK, "a ramp is taken");
	}
	expect(write_word(PASSO_ADDRESS_RUN, (1u << channels) - 1u) == PASSO_VERDICT_OK, "all are started");
	rest(5000);
	expect(write_word((uint16_t)(channel_base(0) + PASSO_CHANNEL_RATE_TARGET), 0) == PASSO_VERDICT_OK,
	    "one is held");
	rest(60000);
	expect(
	    write_word((uint16_t)(channel_base(0) + PASSO_CHANNEL_RATE_TARGET), 0x10000) == PASSO_VERDICT_OK,
	    "and continues");
	rest(500000);
	for (unsigned i = 0; i < channels; i++) {
		expect(state_of(i) % 8u == PASSO_STATE_IDLE, "the motion has ended");
		read_words((uint16_t)(channel_base(i) + PASSO_CHANNEL_POSITION_BASE), position, axes);
		for (unsigned axis = 0; axis < axes; axis++) {
			const uint32_t way = (axis & 1u) != 0u ? 0u - position[axis] : position[axis];
			expect(way != 0u && way % line.steps[axis] == 0u, "the steps are made");
		}
	}
	expect(write_word(PASSO_ADDRESS_RUN, 0) == PASSO_VERDICT_OK, "all rest");
}

/* Every way in which a motion can end. */
static void fault_every_way(unsigned channel)
{
	const uint16_t base = channel_base(channel);
	const uint64_t half = PASSO_VELOCITY_MAX;
	const struct passo_line line = {.substeps = 5000, .steps = {5000}};
	const struct passo_ramp jump = {.velocity_end = half, .shape = PASSO_SHAPE_COSINE};
	const struct passo_ramp cruise = {
	    .velocity_end = half, .ticks = 500, .progress_step = PASSO_ONE_Q48 / 500};

	for (unsigned way = 0; way < 5; way++) {
		const struct passo_line pushed = {
		    .last = way == 3, .endless = way == 2, .substeps = line.substeps, .steps = {5000}};
		const uint32_t cause[] = {PASSO_CAUSE_STOP, PASSO_CAUSE_ABORT, PASSO_CAUSE_STOP,
		    PASSO_CAUSE_STEP_OVERRUN, PASSO_CAUSE_LINE_UNDERRUN};

		expect(write_word((uint16_t)(base + PASSO_CHANNEL_AXIS_BASE + PASSO_AXIS_STEP_TIMING),
			   way == 3 ? 0x03E803E8u : 0u)
		           == PASSO_VERDICT_OK,
		    "the pins are set");
		expect(write_word(PASSO_ADDRESS_RUN, 0) == PASSO_VERDICT_OK, "nothing starts yet");
		expect(write_word((uint16_t)(base + PASSO_CHANNEL_STOP_SLEW), 0x2000) == PASSO_VERDICT_OK,
		    "stops are short");
		expect(push_line(channel, &pushed) == PASSO_VERDICT_OK, "a line is taken");
		expect(push_ramp(channel, &jump) == PASSO_VERDICT_OK, "a jump is taken");
		expect(push_ramp(channel, &cruise) == PASSO_VERDICT_OK, "a cruise is taken");
		expect(write_word(PASSO_ADDRESS_RUN, 1u << channel) == PASSO_VERDICT_OK, "it starts");
		if (way < 3)
			write_word((uint16_t)(base + PASSO_CHANNEL_COMMAND), way == 1 ? 2 : 1);
		rest(200000);
		expect((state_of(channel) & 0xF7u)
		           == (cause[way] << PASSO_CHANNEL_STATE_CAUSE_LSB | PASSO_STATE_STOPPED),
		    "it has stopped, and says why");
		expect(push_line(channel, &pushed) == PASSO_VERDICT_BUSY,
		    "nothing is taken before it is cleared");
		expect(write_word(
			   (uint16_t)(base + PASSO_CHANNEL_COMMAND), 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB)
		           == PASSO_VERDICT_OK,
		    "it is cleared");
		rest(200000);
	}
	expect(write_word((uint16_t)(base + PASSO_CHANNEL_AXIS_BASE + PASSO_AXIS_STEP_TIMING), 0)
	           == PASSO_VERDICT_OK,
	    "pins");
}

/* Random frames with a valid CRC, and frames of random bits, cut anywhere. */
static void send_rubbish(unsigned count)
{
	uint32_t frame[PASSO_FRAME_WORDS_MAX];
	uint32_t miso[PASSO_FRAME_WORDS_MAX];
	uint32_t payload[PASSO_FRAME_PAYLOAD_MAX];

	for (unsigned i = 0; i < count; i++) {
		const size_t length = 1u + random_word() % PASSO_FRAME_PAYLOAD_MAX;
		const uint16_t address = (uint16_t)(random_word() % 0x1000u);

		for (size_t k = 0; k < length; k++)
			payload[k] = random_word() >> random_word() % 32u;
		memset(miso, 0, sizeof miso);
		if (i % 4u == 0u) {
			transfer_bits(payload, miso, 1u + random_word() % (32u * length));
		} else if (i % 4u == 1u) {
			transfer_bits(
			    frame, miso, 32u * passo_frame_read(frame, sequence++, address, length));
		} else if (i % 4u == 2u) {
			const uint16_t queue =
			    (uint16_t)((address & 0xF00u) | PASSO_CHANNEL_LINE | (address & 1u));
			transfer_bits(
			    frame, miso, 32u * passo_frame_push(frame, sequence++, queue, payload, length));
		} else {
			transfer_bits(frame, miso,
			    32u * passo_frame_write(frame, sequence++, address, payload, length));
		}
	}
}

#define BUILD(channels_, axes_, tick, lines, ramps)                                                          \
	{.channels = (channels_),                                                                            \
	    .axes = (axes_),                                                                                 \
	    .tick_log2 = (tick),                                                                             \
	    .line_queue_log2 = (lines),                                                                      \
	    .ramp_queue_log2 = (ramps)}

int main(void)
{
	const struct passo_parameters builds[] = {
	    BUILD(1, 4, 7, 8, 4), BUILD(2, 2, 7, 2, 3), BUILD(8, 8, 16, 8, 8), BUILD(3, 1, 9, 4, 3)};
	const struct passo_parameters bad[] = {BUILD(0, 4, 7, 8, 4), BUILD(9, 4, 7, 8, 4),
	    BUILD(1, 0, 7, 8, 4), BUILD(1, 9, 7, 8, 4), BUILD(1, 4, 6, 8, 4), BUILD(1, 4, 17, 8, 4),
	    BUILD(1, 4, 7, 1, 4), BUILD(1, 4, 7, 9, 4), BUILD(1, 4, 7, 8, 1), BUILD(1, 4, 7, 8, 9)};

	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
		expect(!passo_core_reset(&core, &bad[i]), "parameters out of range are refused");
	for (size_t i = 0; i < sizeof builds / sizeof *builds; i++) {
		expect(passo_core_reset(&core, &builds[i]), "the core is reset");
		rest(10);
		/* a tick of 2^16 clocks is too long for these */
		if (builds[i].tick_log2 < 10) {
			move_every_channel(PASSO_SHAPE_SIGMOID);
			move_every_channel(PASSO_SHAPE_EASE);
			for (unsigned channel = 0; channel < builds[i].channels && channel < 2u; channel++)
				fault_every_way(channel);
		}
		send_rubbish(200);
		rest(100000);
	}
	puts("ok");
	return 0;
}
