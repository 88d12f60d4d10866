/* SPDX-License-Identifier: MIT
 * Hardware functions of the driver for the STM32Cube HAL: SPI1 (mode 0, 8 bits, MSB first), chip select on
 * PA4.
 */
#include "passo.h"
#include "stm32f1xx_hal.h"

#define BYTES_PER_WORD 4u
#define TIMEOUT_MILLISECONDS 10u

extern SPI_HandleTypeDef hspi1; /* made by the code generator */

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	static uint8_t bytes[PASSO_FRAME_WORDS_MAX * BYTES_PER_WORD];
	const uint16_t size = (uint16_t)(words * BYTES_PER_WORD);

	(void)context;
	for (size_t i = 0; i < size; i++)
		bytes[i] = (uint8_t)(send[i / BYTES_PER_WORD] >> (24u - 8u * (i % BYTES_PER_WORD)));
	HAL_GPIO_WritePin(GPIOA, GPIO_PIN_4, GPIO_PIN_RESET);
	HAL_StatusTypeDef status = HAL_SPI_TransmitReceive(&hspi1, bytes, bytes, size, TIMEOUT_MILLISECONDS);
	HAL_GPIO_WritePin(GPIOA, GPIO_PIN_4, GPIO_PIN_SET);
	for (size_t i = 0; i < size; i++)
		receive[i / BYTES_PER_WORD] = receive[i / BYTES_PER_WORD] << 8 | bytes[i];
	return status == HAL_OK;
}

/* Millisecond resolution is enough for timeouts. */
static uint32_t microseconds(void *context)
{
	(void)context;
	return HAL_GetTick() * 1000u;
}

enum passo_error open_passo(struct passo *passo, struct passo_host *host)
{
	const struct passo_hardware hardware = {.transfer = transfer, .microseconds = microseconds};
	const struct passo_options options = {.clock_hz = 72000000};

	return passo_open(passo, host, &hardware, &options);
}
