/* SPDX-License-Identifier: MIT
 * Pending output changes: the output delay. See rtl/passo_changes.v.
 */
#include "passo_core_outputs.h"

#include <string.h>

enum { TWICE_DEPTH = 2 * PASSO_CHANGES_DEPTH };

static void drop(struct passo_changes *changes)
{
	changes->write_place = changes->read_place = 0;
	changes->hit = changes->valid = changes->full = changes->overflow = false;
	changes->empty = true;
}

void passo_changes_reset(struct passo_changes *changes)
{
	*changes = (struct passo_changes){0};
	drop(changes);
}

void passo_changes_clock(struct passo_changes *changes, bool flush, uint16_t lag, bool change,
    const struct passo_line_output *word)
{
	const uint16_t reads = (uint16_t)((changes->read_place + (changes->hit ? 1u : 0u)) % TWICE_DEPTH);
	const uint16_t write_place = changes->write_place;
	const bool push = change && !changes->full;

	changes->hit = changes->valid && changes->data.time == changes->now;
	changes->valid = reads != write_place;
	changes->data = changes->changes[reads % PASSO_CHANGES_DEPTH];
	changes->overflow = change && changes->full;
	changes->empty = !changes->valid && !change;
	changes->full = (write_place ^ changes->read_place) == PASSO_CHANGES_DEPTH;
	if (push) {
		changes->changes[write_place % PASSO_CHANGES_DEPTH] =
		    (struct passo_change){.time = changes->due, .word = *word};
		changes->write_place = (uint16_t)((write_place + 1u) % TWICE_DEPTH);
	}
	changes->read_place = reads;
	changes->due = (uint16_t)(changes->now + lag + 3u);
	changes->now++;
	if (flush)
		drop(changes);
}

bool passo_changes_steady(const struct passo_changes *changes, bool flush, uint16_t lag)
{
	const struct passo_change *next = &changes->changes[changes->read_place % PASSO_CHANGES_DEPTH];

	return changes->empty && !changes->hit && !changes->valid && !changes->overflow && !changes->full
	    && changes->read_place == changes->write_place && (!flush || changes->read_place == 0u)
	    && memcmp(&changes->data, next, sizeof *next) == 0
	    && changes->due == (uint16_t)(changes->now + lag + 2u);
}
