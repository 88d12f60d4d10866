/* SPDX-License-Identifier: MIT
 * SPI1 to the core (NSS PA4, SCK PA5, MISO PA6, MOSI PA7) by DMA, and the CRC unit.
 */
#ifndef SPI_H
#define SPI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Mode 0, 18 MHz (16 MHz without the crystal). */
void spi_start(void);

/* A quarter of the CPU's clock, or an eighth. */
void spi_set_fast(bool fast);

/* One chip select: 1 .. 64 words, the most significant bit first. False if the DMA does not finish; the time
 * it may take is bounded. The signature is that of passo_hardware.transfer; context is not used. */
bool spi_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words);

/* Does the CRC unit compute what the software does? If not, passo_crc() goes on in software. */
bool crc_start(void);

#endif
