/* SPDX-License-Identifier: MIT
 * Corners within a shaped ramp. It covers the same length in the same time as a linear one, but is faster in
 * between: when it speeds up, in its second half.
 */
#include "passo_path_private.h"
#include "passo_shapes.h"

#ifndef PASSO_LINEAR_PATHS

/* A ramp ends at a lone corner that it would pass with less than this part of the square to spare: there it
 * has no acceleration along the path. */
#define LONE 16u

/* Square of the velocity that a ramp has when a share of its shape (UQ0.16) is done. */
static uint64_t square_at(uint64_t begin, uint64_t end, uint32_t share)
{
	const uint64_t change = begin < end ? end - begin : begin - end;
	const uint64_t part = passo_mul_div(change, share, UINT32_C(1) << 16);
	const uint64_t velocity = (begin < end ? begin + part : begin - part) >> PASSO_PATH_VELOCITY_SHIFT;

	return velocity * velocity;
}

uint32_t passo_path_too_fast(const struct passo_path_planner *path, const struct passo_path_aim *aim)
{
	const unsigned bank = (unsigned)passo_path_shape(path);
	const uint64_t begin = path->velocity;
	const uint64_t end = (uint64_t)passo_isqrt64(aim->square) << PASSO_PATH_VELOCITY_SHIFT;
	const bool falls = end < begin;
	uint32_t index = path->planned;
	uint64_t corner = ((uint64_t)passo_path_item(path, index)->substeps << 32) - (uint64_t)path->offset;
	uint64_t area = 0; /* under the shape so far, in units of 2^-17 points */

	for (uint32_t k = 0; k < PASSO_BANK_POINTS && index + 1 < path->added; k++) {
		const uint32_t point = passo_shape_point(bank, k), next = passo_shape_point(bank, k + 1);

		area += point + next;
		/* twice the mean velocity times the time so far, as a share of that of the whole ramp */
		const uint64_t fixed = begin * 2 / PASSO_BANK_POINTS * (k + 1);
		const uint64_t moved = passo_mul_div(
		    falls ? begin - end : end - begin, area, (UINT64_C(1) << 16) * PASSO_BANK_POINTS);
		const uint64_t covered =
		    passo_mul_div(aim->length, falls ? fixed - moved : fixed + moved, begin + end);
		const uint64_t square = square_at(begin, end, falls ? point : next);

		for (; corner <= covered && corner < aim->length && index + 1 < path->added; index++) {
			const struct passo_path_item *item = passo_path_item(path, index + 1);
			const uint64_t most = item->corner - (item->arc == 0 ? item->corner / LONE : 0);

			if (square > most && most > 0)
				return index + 1;
			corner += (uint64_t)item->substeps << 32;
		}
	}
	return path->added;
}

#endif
