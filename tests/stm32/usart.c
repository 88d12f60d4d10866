/* SPDX-License-Identifier: MIT
 * Echo by interrupts. After a '!' the program is deaf for 5 ms, so that characters are lost: it answers with
 * the status register it finds then (E and two hexadecimal digits).
 */
#include "machine.h"

static volatile uint8_t queue[64];
static volatile uint32_t head, tail;

static void say(uint8_t character)
{
	queue[head++ % sizeof queue] = character;
	USART(0x0C) |= 1u << 7;
}

void usart_handler(void)
{
	const uint32_t status = USART(0x00);

	if (status & (1u << 5 | 1u << 3))
		say((uint8_t)USART(0x04));
	if (USART(0x0C) & status & 1u << 7) {
		if (tail != head)
			USART(0x04) = queue[tail++ % sizeof queue];
		else
			USART(0x0C) &= ~(1u << 7);
	}
}

static void wait_milliseconds(uint32_t count)
{
	SYSTICK_LOAD = 72000 - 1;
	SYSTICK_VAL = 0;
	SYSTICK_CTRL = 5;
	while (count)
		count -= SYSTICK_CTRL >> 16 & 1;
	SYSTICK_CTRL = 0;
}

int main(void)
{
	use_crystal();
	RCC_APB2ENR |= 1u << 2 | 1u << 14;
	GPIO(0, 4) = 0x444444B4;
	USART(0x08) = 625; /* 115200 */
	USART(0x0C) = 1u << 13 | 1u << 5 | 1u << 3 | 1u << 2;
	NVIC_ISER(1) = 1u << (37 - 32);
	for (;;) {
		uint32_t status;

		sleep();
		if (!head || queue[(head - 1) % sizeof queue] != '!')
			continue;
		disable_interrupts();
		while (!(USART(0x00) & 1u << 5)) /* the next one, taken away from the handler */
			;
		wait_milliseconds(5);
		status = USART(0x00);
		(void)USART(0x04);
		note(status);
		note(USART(0x00));
		enable_interrupts();
		say('E');
		say("0123456789ABCDEF"[status >> 4 & 15]);
		say("0123456789ABCDEF"[status & 15]);
	}
}
