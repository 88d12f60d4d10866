/* SPDX-License-Identifier: MIT
 * A record that survives a power failure: two copies, each with a number and a CRC.
 *
 *     passo_storage_open(&storage, &pages, words);
 *     if (passo_storage_load(&storage, record) != PASSO_STORAGE_LOADED) // once, at the start
 *             ... defaults
 *     passo_storage_save(&storage, record);
 *
 * A save writes the inactive copy, its CRC last, unless the active one has the same words. A power failure at
 * any moment keeps either the old or the new record.
 */
#ifndef PASSO_STORAGE_H
#define PASSO_STORAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Words of a page in addition to the record. */
#define PASSO_STORAGE_OVERHEAD 3u

/* Two pages, of flash or of a file; offsets and counts are in words. An erased word is 0xFFFFFFFF and can
 * be written once. The calls return false on failure. */
struct passo_storage_pages {
	void *context;
	bool (*read)(void *context, unsigned page, size_t at, uint32_t *words, size_t count);
	bool (*erase)(void *context, unsigned page);
	bool (*write)(void *context, unsigned page, size_t at, const uint32_t *words, size_t count);
};

enum passo_storage_state {
	PASSO_STORAGE_EMPTY, /* both copies are erased */
	PASSO_STORAGE_LOADED,
	PASSO_STORAGE_BAD /* no copy is valid; the record is unchanged */
};

/* All members are private. */
struct passo_storage {
	const struct passo_storage_pages *pages;
	size_t words;  /* of the record */
	unsigned page; /* of the active copy */
	uint32_t number;
};

void passo_storage_open(struct passo_storage *storage, const struct passo_storage_pages *pages, size_t words);
enum passo_storage_state passo_storage_load(struct passo_storage *storage, uint32_t *record);
/* False: it could not be written; the previous record is kept. */
bool passo_storage_save(struct passo_storage *storage, const uint32_t *record);

#endif
