/* SPDX-License-Identifier: MIT
 * Each corner is the start turned about the center by its share of the sweep, so errors do not add up.
 */
#include "passo_gcode_arc.h"

#include "passo_math.h"

#define WHOLE_TURN (UINT64_C(1) << 63)      /* UQ1.63 */
#define TWO_PI UINT64_C(0xC90FDAA22168C235) /* UQ3.61 */
#define NEAR (UINT64_C(1) << 16)            /* angle of the same direction, UQ0.64 */
#define RADIUS_ALWAYS 5000u                 /* nm: differences of the radii that are allowed */
#define RADIUS_NEVER 500000u                /* nm */
#define RADIUS_SHARE 1000u

/* value * share / whole, to the nearest integer */
static int64_t part(int64_t value, uint32_t share, uint32_t whole)
{
	const int64_t size = (int64_t)passo_mul_div(2 * passo_size64(value), share, whole);

	return value < 0 ? -((size + 1) / 2) : (size + 1) / 2;
}

/* length * sqrt(a / b). Both are shifted left as far as possible, for the precision of their roots. */
static uint64_t times_root(uint64_t length, struct passo_u128 a, struct passo_u128 b)
{
	const uint32_t bits = passo_bits(passo_u128_less(a, b) ? b : a);
	const uint32_t shift = (128 - bits) & ~1u;

	return passo_mul_div(length, passo_isqrt128(passo_u128_shift_left(a, shift)),
	    passo_isqrt128(passo_u128_shift_left(b, shift)));
}

enum passo_gcode_error passo_gcode_arc_center(
    struct passo_gcode_vector chord, int64_t radius, bool clockwise, struct passo_gcode_vector *offset)
{
	const uint64_t x = passo_size64(chord.x), y = passo_size64(chord.y), twice = 2 * passo_size64(radius);
	const struct passo_u128 square = passo_u128_add(passo_multiply(x, x), passo_multiply(y, y));
	const struct passo_u128 diameter = passo_multiply(twice, twice);

	if (x == 0 && y == 0)
		return PASSO_GCODE_TARGET;
	if (passo_u128_less(diameter, square))
		return PASSO_GCODE_RADIUS;
	/* the center is beside the middle of the chord: to its left, counterclockwise and the shorter way */
	const struct passo_u128 rest = passo_u128_subtract(diameter, square);
	const int64_t aside_x = (int64_t)times_root(x, rest, square),
		      aside_y = (int64_t)times_root(y, rest, square);
	const bool left = clockwise == (radius < 0);
	const int64_t to_x = (chord.y > 0) == left ? -aside_y : aside_y;
	const int64_t to_y = (chord.x > 0) == left ? aside_x : -aside_x;

	*offset = (struct passo_gcode_vector){(chord.x + to_x) / 2, (chord.y + to_y) / 2};
	return PASSO_GCODE_OK;
}

static bool radii_differ(uint64_t a, uint64_t b)
{
	const uint64_t difference = a > b ? a - b : b - a;

	return difference > RADIUS_ALWAYS && (difference > RADIUS_NEVER || difference > a / RADIUS_SHARE);
}

/* From one direction to the other; UQ1.63. */
static uint64_t sweep(uint64_t from, uint64_t to)
{
	const uint64_t angle = to - from;

	return angle < NEAR ? WHOLE_TURN : angle / 2;
}

/* Half of the chord whose middle is at the tolerance from the arc. Half of the arc must not be longer. */
static uint32_t count_chords(uint64_t radius, uint64_t arc, uint64_t tolerance)
{
	const uint64_t height = tolerance < radius ? tolerance : radius;
	const uint64_t chord = 2 * passo_isqrt128(passo_multiply(height, 2 * radius - height));
	const uint64_t chords = chord > 0 ? arc / chord + 1 : 1;

	return chords > UINT32_MAX ? UINT32_MAX : (uint32_t)chords;
}

/* Length of a path that turns and moves along the other axes simultaneously. */
static uint64_t helix(const struct passo_gcode_arc *arc, uint64_t turned)
{
	struct passo_u128 sum = passo_multiply(turned, turned);

	for (unsigned axis = 0; axis < arc->axes; axis++) {
		const uint64_t way = passo_size64(arc->target[axis] - arc->start[axis]);

		if (axis != arc->plane.first && axis != arc->plane.second)
			sum = passo_u128_add(sum, passo_multiply(way, way));
	}
	return passo_isqrt128(sum);
}

enum passo_gcode_error passo_gcode_arc_begin(
    struct passo_gcode_arc *arc, struct passo_gcode_vector offset, uint64_t tolerance)
{
	const unsigned first = arc->plane.first, second = arc->plane.second;
	const struct passo_gcode_vector to = {
	    arc->target[first] - arc->start[first] - offset.x,
	    arc->target[second] - arc->start[second] - offset.y,
	};

	arc->radial = (struct passo_gcode_vector){-offset.x, -offset.y};
	arc->center =
	    (struct passo_gcode_vector){arc->start[first] + offset.x, arc->start[second] + offset.y};
	arc->radius = passo_gcode_length(offset);
	if (arc->radius > (uint64_t)PASSO_GCODE_COORDINATE_MAX
	    || radii_differ(arc->radius, passo_gcode_length(to)))
		return PASSO_GCODE_TARGET;
	const uint64_t begin = passo_gcode_angle(arc->radial), end = passo_gcode_angle(to);
	arc->sweep = arc->clockwise ? sweep(end, begin) : sweep(begin, end);
	const uint64_t turned =
	    passo_mul_div(arc->sweep, passo_mul_div(arc->radius, TWO_PI, UINT64_C(1) << 61), WHOLE_TURN);
	arc->length = helix(arc, turned);
	arc->chords = count_chords(arc->radius, turned, tolerance);
	arc->done = 0;
	return PASSO_GCODE_OK;
}

bool passo_gcode_arc_next(struct passo_gcode_arc *arc, int64_t *corner)
{
	if (arc->done == arc->chords)
		return false;
	arc->done++;
	for (unsigned axis = 0; axis < arc->axes; axis++)
		corner[axis] =
		    arc->start[axis] + part(arc->target[axis] - arc->start[axis], arc->done, arc->chords);
	if (arc->done < arc->chords) {
		const uint64_t turned = 2 * passo_mul_div(arc->sweep, arc->done, arc->chords);
		const struct passo_gcode_vector unit =
		    passo_gcode_unit_vector(arc->clockwise ? 0 - turned : turned);
		const struct passo_gcode_vector at = passo_gcode_rotate(arc->radial, unit);

		corner[arc->plane.first] = arc->center.x + at.x;
		corner[arc->plane.second] = arc->center.y + at.y;
	}
	return true;
}
