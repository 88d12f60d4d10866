/* SPDX-License-Identifier: MIT
 * Encoders of a channel, and the follower. See rtl/passo_encoders.v.
 */
#include "passo_least.h"
#include "passo_model.h"
#include "passo_words.h"

static bool pin(uint8_t pins, unsigned axis)
{
	return ((uint32_t)pins >> axis & 1u) != 0u;
}

void passo_encoders_pins(
    struct passo_channel_inputs *inputs, const struct passo_inputs *pins, unsigned channel)
{
	const unsigned first = channel * inputs->parameters->axes;

	if (inputs->parameters->encoders == 0u)
		return;
	inputs->encoder_a = (uint8_t)(pins->encoder_a >> first);
	inputs->encoder_b = (uint8_t)(pins->encoder_b >> first);
	inputs->encoder_index = (uint8_t)(pins->encoder_index >> first);
}

static struct passo_encoder_wires encoder_wires(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, unsigned axis)
{
	const struct passo_encoder_axis *encoder = &channel->encoders.axis[axis];

	return (struct passo_encoder_wires){
	    .a = pin(inputs->encoder_a, axis),
	    .b = pin(inputs->encoder_b, axis),
	    .index = pin(inputs->encoder_index, axis),
	    .filter = channel->encoders.filter,
	    .inverted = encoder->inverted,
	    .index_inverted = encoder->index_inverted,
	    .index_gated = encoder->index_gated,
	    .clear = channel->registers.command_zero || channel->registers.command_clear,
	};
}

static const struct passo_encoder *followed(const struct passo_channel *channel)
{
	static const struct passo_encoder none = {0};
	const unsigned source = channel->encoders.source;

	return source < channel->axes ? &channel->encoders.axis[source].encoder : &none;
}

static struct passo_follower_wires follower_wires(
    const struct passo_channel *channel, const struct passo_channel_wires *wires)
{
	const struct passo_encoder *source = followed(channel);

	return (struct passo_follower_wires){
	    .following = wires->follows && (wires->begin_profile || wires->counting),
	    .count_made = source->count_made,
	    .count_down = source->count_down,
	    .slipped = source->slipped,
	    .scale = channel->encoders.scale,
	    .limit = channel->encoders.follow_limit,
	    .enable = channel->timescale.enable && wires->counting,
	    .stall = wires->stall,
	};
}

void passo_encoders_reset(struct passo_encoders *encoders, bool present)
{
	*encoders = (struct passo_encoders){.present = present};
	passo_encoder_registers_reset(encoders);
	passo_follower_reset(&encoders->follower);
	passo_positions_reset(&encoders->positions);
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		passo_encoder_reset(&encoders->axis[i].encoder);
}

void passo_encoders_restart(struct passo_encoders *encoders, const struct passo_encoders *before,
    const struct passo_channel_inputs *inputs)
{
	passo_encoders_reset(encoders, before->present);
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		const struct passo_encoder_wires pins = {
		    .a = pin(inputs->encoder_a, i),
		    .b = pin(inputs->encoder_b, i),
		    .index = pin(inputs->encoder_index, i),
		};

		encoders->axis[i].encoder = before->axis[i].encoder;
		passo_encoder_clock(&encoders->axis[i].encoder, &pins);
		passo_encoder_restart(&encoders->axis[i].encoder, &before->axis[i].encoder);
	}
}

void passo_encoders_wires(const struct passo_channel *channel, struct passo_channel_wires *wires)
{
	const struct passo_encoders *encoders = &channel->encoders;
	const bool follow = encoders->follow;

	wires->may_begin = !passo_encoders_await_index(channel) || followed(channel)->index_event;
	wires->follows = follow && !wires->drain;
	wires->too_far = encoders->stop_hard && wires->occupied;
	wires->lags = encoders->stop_soft && wires->occupied;
}

bool passo_encoders_await_index(const struct passo_channel *channel)
{
	return channel->encoders.follow && channel->encoders.wait_index;
}

bool passo_encoders_wait(const struct passo_channel *channel)
{
	const struct passo_encoders *encoders = &channel->encoders;

	return encoders->follow && channel->motion.state != PASSO_STATE_DRAIN && !encoders->follower.due;
}

uint8_t passo_encoders_index(const struct passo_channel *channel)
{
	uint8_t active = 0;

	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_encoder_axis *axis = &channel->encoders.axis[i];
		const struct passo_encoder *encoder = &axis->encoder;
		const bool gate = !axis->index_gated || (encoder->a.sync & encoder->b.sync & 2u) != 0u;
		const bool high = (encoder->index.sync & 2u) != 0u;
		active |= (uint8_t)((gate && high != axis->index_inverted ? 1u : 0u) << i);
	}
	return channel->encoders.present ? active : 0u;
}

bool passo_encoders_advance(const struct passo_channel *channel, const struct passo_channel_wires *wires)
{
	const struct passo_follower_wires follower = follower_wires(channel, wires);

	return passo_follower_advance(&channel->encoders.follower, &follower);
}

static void clock_axis(struct passo_channel *channel, const struct passo_channel_inputs *inputs, unsigned i)
{
	struct passo_encoder_axis *axis = &channel->encoders.axis[i];
	const struct passo_encoder_wires pins = encoder_wires(channel, inputs, i);
	const uint8_t ratio =
	    (uint8_t)(PASSO_CHANNEL_ENCODER_BASE + i * PASSO_CHANNEL_ENCODER_STRIDE + PASSO_ENCODER_RATIO);
	const bool zero = channel->registers.command_zero;
	const struct passo_following_wires following = {
	    .zero = zero || (channel->encoders.writes && channel->encoders.written == ratio),
	    .clear = channel->registers.command_clear,
	    .step_made = channel->axis[i].step_made,
	    .step_direction = channel->axis[i].dir,
	    .count_made = axis->encoder.count_made,
	    .count_down = axis->encoder.count_down,
	    .ratio = axis->ratio,
	    .limit = axis->limit,
	};

	passo_following_clock(&axis->following, &following);
	if (axis->index_event_q) {
		axis->latch = (uint16_t)axis->count;
		axis->indexes++;
	}
	axis->index_event_q = axis->encoder.index_event;
	if (axis->encoder.count_made)
		axis->count += axis->encoder.count_down ? 0xFFFFFFFFu : 1u;
	if (zero) {
		axis->count = 0;
		axis->latch = 0;
		axis->indexes = 0;
		axis->index_event_q = false;
	}
	passo_encoder_clock(&axis->encoder, &pins);
}

void passo_encoders_clock(struct passo_channel *channel, const struct passo_channel_inputs *inputs,
    const struct passo_channel_wires *wires)
{
	struct passo_encoders *encoders = &channel->encoders;
	const struct passo_follower_wires follower = follower_wires(channel, wires);
	uint32_t counts[PASSO_AXES_MAX];
	bool soft = encoders->follower.lost;
	bool hard = false;

	if (!encoders->present)
		return;
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		counts[i] = encoders->axis[i].count;
	passo_positions_clock(&encoders->positions, counts, channel->registers.command_zero, inputs->snapshot,
	    wires->requests.latch);
	encoders->was_behind = (encoders->was_behind && !wires->prepare) || encoders->follower.behind;
	encoders->was_lost = (encoders->was_lost && !wires->prepare) || encoders->follower.lost;
	passo_follower_clock(&encoders->follower, &follower);
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_encoder_axis *axis = &encoders->axis[i];
		soft = soft || (axis->following.exceeded && axis->stops_soft);
		hard = hard || (axis->following.exceeded && axis->stops_hard);
		clock_axis(channel, inputs, i);
	}
	encoders->stop_soft = soft;
	encoders->stop_hard = hard;
	passo_encoder_registers_clock(channel, inputs->bus, wires);
}

/* Of the follower in quiet time: in RUN it follows; before, it is reset on each clock. */
static struct passo_follower_wires quiet_wires(const struct passo_channel *channel)
{
	const bool runs = channel->motion.state == PASSO_STATE_RUN;
	const struct passo_channel_wires wires = {.follows = channel->encoders.follow, .counting = runs};

	return follower_wires(channel, &wires);
}

uint64_t passo_encoders_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_encoders *encoders = &channel->encoders;
	bool soft = encoders->follower.lost;
	bool hard = false;

	if (!encoders->present)
		return UINT64_MAX;
	if (encoders->writes || encoders->written != (uint8_t)inputs->bus->address
	    || encoders->positions.snapshot_waits || encoders->positions.latch_waits
	    || (encoders->follower.behind && !encoders->was_behind))
		return 0;
	const struct passo_follower_wires follower = quiet_wires(channel);
	uint64_t clocks = passo_follower_quiet(&encoders->follower, &follower);
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_encoder_axis *axis = &encoders->axis[i];
		const struct passo_encoder_wires pins = encoder_wires(channel, inputs, i);
		const struct passo_following_wires following = {
		    .step_made = channel->axis[i].step_made, .ratio = axis->ratio, .limit = axis->limit};

		if (!passo_following_quiet(&axis->following, &following) || axis->index_event_q)
			return 0;
		clocks = passo_least(clocks, passo_encoder_quiet(&axis->encoder, &pins));
		soft = soft || (axis->following.exceeded && axis->stops_soft);
		hard = hard || (axis->following.exceeded && axis->stops_hard);
	}
	/* either stops a motion in the next clock */
	if ((soft || hard) && passo_channel_occupied(channel))
		return 0;
	return encoders->stop_soft == soft && encoders->stop_hard == hard ? clocks : 0u;
}

void passo_encoders_skip(struct passo_channel *channel, uint64_t clocks)
{
	struct passo_encoders *encoders = &channel->encoders;

	if (!encoders->present)
		return;
	const struct passo_follower_wires follower = quiet_wires(channel);
	passo_follower_skip(&encoders->follower, &follower, clocks);
	passo_positions_skip(&encoders->positions, clocks);
	for (unsigned i = 0; i < channel->axes; i++)
		passo_encoder_skip(&encoders->axis[i].encoder, clocks);
}
