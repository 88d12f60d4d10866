/* SPDX-License-Identifier: MIT
 * USART1 (TX PA9, RX PA10, 8N1) with interrupts, and a ring buffer for sending.
 */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

#define UART_BAUD_RESET 115200u

void uart_start(uint32_t baud);

/* Changes the baud rate after all queued text has been sent. */
void uart_set_baud(uint32_t baud);

/* Queues text for sending; waits while the ring is full. */
void uart_write(const char *text);

/* Bytes that can be queued without waiting. */
uint32_t uart_room(void);

/* What the program does with a received byte, in the interrupt; and with one that was lost or corrupt (noise,
 * framing error, overrun of the receiver). */
void uart_received(char byte);
void uart_lost(void);

#endif
