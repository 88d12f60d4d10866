/* SPDX-License-Identifier: MIT
 * Causes of resets: power, then software, then the watchdog, then a fault whose handler resets. Feeds the
 * watchdog for 50 ms before it stops doing so. SysTick never stops.
 */
#include "machine.h"

__attribute__((section(".noinit"))) static uint32_t kept[8];
static volatile uint32_t milliseconds;

void systick_handler(void)
{
	milliseconds++;
}

void hard_fault_handler(void)
{
	kept[7] = 0xFA17;
	SCB_AIRCR = 0x05FA0004;
	for (;;)
		;
}

int main(void)
{
	const uint32_t cause = RCC_CSR >> 24;

	if (cause & 1u << 3)
		kept[0] = 0;
	kept[++kept[0]] = cause;
	RCC_CSR = 1u << 24;
	SYSTICK_LOAD = 8000 - 1;
	SYSTICK_VAL = 0;
	SYSTICK_CTRL = 7;
	if (kept[0] == 1)
		SCB_AIRCR = 0x05FA0004;
	if (kept[0] == 2) {
		IWDG(0) = 0x5555;
		IWDG(4) = 2;      /* 16 */
		IWDG(8) = 25 - 1; /* 10 ms */
		while (IWDG(12))
			;
		IWDG(0) = 0xCCCC;
		while (milliseconds < 50) {
			sleep();
			IWDG(0) = 0xAAAA;
		}
		for (;;)
			sleep();
	}
	if (kept[0] == 3)
		*(volatile uint32_t *)0x30000000 = 1;
	return 0;
}
