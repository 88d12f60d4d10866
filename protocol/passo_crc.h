/* SPDX-License-Identifier: MIT
 * The check of a frame.
 */
#ifndef PASSO_CRC_H
#define PASSO_CRC_H

#include <stddef.h>
#include <stdint.h>

#define PASSO_CRC_START UINT32_C(0xFFFFFFFF)

/* CRC-32/MPEG-2 over words; begin with PASSO_CRC_START. Compiled with PASSO_CRC_EXTERNAL this function is
 * left to the program: the CRC unit of an STM32F103, reset and given words[0] ^ ~crc, then the other words,
 * computes it. */
uint32_t passo_crc(uint32_t crc, const uint32_t *words, size_t count);

#endif
