/* SPDX-License-Identifier: MIT
 * Hardware functions of the driver for a CPU in the same FPGA, with passo_wishbone or passo_axi_lite; the
 * cycle counter of the CPU is the clock.
 */
#include "passo.h"

#define PORT_ADDRESS 0x40000000u /* address on your bus */
#define CLOCK_HZ 100000000u      /* of CPU and core */

uint32_t cycle_count(void); /* of your CPU, such as mcycle on RISC-V */

/* See rtl/passo_words.v. An access waits until the previous word has been sent. */
struct port {
	volatile uint32_t select; /* 1: a frame is open */
	volatile uint32_t word;   /* write: the next word to send; read: the word received in exchange */
};

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct port *port = context;

	port->select = 1;
	for (size_t i = 0; i < words; i++) {
		receive[i] = port->word;
		port->word = send[i];
	}
	port->select = 0;
	return true;
}

/* Extends the cycle counter: both it and the microseconds wrap at 2^32. */
static uint32_t microseconds(void *context)
{
	static uint32_t cycles, now;
	const uint32_t passed = (cycle_count() - cycles) / (CLOCK_HZ / 1000000u);

	(void)context;
	cycles += passed * (CLOCK_HZ / 1000000u);
	now += passed;
	return now;
}

enum passo_error open_passo(struct passo *passo, struct passo_host *host)
{
	const struct passo_hardware hardware = {
	    .transfer = transfer, .microseconds = microseconds, .context = (void *)(uintptr_t)PORT_ADDRESS};
	const struct passo_options options = {.clock_hz = CLOCK_HZ};

	return passo_open(passo, host, &hardware, &options);
}
