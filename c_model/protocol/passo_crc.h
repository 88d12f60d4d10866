/* SPDX-License-Identifier: MIT
 * The CRC of a frame.
 */
#ifndef PASSO_CRC_H
#define PASSO_CRC_H

#include <stddef.h>
#include <stdint.h>

#define PASSO_CRC_START UINT32_C(0xFFFFFFFF)

/* CRC-32/MPEG-2 over `count` words, most significant bit first; `crc` is PASSO_CRC_START or the result of a
 * previous call. With PASSO_CRC_EXTERNAL defined, the program provides this function. The CRC unit of an
 * STM32F103 computes it: reset it, write words[0] ^ ~crc, then the other words. */
uint32_t passo_crc(uint32_t crc, const uint32_t *words, size_t count);

#endif
