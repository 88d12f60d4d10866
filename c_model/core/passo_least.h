/* SPDX-License-Identifier: MIT
 * Internal: the earlier of two times, in clocks.
 */
#ifndef PASSO_LEAST_H
#define PASSO_LEAST_H

#include <stdint.h>

static inline uint64_t passo_least(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

#endif
