/* SPDX-License-Identifier: MIT */
#include "flash.h"

#include <string.h>

#include "stm32f103.h"

#define PAGE_BYTES (SETTINGS_BYTES / 2u)
#define PAGE_WORDS (PAGE_BYTES / sizeof(uint32_t))
#define ROUNDS_MAX 1000000u /* of at least 6 clocks: 80 ms */
#define ERRORS (FLASH_SR_PGERR | FLASH_SR_WRPRTERR)

extern uint32_t settings_pages[]; /* of the linker */

static uint32_t *word_of(unsigned page, size_t at)
{
	return settings_pages + page * PAGE_WORDS + at;
}

/* The range is within the page. */
static bool fits(size_t at, size_t count)
{
	return at <= PAGE_WORDS && count <= PAGE_WORDS - at;
}

static bool has_ended(void)
{
	for (uint32_t rounds = 0; (FLASH->sr & FLASH_SR_BSY) != 0u; rounds++) {
		if (rounds == ROUNDS_MAX)
			return false;
	}
	return (FLASH->sr & ERRORS) == 0u;
}

static void unlock(void)
{
	FLASH->keyr = FLASH_KEY1;
	FLASH->keyr = FLASH_KEY2;
	FLASH->sr = ERRORS | FLASH_SR_EOP;
}

static bool read(void *context, unsigned page, size_t at, uint32_t *words, size_t count)
{
	(void)context;
	if (!fits(at, count))
		return false;
	memcpy(words, word_of(page, at), count * sizeof *words);
	return true;
}

static bool erase(void *context, unsigned page)
{
	bool good = true;

	(void)context;
	unlock();
	for (uint32_t at = 0; good && at < PAGE_BYTES; at += FLASH_PAGE_BYTES) {
		FLASH->cr = FLASH_CR_PER;
		FLASH->ar = (uint32_t)(uintptr_t)word_of(page, 0) + at;
		FLASH->cr = FLASH_CR_PER | FLASH_CR_STRT;
		good = has_ended();
	}
	FLASH->cr = FLASH_CR_LOCK;
	return good;
}

static bool write(void *context, unsigned page, size_t at, const uint32_t *words, size_t count)
{
	volatile uint16_t *to = (volatile uint16_t *)(void *)word_of(page, at);
	bool good = fits(at, count);

	(void)context;
	unlock();
	FLASH->cr = FLASH_CR_PG;
	for (size_t i = 0; good && i < 2u * count; i++) {
		to[i] = (uint16_t)(words[i / 2u] >> 16u * (i % 2u));
		good = has_ended();
	}
	FLASH->cr = FLASH_CR_LOCK;
	return good;
}

const struct passo_storage_pages flash_pages = {.read = read, .erase = erase, .write = write};
