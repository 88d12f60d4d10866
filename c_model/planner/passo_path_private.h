/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the path planner.
 */
#ifndef PASSO_PATH_PRIVATE_H
#define PASSO_PATH_PRIVATE_H

#include <stddef.h>

#include "passo_math.h"
#include "passo_path.h"

/* Squares of velocities are below this, so that the sum of two fits. */
#define PASSO_PATH_SQUARE_MAX (UINT64_C(1) << 62)

/* Velocities of the planner are UQ0.32, those of ramps UQ0.48. */
#define PASSO_PATH_VELOCITY_SHIFT 16u

/* 1.0 of a unit vector. */
#define PASSO_PATH_UNIT_BITS 30u
#define PASSO_PATH_ONE (UINT32_C(1) << PASSO_PATH_UNIT_BITS)
/* 1 / sqrt(2): a motor that moves two axes has its limits along a direction between them. */
#define PASSO_PATH_HALF_ROOT INT64_C(759250125)

/* Speeds up to half a substep per clock. */
#define PASSO_PATH_SPEED_MAX (UINT64_C(1) << 31)

/* Longest ramp that is not shaped: a longer one is cut. */
#define PASSO_PATH_TICKS_MAX (UINT32_C(1) << 15)

/* Longest shaped ramp. */
#define PASSO_PATH_SHAPED_TICKS_MAX (UINT32_C(1) << 20)

/* The path comes to rest from a velocity that the acceleration reaches in this number of ticks. */
#define PASSO_PATH_LANDING_TICKS 2u

/* By this part of its slope a ramp may be steeper: one that ends within several parts of the profile, with
 * slopes that differ a little, is a little above it. */
#define PASSO_PATH_STEEPER 64u

/* Less than this part of a rounding in a line is none. */
#define PASSO_PATH_HARDLY 16u

/* A straight part of the profile: the square of the velocity changes evenly over the path. */
enum passo_path_kind { PASSO_PATH_UP, PASSO_PATH_FLAT, PASSO_PATH_DOWN };

struct passo_path_part {
	enum passo_path_kind kind;
	uint64_t length; /* UQ32.32 substeps */
	uint64_t square; /* at its end */
	uint64_t slope;
	bool early; /* a way up that ends where the path has to come down for the end of the known lines */
};

/* Most parts of a line. */
#define PASSO_PATH_PARTS (PASSO_PATH_HALVES * 6u + 2u)

#define PASSO_PATH_ARC_BEFORE 1u
#define PASSO_PATH_ARC_BEHIND 2u

/* What the next ramp aims at. */
struct passo_path_aim {
	enum passo_path_kind kind;
	uint64_t length, square; /* of the path to there, UQ32.32 substeps; of the velocity there */
	uint64_t slope;
	bool rest;      /* it comes to rest there */
	bool open;      /* it ends there because what follows is not settled: */
	uint32_t index; /* this item */
	bool plain;     /* its ramp is linear */
	uint64_t first; /* slope of the part that it began with; `slope` is the steepest */
};

/* Why ramps are made beyond what is settled. */
enum passo_path_need { PASSO_PATH_NO_NEED, PASSO_PATH_FULL, PASSO_PATH_DRY };

static inline struct passo_path_item *passo_path_item(const struct passo_path_planner *path, uint32_t index)
{
	return &path->items[index % path->capacity];
}

/* Rows: directions in space that have limits, those of the axes and, behind them, those in which the motors
 * that move two axes go. So all shares of a unit vector are at most 1. */
static inline uint32_t passo_path_rows(const struct passo_path_planner *path)
{
#ifdef PASSO_CARTESIAN
	return path->machine.axes;
#else
	return path->rows;
#endif
}

static inline uint64_t passo_path_smaller(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static inline uint64_t passo_path_larger(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

static inline uint32_t passo_path_size32(int32_t value)
{
	return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

static inline uint64_t passo_path_speed_square(uint64_t speed)
{
	speed = passo_path_smaller(speed, PASSO_PATH_SPEED_MAX);
	return speed * speed;
}

/* Highest square at the end of an item, if the path rests there. */
static inline uint64_t passo_path_halt(const struct passo_path_item *item)
{
	return passo_path_smaller((uint64_t)item->halt * item->halt, item->top);
}

/* What a line takes at least, in clocks. */
static inline uint64_t passo_path_clocks(const struct passo_path_item *item)
{
	return ((uint64_t)item->substeps << 32) / passo_path_larger(passo_isqrt64(item->top), 1);
}

/* Profile jerk, which an image without room leaves out: PASSO_WITHOUT_JERK_PATHS. */
static inline bool passo_path_is_soft(const struct passo_path_planner *path)
{
#ifdef PASSO_WITHOUT_JERK_PATHS
	(void)path;
	return false;
#else
	return path->soft;
#endif
}

/* Whether lone corners are rounded at constant speed, and lines bend by halves: not with the setting
 * `unrounded`, nor in an image without room, PASSO_WITHOUT_ROUNDING. Both plan the same. */
static inline bool passo_path_is_rounded(const struct passo_path_planner *path)
{
	return PASSO_PATH_HALVES > 1 && !path->unrounded;
}

/* The shape of its ramps. */
static inline enum passo_shape passo_path_shape(const struct passo_path_planner *path)
{
#ifdef PASSO_LINEAR_PATHS
	(void)path;
	return PASSO_SHAPE_LINEAR;
#else
	return path->shape;
#endif
}

/* Of a component of a unit vector, 2^62 divided by it; and a limit of its axis along the line. */
static inline uint64_t passo_path_inverse(uint32_t share)
{
	return (UINT64_C(1) << 62) / share;
}

static inline uint64_t passo_path_along(uint64_t limit, uint64_t inverse)
{
	return passo_mul_shift(limit, inverse, 62 - PASSO_PATH_UNIT_BITS);
}

/* The velocity (UQ0.48) of a square, and the square of a velocity. */
static inline uint64_t passo_path_velocity_of(uint64_t square)
{
	return (uint64_t)passo_isqrt64(square) << PASSO_PATH_VELOCITY_SHIFT;
}

static inline uint64_t passo_path_square_of(uint64_t velocity)
{
	velocity >>= PASSO_PATH_VELOCITY_SHIFT;
	return velocity * velocity;
}

/* Change of the square per substep within a half of an item that the axes allow, over a length (UQ32.32
 * substeps) from its lower end. */
uint64_t passo_path_slope(
    const struct passo_path_item *item, unsigned half, bool up, uint64_t low, uint64_t length);

/* Deceleration is planned a little below the limit, so that it can make up for ramps that end at ticks. */
static inline uint64_t passo_path_down(uint64_t slope)
{
	return slope - slope / 256;
}

/* The square from which a part of a half of an item comes down to one at its end. */
uint64_t passo_path_half_before(
    const struct passo_path_item *item, unsigned half, uint64_t end, uint64_t length);

/* The highest square, within an item, from which it falls to the one at its end over a length that ends so
 * far before that. */
uint64_t passo_path_before(
    const struct passo_path_item *item, uint64_t end, uint64_t length, uint64_t behind);

/* Sets the limits of an item, `top` and, unless the path rests there, `corner`; those before it are known. */
void passo_path_limit(struct passo_path_planner *path, uint32_t index);

/* What a line has by the corner at its start; its end may become another one, with a longer line. */
static inline void passo_path_keep_start(const struct passo_path_item *item, struct passo_path_place *at)
{
	at->curve = item->curve;
#ifndef PASSO_WITHOUT_ROUNDING
	at->bend = item->bend;
#endif
#ifndef PASSO_LINEAR_PATHS
	at->slope = item->slope;
	at->eased = item->eased;
#ifndef PASSO_WITHOUT_JERK_PATHS
	at->jerk = item->jerk;
#endif
#endif
}

static inline void passo_path_restore_start(struct passo_path_planner *path)
{
	struct passo_path_item *item = passo_path_item(path, path->added - 1);
	const struct passo_path_place *at = &path->at;

	item->curve = at->curve;
#ifndef PASSO_LINEAR_PATHS
	item->slope = at->slope;
	item->eased = at->eased;
#ifndef PASSO_WITHOUT_JERK_PATHS
	item->jerk = at->jerk;
#endif
#endif
#ifndef PASSO_WITHOUT_ROUNDING
	if (passo_path_is_soft(path) && passo_path_is_rounded(path)) {
		item->bend = at->bend;
		passo_path_limit(path, path->added - 1);
	}
#endif
}

/* The next line begins no part of a curve. */
static inline void passo_path_begin_straight(struct passo_path_planner *path)
{
#ifdef PASSO_WITHOUT_JERK_PATHS
	(void)path;
#else
	path->at.bends = false;
#endif
}

/* In how many parts the curve of an item is. */
static inline unsigned passo_path_halves(const struct passo_path_item *item)
{
	return PASSO_PATH_HALVES > 1 && item->curve.halved ? 2 : 1;
}

/* Whether its halves are passed in steps. */
static inline bool passo_path_is_strong(const struct passo_path_item *item)
{
	return passo_path_halves(item) > 1 && item->curve.strong;
}

/* Steps of a strong half end at a half, a quarter and an eighth of its length, however much of it is left: a
 * ramp for each of them is enough. */
static inline uint64_t passo_path_longest_step(const struct passo_path_item *item)
{
	return (uint64_t)item->substeps << 30;
}

static inline uint64_t passo_path_shortest_step(const struct passo_path_item *item)
{
	return passo_path_longest_step(item) / 4;
}

/* The slope that an item had before its end became a curve. */
static inline uint64_t passo_path_straight_slope(const struct passo_path_item *item)
{
#ifdef PASSO_LINEAR_PATHS
	return item->slope;
#else
	return item->slope / (4u - item->eased) * 4;
#endif
}

/* Sets the slope of an axis of an item, beside its curve. */
void passo_path_add_slope(struct passo_path_item *item, uint32_t axis, uint32_t share, uint64_t slope);

/* By the curve and the length of an item: what passo_path_fall() needs, and whether its halves are strong. */
void passo_path_set_fall(struct passo_path_item *item);

/* Change of the square down a whole item that is not halved, to a square at its end: the slope there, over
 * the line. */
uint64_t passo_path_fall(const struct passo_path_item *item, uint64_t end);

/* Adds a curvature, Q15.48 per substep, to a half of an item with this unit vector; and takes all of it. */
void passo_path_straighten(struct passo_path_item *item, unsigned half);
void passo_path_bend(const struct passo_path_planner *path, const int64_t *curvature, const int32_t *unit,
    unsigned half, struct passo_path_item *item);

/* Change of the square over a length (UQ32.32 substeps); saturates. */
uint64_t passo_path_gain(uint64_t slope, uint64_t length);

/* Change of the velocity, UQ0.48, in `ticks` ticks. */
uint64_t passo_path_change(const struct passo_path_planner *path, uint64_t slope, uint64_t ticks);

/* Whether the map of motors has an inverse, room, and one scale for the axes of each motor. */
bool passo_path_has_motors(const struct passo_path_settings *settings);

/* Fills in the geometry and the limits of a line, and remembers it as the last one, or `instead` of that;
 * *substeps is 0 if it is too short to be a line. After an error, or then, nothing has changed. */
enum passo_plan_error passo_path_measure(struct passo_path_planner *path, const struct passo_path_move *move,
    bool instead, struct passo_path_item *item);

/* Where the direction changes at a corner: so long before it and behind it, UQ32.16 substeps; no farther than
 * the middle of the lines, and not on one side alone. */
struct passo_path_rounding {
	uint64_t before, behind;
};

struct passo_path_corner {
	uint32_t change[PASSO_AXES_MAX]; /* of the direction, by rows, Q1.30 */
	uint64_t turn;                   /* the sum of their squares, of the axes */
	uint64_t arc;                    /* what the rounding may have on either side, UQ32.16 substeps */
	struct passo_path_rounding rounding;
	uint64_t over;                   /* UQ.30 substeps, in which it turns at a constant speed */
	bool bends_before, bends_behind; /* the lines are parts of a curve */
#ifndef PASSO_WITHOUT_ROUNDING
	bool whole; /* it is lone: rounded as far as it needs, maybe over several lines */
	struct passo_path_part_covered { /* otherwise, on each side, the last line where it covers a small
	                                    part: */
		uint32_t index;          /* it begins, or ends, at the start of this item; 0: there is none */
		uint64_t left;           /* that part, UQ32.16 substeps */
	} point[2];
#endif
};

/* What meets at the corner at the start of an item. Lengths are UQ32.16 substeps. */
struct passo_path_meeting {
	uint32_t index;                 /* this item */
	const int32_t *from, *to;       /* unit vectors */
	uint64_t before, behind;        /* the straights */
	uint64_t last, next;            /* the lines beside the corner */
	struct passo_path_item *newest; /* that is being added */
#ifndef PASSO_WITHOUT_ROUNDING
	uint64_t newest_length;
	uint32_t end; /* number of the last item behind the corner */
#endif
};

/* Finds the change of direction from one unit vector to another; false: it goes straight on. */
bool passo_path_find_turn(const struct passo_path_planner *path, const int32_t *from, const int32_t *to,
    struct passo_path_corner *corner);

/* Highest square at a corner by its rounding, which bends the lines beside it. */
uint64_t passo_path_round(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    struct passo_path_corner *corner, struct passo_path_item *item);

/* Whether a rounding spans lines of several feeds that go straight on. */
static inline bool passo_path_spans(const struct passo_path_planner *path)
{
	return passo_path_is_rounded(path) && passo_path_shape(path) == PASSO_SHAPE_LINEAR;
}

/* The first line of the straight that the last one ends. */
static inline uint32_t passo_path_first(const struct passo_path_planner *path)
{
#ifndef PASSO_WITHOUT_ROUNDING
	if (passo_path_is_rounded(path))
		return path->at.first;
#endif
	return path->added - 1;
}

/* Its length, UQ32.16 substeps. */
static inline uint64_t passo_path_since_corner(const struct passo_path_planner *path)
{
#ifndef PASSO_WITHOUT_ROUNDING
	if (passo_path_is_rounded(path))
		return path->at.straight;
#endif
	return path->at.length;
}

/* The limits of an item have changed. */
static inline void passo_path_changes(struct passo_path_planner *path, uint32_t index)
{
#ifdef PASSO_WITHOUT_ROUNDING
	(void)path, (void)index;
#else
	path->bent = index < path->bent ? index : path->bent;
#endif
}

#ifdef PASSO_WITHOUT_ROUNDING
static inline uint64_t passo_path_straight(const struct passo_path_planner *path)
{
	return path->at.length;
}

static inline void passo_path_end_straight(struct passo_path_planner *path)
{
	(void)path;
}

static inline void passo_path_keep_corner(const struct passo_path_corner *corner, struct passo_path_place *at)
{
	(void)corner, (void)at;
}

static inline bool passo_path_was_lone(const struct passo_path_planner *path)
{
	(void)path;
	return true;
}

static inline uint64_t passo_path_ahead(const struct passo_path_planner *path)
{
	(void)path;
	return 0;
}

static inline void passo_path_prolong(
    struct passo_path_planner *path, struct passo_path_item *newest, uint64_t length)
{
	(void)path, (void)newest, (void)length;
}

static inline void passo_path_begin(
    struct passo_path_planner *path, uint64_t length, const struct passo_path_meeting *meeting, uint64_t arc)
{
	(void)path, (void)length, (void)meeting, (void)arc;
}

static inline bool passo_path_goes_on(
    const struct passo_path_planner *path, uint64_t turn, uint64_t length, uint32_t feed)
{
	(void)path, (void)turn, (void)length, (void)feed;
	return false;
}
#else
/* Up to where a rounding covers the lines on one side of a corner, in halves, if it may reach so far; and
 * bends them by a curvature, unless that is null. */
uint64_t passo_path_spread(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    struct passo_path_corner *corner, bool behind, uint64_t reach, const int64_t *curvature);

/* Takes the curvature of a corner off the lines on one side of it, so far. */
void passo_path_unbend(
    struct passo_path_planner *path, const struct passo_path_meeting *meeting, bool behind, uint64_t reach);

/* Whether the lines before a corner are known that far. */
bool passo_path_is_known(
    const struct passo_path_planner *path, const struct passo_path_meeting *meeting, uint64_t reach);

/* Lines that a rounding covers without bending them are passed as the one beside the corner is: `item`. */
void passo_path_set_points(struct passo_path_planner *path, const struct passo_path_meeting *meeting,
    const struct passo_path_corner *corner, const struct passo_path_item *item);

/* Length of the straight that the last line ends, UQ32.16 substeps. */
static inline uint64_t passo_path_straight(const struct passo_path_planner *path)
{
	return passo_path_spans(path) ? path->at.straight : path->at.length;
}

/* The straight that the last line ends is followed by a corner; it continues with the item that is being
 * added. */
void passo_path_end_straight(struct passo_path_planner *path);
void passo_path_prolong(struct passo_path_planner *path, struct passo_path_item *newest, uint64_t length);

/* A new straight begins with the item that is being added, at a corner, or, where that is null, at rest. */
void passo_path_begin(
    struct passo_path_planner *path, uint64_t length, const struct passo_path_meeting *meeting, uint64_t arc);

/* Of a corner, for the next one with profile jerk: whether it was lone, as far as that matters, and how far
 * before it its rounding begins, UQ32.16 substeps. */
static inline void passo_path_keep_corner(const struct passo_path_corner *corner, struct passo_path_place *at)
{
	at->lone = !corner->bends_before && !corner->bends_behind;
	at->ahead = corner->rounding.before;
}

static inline bool passo_path_was_lone(const struct passo_path_planner *path)
{
	return path->at.lone || !passo_path_is_rounded(path);
}

static inline uint64_t passo_path_ahead(const struct passo_path_planner *path)
{
	return path->at.ahead;
}

/* Whether a turn (UQ2.60, squared) beside a line of a length is that of targets in 2^-32 mm alone. With one
 * feed and shaped ramps it is a corner all the same: there a curve that turns to the other side has one. */
bool passo_path_goes_on(const struct passo_path_planner *path, uint64_t turn, uint64_t length, uint32_t feed);
#endif

/* The path rests at the start of an item, if it is hardly faster there. */
void passo_path_rest_if_slow(const struct passo_path_planner *path, struct passo_path_item *item);

/* Highest square at a corner by what is left of the acceleration of each axis; null: all of it. */
uint64_t passo_path_corner_square(
    const struct passo_path_planner *path, const struct passo_path_corner *corner, const uint64_t *left);

/* The same where ramps are shaped; the curved lines beside it leave what the corner needs. */
uint64_t passo_path_shaped_corner(struct passo_path_planner *path, const struct passo_path_corner *corner,
    const int32_t *unit, struct passo_path_item *item);

/* Square at the corner between the last line and this one. The change of direction of an axis takes place
 * over a certain length: half the sum of the two lines, if they stand for an arc, or the arc that deviates by
 * the junction deviation. */
uint64_t passo_path_limit_corner(
    struct passo_path_planner *path, const int32_t *unit, uint64_t length, struct passo_path_item *item);

/* By how much a line from the start of the last one, to a target, is off that one and all that it replaces;
 * saturates if it is not longer. */
struct passo_path_merged passo_path_off(const struct passo_path_planner *path, const int64_t *target);

/* Ticks over a length (UQ32.32 substeps) at the mean of two velocities, whose sum is given, rounded down. */
uint64_t passo_path_ticks_over(const struct passo_path_planner *path, uint64_t length, uint64_t speeds);

/* Length, UQ32.32 substeps, of `ticks` ticks at the mean of two velocities, whose sum is given. */
uint64_t passo_path_length_in(const struct passo_path_planner *path, uint64_t speeds, uint64_t ticks);

/* The newest line is entered when the next one is known, or when it is the last; the one before it when it
 * cannot become another one. */
bool passo_path_is_held_back(const struct passo_path_planner *path, uint32_t index);

/* The path rests at the end of this item, as far as is known. */
bool passo_path_rests_after(const struct passo_path_planner *path, uint32_t index);

/* Highest square at the end of an item, and whether further lines can raise it. */
uint64_t passo_path_end_square(const struct passo_path_planner *path, uint32_t index);
bool passo_path_is_settled(const struct passo_path_planner *path, uint32_t index);

/* Length on the side of the corner at the start of an item that `line` is, over which the path, which rises
 * there or falls, keeps a square, so that the rounding of a lone corner has what it needs of the
 * acceleration. A `valley`, before which the path comes down, may do without. */
#ifdef PASSO_WITHOUT_ROUNDING
static inline void passo_path_pass(struct passo_path_planner *path, uint64_t velocity)
{
	(void)path, (void)velocity;
}

static inline uint64_t passo_path_passing(const struct passo_path_planner *path, uint64_t square)
{
	(void)path;
	return square;
}

static inline uint64_t passo_path_flat(const struct passo_path_planner *path, uint32_t index, uint32_t line,
    bool rises, uint64_t square, bool valley)
{
	(void)path, (void)index, (void)line, (void)rises, (void)square, (void)valley;
	return 0;
}
#else
/* The ramps pass the start of an item; and the square there, when they are in it with another one. */
static inline void passo_path_pass(struct passo_path_planner *path, uint64_t velocity)
{
	path->passing = passo_path_square_of(velocity);
}

static inline uint64_t passo_path_passing(const struct passo_path_planner *path, uint64_t square)
{
	return passo_path_smaller(path->passing, square);
}

uint64_t passo_path_flat(const struct passo_path_planner *path, uint32_t index, uint32_t line, bool rises,
    uint64_t square, bool valley);
#endif

/* Updates `reach` after a line has been added. */
void passo_path_look_back(struct passo_path_planner *path);

/* The newest line stays as it is. */
void passo_path_close(struct passo_path_planner *path);

/* The parts of the profile from a point of an item to its end, of which `left` (UQ32.32 substeps) are left:
 * at most PASSO_PATH_PARTS. With `level` the path does not speed up for less than the line. */
unsigned passo_path_parts(const struct passo_path_planner *path, uint32_t index, uint64_t left,
    uint64_t square, bool level, struct passo_path_part *parts);

/* The distance under a ramp that begins at a velocity, UQ32.32 substeps. */
uint64_t passo_path_distance(
    const struct passo_path_planner *path, uint64_t velocity, const struct passo_ramp *ramp);

/* Solves a ramp of given shape and ticks for the end velocity with which it covers a distance; saturates at 0
 * and PASSO_VELOCITY_MAX. */
void passo_path_land(
    const struct passo_path_planner *path, uint64_t velocity, uint64_t distance, struct passo_ramp *ramp);

/* The first item at whose start a shaped ramp would exceed the limit of the corner; `added`: none. */
uint32_t passo_path_too_fast(const struct passo_path_planner *path, const struct passo_path_aim *aim);

/* Profile jerk: the limit of an item along its line, UQ0.80 substeps per clock^3. */
void passo_path_soften(struct passo_path_item *item, uint64_t jerk);

/* Profile jerk: `reach` of an item, those behind it being known, and its descent; and what the next ramp aims
 * at. Unless it is needed, the aim is open where further lines can change it. */
uint64_t passo_path_soft_reach(struct passo_path_planner *path, uint32_t index);
struct passo_path_aim passo_path_soft_aim(const struct passo_path_planner *path, bool needed);

/* What the next ramp aims at, the ticks to there, and whether the ramp has the shape of the path. */
struct passo_path_aim passo_path_choose_aim(const struct passo_path_planner *path, enum passo_path_need need);
uint64_t passo_path_ticks_to(const struct passo_path_planner *path, const struct passo_path_aim *aim);
bool passo_path_is_shaped(const struct passo_path_planner *path, const struct passo_path_aim *aim);

/* The same, or a calmer one, if there would be more ramps than can be sent. */
struct passo_path_aim passo_path_at_pace(
    const struct passo_path_planner *path, const struct passo_path_aim *aim, enum passo_path_need need);

/* Ticks missing until the next `count` ramps may end, if they last `ticks` as they are. */
uint32_t passo_path_pace_need(const struct passo_path_planner *path, uint64_t ticks, unsigned count);

/* A motion begins; a ramp was made; a line is added. */
void passo_path_pace_begin(struct passo_path_planner *path);
void passo_path_pace_ramp(struct passo_path_planner *path, uint32_t ticks);
void passo_path_pace_line(struct passo_path_planner *path, struct passo_path_item *item);

/* Sets ticks and progress step. */
void passo_path_set_ticks(struct passo_ramp *ramp, uint32_t ticks);

#endif
