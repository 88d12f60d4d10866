/* SPDX-License-Identifier: MIT
 * USART1 (TX PA9, RX PA10, 8N1): interrupts and a ring buffer send, DMA receives.
 */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

#define UART_BAUD_RESET 115200u

void uart_start(uint32_t baud);

/* Waits until all queued text has been sent. */
void uart_finish(void);

/* The same, then changes the baud rate. */
void uart_set_baud(uint32_t baud);

/* Queues text for sending; waits while the ring is full. */
void uart_write(const char *text);

/* Bytes that can be queued without waiting. */
uint32_t uart_room(void);

/* Gets the next received byte; false if there is none. UART_LOST stands for bytes that were lost, because too
 * many had not been read, or corrupt (noise, framing error). */
#define UART_LOST '\0'
bool uart_read(char *byte);

/* Number of lost and corrupt bytes since start; wraps. */
uint32_t uart_losses(void);

#endif
