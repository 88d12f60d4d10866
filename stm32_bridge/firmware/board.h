/* SPDX-License-Identifier: MIT
 * The Blue Pill (STM32F103C8): clocks, time, LED, watchdog, the core's interrupt line, resets.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

/* Clocks (72 MHz from the crystal; 64 MHz from the internal oscillator if there is none), pins, time.
 * Returns whether the crystal is there. */
bool board_start(void);

/* The clock of the CPU and of SPI1 and USART1. */
uint32_t board_clock_hz(void);

/* Time since the start; both wrap at 2^32. The second one is called as struct passo_hardware has it. */
uint32_t board_milliseconds(void);
uint32_t board_microseconds(void *context);

/* Why the board has started: one word ("power", "pin", "watchdog", "software" ...); after a fault "fault". */
const char *board_reset_cause(void);

/* The exception (3 hard fault, 5 bus fault ...) and the place of the fault that led to this start. */
struct board_fault {
	uint32_t exception, address;
};
struct board_fault board_last_fault(void);

/* Keep for the next start. */
void board_note_fault(uint32_t exception, uint32_t address);

void board_reset(void) __attribute__((noreturn));

/* The watchdog resets the board a second (0.6 to 1.4) after it was last fed. Once started it cannot be
 * stopped. It is fed only while the end of the stack is intact. */
void board_watchdog_start(void);
void board_watchdog_feed(void);

/* LED: a short flash each second, or fast blinking. */
void board_led(bool fault);

/* Level of the core's interrupt line, as struct passo_hardware has it. When it rises board_sleep() ends. */
bool board_core_calls(void *context);

/* Sleep until something interrupts; at most a millisecond. */
void board_sleep(void);

void systick_handler(void);
void exti0_handler(void);
void usart1_handler(void);

#endif
