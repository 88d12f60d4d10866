/* SPDX-License-Identifier: MIT
 * CRC unit, and edges of PB0 as interrupts.
 */
#include "machine.h"

static uint32_t edges;

void exti0_handler(void)
{
	EXTI(0x14) = 1;
	note(0x100 | (GPIO(1, 8) & 1));
	edges++;
}

int main(void)
{
	RCC_AHBENR |= 1u << 6;
	CRC(8) = 1;
	CRC(0) = 0x12345678;
	note(CRC(0));
	CRC(0) = 0x9ABCDEF0;
	note(CRC(0));
	CRC(8) = 1;
	note(CRC(0));

	RCC_APB2ENR |= 1u << 3 | 1;
	GPIO(1, 0) = 0x44444448; /* pulled down */
	AFIO_EXTICR1 = 1;
	EXTI(0) = 1;
	EXTI(8) = 1; /* rising */
	NVIC_ISER(0) = 1u << 6;
	while (edges < 2)
		sleep();
	EXTI(12) = 1; /* falling as well */
	while (edges < 4)
		sleep();
	return 0;
}
