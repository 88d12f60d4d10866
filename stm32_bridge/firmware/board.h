/* SPDX-License-Identifier: MIT
 * The Blue Pill (STM32F103C8): clocks, time, LED, watchdog, the core's interrupt line, resets.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

/* Flash of the chip in KiB, by its register; and the name of a chip with as much: "STM32F103xB". */
uint32_t board_flash_kilobytes(void);
const char *board_chip(void);

/* Whether the power was off before this start; only before board_start(). */
bool board_was_off(void);

/* Starts clocks (72 MHz from the crystal, or 64 MHz from the internal oscillator without one), pins and time.
 * Returns whether there is a crystal. */
bool board_start(void);

/* Clock of the CPU, SPI1 and USART1. */
uint32_t board_clock_hz(void);

/* Time since start; both wrap at 2^32. The second one fits struct passo_hardware. */
uint32_t board_milliseconds(void);
uint32_t board_microseconds(void *context);

/* Cause of the last reset ("power", "pin", "watchdog", "software", ...), or "fault". */
const char *board_reset_cause(void);

/* Exception number (3 hard fault, 5 bus fault, ...; 0: none) and program counter of the fault that caused the
 * last reset. */
struct board_fault {
	uint32_t exception, address;
};
struct board_fault board_last_fault(void);

/* Records a fault for the next start. */
void board_note_fault(uint32_t exception, uint32_t address);

void board_reset(void) __attribute__((noreturn));

/* The watchdog resets the board one second (0.6 to 1.4) after it was last fed. It cannot be stopped. Feeding
 * works only while the guard word at the end of the stack is intact. */
void board_watchdog_start(void);
void board_watchdog_feed(void);

/* LED: one short flash per second, or fast blinking for a fault. Call it continuously. */
void board_led(bool fault);

/* Level of the core's irq line, for struct passo_hardware. Its rising edge ends board_sleep(). */
bool board_core_calls(void *context);

/* Sleeps until the next interrupt; at most a millisecond. */
void board_sleep(void);

void systick_handler(void);
void exti0_handler(void);
void dma1_channel5_handler(void);
void usart1_handler(void);

#endif
