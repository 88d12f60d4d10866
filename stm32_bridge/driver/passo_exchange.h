/* SPDX-License-Identifier: MIT
 * One chip select, for passo_tries.c.
 */
#ifndef PASSO_EXCHANGE_H
#define PASSO_EXCHANGE_H

#include "passo_host.h"

/* Sends the present frame once. Everything but OK and the refusals may be tried again. *known: the status is
 * undamaged, and now in host->status. */
enum passo_error passo_host_exchange(struct passo_host *host, bool *known);

/* Room in the queues, from the status at the fall of chip select and what this frame has pushed. */
void passo_host_count_room(struct passo_host *host, bool known, bool executed);

#endif
