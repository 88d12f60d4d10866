/* SPDX-License-Identifier: MIT
 * USART1 (TX PA9, RX PA10, 8N1) with interrupts and a ring buffer each way.
 */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

#define UART_BAUD_RESET 115200u

void uart_start(uint32_t baud);

/* Another speed, after everything waiting has been sent. */
void uart_set_baud(uint32_t baud);

/* The next byte received; false if there is none. UART_LOST stands where bytes were lost or damaged (noise,
 * wrong stop bit, overrun of the receiver or of the ring). */
#define UART_LOST '\0'
bool uart_read(char *byte);

/* Queue text for sending; waits while there is no room. */
void uart_write(const char *text);

/* How often that was since the start; wraps. */
uint32_t uart_losses(void);

#endif
