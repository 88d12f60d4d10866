/* SPDX-License-Identifier: MIT
 * Pulse shapes as the core has them after reset. Made by tools/generate_shapes.py.
 */
#ifndef PASSO_SHAPES_H
#define PASSO_SHAPES_H

#include <stdint.h>

/* Banks 1 to 3: cosine, sigmoid, ease. Point k is shape(k / 256) * 65536; point 256 is always 65536. */
extern const uint16_t passo_shapes[3][256];

#endif
