/* SPDX-License-Identifier: MIT
 * The SPI transfers halfwords. To send the upper half of each word first, the halves are swapped: in a copy
 * for sending, in place for receiving.
 */
#include "spi.h"

#include "board.h"
#include "passo_host.h"
#include "stm32f103.h"

#define NSS_PIN 4u
#define SCK_PIN 5u
#define MISO_PIN 6u
#define MOSI_PIN 7u
#define RX_CHANNEL 2u /* DMA1 channels of SPI1 */
#define TX_CHANNEL 3u
#define WORDS_AHEAD 8u      /* swapped before the transfer begins: 14 us at 18 MHz */
#define MILLISECONDS_MAX 4u /* the longest transfer takes 0.25 ms */

static uint32_t swapped[PASSO_FRAME_WORDS_MAX];
static uint32_t *reply; /* last words received in the exchange under way; null: there is none */
static uint32_t began;  /* milliseconds */
static bool crc_unit_is_good;

static void swap_halves(uint32_t *to, const uint32_t *from, size_t words)
{
	for (; words != 0u; words--, from++)
		*to++ = *from << 16 | *from >> 16;
}

void spi_set_fast(bool fast)
{
	SPI1->cr1 = 0;
	SPI1->cr1 = SPI_CR1_MSTR | SPI_CR1_SSM | SPI_CR1_SSI | SPI_CR1_DFF_16
	          | (fast ? SPI_CR1_BR_QUARTER : SPI_CR1_BR_EIGHTH) | SPI_CR1_SPE;
}

void spi_start(void)
{
	RCC->ahbenr |= RCC_AHBENR_DMA1EN;
	RCC->apb2enr |= RCC_APB2ENR_SPI1EN;
	GPIOA->bsrr = BIT(NSS_PIN) | BIT(MISO_PIN + 16u);
	gpio_mode(GPIOA, NSS_PIN, GPIO_OUTPUT_50MHZ);
	gpio_mode(GPIOA, SCK_PIN, GPIO_FUNCTION_50MHZ);
	gpio_mode(GPIOA, MISO_PIN, GPIO_INPUT_PULL); /* pull-down: a missing core reads as 0 */
	gpio_mode(GPIOA, MOSI_PIN, GPIO_FUNCTION_50MHZ);
	DMA1->channel[RX_CHANNEL - 1u].cpar = (uint32_t)(uintptr_t)&SPI1->dr;
	DMA1->channel[TX_CHANNEL - 1u].cpar = (uint32_t)(uintptr_t)&SPI1->dr;
	spi_set_fast(true);
	SPI1->cr2 = SPI_CR2_RXDMAEN | SPI_CR2_TXDMAEN;
}

/* Enables reception first: a halfword that is not fetched would stall the transfer. */
static void start_dma(const uint32_t *send, const uint32_t *receive, size_t words)
{
	struct dma_channel *rx = &DMA1->channel[RX_CHANNEL - 1u], *tx = &DMA1->channel[TX_CHANNEL - 1u];

	__asm volatile("" ::: "memory"); /* the DMA reads */
	DMA1->ifcr = DMA_IFCR_CGIF(RX_CHANNEL) | DMA_IFCR_CGIF(TX_CHANNEL);
	rx->cmar = (uint32_t)(uintptr_t)receive;
	rx->cndtr = (uint32_t)words * 2u;
	rx->ccr =
	    DMA_CCR_MINC | DMA_CCR_PSIZE_16 | DMA_CCR_MSIZE_16 | DMA_CCR_PRIORITY_VERY_HIGH | DMA_CCR_EN;
	tx->cmar = (uint32_t)(uintptr_t)send;
	tx->cndtr = (uint32_t)words * 2u;
	tx->ccr = DMA_CCR_FROM_MEMORY | DMA_CCR_MINC | DMA_CCR_PSIZE_16 | DMA_CCR_MSIZE_16
	        | DMA_CCR_PRIORITY_HIGH | DMA_CCR_EN;
}

/* The first words are swapped when they go out, the others long before their turn; if an interrupt takes
 * longer than these, the core sees a wrong CRC. */
bool spi_begin(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	const size_t first = words < WORDS_AHEAD ? words : WORDS_AHEAD;

	(void)context;
	if (words < PASSO_REPLY_WORDS || words > PASSO_FRAME_WORDS_MAX)
		return false;
	swap_halves(swapped, send, first);
	reply = receive + words - PASSO_REPLY_WORDS;
	began = board_milliseconds();
	GPIOA->bsrr = BIT(NSS_PIN + 16u);
	start_dma(swapped, receive, words);
	swap_halves(swapped + first, send + first, words - first);
	return true;
}

/* The last halfword is received after the last one has been sent. */
enum passo_error spi_finish(void *context)
{
	const bool done = (DMA1->isr & DMA_ISR_TCIF(RX_CHANNEL)) != 0u && (SPI1->sr & SPI_SR_BSY) == 0u;

	(void)context;
	if (!reply)
		return PASSO_OK;
	if (!done && board_milliseconds() - began < MILLISECONDS_MAX)
		return PASSO_PENDING;
	GPIOA->bsrr = BIT(NSS_PIN);
	DMA1->channel[RX_CHANNEL - 1u].ccr = 0;
	DMA1->channel[TX_CHANNEL - 1u].ccr = 0;
	__asm volatile("" ::: "memory"); /* the DMA has written */
	swap_halves(reply, reply, PASSO_REPLY_WORDS);
	reply = NULL;
	return done ? PASSO_OK : PASSO_ERROR_TRANSFER;
}

bool spi_transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	enum passo_error error = PASSO_PENDING;

	if (!spi_begin(context, send, receive, words))
		return false;
	while (error == PASSO_PENDING)
		error = spi_finish(context);
	swap_halves(receive, receive, words - PASSO_REPLY_WORDS);
	return error == PASSO_OK;
}

/* ---------------------------------------------------------------------------------------------- CRC ---- */

static uint32_t crc_in_software(uint32_t crc, const uint32_t *words, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		crc ^= words[i];
		for (unsigned bit = 0; bit < 32u; bit++)
			crc = crc << 1 ^ ((crc >> 31) != 0u ? UINT32_C(0x04C11DB7) : 0u);
	}
	return crc;
}

/* The unit starts at 0xFFFFFFFF; a different start value is folded into the first word. */
static uint32_t crc_in_hardware(uint32_t crc, const uint32_t *words, size_t count)
{
	if (count == 0u)
		return crc;
	CRC->cr = CRC_CR_RESET;
	CRC->dr = words[0] ^ ~crc;
	for (size_t i = 1; i < count; i++)
		CRC->dr = words[i];
	return CRC->dr;
}

uint32_t passo_crc(uint32_t crc, const uint32_t *words, size_t count)
{
	return crc_unit_is_good ? crc_in_hardware(crc, words, count) : crc_in_software(crc, words, count);
}

bool crc_start(void)
{
	static const uint32_t SAMPLE[] = {0x5041534Fu, 0x00000000u, 0xFFFFFFFFu, 0x12345678u};

	RCC->ahbenr |= RCC_AHBENR_CRCEN;
	crc_unit_is_good =
	    crc_in_hardware(PASSO_CRC_START, SAMPLE, 4) == crc_in_software(PASSO_CRC_START, SAMPLE, 4)
	    && crc_in_hardware(0x89ABCDEFu, SAMPLE, 2) == crc_in_software(0x89ABCDEFu, SAMPLE, 2);
	return crc_unit_is_good;
}
