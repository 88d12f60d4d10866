/* SPDX-License-Identifier: MIT
 * Units of all values of a move: PASSO_MM(1.5), PASSO_STEPS_PER_S(20000), PASSO_MS(400).
 *
 * The compiler evaluates them: no floating point is linked. They take constants; with GCC or Clang anything
 * else fails to link (passo_unit_is_not_a_constant). At run time use PASSO_THOUSANDTHS(micrometers), which
 * takes an integer; times are integers in clocks.
 */
#ifndef PASSO_UNITS_H
#define PASSO_UNITS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Not defined anywhere. */
uint64_t passo_unit_is_not_a_constant(void);

/* Used by the macros below. */
#ifdef __GNUC__
#define PASSO_UNIT_CONSTANT(x, type, value)                                                                  \
	(__builtin_constant_p(x) ? (type)(value) : (type)passo_unit_is_not_a_constant())
#else
#define PASSO_UNIT_CONSTANT(x, type, value) ((type)(value))
#endif
/* UQ32.32, and Q31.32, rounded to nearest. */
#define PASSO_UNIT_UNSIGNED(x) PASSO_UNIT_CONSTANT(x, uint64_t, (x) * 4294967296.0 + 0.5)
#define PASSO_UNIT_SIGNED(x) PASSO_UNIT_CONSTANT(x, int64_t, (x) * 4294967296.0 + ((x) < 0 ? -0.5 : 0.5))

/* Lengths and angles; the sign is the direction. */
#define PASSO_MM(x) PASSO_UNIT_SIGNED(x)
#define PASSO_DEGREES(x) PASSO_UNIT_SIGNED(x)
/* Thousandths of a millimeter or a degree, an integer up to 2^31; also at run time. */
#define PASSO_THOUSANDTHS(n) ((int64_t)(n) * INT64_C(4294967296) / 1000)

/* Speeds, accelerations, jerks. */
#define PASSO_STEPS_PER_S(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_STEPS_PER_S2(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_STEPS_PER_S3(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_MM_PER_S(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_MM_PER_S2(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_MM_PER_S3(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_RPM(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_RPM_PER_S(x) PASSO_UNIT_UNSIGNED(x)

/* Scales of an axis, and the steepness of a sigmoid. */
#define PASSO_STEPS_PER_MM(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_STEPS_PER_DEGREE(x) PASSO_UNIT_UNSIGNED(x)
#define PASSO_ALPHA(x) PASSO_UNIT_CONSTANT(x, uint32_t, (x) * 4096.0 + 0.5)

/* Times, as clocks of the core. The program defines the constant PASSO_CLOCK_HZ and passes it to
 * passo_open(), too. */
#define PASSO_S(x) PASSO_UNIT_CONSTANT(x, uint64_t, (x) * (double)(PASSO_CLOCK_HZ) + 0.5)
#define PASSO_MS(x) PASSO_UNIT_CONSTANT(x, uint64_t, (x) * ((double)(PASSO_CLOCK_HZ) / 1e3) + 0.5)
#define PASSO_US(x) PASSO_UNIT_CONSTANT(x, uint64_t, (x) * ((double)(PASSO_CLOCK_HZ) / 1e6) + 0.5)

#ifdef __cplusplus
}
#endif

#endif
