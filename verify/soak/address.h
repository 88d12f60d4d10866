/* SPDX-License-Identifier: MIT
 * Addresses of the registers of channels and axes.
 */
#ifndef SOAK_ADDRESS_H
#define SOAK_ADDRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_registers.h"
#include "passo_shapes.h"

static inline uint16_t channel_address(unsigned channel, unsigned place)
{
	return (uint16_t)(PASSO_ADDRESS_CHANNEL_BASE + channel * PASSO_ADDRESS_CHANNEL_STRIDE + place);
}

static inline uint16_t axis_address(unsigned channel, unsigned axis, unsigned place)
{
	return channel_address(channel, PASSO_CHANNEL_AXIS_BASE + axis * PASSO_CHANNEL_AXIS_STRIDE + place);
}

static inline bool in_channel(uint32_t address)
{
	return address >= PASSO_ADDRESS_CHANNEL_BASE
	    && address < channel_address(PASSO_ADDRESS_CHANNEL_COUNT, 0);
}

/* Channel of a register; 0 for other registers. */
static inline uint8_t channel_of(uint32_t address)
{
	const uint32_t channel = (address - PASSO_ADDRESS_CHANNEL_BASE) / PASSO_ADDRESS_CHANNEL_STRIDE;

	return in_channel(address) ? (uint8_t)channel : 0u;
}

/* Offset of a register within its channel. */
static inline unsigned place_of(uint32_t address)
{
	return address % PASSO_ADDRESS_CHANNEL_STRIDE;
}

static inline bool in_axis(uint32_t address)
{
	return in_channel(address) && place_of(address) >= PASSO_CHANNEL_AXIS_BASE;
}

#endif
