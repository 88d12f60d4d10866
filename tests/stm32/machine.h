/* SPDX-License-Identifier: MIT
 * What the test programs share: registers, vectors, and results that the test reads out of RAM.
 */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t *)(address))

#define RCC_CR REGISTER(0x40021000)
#define RCC_CFGR REGISTER(0x40021004)
#define RCC_AHBENR REGISTER(0x40021014)
#define RCC_APB2ENR REGISTER(0x40021018)
#define RCC_CSR REGISTER(0x40021024)
#define FLASH_ACR REGISTER(0x40022000)
#define GPIO(port, offset) REGISTER(0x40010800 + 0x400 * (port) + (offset))
#define AFIO_EXTICR1 REGISTER(0x40010008)
#define EXTI(offset) REGISTER(0x40010400 + (offset))
#define SPI(offset) REGISTER(0x40013000 + (offset))
#define USART(offset) REGISTER(0x40013800 + (offset))
#define DMA(offset) REGISTER(0x40020000 + (offset))
#define DMA_CHANNEL(n, offset) REGISTER(0x40020008 + 20 * ((n) - 1) + (offset))
#define CRC(offset) REGISTER(0x40023000 + (offset))
#define IWDG(offset) REGISTER(0x40003000 + (offset))
#define SYSTICK_CTRL REGISTER(0xE000E010)
#define SYSTICK_LOAD REGISTER(0xE000E014)
#define SYSTICK_VAL REGISTER(0xE000E018)
#define NVIC_ISER(n) REGISTER(0xE000E100 + 4 * (n))
#define NVIC_ISPR(n) REGISTER(0xE000E200 + 4 * (n))
#define NVIC_PRIORITY(n) (*(volatile uint8_t *)(0xE000E400 + (n)))
#define SCB_ICSR REGISTER(0xE000ED04)
#define SCB_AIRCR REGISTER(0xE000ED0C)
#define SCB_SHPR3 REGISTER(0xE000ED20)

#define LOG_SIZE 256
/* What happened, in order; the test reads it. */
extern volatile uint32_t log_length, log_entries[LOG_SIZE];
void note(uint32_t entry);

extern volatile uint32_t finished;

/* 72 MHz from the crystal. */
void use_crystal(void);

void nmi_handler(void);
void hard_fault_handler(void);
void supervisor_handler(void);
void pend_handler(void);
void systick_handler(void);
void interrupt_0_handler(void);
void interrupt_1_handler(void);
void interrupt_2_handler(void);
void exti0_handler(void);
void spi_handler(void);
void usart_handler(void);

static inline void disable_interrupts(void)
{
	__asm volatile("cpsid i" ::: "memory");
}

static inline void enable_interrupts(void)
{
	__asm volatile("cpsie i" ::: "memory");
}

static inline void sleep(void)
{
	__asm volatile("wfi" ::: "memory");
}

#endif
