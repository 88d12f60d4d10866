/* SPDX-License-Identifier: MIT */
#include "uart.h"

#include "board.h"
#include "ring.h"
#include "stm32f103.h"

#define TX_PIN 9u
#define RX_PIN 10u

static struct ring sending;

static void set_divider(uint32_t baud)
{
	USART1->brr = (board_clock_hz() + baud / 2u) / baud;
}

void uart_start(uint32_t baud)
{
	RCC->apb2enr |= RCC_APB2ENR_USART1EN;
	GPIOA->bsrr = BIT(RX_PIN);
	gpio_mode(GPIOA, TX_PIN, GPIO_FUNCTION_50MHZ);
	gpio_mode(GPIOA, RX_PIN, GPIO_INPUT_PULL);
	set_divider(baud);
	USART1->cr1 = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE;
}

void uart_set_baud(uint32_t baud)
{
	while (sending.head != sending.tail)
		wait_for_interrupt();
	while ((USART1->sr & USART_SR_TC) == 0u)
		continue;
	set_divider(baud);
}

/* Reading SR and then DR clears the errors. On overrun, the byte in DR is valid and the next one was lost. */
void usart1_handler(void)
{
	uint32_t status = USART1->sr;
	uint8_t byte;

	if ((status & (USART_SR_RXNE | USART_SR_ORE)) != 0u) {
		byte = (uint8_t)USART1->dr;
		if ((status & (USART_SR_NE | USART_SR_FE)) != 0u)
			uart_lost();
		else if ((status & USART_SR_RXNE) != 0u)
			uart_received((char)byte);
		if ((status & USART_SR_ORE) != 0u)
			uart_lost();
	}
	if ((status & USART_SR_TXE) != 0u) {
		if (ring_get(&sending, &byte))
			USART1->dr = byte;
		else
			USART1->cr1 &= ~USART_CR1_TXEIE;
	}
}

/* CR1 is also changed by the interrupt handler, hence the critical section. */
static void put(uint8_t byte)
{
	while (!ring_put(&sending, byte))
		wait_for_interrupt();
	irq_disable();
	USART1->cr1 |= USART_CR1_TXEIE;
	irq_enable();
}

void uart_write(const char *text)
{
	while (*text != '\0')
		put((uint8_t)*text++);
}

uint32_t uart_room(void)
{
	return ring_room(&sending);
}
