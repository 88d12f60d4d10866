/* SPDX-License-Identifier: MIT
 * DMA receives, so that no byte is lost while the processor stalls: the flash takes 20 to 40 ms to erase a
 * page.
 */
#include "uart.h"

#include "board.h"
#include "ring.h"
#include "stm32f103.h"

#define TX_PIN 9u
#define RX_PIN 10u
#define RX_CHANNEL 5u /* DMA1 channel of USART1 */
#define RECEIVED 256u /* bytes, a power of two: more than a sender may have under way */
#define MARGIN 8u     /* bytes that may come while one is read */

static struct ring sending;
static volatile uint8_t received[RECEIVED];
static volatile uint32_t laps;    /* of the DMA */
static volatile uint32_t corrupt; /* bytes */
static uint32_t taken;            /* bytes read or overwritten */
static uint32_t overwritten;      /* bytes */

static struct dma_channel *const dma = &DMA1->channel[RX_CHANNEL - 1u];

static void set_divider(uint32_t baud)
{
	USART1->brr = (board_clock_hz() + baud / 2u) / baud;
}

void uart_start(uint32_t baud)
{
	RCC->ahbenr |= RCC_AHBENR_DMA1EN;
	RCC->apb2enr |= RCC_APB2ENR_USART1EN;
	GPIOA->bsrr = BIT(RX_PIN);
	gpio_mode(GPIOA, TX_PIN, GPIO_FUNCTION_50MHZ);
	gpio_mode(GPIOA, RX_PIN, GPIO_INPUT_PULL);
	dma->cpar = (uint32_t)(uintptr_t)&USART1->dr;
	dma->cmar = (uint32_t)(uintptr_t)received;
	dma->cndtr = RECEIVED;
	dma->ccr = DMA_CCR_MINC | DMA_CCR_CIRCULAR | DMA_CCR_TCIE | DMA_CCR_EN;
	set_divider(baud);
	USART1->cr3 = USART_CR3_DMAR | USART_CR3_EIE;
	USART1->cr1 = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE;
}

void uart_finish(void)
{
	while (sending.head != sending.tail)
		wait_for_interrupt();
	while ((USART1->sr & USART_SR_TC) == 0u)
		continue;
}

void uart_set_baud(uint32_t baud)
{
	uart_finish();
	set_divider(baud);
}

void dma1_channel5_handler(void)
{
	DMA1->ifcr = DMA_IFCR_CGIF(RX_CHANNEL);
	laps++;
}

/* Reading SR and then DR clears the errors. They come with their byte, or on overrun with the last one that
 * was received; while DMA has still to fetch it, the interrupt stays pending. */
static void mark_error(uint32_t status)
{
	if ((status & (USART_SR_NE | USART_SR_FE | USART_SR_ORE)) == 0u || (status & USART_SR_RXNE) != 0u)
		return;
	(void)USART1->dr;
	received[(RECEIVED - 1u - dma->cndtr) % RECEIVED] = UART_LOST;
	corrupt++;
}

void usart1_handler(void)
{
	const uint32_t status = USART1->sr;
	uint8_t byte;

	mark_error(status);
	if ((status & USART_SR_TXE) != 0u) {
		if (ring_get(&sending, &byte))
			USART1->dr = byte;
		else
			USART1->cr1 &= ~USART_CR1_TXEIE;
	}
}

/* Bytes since the start; wraps. Reads again if a lap ends between the two readings. */
static uint32_t count_received(void)
{
	uint32_t before, left;

	do {
		before = laps;
		left = dma->cndtr;
		__asm volatile("isb" ::: "memory"); /* a pending interrupt is taken here */
	} while (before != laps);
	return before * RECEIVED + RECEIVED - left;
}

bool uart_read(char *byte)
{
	const uint32_t unread = count_received() - taken;

	if (unread == 0u)
		return false;
	if (unread > RECEIVED - MARGIN) {
		overwritten += unread;
		taken += unread;
		*byte = UART_LOST;
		return true;
	}
	*byte = (char)received[taken++ % RECEIVED];
	return true;
}

uint32_t uart_losses(void)
{
	return corrupt + overwritten;
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
