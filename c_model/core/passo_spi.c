/* SPDX-License-Identifier: MIT
 * SPI slave: converts between bits and half words. See rtl/passo_spi.v.
 */
#include "passo_model.h"

void passo_spi_reset(struct passo_spi *spi)
{
	*spi = (struct passo_spi){.first_word = true, .miso = true};
}

struct passo_spi_wires passo_spi_wires(const struct passo_spi *spi)
{
	const bool selected = (spi->select_sync >> 1 & 1u) != 0u;
	const bool was_selected = (spi->select_sync >> 2 & 1u) != 0u;
	return (struct passo_spi_wires){
	    .frame_start = selected && !was_selected,
	    .frame_end = !selected && was_selected,
	    .half_valid = (spi->toggle_sync >> 1 & 1u) != (spi->toggle_sync >> 2 & 1u),
	};
}

static void rising_sclk(struct passo_spi *spi, bool mosi)
{
	spi->mosi = mosi;
	spi->bit_count = (spi->bit_count + 1u) & 31u;
}

static uint32_t append(uint32_t word, bool bit)
{
	return word << 1 | (bit ? 1u : 0u);
}

static void falling_sclk(struct passo_spi *spi, uint32_t reply_word)
{
	const bool load_next = spi->bit_count == 0u;
	const bool load_first = spi->first_word && spi->bit_count == 1u;
	const uint32_t shift = spi->shift;

	if ((spi->bit_count & 15u) == 0u) {
		const uint32_t received = spi->first_word ? append(shift, spi->mosi_late) : shift;
		spi->half_toggle = !spi->half_toggle;
		spi->half_low = load_next;
		spi->half = (uint16_t)append(received, spi->mosi);
	}
	if (load_next || load_first) {
		spi->miso = (reply_word >> (load_next ? 31 : 30) & 1u) != 0u;
		spi->shift = reply_word & 0x7FFFFFFFu;
	} else {
		spi->miso = (shift >> (spi->first_word ? 29 : 30) & 1u) != 0u;
		spi->shift = append(shift, spi->first_word ? spi->mosi_late : spi->mosi) & 0x7FFFFFFFu;
	}
	spi->mosi_late = spi->mosi;
	if (load_next)
		spi->first_word = false;
}

void passo_spi_clock(
    struct passo_spi *spi, bool sclk_was, bool sclk, bool mosi, bool cs_n, uint32_t reply_word)
{
	if (cs_n) {
		spi->bit_count = 0;
		spi->first_word = true;
		spi->miso = true;
	} else if (sclk && !sclk_was) {
		rising_sclk(spi, mosi);
	} else if (!sclk && sclk_was) {
		falling_sclk(spi, reply_word);
	}
	spi->select_sync = (uint8_t)((spi->select_sync << 1 | (cs_n ? 0 : 1)) & 7);
	spi->toggle_sync = (uint8_t)((spi->toggle_sync << 1 | (spi->half_toggle ? 1 : 0)) & 7);
}
