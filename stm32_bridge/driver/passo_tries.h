/* SPDX-License-Identifier: MIT
 * Tries of a frame, for passo_host.c.
 */
#ifndef PASSO_TRIES_H
#define PASSO_TRIES_H

#include "passo_host.h"

/* A whole read of at most so many tries. */
enum passo_error passo_host_read_with(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length, uint8_t tries);

/* Makes a write the present frame, with the next sequence number. */
void passo_host_begin_write(struct passo_host *host, enum passo_operation operation, uint16_t address,
    const uint32_t *words, size_t length);
/* One chip select for the present write. PENDING: it is not settled yet. */
enum passo_error passo_host_step_write(struct passo_host *host);
/* It is not known whether the present frame was executed. */
void passo_host_give_up(struct passo_host *host);

/* The mark is still there: the core was not reset. */
enum passo_error passo_host_prove(struct passo_host *host, uint8_t tries);

#endif
