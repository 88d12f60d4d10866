/* SPDX-License-Identifier: MIT
 * Opens a channel on Linux, and says in one sentence what to do if that fails.
 */
#define _DEFAULT_SOURCE
#include "passo_linux.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "passo_linux_private.h"

#define MICROSECONDS UINT32_C(1000000)
#define NANOSECONDS 1000u /* of a microsecond */
#define SOCKET "unix:"

bool passo_linux_fail(struct passo_linux *host, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	vsnprintf(host->problem, sizeof host->problem, format, arguments);
	va_end(arguments);
	return false;
}

uint32_t passo_linux_microseconds(void *context)
{
	struct timespec now;

	(void)context;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (uint32_t)now.tv_sec * MICROSECONDS + (uint32_t)now.tv_nsec / NANOSECONDS;
}

void passo_linux_sleep(void *context, uint32_t microseconds)
{
	(void)context;
	nanosleep(&(struct timespec){microseconds / MICROSECONDS,
		      (long)(microseconds % MICROSECONDS) * (long)NANOSECONDS},
	    NULL);
}

/* What to do after an error of passo_open(). */
static const char *advice(enum passo_error error)
{
	switch (error) {
	case PASSO_ERROR_STUCK_LOW:
	case PASSO_ERROR_STUCK_HIGH:
		return "is the FPGA configured? check the wires of MISO, chip select and ground";
	case PASSO_ERROR_NO_ACK:
	case PASSO_ERROR_DAMAGED:
	case PASSO_ERROR_SEQUENCE:
	case PASSO_ERROR_BAD_CRC:
		return "lower the speed of SCLK, shorten the wires, and check that nothing sets another SPI "
		       "mode";
	case PASSO_ERROR_NOT_PASSO:
		return "check which device is at this chip select";
	case PASSO_ERROR_VERSION:
		return "build bitstream and program from the same version";
	case PASSO_ERROR_PARAMETERS:
	case PASSO_ERROR_CLOCK:
		return "build the bitstream with what the program expects, or change its options";
	case PASSO_ERROR_CLOCK_UNKNOWN:
		return "give its clock in the options";
	case PASSO_ERROR_MOVING:
		return "hold, stop or wait for it, then clear";
	case PASSO_ERROR_ESTOP:
	case PASSO_ERROR_ALARM:
		return "release it, then clear";
	default:
		return "see docs/trouble.md";
	}
}

static enum passo_error explain(
    struct passo_linux *host, const struct passo_linux_options *device, enum passo_error error)
{
	const char *text = passo_error_text(error);
	const int length = (int)strcspn(text, "."); /* it becomes the beginning of the sentence */

	passo_linux_fail(
	    host, "%s: %s: %.*s: %s", device->device, passo_error_name(error), length, text, advice(error));
	return error;
}

enum passo_error passo_open_linux(struct passo *passo, struct passo_host *host,
    struct passo_linux *linux_host, const struct passo_linux_options *device,
    const struct passo_options *options)
{
	if (!passo || !host || !linux_host || !device || !device->device || !options)
		return PASSO_ERROR_ARGUMENT_POINTER;
	struct passo_hardware hardware = {.context = linux_host};
	*linux_host = (struct passo_linux){
	    .device = -1, .irq = -1, .speed_hz = device->speed_hz ? device->speed_hz : PASSO_LINUX_SPEED_HZ};
	linux_host->served = strncmp(device->device, SOCKET, strlen(SOCKET)) == 0;
	if (!(linux_host->served ? passo_linux_open_socket : passo_linux_open_spi)(
		linux_host, device, &hardware)) {
		passo_close_linux(linux_host);
		return PASSO_ERROR_TRANSFER;
	}
	enum passo_error error = passo_open(passo, host, &hardware, options);
	const bool open = error == PASSO_OK || error == PASSO_ERROR_MOVING || error == PASSO_ERROR_ESTOP
	               || error == PASSO_ERROR_ALARM;

	if (error != PASSO_OK)
		explain(linux_host, device, error);
	if (open && passo_machine(passo)->axes < device->axes) {
		passo_linux_fail(linux_host,
		    "%s: the core has %u axes, the program needs %u: build it with AXES=%u", device->device,
		    passo_machine(passo)->axes, device->axes, device->axes);
		error = PASSO_ERROR_PARAMETERS;
	} else if (open) {
		return error;
	}
	passo_close_linux(linux_host);
	return error;
}

void passo_close_linux(struct passo_linux *linux_host)
{
	if (linux_host->irq >= 0)
		close(linux_host->irq);
	if (linux_host->device >= 0)
		close(linux_host->device);
	linux_host->irq = linux_host->device = -1;
}
