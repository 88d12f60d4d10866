/* SPDX-License-Identifier: MIT
 * The profile of a path: the square of the velocity over the path, which changes evenly at constant
 * acceleration. It rises from where the ramps end, and falls such that the path can come to rest.
 */
#include "passo_path_private.h"

uint64_t passo_path_gain(uint64_t slope, uint64_t length)
{
	return passo_path_smaller(passo_mul_shift(slope, length, 32), PASSO_PATH_SQUARE_MAX);
}

uint64_t passo_path_change(const struct passo_path_planner *path, uint64_t slope, uint64_t ticks)
{
	return passo_mul_shift(slope, ticks << path->machine.tick_log2, 17);
}

/* Length over which the square changes, UQ32.32 substeps. */
static uint64_t length_of(uint64_t change, uint64_t slope)
{
	return passo_mul_div(change, PASSO_UNIT_Q32, slope);
}

static unsigned put(struct passo_path_part *parts, unsigned count, enum passo_path_kind kind, uint64_t length,
    uint64_t square, uint64_t slope)
{
	if (length == 0)
		return count;
	parts[count] = (struct passo_path_part){kind, length, square, slope, .early = false};
	return count + 1;
}

#ifndef PASSO_WITHOUT_ROUNDING
/* By this part of its square a path may be slower in a valley. */
#define VALLEY 128u

/* Whether the path passes the corner at the start of an item at the highest speed there, from which it need
 * not come down any further. A ramp that comes down to there ends within a tick. */
static bool is_valley(const struct passo_path_item *item, uint64_t square)
{
	const uint64_t above = square + square / VALLEY;

	if (item->point != PASSO_PATH_CORNER)
		return item->valley && above >= item->bend;
	return item->valley && item->reach == item->corner && above >= item->reach;
}

/* UQ32.32 substeps. */
static uint64_t away_of(const struct passo_path_item *item)
{
	return (uint64_t)item->turn * item->away << 16;
}

uint64_t passo_path_flat(const struct passo_path_planner *path, uint32_t index, uint32_t line, bool rises,
    uint64_t square, bool valley)
{
	const struct passo_path_item *item = passo_path_item(path, index);
	const uint32_t length = passo_path_item(path, line)->substeps;

	if (index >= path->added || item->rest || item->turn == 0
	    || passo_path_shape(path) != PASSO_SHAPE_LINEAR)
		return 0;
	if (item->point == (line == index ? PASSO_PATH_BEFORE : PASSO_PATH_BEHIND))
		return 0;
	if (length / 2 < item->turn && !item->whole) /* the curve of a short line has it */
		return 0;
	if (valley && is_valley(item, square))
		return 0;
	uint64_t flat = 0;
	/* what both sides leave, signed, is at least what the corner needs: a right angle has it */
	for (unsigned i = 0; i < PASSO_PATH_SHARES; i++) {
		const struct passo_path_share *share = &item->lone[rises][i];
		const uint64_t lost = share->lost;
		if (lost == 0)
			break;
		const uint64_t needed =
		    passo_mul_div(passo_path_smaller(square, item->bend), share->needed, item->bend);
		const uint64_t left = 256 - needed;

		if (left < lost)
			flat = passo_path_larger(flat, ((uint64_t)item->turn << 32) / lost * (lost - left));
	}
	const uint64_t away = away_of(item);
	return flat > away ? passo_path_smaller(flat - away, (uint64_t)length << 32) : 0;
}

/* Length beside the start of an item over which a corner there, or farther away, is rounded. */
static uint64_t turn_of(const struct passo_path_item *item)
{
	return ((uint64_t)item->turn << 32) - away_of(item);
}
#endif

/* Of a half, or less, in a step: at most three. */
static unsigned step_parts(const struct passo_path_item *item, unsigned half, uint64_t left, uint64_t square,
    uint64_t top, uint64_t end, struct passo_path_part *parts)
{
	const uint64_t steepest = passo_path_slope(item, half, false, end, left); /* makes up for rounding */
	const uint64_t down = passo_path_down(steepest);
	const uint64_t highest = end + passo_path_gain(down, left);

	/* above it where a line at whose end the path could rest has become part of a curve */
	if (square >= highest)
		return put(parts, 0, PASSO_PATH_DOWN, left, end,
		    square > highest ? passo_path_straight_slope(item) : steepest);
	top = passo_path_larger(top, square);
	const uint64_t up = passo_path_slope(item, half, true, square, left);
	const uint64_t rise = square + passo_path_gain(up, left);
	if (rise <= end && rise <= top)
		return put(parts, 0, PASSO_PATH_UP, left, rise, up);

	uint64_t rising = passo_path_smaller(length_of(highest - square, up + down), left);
	uint64_t peak = square + passo_path_gain(up, rising);
	uint64_t falling = left - rising;
	if (peak > top) {
		peak = top;
		rising = length_of(peak - square, up);
		falling = peak > end ? length_of(peak - end, down) : 0;
		falling = passo_path_smaller(falling, left - rising);
	}
	unsigned count = put(parts, 0, PASSO_PATH_UP, rising, peak, up);
	if (count > 0)
		parts[0].early = peak < top;
	count = put(parts, count, PASSO_PATH_FLAT, left - rising - falling, peak, up);
	return put(parts, count, PASSO_PATH_DOWN, falling, end, steepest);
}

/* At most six. */
static unsigned half_parts(const struct passo_path_item *item, unsigned half, uint64_t left, uint64_t square,
    uint64_t top, uint64_t end, struct passo_path_part *parts)
{
	if (!passo_path_is_strong(item) || left <= passo_path_shortest_step(item))
		return step_parts(item, half, left, square, top, end, parts);
	uint64_t second = passo_path_longest_step(item);

	while (second >= left)
		second /= 2;
	const uint64_t middle =
	    passo_path_smaller(passo_path_half_before(item, half, end, second), passo_path_larger(top, end));
	const unsigned count = step_parts(item, half, left - second, square, top, middle, parts);
	return count + step_parts(item, half, second, parts[count - 1].square, top, end, parts + count);
}

/* Without the flat ends, of which that behind is given; no faster than `top`, unless it is already. */
static unsigned middle_parts(const struct passo_path_planner *path, uint32_t index, uint64_t left,
    uint64_t behind, uint64_t square, uint64_t end, uint64_t top, bool level, struct passo_path_part *parts)
{
	const struct passo_path_item *item = passo_path_item(path, index);
	const uint64_t half = (uint64_t)item->substeps << 31;
	const uint64_t second = half > behind ? half - behind : 0;
	unsigned count = 0;

	if (level && !passo_path_is_settled(path, index))
		top = passo_path_smaller(top, passo_path_larger(end, square));
	if (passo_path_halves(item) > 1 && left > second) {
		const uint64_t middle = passo_path_before(item, end, second, behind);

		count = half_parts(item, 0, left - second, square, top,
		    passo_path_smaller(middle, passo_path_larger(item->top, end)), parts);
		square = parts[count - 1].square;
		left = second;
	}
	if (left > 0)
		count += half_parts(item, passo_path_halves(item) - 1, left, square, top, end, parts + count);
	return count;
}

/* With the flat ends. */
static unsigned all_parts(const struct passo_path_planner *path, uint32_t index, uint64_t left,
    uint64_t before, uint64_t behind, uint64_t square, uint64_t end, uint64_t top, bool level,
    struct passo_path_part *parts)
{
	const uint64_t slope = passo_path_item(path, index)->slope;

	behind = passo_path_smaller(behind, left);
	before = passo_path_smaller(before, left - behind);
	unsigned count = put(parts, 0, PASSO_PATH_FLAT, before, square, slope);
	if (left > before + behind)
		count += middle_parts(
		    path, index, left - before - behind, behind, square, end, top, level, parts + count);
	if (count > 0)
		square = parts[count - 1].square;
	return put(parts, count, PASSO_PATH_FLAT, behind, passo_path_smaller(square, end), slope);
}

#ifndef PASSO_WITHOUT_ROUNDING
/* Whether it goes down behind what is flat. */
static bool falls(const struct passo_path_part *parts, unsigned count, uint64_t square)
{
	for (unsigned i = 0; i < count; i++) {
		if (parts[i].square != square)
			return parts[i].square < square;
	}
	return false;
}

/* Length before the way down; of all of it, if there is none. */
static uint64_t before_fall(const struct passo_path_part *parts, unsigned count)
{
	uint64_t length = 0;

	for (unsigned i = 0; i < count && parts[i].kind != PASSO_PATH_DOWN; i++)
		length += parts[i].length;
	return length;
}

/* Length behind the way up; no limit if there is none. */
static uint64_t behind_rise(const struct passo_path_part *parts, unsigned count)
{
	uint64_t length = 0;

	while (count > 0 && parts[count - 1].kind != PASSO_PATH_UP)
		length += parts[--count].length;
	return count > 0 ? length : UINT64_MAX;
}

/* The square that the path has on its way up, which begins at `square`, so far before the end. */
static uint64_t square_before(
    const struct passo_path_part *parts, unsigned count, uint64_t left, uint64_t square, uint64_t behind)
{
	for (unsigned i = 0; i < count && left > behind; i++) {
		const struct passo_path_part *part = &parts[i];
		const uint64_t length = passo_path_smaller(part->length, left - behind);

		if (part->square > square)
			square += passo_mul_div(part->square - square, length, part->length);
		left -= length;
	}
	return square;
}

/* Whether the path comes down over all of the rounding of the valley at the end of an item. */
static bool comes_down(const struct passo_path_item *next, uint64_t left, uint64_t square,
    const struct passo_path_part *parts, unsigned count)
{
	const uint64_t turn = turn_of(next);
	uint64_t length = 0;

	if (left <= turn) /* is within it */
		return is_valley(next, square)
		    && (left <= turn / PASSO_PATH_HARDLY || parts[0].square <= square + square / VALLEY);
	while (count > 0 && parts[count - 1].kind == PASSO_PATH_DOWN)
		length += parts[--count].length;
	return length >= turn;
}

/* The way up behind a level part begins with less slope instead: it is faster sooner. */
static unsigned rise_evenly(struct passo_path_part *parts, unsigned count, uint64_t over, uint64_t square)
{
	struct passo_path_part *flat = &parts[0], *up = &parts[1];

	if (count < 2 || flat->kind != PASSO_PATH_FLAT || up->kind != PASSO_PATH_UP || flat->length >= over)
		return count;
	const uint64_t both = flat->length + up->length, most = passo_path_smaller(both, over);
	const uint64_t steep = most - flat->length;
	*flat = *up;
	flat->square = square + passo_mul_div(up->square - square, steep, up->length);
	flat->slope = passo_path_larger(passo_mul_div(up->slope, steep, most), 1);
	flat->length = most;
	up->length = both - most;
	if (up->length > 0)
		return count;
	for (unsigned i = 1; i + 1 < count; i++)
		parts[i] = parts[i + 1];
	return count - 1;
}

/* The way down before a level part ends with less slope instead. */
static unsigned fall_evenly(struct passo_path_part *parts, unsigned count, uint64_t over, uint64_t square)
{
	if (count < 2)
		return count;
	struct passo_path_part *down = &parts[count - 2], *flat = &parts[count - 1];

	if (flat->kind != PASSO_PATH_FLAT || down->kind != PASSO_PATH_DOWN || flat->length >= over)
		return count;
	const uint64_t both = flat->length + down->length, most = passo_path_smaller(both, over);
	const uint64_t steep = most - flat->length, from = count > 2 ? parts[count - 3].square : square;

	down->square = flat->square + passo_mul_div(from - flat->square, steep, down->length);
	/* all of it, also where it is within the level part already */
	const uint64_t needed = passo_mul_div_ceil(down->square - flat->square, PASSO_UNIT_Q32, most);
	const struct passo_path_part last = {PASSO_PATH_DOWN, most, flat->square,
	    passo_path_larger(passo_path_smaller(needed, down->slope), 1), .early = false};
	down->length = both - most;
	if (down->length == 0)
		count--;
	parts[count - 1] = last;
	return count;
}

/* Highest square from which an item can come down to its end, if it does so behind a length only. */
static uint64_t high_behind(
    const struct passo_path_item *item, uint64_t left, uint64_t length, uint64_t behind, uint64_t end)
{
	return passo_path_before(item, end, left - passo_path_smaller(left, length + behind), behind);
}

/* Length over which a way of less slope replaces a level part at a corner that turns over a length, and the
 * steep way beside it. A level part takes longest, so it leaves most for the corner, but it costs most: so
 * between. */
static uint64_t spread(uint64_t flat, uint64_t turn)
{
	return flat + (turn - flat) / 2;
}

/* What is level of the rest of it. */
static uint64_t share_of(uint64_t flat, uint64_t over, uint64_t left)
{
	return left < over ? passo_mul_div(flat, left, over) : flat;
}
#endif

unsigned passo_path_parts(const struct passo_path_planner *path, uint32_t index, uint64_t left,
    uint64_t square, bool level, struct passo_path_part *parts)
{
	uint64_t end = passo_path_end_square(path, index);
#ifdef PASSO_WITHOUT_ROUNDING
	return all_parts(
	    path, index, left, 0, 0, square, end, passo_path_item(path, index)->top, level, parts);
#else
	const struct passo_path_item *item = passo_path_item(path, index);
	uint64_t top = item->top;
	const struct passo_path_item *next = passo_path_item(path, index + 1);
	const uint64_t passed = ((uint64_t)item->substeps << 32) - left;
	const uint64_t corner = passed > 0 ? passo_path_passing(path, square) : square;
	const uint64_t begun = passo_path_flat(path, index, index, true, corner, true);
	const uint64_t ended = passo_path_flat(path, index + 1, index, false, end, true);
	const uint64_t rising = spread(begun, turn_of(item));
	const uint64_t over = rising > passed ? rising - passed : 0;
	const uint64_t falling = spread(ended, turn_of(next));
	uint64_t before = share_of(begun, rising, over);
	uint64_t behind = share_of(ended, falling, left);
	unsigned count = all_parts(path, index, left, before, behind, square, end, top, level, parts);
	const bool valley = index + 1 < path->added && is_valley(next, end);
	const uint64_t high = passo_path_flat(path, index, index, false, corner, true);

	/* beside the corner at its start it does not come down for so long, so it rises no higher than it can
	 * come down from behind that */
	uint64_t most = UINT64_MAX;
	if (before > 0 && falls(parts, count, square))
		most = square;
	else if (high > passed && before_fall(parts, count) < high - passed)
		most = high_behind(item, left, high - passed, behind, end);
	if (most < UINT64_MAX) {
		if (most <= square + square / VALLEY) {
			before = 0;
			most = square;
		}
		top = passo_path_smaller(top, most);
		count = all_parts(path, index, left, before, behind, square, end, top, level, parts);
	}
	/* where it comes up to the corner, that is no valley, nor does it need more than at the highest speed
	 * there */
	if (valley ? !comes_down(next, left, square, parts, count) : parts[count - 1].square < end) {
		if (valley)
			end -= end / VALLEY * 2;
		count = all_parts(path, index, left, before, 0, square, end, top, level, parts);
		behind = passo_path_flat(path, index + 1, index, true, parts[count - 1].square, false);
		if (behind > 0)
			count = all_parts(path, index, left, before, behind, square, end, top, level, parts);
	} else if (!valley) {
		/* beside that at its end it does not rise to come down again */
		const uint64_t low = passo_path_flat(path, index + 1, index, true, end, false);

		if (behind_rise(parts, count) < low) {
			top = square_before(parts, count, left, square, low);
			count = all_parts(path, index, left, before, behind, square, end, top, level, parts);
		}
	}
	if (before > 0)
		count = rise_evenly(parts, count, over, square);
	if (behind > 0)
		count = fall_evenly(parts, count, passo_path_smaller(falling, left), square);
	return count;
#endif
}
