/* SPDX-License-Identifier: MIT
 * Declares what the Arduino example uses, so that it can be compiled here.
 */
#pragma once
#include <stdint.h>

enum { MSBFIRST = 1, SPI_MODE0 = 0 };

struct SPISettings {
	SPISettings(uint32_t clock, uint8_t order, uint8_t mode);
};

struct SPIClass {
	void begin();
	void beginTransaction(SPISettings settings);
	void endTransaction();
	uint16_t transfer16(uint16_t data);
};

extern SPIClass SPI;
