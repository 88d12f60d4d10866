/* SPDX-License-Identifier: MIT
 * Sine and cosine are polynomials within an eighth of a turn: x^17 / 17! and x^18 / 18! are below 2^-54
 * there.
 */
#include "passo_gcode_angle.h"

#include <stddef.h>

#include "passo_math.h"

#define EIGHTH (UINT64_C(1) << 61)
#define QUARTER_PI UINT64_C(0xC90FDAA22168C235) /* UQ0.64 */

#define TURNS_PER_RADIAN UINT64_C(0x28BE60DB9391054A) /* UQ0.64 */

/* 1 / 15!, 1 / 13! .. 1 / 3! and 1 / 16! .. 1 / 2!, UQ0.64 */
static const uint64_t SINE[] = {0xD73F9F, 0xB092309D, UINT64_C(0x6B99159FD5), UINT64_C(0x2E3BC74AAD8E),
    UINT64_C(0xD00D00D00D00D), UINT64_C(0x222222222222222), UINT64_C(0x2AAAAAAAAAAAAAAB)};
static const uint64_t COSINE[] = {0xD73FA, 0xC9CBA54, UINT64_C(0x8F76C77FC), UINT64_C(0x49F93EDDE28),
    UINT64_C(0x1A01A01A01A02), UINT64_C(0x5B05B05B05B05B), UINT64_C(0xAAAAAAAAAAAAAAB),
    UINT64_C(0x8000000000000000)};

#define COUNT(table) (sizeof(table) / sizeof *(table))

static uint64_t times(uint64_t a, uint64_t b)
{
	return passo_multiply(a, b).high;
}

/* c[n] - x (c[n - 1] - x (... - x c[0])), all UQ0.64 */
static uint64_t polynomial(const uint64_t *coefficients, size_t count, uint64_t x)
{
	uint64_t sum = coefficients[0];

	for (size_t i = 1; i < count; i++)
		sum = coefficients[i] - times(sum, x);
	return sum;
}

struct passo_gcode_vector passo_gcode_unit_vector(uint64_t angle)
{
	const unsigned eighth = (unsigned)(angle >> 61);
	const uint64_t within = angle % EIGHTH, from_axis = eighth % 2 ? EIGHTH - within : within;
	const uint64_t x = times(from_axis << 2, QUARTER_PI) << 1; /* radians, UQ0.64 */
	const uint64_t square = times(x, x);
	const uint64_t sine = x - times(x, times(square, polynomial(SINE, COUNT(SINE), square)));
	const uint64_t fall = times(square, polynomial(COSINE, COUNT(COSINE), square));
	const int64_t along = PASSO_GCODE_UNIT - (int64_t)(fall >> 2), across = (int64_t)(sine >> 2);

	switch (eighth) {
	case 0:
		return (struct passo_gcode_vector){along, across};
	case 1:
		return (struct passo_gcode_vector){across, along};
	case 2:
		return (struct passo_gcode_vector){-across, along};
	case 3:
		return (struct passo_gcode_vector){-along, across};
	case 4:
		return (struct passo_gcode_vector){-along, -across};
	case 5:
		return (struct passo_gcode_vector){-across, -along};
	case 6:
		return (struct passo_gcode_vector){across, -along};
	default:
		return (struct passo_gcode_vector){along, -across};
	}
}

uint64_t passo_gcode_length(struct passo_gcode_vector vector)
{
	const uint64_t x = passo_size64(vector.x), y = passo_size64(vector.y);

	return passo_isqrt128(passo_u128_add(passo_multiply(x, x), passo_multiply(y, y)));
}

/* a * b, two's complement */
static struct passo_u128 product(int64_t a, int64_t b)
{
	const struct passo_u128 size = passo_multiply(passo_size64(a), passo_size64(b));

	return (a < 0) != (b < 0) ? passo_u128_subtract((struct passo_u128){0, 0}, size) : size;
}

/* The same divided by 2^62, to the nearest integer. */
static int64_t rounded(struct passo_u128 value)
{
	value = passo_u128_add(value, (struct passo_u128){0, PASSO_GCODE_UNIT / 2});
	return (int64_t)(value.high << 2 | value.low >> 62);
}

struct passo_gcode_vector passo_gcode_rotate(struct passo_gcode_vector vector, struct passo_gcode_vector unit)
{
	return (struct passo_gcode_vector){
	    rounded(passo_u128_subtract(product(vector.x, unit.x), product(vector.y, unit.y))),
	    rounded(passo_u128_add(product(vector.x, unit.y), product(vector.y, unit.x))),
	};
}

/* Newton's method: an angle is corrected by the sine of what it lacks, which cubes the error. The first one,
 * from the ratio of the components, is within 1/80 of a turn. */
uint64_t passo_gcode_angle(struct passo_gcode_vector vector)
{
	uint64_t either = passo_size64(vector.x) | passo_size64(vector.y);

	if (either == 0)
		return 0;
	for (; either < PASSO_GCODE_UNIT / 2; either *= 2) {
		vector.x *= 2;
		vector.y *= 2;
	}
	const uint64_t x = passo_size64(vector.x), y = passo_size64(vector.y),
		       length = passo_gcode_length(vector);
	const uint64_t eighth = x == y ? EIGHTH : passo_mul_div(EIGHTH, x < y ? x : y, x < y ? y : x);
	const uint64_t first = x < y ? 2 * EIGHTH - eighth : eighth; /* in the first quarter */
	uint64_t angle = vector.x < 0 ? 4 * EIGHTH - first : first;

	angle = vector.y < 0 ? 0 - angle : angle;
	for (unsigned round = 0; round < 3; round++) {
		const struct passo_gcode_vector unit = passo_gcode_unit_vector(0 - angle);
		const int64_t across = passo_gcode_rotate(vector, unit).y;
		const uint64_t turn = passo_mul_div(passo_size64(across), TURNS_PER_RADIAN, length);

		angle = across < 0 ? angle - turn : angle + turn;
	}
	return angle;
}
