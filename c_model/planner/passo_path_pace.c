/* SPDX-License-Identifier: MIT
 * The pace of a path: no more ramps and lines than a host with a lowest rate of polls can send.
 *
 * Of the ramps, any PASSO_PATH_PACED in a row last a certain time. While the last ones were long, the next
 * one may be short, and the profile is followed exactly. Before it may not, a ramp ends only where the path
 * could go on at its speed for as long as the next one must last. From there that ramp can always be made: it
 * goes to the lowest speed of all that is before it until the end of the one after it. If the profile comes
 * down to there only after the ramp, it does so in less time, so the ramp is not steeper.
 *
 * Of the lines, each takes as long as its share of a frame; those behind a long one may take less. Those of a
 * small look-ahead are known so late that the path may have to come to rest within them: they take longer.
 */
#include "passo_path_private.h"

/* Most lines that may follow a long one immediately. */
#define BURST 16u

/* By 2^-20 of its square a ramp may be above the profile, which is rounded. */
#define ROUNDED 20u

/* The room for a frame is seen by one poll and used by the next, and a frame of lines may be under way then:
 * what is queued behind the room lasts for three polls, and so do the known lines, which hold twice as many
 * ramps as are limited together. Of three frames two are for lines; one in four is spare. */
void passo_path_pace(
    struct passo_path_planner *path, uint32_t queued, uint32_t lines_queued, uint32_t lines_sent)
{
	if (path->polls == 0)
		return; /* not open yet */
	const uint64_t poll = (path->machine.clock_hz >> path->machine.tick_log2) / path->polls + 1;
	const uint64_t known = passo_path_smaller(path->capacity / 2 - 1, PASSO_PATH_PACED);
	const uint32_t together = (uint32_t)passo_path_larger(passo_path_smaller(queued, known), 1);
	const uint64_t ramps = 3 * together * poll / passo_path_larger(queued, 1) + 1;
	/* two polls for those of a frame, four for those queued, three for those known */
	const uint64_t share = passo_path_smaller(
	    passo_path_smaller(6 * lines_sent, 3 * lines_queued), 4 * (path->capacity - 2));
	const uint64_t line = 12 * poll / passo_path_larger(share, 1);

	path->waits = false;
	path->paced = together;
	path->pace = (uint32_t)passo_path_smaller(ramps, PASSO_PATH_TICKS_MAX);
	path->line_clocks =
	    (uint32_t)passo_path_smaller((line + 1) << path->machine.tick_log2, UINT32_MAX / (2 * BURST));
	const uint32_t most = lines_queued < BURST ? lines_queued : 2 * BURST;
	path->line_burst = (most < path->capacity ? most : path->capacity) / 2; /* the path has to see them */
}

void passo_path_pace_begin(struct passo_path_planner *path)
{
	for (unsigned i = 0; i < PASSO_PATH_PACED - 1; i++)
		path->recent[i] = PASSO_PATH_TICKS_MAX;
}

void passo_path_pace_ramp(struct passo_path_planner *path, uint32_t ticks)
{
	for (unsigned i = PASSO_PATH_PACED - 2; i > 0; i--)
		path->recent[i] = path->recent[i - 1];
	path->recent[0] = (uint32_t)passo_path_smaller(ticks, PASSO_PATH_TICKS_MAX);
}

void passo_path_pace_line(struct passo_path_planner *path, struct passo_path_item *item)
{
	const uint64_t length = (uint64_t)item->substeps << 32;
	const uint64_t clocks = length / passo_path_larger(item->limit, 1);
	const uint64_t most = path->line_burst * (uint64_t)path->line_clocks;
	const uint64_t credit = path->at.line_credit + clocks;

	if (credit < path->line_clocks) {
		const uint64_t velocity = length / (path->line_clocks - path->at.line_credit);

		item->limit = (uint32_t)passo_path_larger(velocity, 1);
		path->at.line_credit = 0;
	} else {
		path->at.line_credit = (uint32_t)passo_path_smaller(credit - path->line_clocks, most);
	}
}

uint32_t passo_path_pace_need(const struct passo_path_planner *path, uint64_t ticks, unsigned count)
{
	uint64_t sum = count <= path->paced ? ticks : 0;

	for (unsigned i = 0; i + count < path->paced; i++)
		sum += path->recent[i];
	return sum < path->pace ? path->pace - (uint32_t)sum : 0;
}

uint64_t passo_path_length_in(const struct passo_path_planner *path, uint64_t speeds, uint64_t ticks)
{
	return passo_mul_shift(speeds, ticks << path->machine.tick_log2, 17);
}

/* The least that the curve of an item leaves, from the present speed over a length. */
static uint64_t slope_left(
    const struct passo_path_planner *path, const struct passo_path_item *item, bool up, uint64_t length)
{
	const uint64_t square = passo_path_square_of(path->velocity);
	uint64_t slope = UINT64_MAX;

	for (unsigned half = 0; half < passo_path_halves(item); half++)
		slope = passo_path_smaller(slope, passo_path_slope(item, half, up, square, length));
	return slope;
}

/* What the corner at the start of the line leaves of its slope while the path is within the rounding: of the
 * part that would be level, nothing, so evenly. */
static uint64_t left_behind(const struct passo_path_planner *path, bool up)
{
#ifdef PASSO_WITHOUT_ROUNDING
	(void)path, (void)up;
	return UINT64_MAX;
#else
	const struct passo_path_item *item = passo_path_item(path, path->planned);
	const uint64_t turn = (uint64_t)item->turn << 32;

	if ((uint64_t)path->offset >= turn)
		return UINT64_MAX;
	const uint64_t flat = passo_path_flat(path, path->planned, path->planned, up, path->passing, false);
	return passo_mul_div(item->slope, turn - passo_path_smaller(flat, turn), turn);
#endif
}

/* The square from which an item comes down to one at its end over the rest of it, UQ32.32 substeps; where the
 * corner there is rounded it is level. */
static uint64_t before_corner(const struct passo_path_planner *path, const struct passo_path_item *item,
    uint32_t index, uint64_t end, uint64_t rest)
{
#ifdef PASSO_WITHOUT_ROUNDING
	(void)path, (void)index;
	return passo_path_before(item, end, rest, 0);
#else
	const uint64_t flat =
	    passo_path_smaller(passo_path_flat(path, index + 1, index, false, end, true), rest);

	return passo_path_before(item, end, rest - flat, flat);
#endif
}

/* What is before the end of the ramps. */
struct ahead {
	uint64_t square; /* the lowest that is allowed */
	uint64_t slope;  /* the lowest of the lines, whatever their curves */
	uint64_t left;   /* the steepest that a ramp up, or down, over them may be */
	uint64_t fall;   /* the least steep that a ramp down has to be, to be below all that it passes */
	uint64_t rest;   /* length to the end of the line at which the path rests; 0: it does not */
	uint64_t end;    /* the square there */
	bool open;       /* further lines may raise it */
	bool unknown;    /* further lines are needed to know it */
};

/* Over a length. Where it is needed the path rests at the end of the newest line; before, that line is not
 * entered, and what is behind its start is not known. */
static struct ahead look_ahead(
    const struct passo_path_planner *path, uint64_t length, enum passo_path_need need, bool up)
{
	struct ahead ahead = {
	    .square = PASSO_PATH_SQUARE_MAX, .slope = UINT64_MAX, .left = left_behind(path, up)};
	const uint64_t square = passo_path_square_of(path->velocity);
	uint64_t passed = 0;

	for (uint32_t index = path->planned;; index++) {
		if (need == PASSO_PATH_NO_NEED && passo_path_is_held_back(path, index)) {
			ahead.open = ahead.unknown = true;
			break;
		}
		const struct passo_path_item *item = passo_path_item(path, index);
		const uint64_t end = passo_path_end_square(path, index);

		passed += (uint64_t)item->substeps << 32;
		if (index == path->planned)
			passed -= (uint64_t)path->offset;
		const uint64_t beyond = passed > length ? passed - length : 0;
		const uint64_t before = before_corner(path, item, index, end, beyond);

		ahead.open = ahead.open || !passo_path_is_settled(path, index);
		ahead.slope = passo_path_smaller(ahead.slope, item->slope);
		ahead.left = passo_path_smaller(
		    ahead.left, slope_left(path, item, up, up ? passo_path_smaller(passed, length) : 0));
		ahead.square = passo_path_smaller(ahead.square, item->top);
		if (beyond > 0) {
			ahead.square = passo_path_smaller(ahead.square, before);
			break;
		}
		if (passo_path_rests_after(path, index)) {
			ahead.rest = passed;
			ahead.end = end;
			break;
		}
		ahead.square = passo_path_smaller(ahead.square, end);
		if (end + (end >> ROUNDED) < square)
			ahead.fall = passo_path_larger(
			    ahead.fall, passo_mul_div_ceil(square - end, PASSO_UNIT_Q32, passed));
	}
	return ahead;
}

/* Whether a ramp down stays below all that it passes: what it ends below is no steeper. */
static bool is_below(
    const struct passo_path_planner *path, const struct ahead *ahead, const struct passo_path_aim *aim)
{
	const uint64_t fall = passo_path_gain(ahead->fall, aim->length);

	return aim->square + fall <= passo_path_square_of(path->velocity);
}

static uint64_t lowest(const struct ahead *ahead)
{
	return ahead->rest > 0 ? passo_path_smaller(ahead->square, ahead->end) : ahead->square;
}

static struct passo_path_aim aim_at(
    const struct passo_path_planner *path, uint64_t velocity, uint64_t length, uint64_t slope)
{
	const enum passo_path_kind kind = velocity > path->velocity ? PASSO_PATH_UP
	                                : velocity < path->velocity ? PASSO_PATH_DOWN
	                                                            : PASSO_PATH_FLAT;

	return (struct passo_path_aim){kind, length, passo_path_square_of(velocity), slope, .plain = true};
}

/* A ramp of `ticks` ticks, after which the path could continue for `next`; down no steeper than the curves
 * leave at the present speed, or `steep`, than the lines. Length 0: there is none. */
static struct passo_path_aim calm(const struct passo_path_planner *path, uint64_t ticks, uint64_t next,
    bool steep, enum passo_path_need need)
{
	const uint64_t from = path->velocity, slope = passo_path_item(path, path->planned)->slope;
	const uint64_t most = from + passo_path_change(path, slope, ticks);
	struct ahead ahead =
	    look_ahead(path, passo_path_length_in(path, 2 * from, ticks + next), need, false);
	uint64_t to = passo_path_velocity_of(lowest(&ahead));

	if (ahead.rest > 0 && from > 0) {
		struct passo_path_aim aim =
		    aim_at(path, passo_path_velocity_of(ahead.end), ahead.rest, ahead.slope);

		if (aim.kind == PASSO_PATH_DOWN && !is_below(path, &ahead, &aim))
			aim.length = 0;
		aim.rest = true;
		aim.open = ahead.open;
		return aim;
	}
	if (to < from) {
		const uint64_t fall =
		    passo_path_smaller(passo_path_change(path, ahead.fall, ticks), from - 1) + 1;
		const uint64_t most_down =
		    steep ? ahead.slope + ahead.slope / 16 : ahead.left + ahead.left / PASSO_PATH_STEEPER;

		to = passo_path_smaller(to, from - fall);
		if (from - to > passo_path_change(path, most_down, ticks))
			return (struct passo_path_aim){.length = 0, .open = ahead.unknown};
	} else {
		ahead = look_ahead(path,
		    passo_path_length_in(path, from + most, ticks)
		        + passo_path_length_in(path, 2 * most, next),
		    need, true);
		to = passo_path_velocity_of(lowest(&ahead));
		const uint64_t units = UINT64_C(1) << (17u - path->machine.tick_log2);
		if (ahead.rest > 0 && from > 0) { /* the next one is the last */
			const uint64_t way = passo_path_length_in(path, from, ticks);
			const uint64_t left = ahead.rest > way ? ahead.rest - way : 0;

			to = passo_path_smaller(to, passo_mul_div(left, units, ticks + 2 * next));
		} else if (ahead.rest > 0) { /* up, and down again, and the ramp to 0 */
			next = passo_path_larger(passo_path_pace_need(path, ticks, 3), ticks / 4);
			to = passo_path_smaller(passo_path_velocity_of(ahead.square),
			    passo_mul_div(ahead.rest, units, ticks + next));
			to = passo_path_smaller(to, passo_path_change(path, ahead.slope, next));
		}
		to = passo_path_smaller(to, from + passo_path_change(path, ahead.left, ticks));
		to = passo_path_larger(to, from);
	}
	struct passo_path_aim aim = aim_at(
	    path, to, passo_path_length_in(path, from + to, ticks), to > from ? ahead.left : ahead.slope);
	aim.open = ahead.open;
	return aim;
}

/* A ramp down, to a speed at which the known lines last: where there is no room for more of them, and they
 * are so short that they do not at this one. */
static struct passo_path_aim brake(const struct passo_path_planner *path, uint64_t least)
{
	const uint64_t from = path->velocity;
	uint64_t slope = UINT64_MAX, to = from - from / 4;

	while (to > from / 8) {
		const uint64_t needed = passo_path_ticks_over(path, from - to, slope); /* as for a length */
		const uint64_t ticks = passo_path_larger(least, needed) + 1;
		const uint64_t way = passo_path_length_in(path, from + to, ticks);
		const uint64_t next = passo_path_pace_need(path, ticks, 2);
		const struct ahead ahead =
		    look_ahead(path, way + passo_path_length_in(path, 2 * to, next), PASSO_PATH_FULL, false);
		const struct passo_path_aim aim = aim_at(path, to, way, ahead.slope);

		if (ahead.left
		    < slope) { /* the longer way of a ramp that is less steep may have more curves */
			slope = ahead.left;
			continue;
		}
		if (ahead.rest == 0 && aim.square <= ahead.square && is_below(path, &ahead, &aim))
			return aim;
		to -= from / 4;
	}
	return (struct passo_path_aim){.length = 0};
}

struct passo_path_aim passo_path_at_pace(
    const struct passo_path_planner *path, const struct passo_path_aim *aim, enum passo_path_need need)
{
	const uint64_t ticks = passo_path_ticks_to(path, aim);
	const uint64_t least = passo_path_pace_need(path, 0, aim->rest ? 2 : 1);
	const uint64_t then = aim->rest ? 0 : passo_path_pace_need(path, ticks, 2);

	if (path->pace == 0 || aim->length == 0 || (ticks >= least && then == 0))
		return *aim;
	const uint64_t way = passo_path_length_in(path, 2 * passo_path_velocity_of(aim->square), then);
	if (ticks >= least) {
		const struct ahead ahead = look_ahead(path, aim->length + way, need, true);

		if (!ahead.unknown && lowest(&ahead) >= aim->square)
			return *aim;
	}
	/* As long as the mean, and then on at its speed; or so long that any may follow; or with the mean
	 * just down with the profile. */
	const uint64_t shorter = passo_path_larger(least, path->pace / path->paced) + 1;
	const uint64_t longer = passo_path_larger(shorter, passo_path_pace_need(path, 0, 2) + 1);
	struct passo_path_aim made = {.length = 0};

	for (unsigned i = 0; i < 6 && made.length == 0 && !made.open; i++) {
		const uint64_t some = i % 3 == 1 ? longer : shorter;
		const uint64_t next = i % 3 == 2 ? 0 : passo_path_pace_need(path, some, 2);

		made = calm(path, some, next, i >= 3, need);
	}
	if (made.open && need == PASSO_PATH_NO_NEED) {
		made.length = 0;
		return made;
	}
	if (made.length == 0 && need == PASSO_PATH_FULL)
		made = brake(path, least);
	if (made.length == 0)
		return *aim;
	made.open = false;
	return made;
}
