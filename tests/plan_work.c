/* SPDX-License-Identifier: MIT
 * Counts the roots of 128 bits, the longest steps of a plan: linked with --wrap=passo_isqrt128.
 */
#include "passo_math.h"

uint64_t __real_passo_isqrt128(struct passo_u128 a);
uint64_t __wrap_passo_isqrt128(struct passo_u128 a);
extern unsigned passo_roots;

unsigned passo_roots;

uint64_t __wrap_passo_isqrt128(struct passo_u128 a)
{
	passo_roots++;
	return __real_passo_isqrt128(a);
}
