/* SPDX-License-Identifier: MIT
 * Declares what the HAL example uses, so that it can be compiled here.
 */
#include <stdint.h>

typedef enum { HAL_OK, HAL_ERROR, HAL_BUSY, HAL_TIMEOUT } HAL_StatusTypeDef;
typedef enum { GPIO_PIN_RESET, GPIO_PIN_SET } GPIO_PinState;
typedef struct {
	volatile uint32_t CRL;
} GPIO_TypeDef;
typedef struct {
	void *Instance;
} SPI_HandleTypeDef;

extern GPIO_TypeDef *const GPIOA;
#define GPIO_PIN_4 ((uint16_t)0x0010)

void HAL_GPIO_WritePin(GPIO_TypeDef *port, uint16_t pin, GPIO_PinState state);
HAL_StatusTypeDef HAL_SPI_TransmitReceive(
    SPI_HandleTypeDef *spi, uint8_t *send, uint8_t *receive, uint16_t size, uint32_t timeout);
uint32_t HAL_GetTick(void);
