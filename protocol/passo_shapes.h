/* SPDX-License-Identifier: MIT
 * Pulse shapes as the core has them after reset. Made by tools/generate_shapes.py.
 */
#ifndef PASSO_SHAPES_H
#define PASSO_SHAPES_H

#include <stdint.h>

#define PASSO_BANKS 3u
#define PASSO_BANK_POINTS 256u

/* Banks 1 to 3: cosine, sigmoid, ease.
 * Point k is shape(k / 256) * 65536; point 256 is always 65536. */
extern const uint16_t passo_shapes[PASSO_BANKS][PASSO_BANK_POINTS];
/* Where their points are written. */
extern const uint16_t passo_shape_addresses[PASSO_BANKS];

/* The bank that has a point at an address, 1 to 3, or 0. */
unsigned passo_bank_at(uint32_t address);

#endif
