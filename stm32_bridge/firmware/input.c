/* SPDX-License-Identifier: MIT */
#include "input.h"

#include "ring.h"
#include "uart.h"

static struct ring received;
static volatile uint32_t losses;
static bool lost; /* a mark is due in the ring */

void uart_lost(void)
{
	losses++;
	lost = true;
}

/* Puts a byte into the ring, after a pending INPUT_LOST. */
void uart_received(char byte)
{
	if (lost) {
		if (!ring_put(&received, (uint8_t)INPUT_LOST))
			return;
		lost = false;
	}
	if (!ring_put(&received, (uint8_t)byte))
		uart_lost();
}

bool input_read(char *byte)
{
	uint8_t value;

	if (!ring_get(&received, &value))
		return false;
	*byte = (char)value;
	return true;
}

uint32_t input_losses(void)
{
	return losses;
}
