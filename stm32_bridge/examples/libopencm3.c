/* SPDX-License-Identifier: MIT
 * Hardware functions of the driver for libopencm3: SPI1 (mode 0, 8 bits, MSB first), chip select on PA4, the
 * cycle counter as clock.
 */
#include <libopencm3/cm3/dwt.h>
#include <libopencm3/stm32/gpio.h>
#include <libopencm3/stm32/spi.h>

#include "passo.h"

#define CYCLES_PER_MICROSECOND 72u

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	(void)context;
	gpio_clear(GPIOA, GPIO4);
	for (size_t i = 0; i < words; i++) {
		uint32_t word = 0;

		for (unsigned shift = 32; shift != 0u; shift -= 8)
			word =
			    word << 8 | (spi_xfer(SPI1, (uint16_t)(send[i] >> (shift - 8u) & 0xFFu)) & 0xFFu);
		receive[i] = word;
	}
	gpio_set(GPIOA, GPIO4);
	return true;
}

/* Extends the cycle counter: both it and the microseconds wrap at 2^32. */
static uint32_t microseconds(void *context)
{
	static uint32_t cycles, now;
	const uint32_t passed = (dwt_read_cycle_counter() - cycles) / CYCLES_PER_MICROSECOND;

	(void)context;
	cycles += passed * CYCLES_PER_MICROSECOND;
	now += passed;
	return now;
}

enum passo_error open_passo(struct passo *passo, struct passo_host *host)
{
	const struct passo_hardware hardware = {.transfer = transfer, .microseconds = microseconds};
	const struct passo_options options = {.clock_hz = 72000000};

	dwt_enable_cycle_counter();
	return passo_open(passo, host, &hardware, &options);
}
