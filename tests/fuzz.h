/* SPDX-License-Identifier: MIT
 * Random numbers of the programs NAME_fuzz SEED SECONDS, and how long they run.
 */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

static uint64_t fuzz_state;
static time_t fuzz_end;

/* From the command line; by default seed 1 and one second. */
static inline void fuzz_begin(int count, char **words)
{
	fuzz_state = (count > 1 ? strtoull(words[1], NULL, 10) : 1u) * UINT64_C(0x9E3779B97F4A7C15) | 1u;
	fuzz_end = time(NULL) + (count > 2 ? atoi(words[2]) : 1);
}

static inline bool fuzz_goes_on(void)
{
	return time(NULL) < fuzz_end;
}

static inline uint64_t random_bits(void)
{
	fuzz_state ^= fuzz_state << 13;
	fuzz_state ^= fuzz_state >> 7;
	fuzz_state ^= fuzz_state << 17;
	return fuzz_state;
}

static inline uint32_t below(uint32_t limit)
{
	return (uint32_t)(random_bits() >> 32) % limit;
}

/* One of an array. */
#define PICK(list) ((list)[below(sizeof(list) / sizeof(list)[0])])

#endif
