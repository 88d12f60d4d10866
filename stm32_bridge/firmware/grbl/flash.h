/* SPDX-License-Identifier: MIT
 * The end of the flash, for settings: two pages, each of one or more of the chip. The processor stalls while
 * one of the chip is erased (up to 40 ms) or a half-word is programmed (70 us).
 */
#ifndef FLASH_H
#define FLASH_H

#include "passo_storage.h"

extern const struct passo_storage_pages flash_pages;

#endif
