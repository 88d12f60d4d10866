/* SPDX-License-Identifier: MIT
 * Declares what the libopencm3 example uses, so that it can be compiled here.
 */
#include <stdint.h>

#define GPIOA 0x40010800u
#define GPIO4 0x0010u

void gpio_set(uint32_t port, uint16_t pins);
void gpio_clear(uint32_t port, uint16_t pins);
