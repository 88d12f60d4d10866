/* SPDX-License-Identifier: MIT
 * A core at an SPI controller: spidev in mode 0, chip select by the controller; irq by a GPIO line.
 */
#define _DEFAULT_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/gpio.h>
#include <linux/spi/spidev.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "passo_linux_private.h"

#define BYTES_PER_WORD 4u
#define BITS 8u

static bool transfer(void *context, const uint32_t *send, uint32_t *receive, size_t words)
{
	struct passo_linux *host = context;
	uint8_t bytes[PASSO_FRAME_WORDS_MAX * BYTES_PER_WORD];
	const size_t size = words * BYTES_PER_WORD;
	struct spi_ioc_transfer exchange = {
	    .tx_buf = (uintptr_t)bytes,
	    .rx_buf = (uintptr_t)bytes,
	    .len = (uint32_t)size,
	    .speed_hz = host->speed_hz,
	    .bits_per_word = BITS,
	};

	host->words += (uint32_t)words;
	for (size_t i = 0; i < size; i++)
		bytes[i] = (uint8_t)(send[i / BYTES_PER_WORD] >> (24u - 8u * (i % BYTES_PER_WORD)));
	if (ioctl(host->device, SPI_IOC_MESSAGE(1), &exchange) != (int)size)
		return false;
	for (size_t i = 0; i < size; i++)
		receive[i / BYTES_PER_WORD] = receive[i / BYTES_PER_WORD] << 8 | bytes[i];
	return true;
}

static bool irq(void *context)
{
	const struct passo_linux *host = context;
	struct gpio_v2_line_values values = {.mask = 1};

	/* a line that cannot be read: the driver then reads the state instead */
	return ioctl(host->irq, GPIO_V2_LINE_GET_VALUES_IOCTL, &values) == 0 && (values.bits & 1u) != 0u;
}

static bool open_irq(struct passo_linux *host, const struct passo_linux_options *device)
{
	struct gpio_v2_line_request request = {
	    .offsets = {device->irq_line},
	    .consumer = "passo",
	    .config.flags = GPIO_V2_LINE_FLAG_INPUT,
	    .num_lines = 1,
	};
	const int chip = open(device->irq_chip, O_RDWR | O_CLOEXEC);
	const bool done = chip >= 0 && ioctl(chip, GPIO_V2_GET_LINE_IOCTL, &request) == 0;
	const int reason = errno;

	if (chip >= 0)
		close(chip);
	if (!done)
		return passo_linux_fail(host,
		    "%s, line %u: %s: give the chip and the line of the irq pin, or none", device->irq_chip,
		    device->irq_line, strerror(reason));
	host->irq = request.fd;
	return true;
}

static bool explain_open(struct passo_linux *host, const char *name)
{
	if (errno == ENOENT || errno == ENODEV || errno == ENXIO)
		return passo_linux_fail(host,
		    "%s: there is no such device: switch SPI on (Raspberry Pi: dtparam=spi=on in config.txt)",
		    name);
	if (errno == EACCES || errno == EPERM)
		return passo_linux_fail(host,
		    "%s: no permission: add the user to the group of the device (sudo usermod -aG spi $USER)",
		    name);
	return passo_linux_fail(host, "%s: %s", name, strerror(errno));
}

bool passo_linux_open_spi(
    struct passo_linux *host, const struct passo_linux_options *device, struct passo_hardware *hardware)
{
	const char *name = device->device;
	uint8_t mode = SPI_MODE_0, bits = BITS;

	host->device = open(name, O_RDWR | O_CLOEXEC);
	if (host->device < 0)
		return explain_open(host, name);
	if (flock(host->device, LOCK_EX | LOCK_NB) != 0)
		return passo_linux_fail(host, "%s: another program holds it: end that one first", name);
	errno = 0;
	if (ioctl(host->device, SPI_IOC_WR_MODE, &mode) != 0
	    || ioctl(host->device, SPI_IOC_WR_BITS_PER_WORD, &bits) != 0
	    || ioctl(host->device, SPI_IOC_RD_MODE, &mode) != 0 || mode != SPI_MODE_0)
		return passo_linux_fail(host,
		    errno == ENOTTY ? "%s: this is no SPI device: give one such as /dev/spidev0.0"
		                    : "%s: it does not do SPI mode 0 with 8 bits: use another controller",
		    name);
	hardware->transfer = transfer;
	hardware->microseconds = passo_linux_microseconds;
	hardware->wait = passo_linux_sleep;
	if (!device->irq_chip)
		return true;
	hardware->irq = irq;
	return open_irq(host, device);
}
