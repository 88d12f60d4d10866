/* SPDX-License-Identifier: MIT
 * Start-up of the test programs: vectors, memories, the record of what happened.
 */
#include "machine.h"

extern uint32_t _load[], _data[], _edata[], _bss[], _ebss[];
int main(void);

volatile uint32_t log_length, log_entries[LOG_SIZE], finished;

void note(uint32_t entry)
{
	if (log_length < LOG_SIZE)
		log_entries[log_length++] = entry;
}

void use_crystal(void)
{
	RCC_CR |= 1u << 16;
	while (!(RCC_CR & 1u << 17))
		;
	FLASH_ACR = 0x12;
	RCC_CFGR = 7u << 18 | 1u << 16 | 4u << 8;
	RCC_CR |= 1u << 24;
	while (!(RCC_CR & 1u << 25))
		;
	RCC_CFGR |= 2;
	while ((RCC_CFGR & 0xC) != 8)
		;
}

void reset_handler(void)
{
	for (uint32_t *from = _load, *to = _data; to < _edata;)
		*to++ = *from++;
	for (uint32_t *to = _bss; to < _ebss;)
		*to++ = 0;
	main();
	finished = 1;
	for (;;)
		sleep();
}

static void unexpected(void)
{
	note(0xDEAD0000 | (SCB_ICSR & 0x1FF));
	finished = 2;
	for (;;)
		;
}

#define WEAK(name) void __attribute__((weak, alias("unexpected"))) name(void)
WEAK(nmi_handler);
WEAK(hard_fault_handler);
WEAK(supervisor_handler);
WEAK(pend_handler);
WEAK(systick_handler);
WEAK(interrupt_0_handler);
WEAK(interrupt_1_handler);
WEAK(interrupt_2_handler);
WEAK(exti0_handler);
WEAK(spi_handler);
WEAK(usart_handler);

typedef void (*vector)(void);
__attribute__((section(".vectors"), used)) static const vector vectors[16 + 43] = {
    [0] = (vector)0x20005000,
    [1] = reset_handler,
    [2] = nmi_handler,
    [3] = hard_fault_handler,
    [11] = supervisor_handler,
    [14] = pend_handler,
    [15] = systick_handler,
    [16 + 0] = interrupt_0_handler,
    [16 + 1] = interrupt_1_handler,
    [16 + 2] = interrupt_2_handler,
    [16 + 6] = exti0_handler,
    [16 + 35] = spi_handler,
    [16 + 37] = usart_handler,
};
