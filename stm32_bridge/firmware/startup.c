/* SPDX-License-Identifier: MIT
 * Vector table, startup code and fault handler.
 */
#include <stdint.h>
#include <string.h>

#include "board.h"
#include "stm32f103.h"

extern uint32_t stack_top[], data_start[], data_end[], bss_start[], bss_end[];
extern const uint32_t data_load[];

int main(void);
void reset_handler(void);
void fault_handler(void);
void fault_reset(const uint32_t *frame) __attribute__((noreturn, used));

void reset_handler(void)
{
	memcpy(data_start, data_load, (size_t)((char *)data_end - (char *)data_start));
	memset(bss_start, 0, (size_t)((char *)bss_end - (char *)bss_start));
	/* a boot loader may have changed it */
	SCB_VTOR = 0x08000000u;
	main();
	for (;;)
		board_reset();
}

/* Unexpected exceptions: record exception and address, and reset. */
__attribute__((naked)) void fault_handler(void)
{
	__asm volatile("mrs r0, msp\n\tb fault_reset");
}

void fault_reset(const uint32_t *frame)
{
	uint32_t exception;

	__asm volatile("mrs %0, ipsr" : "=r"(exception));
	board_note_fault(exception, frame[6]); /* r0-r3, r12, lr, pc */
	board_reset();
}

#define FAULT (uintptr_t)fault_handler

/* Stack pointer, 15 exceptions of the core, the interrupts of the chip. */
__attribute__((section(".vectors"), used)) static const uintptr_t vectors[16u + IRQ_COUNT] = {
    (uintptr_t)stack_top,
    (uintptr_t)reset_handler,
    FAULT,        /* NMI */
    FAULT,        /* hard fault */
    FAULT,        /* memory management */
    FAULT,        /* bus fault */
    FAULT,        /* usage fault */
    [11] = FAULT, /* supervisor call */
    FAULT,        /* debug monitor */
    [14] = FAULT, /* pendable service */
    (uintptr_t)systick_handler,
    [16u + IRQ_EXTI0] = (uintptr_t)exti0_handler,
    [16u + IRQ_DMA1_CHANNEL5] = (uintptr_t)dma1_channel5_handler,
    [16u + IRQ_USART1] = (uintptr_t)usart1_handler,
};
