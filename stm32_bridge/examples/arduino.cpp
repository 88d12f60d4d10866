// SPDX-License-Identifier: MIT
// Hardware functions of the driver for Arduino: the default SPI, chip select on PA4.
#include <Arduino.h>
#include <SPI.h>

#include "passo.h"

static const uint32_t spiHertz = 9000000;

static bool transfer(void *, const uint32_t *send, uint32_t *receive, size_t words)
{
	SPI.beginTransaction(SPISettings(spiHertz, MSBFIRST, SPI_MODE0));
	digitalWrite(PA4, LOW);
	for (size_t i = 0; i < words; i++) {
		uint32_t high = SPI.transfer16(static_cast<uint16_t>(send[i] >> 16));
		uint32_t low = SPI.transfer16(static_cast<uint16_t>(send[i]));
		receive[i] = high << 16 | low;
	}
	digitalWrite(PA4, HIGH);
	SPI.endTransaction();
	return true;
}

static uint32_t microseconds(void *)
{
	return micros();
}

passo_error openPasso(struct passo *passo, struct passo_host *host)
{
	struct passo_hardware hardware = {};
	struct passo_options options = {};

	pinMode(PA4, OUTPUT);
	digitalWrite(PA4, HIGH);
	SPI.begin();
	hardware.transfer = transfer;
	hardware.microseconds = microseconds;
	options.clock_hz = 72000000;
	return passo_open(passo, host, &hardware, &options);
}
