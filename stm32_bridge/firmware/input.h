/* SPDX-License-Identifier: MIT
 * The bytes from the UART, in a ring until the main loop reads them.
 */
#ifndef INPUT_H
#define INPUT_H

#include <stdbool.h>
#include <stdint.h>

/* Gets the next received byte; false if there is none. INPUT_LOST stands for bytes that were lost or corrupt:
 * by the UART, or because the ring was full. */
#define INPUT_LOST '\0'
bool input_read(char *byte);

/* Number of losses since start; wraps. */
uint32_t input_losses(void);

#endif
