/* SPDX-License-Identifier: MIT
 * Internal: one frame on the SPI, for passo_link_retry.c.
 */
#ifndef PASSO_LINK_FRAME_H
#define PASSO_LINK_FRAME_H

#include "passo_host.h"

/* Sends the current frame once. While it is in flight: PENDING, and the next call continues. Results other
 * than OK and rejections may be retried. *known is set if the reply had a valid status word, which is then in
 * host->status. */
enum passo_error passo_host_exchange(struct passo_host *host, bool *known);

/* Updates the queue room from the status word, if `known`, and by the items pushed by this frame, if
 * `executed`. */
void passo_host_count_room(struct passo_host *host, bool known, bool executed);

#endif
