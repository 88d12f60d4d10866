/* SPDX-License-Identifier: MIT
 * CRC-32/MPEG-2 over 32-bit words. See rtl/passo_crc.v. The 32 shifts are made at once.
 */
#include "passo_model.h"

static const uint32_t POLYNOMIAL = 0x04C11DB7u;

uint32_t passo_crc_add(uint32_t crc, uint32_t word)
{
	crc ^= word;
	for (int bit = 0; bit < 32; bit++)
		crc = crc << 1 ^ ((crc >> 31) != 0u ? POLYNOMIAL : 0u);
	return crc;
}
