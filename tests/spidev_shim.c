/* SPDX-License-Identifier: MIT
 * For LD_PRELOAD: /dev/spidev9.9 is an SPI controller with the C model at its pins, /dev/gpiochip9 has its
 * irq pin at line 25. Opening, locking and the words on the wire are those of the program under test; what a
 * kernel and real wires do is not tested by this.
 *
 * SHIM_FILE is a file in place of the device, SHIM_FAULT what is wrong:
 *     denied, plain (no SPI device), modeless (no mode 0), low, high, shifted (MISO is a bit late)
 * SHIM_AXES are the axes of the core, SHIM_LOG is a file for the SCLK of each frame.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/gpio.h>
#include <linux/spi/spidev.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "passo_engine.h"

#define CLOCK_HZ 100000000u
#define IRQ_LINE 25u

static int spi = -1, line = -1;
static uint8_t mode = SPI_MODE_3; /* as another program has left it */
static struct passo_engine *engine;
static double began;

static bool is(const char *fault)
{
	const char *given = getenv("SHIM_FAULT");

	return given && strcmp(given, fault) == 0;
}

static double seconds(void)
{
	struct timespec now;

	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* The core continues meanwhile. */
static void catch_up(void)
{
	static struct passo_pin_event events[65536];
	const uint64_t due = (uint64_t)((seconds() - began) * CLOCK_HZ);

	while (passo_engine_clock(engine) < due) {
		passo_engine_run(engine, due - passo_engine_clock(engine));
		passo_engine_drain(engine, events, 65536);
	}
}

int open(const char *path, int flags, ...)
{
	int (*next)(const char *, int, ...) = (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, "open");
	va_list rest;

	va_start(rest, flags);
	const int permissions = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
	va_end(rest);
	if (strcmp(path, "/dev/gpiochip9") == 0)
		return next("/dev/null", flags);
	if (strcmp(path, "/dev/spidev9.9") != 0)
		return next(path, flags, permissions);
	if (is("denied")) {
		errno = EACCES;
		return -1;
	}
	if (!engine) {
		const char *axes = getenv("SHIM_AXES");
		const struct passo_engine_config config = {.core = {.channels = 1,
							       .axes = axes ? (uint32_t)atoi(axes) : 4,
							       .tick_log2 = 7,
							       .line_queue_log2 = 8,
							       .ramp_queue_log2 = 4,
							       .clock_hz = CLOCK_HZ},
		    .clock_hz = CLOCK_HZ,
		    .spi_half_period = 2};
		engine = passo_engine_create(&config);
		began = seconds();
	}
	return spi = next(getenv("SHIM_FILE"), flags);
}

/* A chip select in the mode that is set: in another one than 0 both ends sample a bit too early or late. */
static void exchange(const struct spi_ioc_transfer *wanted)
{
	uint8_t *bytes = (uint8_t *)(uintptr_t)wanted->rx_buf;

	catch_up();
	passo_engine_pace(engine, CLOCK_HZ, 2u * wanted->speed_hz);
	passo_engine_select(engine, true);
	passo_engine_exchange(engine, (const uint8_t *)(uintptr_t)wanted->tx_buf, bytes, wanted->len, 1);
	passo_engine_select(engine, false);
	passo_engine_run(engine, PASSO_ENGINE_GAP);
	for (unsigned i = wanted->len; is("shifted") && i-- > 0u;)
		bytes[i] = (uint8_t)(bytes[i] >> 1 | (i > 0u ? bytes[i - 1] << 7 : 0));
	if (is("low") || is("high"))
		memset(bytes, is("high") ? 0xFF : 0, wanted->len);
}

static int message(const struct spi_ioc_transfer *wanted)
{
	const char *log = getenv("SHIM_LOG");

	if (mode != SPI_MODE_0 || wanted->bits_per_word != 8u || wanted->cs_change || wanted->len > 4096u)
		abort(); /* spidev takes 4096 bytes */
	if (log) {
		FILE *file = fopen(log, "a");
		fprintf(file, "%u\n", wanted->speed_hz);
		fclose(file);
	}
	exchange(wanted);
	return (int)wanted->len;
}

static int on_spi(unsigned long request, void *argument)
{
	if (is("plain")) {
		errno = ENOTTY;
		return -1;
	}
	if (request == SPI_IOC_MESSAGE(1))
		return message(argument);
	if (request == SPI_IOC_WR_MODE)
		mode = is("modeless") ? mode : *(uint8_t *)argument;
	else if (request == SPI_IOC_RD_MODE)
		*(uint8_t *)argument = mode;
	else if (request != SPI_IOC_WR_BITS_PER_WORD || *(uint8_t *)argument != 8u)
		abort();
	return 0;
}

int ioctl(int file, unsigned long request, ...)
{
	int (*next)(int, unsigned long, ...) = (int (*)(int, unsigned long, ...))dlsym(RTLD_NEXT, "ioctl");
	va_list rest;

	va_start(rest, request);
	void *argument = va_arg(rest, void *);
	va_end(rest);
	if (request == GPIO_V2_GET_LINE_IOCTL) {
		struct gpio_v2_line_request *wanted = argument;
		if (wanted->offsets[0] != IRQ_LINE || wanted->config.flags != GPIO_V2_LINE_FLAG_INPUT) {
			errno = EINVAL;
			return -1;
		}
		wanted->fd = line = dup(spi);
		return 0;
	}
	if (file == line && request == GPIO_V2_LINE_GET_VALUES_IOCTL) {
		catch_up();
		((struct gpio_v2_line_values *)argument)->bits = passo_engine_irq(engine);
		return 0;
	}
	return file == spi && file >= 0 ? on_spi(request, argument) : next(file, request, argument);
}
