/* SPDX-License-Identifier: MIT
 * Declares what the libopencm3 example uses, so that it can be compiled here.
 */
#include <stdbool.h>
#include <stdint.h>

bool dwt_enable_cycle_counter(void);
uint32_t dwt_read_cycle_counter(void);
