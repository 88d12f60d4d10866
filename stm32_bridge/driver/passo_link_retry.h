/* SPDX-License-Identifier: MIT
 * Internal: retries of a frame, for passo_host.c.
 */
#ifndef PASSO_LINK_RETRY_H
#define PASSO_LINK_RETRY_H

#include "passo_host.h"

/* A complete read with at most `tries` attempts. */
enum passo_error passo_host_read_with(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length, uint8_t tries);

/* Makes a write or push the current frame, with the next sequence number. */
void passo_host_begin_write(struct passo_host *host, enum passo_operation operation, uint16_t address,
    const uint32_t *words, size_t length);
/* The prepared push becomes the current frame. */
void passo_host_begin_prepared(struct passo_host *host);
/* Begins or ends a chip select for the current write. PENDING: its outcome is not known yet. */
enum passo_error passo_host_step_write(struct passo_host *host);
/* Abandons the current frame, after its end if it is in flight; it is unknown whether it was executed. */
void passo_host_give_up(struct passo_host *host);

/* Verifies that the core has not been reset: passo_host_guard()'s mark must still be there. */
enum passo_error passo_host_prove(struct passo_host *host, uint8_t tries);

#endif
