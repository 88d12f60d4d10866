/* SPDX-License-Identifier: MIT
 * SPI by program and by DMA, in words of 8 and 16 bits, at 18 and 9 MHz. What is at the other end inverts the
 * byte before, 0x00 at first.
 */
#include "machine.h"

#define SELECT(level) (GPIO(0, 0x10) = (level) ? 1u << 4 : 1u << 20)

volatile uint8_t bytes_sent[8] = {0x01, 0x02, 0x03, 0x80, 0xFF, 0x00, 0x55, 0xAA}, bytes_received[8];
volatile uint16_t halves_sent[4] = {0x1234, 0x5678, 0x9ABC, 0xDEF0}, halves_received[4];
volatile uint32_t polled, dma_flags, dma_left;

int main(void)
{
	use_crystal();
	RCC_AHBENR |= 1;
	RCC_APB2ENR |= 1u << 2 | 1u << 12;
	SELECT(1);
	GPIO(0, 0) = 0xB4B34444;

	SPI(0) = 1u << 9 | 1u << 8 | 1u << 6 | 2u << 3 | 1u << 2; /* 8 bits, 9 MHz */
	SELECT(0);
	for (uint32_t i = 0; i < 4; i++) {
		SPI(0x0C) = 0x10 + i;
		while (!(SPI(8) & 1))
			;
		polled = polled << 8 | SPI(0x0C);
	}
	while (SPI(8) & 1u << 7)
		;
	SELECT(1);

	SPI(4) = 3;
	SELECT(0);
	DMA_CHANNEL(2, 8) = DMA_CHANNEL(3, 8) = 0x4001300C;
	DMA_CHANNEL(2, 4) = DMA_CHANNEL(3, 4) = 8;
	DMA_CHANNEL(2, 12) = (uint32_t)bytes_received;
	DMA_CHANNEL(3, 12) = (uint32_t)bytes_sent;
	DMA_CHANNEL(2, 0) = 1u << 7 | 1;
	DMA_CHANNEL(3, 0) = 1u << 7 | 1u << 4 | 1;
	while (!(DMA(0) & 1u << 5))
		;
	dma_flags = DMA(0);
	dma_left = DMA_CHANNEL(2, 4);
	while (SPI(8) & 1u << 7)
		;
	SELECT(1);
	DMA_CHANNEL(2, 0) = DMA_CHANNEL(3, 0) = 0;
	DMA(4) = 0xFF0;
	note(DMA(0));

	SPI(0) = 0;
	SPI(0) = 1u << 11 | 1u << 9 | 1u << 8 | 1u << 6 | 1u << 3 | 1u << 2; /* 16 bits, 18 MHz */
	SELECT(0);
	DMA_CHANNEL(2, 4) = DMA_CHANNEL(3, 4) = 4;
	DMA_CHANNEL(2, 12) = (uint32_t)halves_received;
	DMA_CHANNEL(3, 12) = (uint32_t)halves_sent;
	DMA_CHANNEL(2, 0) = 5u << 8 | 1u << 7 | 1;
	DMA_CHANNEL(3, 0) = 5u << 8 | 1u << 7 | 1u << 4 | 1;
	while (!(DMA(0) & 1u << 5))
		;
	while (SPI(8) & 1u << 7)
		;
	SELECT(1);
	note(SPI(8));
	return 0;
}
