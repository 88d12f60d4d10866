/* SPDX-License-Identifier: MIT
 * The driver on Linux: the core is at an SPI controller (spidev), or it is a simulated one at the Unix socket
 * of `passo serve`, with the same binary.
 *
 *     static struct passo passo;
 *     static struct passo_host host;
 *     static struct passo_linux linux_host;
 *     const struct passo_linux_options device = {.device = "/dev/spidev0.0"};
 *
 *     if (passo_open_linux(&passo, &host, &linux_host, &device, &(struct passo_options){0}) != PASSO_OK)
 *             fprintf(stderr, "%s\n", linux_host.problem);
 * Wiring and permissions: docs/hosts.md. Root is not needed where the user may open the device.
 */
#ifndef PASSO_LINUX_H
#define PASSO_LINUX_H

#include "passo.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PASSO_LINUX_SPEED_HZ 4000000u /* of SCLK, unless another one is given */
#define PASSO_LINUX_PROBLEM_MAX 256u  /* bytes of a sentence, with its zero */

struct passo_linux_options {
	const char *device;   /* "/dev/spidev0.0", or "unix:/tmp/passo": the socket of passo serve */
	uint32_t speed_hz;    /* of SCLK, at most what the link allows (docs/link.md); 0: 4 MHz */
	const char *irq_chip; /* GPIO chip that the irq pin is wired to, "/dev/gpiochip0"; null: none */
	uint32_t irq_line;    /* line of that chip */
	uint8_t axes;         /* that the program needs; the core may have more */
};

/* Members other than `problem` are private. */
struct passo_linux {
	int device, irq; /* file descriptors; irq -1: none */
	uint32_t speed_hz;
	bool served;           /* by a socket */
	bool real_time;        /* which follows the clock of this computer */
	uint32_t microseconds; /* simulated time, of the last answer */
	uint32_t words;        /* exchanged so far; wraps */
	bool irq_level;
	char
	    problem[PASSO_LINUX_PROBLEM_MAX]; /* after an error: what is wrong and what to do, one sentence */
};

/* Opens the device, locks it against other programs, and opens the channel as passo_open() does, whose errors
 * it returns: after MOVING, ESTOP and ALARM the channel is open. TRANSFER: there is no such device, it may
 * not be opened, another program holds it, or it is no SPI controller with mode 0. PARAMETERS: also a core
 * with fewer axes than needed. `linux_host` must live as long as the channel. */
enum passo_error passo_open_linux(struct passo *passo, struct passo_host *host,
    struct passo_linux *linux_host, const struct passo_linux_options *device,
    const struct passo_options *options);

/* Closes the device; the core continues with what it has. */
void passo_close_linux(struct passo_linux *linux_host);

#ifdef __cplusplus
}
#endif

#endif
