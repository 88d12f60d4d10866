/* SPDX-License-Identifier: MIT
 * CRC-32/MPEG-2 over 32-bit words. See rtl/passo_crc.v. The 32 shifts are made at once, in the last of their
 * clocks.
 */
#include "passo_model.h"

static const uint32_t POLYNOMIAL = 0x04C11DB7u;

void passo_crc_clock(struct passo_crc *crc, bool restart, bool start, uint32_t word)
{
	if (crc->busy != 0u) {
		crc->busy--;
		if (crc->busy == 0u) {
			crc->crc ^= crc->word;
			for (int bit = 0; bit < 32; bit++)
				crc->crc = crc->crc << 1 ^ ((crc->crc >> 31) != 0u ? POLYNOMIAL : 0u);
		}
	}
	if (restart) {
		crc->crc = 0xFFFFFFFFu;
		crc->busy = 0;
	}
	if (start) {
		crc->word = word;
		crc->busy = 32;
	}
}
