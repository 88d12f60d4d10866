/* SPDX-License-Identifier: MIT
 * Registers of the encoders of a channel. See rtl/passo_encoder_registers.v.
 */
#include "passo_model.h"
#include "passo_words.h"

void passo_encoder_registers_reset(struct passo_encoders *encoders)
{
	encoders->follow_limit = PASSO_CHANNEL_FOLLOW_LIMIT_LIMIT_RESET;
	encoders->filter = PASSO_CHANNEL_ENCODER_FILTER_FILTER_RESET;
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++) {
		encoders->axis[i].ratio = PASSO_ENCODER_RATIO_RESET;
		encoders->axis[i].limit = PASSO_ENCODER_LIMIT_RESET;
	}
}

static void write_axis(struct passo_encoder_axis *axis, unsigned address, uint32_t data)
{
	switch (address) {
	case PASSO_ENCODER_SETUP: {
		const struct passo_encoder_setup setup = passo_unpack_encoder_setup(data);
		axis->inverted = setup.inverted;
		axis->index_inverted = setup.index_inverted;
		axis->index_gated = setup.index_gated;
		axis->stops_soft = setup.stop_soft;
		axis->stops_hard = setup.stop_hard;
		break;
	}
	case PASSO_ENCODER_RATIO:
		axis->ratio = data;
		break;
	case PASSO_ENCODER_LIMIT:
		axis->limit = (uint16_t)data;
		break;
	default:
		break;
	}
}

static void write_register(struct passo_channel *channel, uint8_t address, uint32_t data)
{
	struct passo_encoders *encoders = &channel->encoders;
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_ENCODER_BASE;

	if (address == PASSO_CHANNEL_FOLLOW) {
		const struct passo_channel_follow follow = passo_unpack_channel_follow(data);
		encoders->follow = follow.follow;
		encoders->wait_index = follow.wait_index;
		encoders->source = follow.source;
		encoders->scale = follow.scale;
	} else if (address == PASSO_CHANNEL_FOLLOW_LIMIT) {
		encoders->follow_limit = data;
	} else if (address == PASSO_CHANNEL_ENCODER_FILTER) {
		encoders->filter = (uint8_t)data;
	} else if (in_axes < channel->axes * PASSO_CHANNEL_ENCODER_STRIDE) {
		write_axis(&encoders->axis[in_axes / PASSO_CHANNEL_ENCODER_STRIDE],
		    in_axes % PASSO_CHANNEL_ENCODER_STRIDE, data);
	}
}

void passo_encoder_registers_clock(
    struct passo_channel *channel, const struct passo_bus *bus, const struct passo_channel_wires *wires)
{
	struct passo_encoders *encoders = &channel->encoders;

	if (encoders->writes)
		write_register(channel, encoders->written, bus->data);
	encoders->writes = wires->selected && bus->write;
	encoders->written = wires->bus_address;
}

uint32_t passo_encoder_registers_value(const struct passo_channel *channel, uint8_t address)
{
	const struct passo_encoders *encoders = &channel->encoders;
	const unsigned in_axes = (unsigned)address - PASSO_CHANNEL_ENCODER_BASE;
	const struct passo_encoder_axis *axis =
	    &encoders->axis[in_axes / PASSO_CHANNEL_ENCODER_STRIDE % PASSO_AXES_MAX];

	if (address == PASSO_CHANNEL_FOLLOW_STATE)
		return passo_pack_channel_follow_state(&(struct passo_channel_follow_state){
		    .owed = (uint32_t)encoders->follower.owed & 0xFFFFFFu,
		    .behind = encoders->was_behind,
		    .lost = encoders->was_lost,
		});
	if (in_axes >= channel->axes * PASSO_CHANNEL_ENCODER_STRIDE)
		return 0;
	switch (in_axes % PASSO_CHANNEL_ENCODER_STRIDE) {
	case PASSO_ENCODER_ERROR:
		return (uint32_t)(axis->following.error >> 8);
	case PASSO_ENCODER_GREATEST:
		return passo_pack_encoder_greatest(&(struct passo_encoder_greatest){
		    .greatest = axis->following.greatest, .exceeded = axis->following.exceeded});
	case PASSO_ENCODER_INDEX:
		return passo_pack_encoder_index(&(struct passo_encoder_index){
		    .latch = axis->latch, .indexes = axis->indexes, .illegal = axis->encoder.illegal});
	default:
		return 0;
	}
}
