/* SPDX-License-Identifier: MIT
 * Internal: the two transports, for passo_linux.c.
 */
#ifndef PASSO_LINUX_PRIVATE_H
#define PASSO_LINUX_PRIVATE_H

#include "passo_linux.h"

/* Opens the device and sets the functions of `hardware`; false: `problem` says why not. */
bool passo_linux_open_spi(
    struct passo_linux *host, const struct passo_linux_options *device, struct passo_hardware *hardware);
bool passo_linux_open_socket(
    struct passo_linux *host, const struct passo_linux_options *device, struct passo_hardware *hardware);

/* Sets `problem`, as printf() does; returns false. */
__attribute__((format(printf, 2, 3))) bool passo_linux_fail(
    struct passo_linux *host, const char *format, ...);

/* The clock of this computer, for struct passo_hardware. */
uint32_t passo_linux_microseconds(void *context);
void passo_linux_sleep(void *context, uint32_t microseconds);

#endif
