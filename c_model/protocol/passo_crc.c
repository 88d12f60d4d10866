/* SPDX-License-Identifier: MIT */
#include "passo_crc.h"

#ifndef PASSO_CRC_EXTERNAL

/* CRC of each 4-bit value: a small table for microcontrollers, eight look-ups per word. */
static const uint32_t crc_of_nibble[16] = {
    0x00000000u,
    0x04C11DB7u,
    0x09823B6Eu,
    0x0D4326D9u,
    0x130476DCu,
    0x17C56B6Bu,
    0x1A864DB2u,
    0x1E475005u,
    0x2608EDB8u,
    0x22C9F00Fu,
    0x2F8AD6D6u,
    0x2B4BCB61u,
    0x350C9B64u,
    0x31CD86D3u,
    0x3C8EA00Au,
    0x384FBDBDu,
};

uint32_t passo_crc(uint32_t crc, const uint32_t *words, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		crc ^= words[i];
		for (unsigned nibble = 0; nibble < 8; nibble++)
			crc = crc << 4 ^ crc_of_nibble[crc >> 28];
	}
	return crc;
}

#endif
