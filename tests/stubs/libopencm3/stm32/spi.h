/* SPDX-License-Identifier: MIT
 * Declares what the libopencm3 example uses, so that it can be compiled here.
 */
#include <stdint.h>

#define SPI1 0x40013000u

uint16_t spi_xfer(uint32_t spi, uint16_t data);
