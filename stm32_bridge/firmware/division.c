/* SPDX-License-Identifier: MIT
 * What the compiler calls to divide 64 bits, in place of its library's 700 bytes.
 */
#include "passo_math.h"

uint64_t __udivmoddi4(uint64_t a, uint64_t divisor, uint64_t *remainder);

uint64_t __udivmoddi4(uint64_t a, uint64_t divisor, uint64_t *remainder)
{
	return passo_divide((struct passo_u128){0, a}, divisor, remainder);
}
