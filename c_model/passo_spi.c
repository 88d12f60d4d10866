/* SPDX-License-Identifier: MIT
 * SPI slave: bits to words and back. See rtl/passo_spi.v.
 */
#include "passo_model.h"

void passo_spi_reset(struct passo_spi *spi)
{
	*spi = (struct passo_spi){.first_word = true, .send = 0x80000000u};
}

struct passo_spi_wires passo_spi_wires(const struct passo_spi *spi)
{
	const bool selected = (spi->select_sync >> 1 & 1u) != 0u;
	const bool was_selected = (spi->select_sync >> 2 & 1u) != 0u;
	return (struct passo_spi_wires){
	    .frame_start = selected && !was_selected,
	    .frame_end = !selected && was_selected,
	    .word_valid = (spi->toggle_sync >> 1 & 1u) != (spi->toggle_sync >> 2 & 1u),
	};
}

static void rising_sclk(struct passo_spi *spi, bool mosi)
{
	spi->receive = spi->receive << 1 | (mosi ? 1u : 0u);
	if (spi->bit_count == 31u)
		spi->word = spi->receive;
	spi->bit_count = (spi->bit_count + 1u) & 31u;
}

static void falling_sclk(struct passo_spi *spi, uint32_t reply_word)
{
	if (spi->bit_count == 0u) {
		spi->word_toggle = !spi->word_toggle;
		spi->first_word = false;
		spi->send = reply_word;
	} else if (spi->first_word && spi->bit_count == 1u) {
		spi->send = reply_word << 1;
	} else {
		spi->send <<= 1;
	}
}

void passo_spi_clock(
    struct passo_spi *spi, bool sclk_was, bool sclk, bool mosi, bool cs_n, uint32_t reply_word)
{
	if (cs_n) {
		spi->bit_count = 0;
		spi->first_word = true;
		spi->send = 0x80000000u;
	} else if (sclk && !sclk_was) {
		rising_sclk(spi, mosi);
	} else if (!sclk && sclk_was) {
		falling_sclk(spi, reply_word);
	}
	spi->select_sync = (uint8_t)((spi->select_sync << 1 | (cs_n ? 0 : 1)) & 7);
	spi->toggle_sync = (uint8_t)((spi->toggle_sync << 1 | (spi->word_toggle ? 1 : 0)) & 7);
}
