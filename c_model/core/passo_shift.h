/* SPDX-License-Identifier: MIT
 * Host side of an SPI exchange, mode 0: MOSI changes on the falling edge, both sides sample on the
 * rising edge. Words are sent and received MSB first.
 */
#ifndef PASSO_SHIFT_H
#define PASSO_SHIFT_H

#include "passo_pins.h"

struct passo_shift {
	const uint32_t *mosi;
	uint32_t *miso; /* each bit received is shifted in */
	uint64_t bits;
	uint32_t half_period; /* clocks of each level of SCLK, at least 1 */
	uint64_t clock;       /* since the first bit */
};

/* The word that is being received. */
static inline uint32_t *passo_shift_word(const struct passo_shift *shift)
{
	return &shift->miso[shift->clock / shift->half_period / 64u];
}

/* Whether the clocks of the last bit have passed; its falling edge is still to come. */
static inline bool passo_shift_done(const struct passo_shift *shift)
{
	return shift->clock == 2u * shift->half_period * shift->bits;
}

/* Clocks until SCLK changes. */
static inline uint64_t passo_shift_constant(const struct passo_shift *shift)
{
	return shift->half_period - shift->clock % shift->half_period;
}

/* Sets SCLK and MOSI to a level, of which there are two for each bit. A rising edge samples MISO, which is
 * `miso`. */
static inline void passo_shift_to(
    const struct passo_shift *shift, uint64_t level, bool edge, struct passo_inputs *inputs, bool miso)
{
	const uint64_t bit = level / 2u, word = bit / 32u;

	inputs->spi_sclk = level % 2u != 0u;
	if (!inputs->spi_sclk)
		inputs->spi_mosi = (shift->mosi[word] >> (31u - bit % 32u) & 1u) != 0u;
	else if (edge)
		shift->miso[word] = shift->miso[word] << 1 | (miso ? 1u : 0u);
}

/* The same for the level of the next clock. */
static inline void passo_shift_pins(const struct passo_shift *shift, struct passo_inputs *inputs, bool miso)
{
	const uint64_t level = shift->clock / shift->half_period;

	passo_shift_to(shift, level, shift->clock == level * shift->half_period, inputs, miso);
}

#endif
