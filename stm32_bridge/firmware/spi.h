/* SPDX-License-Identifier: MIT
 * SPI1 to the core (NSS PA4, SCK PA5, MISO PA6, MOSI PA7) by DMA, and the CRC unit.
 */
#ifndef SPI_H
#define SPI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_error.h"

/* Starts SPI1 in mode 0 at 18 MHz (16 MHz without the crystal). */
void spi_start(void);

/* Sets SCLK to a quarter of the CPU clock, or to an eighth. */
void spi_set_fast(bool fast);
#define SPI_FAST_HZ 72000000u /* clock of the core from which it can be: four clocks to one of SPI */

/* One chip select: exchanges 5 .. 64 words, most significant bit first. They implement `transfer`, `start`
 * and `finish` of struct passo_hardware; context is not used. An exchange that takes longer than some
 * milliseconds fails. */
bool spi_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words);
bool spi_begin(void *context, const uint32_t *send, uint32_t *receive, size_t words);
enum passo_error spi_finish(void *context);

/* Tests the CRC unit against software. Returns whether it works; if not, passo_crc() uses software. */
bool crc_start(void);

#endif
