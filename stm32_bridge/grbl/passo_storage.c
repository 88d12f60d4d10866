/* SPDX-License-Identifier: MIT
 * A page is: tag, number, record, CRC.
 */
#include "passo_storage.h"

#include <string.h>

#include "passo_crc.h"

#define TAG UINT32_C(0x50530000) /* and the words of the record */
#define ERASED UINT32_MAX
#define HEAD 2u
#define PIECE 16u

enum copy { COPY_ERASED, COPY_VALID, COPY_BAD };

void passo_storage_open(struct passo_storage *storage, const struct passo_storage_pages *pages, size_t words)
{
	*storage = (struct passo_storage){.pages = pages, .words = words};
}

static size_t smaller(size_t a, size_t b)
{
	return a < b ? a : b;
}

static enum copy look_at(const struct passo_storage *storage, unsigned page, uint32_t *number)
{
	const struct passo_storage_pages *pages = storage->pages;
	const size_t words = HEAD + storage->words;
	uint32_t crc = PASSO_CRC_START, piece[PIECE], head[HEAD] = {0, 0};
	bool erased = true;

	for (size_t at = 0; at < words; at += PIECE) {
		const size_t count = smaller(words - at, PIECE);

		if (!pages->read(pages->context, page, at, piece, count))
			return COPY_BAD;
		for (size_t i = 0; i < count; i++) {
			erased = erased && piece[i] == ERASED;
			if (at + i < HEAD)
				head[at + i] = piece[i];
		}
		crc = passo_crc(crc, piece, count);
	}
	if (!pages->read(pages->context, page, words, piece, 1))
		return COPY_BAD;
	*number = head[1];
	if (head[0] == (TAG | storage->words) && piece[0] == crc)
		return COPY_VALID;
	return erased && piece[0] == ERASED ? COPY_ERASED : COPY_BAD;
}

enum passo_storage_state passo_storage_load(struct passo_storage *storage, uint32_t *record)
{
	uint32_t number[2] = {0, 0};
	enum copy copy[2];

	for (unsigned page = 0; page < 2; page++)
		copy[page] = look_at(storage, page, &number[page]);
	if (copy[0] != COPY_VALID && copy[1] != COPY_VALID)
		return copy[0] == COPY_ERASED && copy[1] == COPY_ERASED ? PASSO_STORAGE_EMPTY
		                                                        : PASSO_STORAGE_BAD;
	const bool second_is_newer = copy[0] != COPY_VALID || (int32_t)(number[1] - number[0]) > 0;

	storage->page = copy[1] == COPY_VALID && second_is_newer ? 1u : 0u;
	storage->number = number[storage->page];
	return storage->pages->read(storage->pages->context, storage->page, HEAD, record, storage->words)
	         ? PASSO_STORAGE_LOADED
	         : PASSO_STORAGE_BAD;
}

/* Whether the copy in force has these words: it is not written again, so that the flash does not wear. */
static bool is_kept(const struct passo_storage *storage, const uint32_t *record)
{
	const struct passo_storage_pages *pages = storage->pages;
	uint32_t piece[PIECE], number = 0;

	for (size_t at = 0; at < storage->words; at += PIECE) {
		const size_t count = smaller(storage->words - at, PIECE);

		if (!pages->read(pages->context, storage->page, HEAD + at, piece, count)
		    || memcmp(piece, record + at, count * sizeof *piece) != 0)
			return false;
	}
	return look_at(storage, storage->page, &number) == COPY_VALID;
}

bool passo_storage_save(struct passo_storage *storage, const uint32_t *record)
{
	const struct passo_storage_pages *pages = storage->pages;
	const unsigned page = 1u - storage->page;
	const uint32_t head[HEAD] = {TAG | (uint32_t)storage->words, storage->number + 1u};
	const uint32_t crc = passo_crc(passo_crc(PASSO_CRC_START, head, HEAD), record, storage->words);
	uint32_t number = 0;

	if (is_kept(storage, record))
		return true;
	if (!pages->erase(pages->context, page) || !pages->write(pages->context, page, 0, head, HEAD)
	    || !pages->write(pages->context, page, HEAD, record, storage->words)
	    || !pages->write(pages->context, page, HEAD + storage->words, &crc, 1)
	    || look_at(storage, page, &number) != COPY_VALID)
		return false;
	storage->page = page;
	storage->number = number;
	return true;
}
