/* SPDX-License-Identifier: MIT
 * The crystal, or 64 MHz from the internal oscillator when it does not start; then 100 periods of SysTick.
 */
#include "machine.h"

volatile uint32_t megahertz;
static volatile uint32_t periods;

void systick_handler(void)
{
	periods++;
}

int main(void)
{
	uint32_t patience = 10000;

	RCC_CR |= 1u << 16;
	while (!(RCC_CR & 1u << 17) && --patience)
		;
	FLASH_ACR = 0x12;
	megahertz = patience ? 72 : 64;
	RCC_CFGR = (patience ? 7u << 18 | 1u << 16 : 14u << 18) | 4u << 8;
	RCC_CR |= 1u << 24;
	while (!(RCC_CR & 1u << 25))
		;
	RCC_CFGR |= 2;
	while ((RCC_CFGR & 0xC) != 8)
		;
	SYSTICK_LOAD = megahertz * 1000 - 1;
	SYSTICK_VAL = 0;
	SYSTICK_CTRL = 7;
	note(1);
	while (periods < 100)
		sleep();
	note(SYSTICK_VAL);
	note(2);
	return 0;
}
