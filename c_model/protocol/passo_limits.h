/* SPDX-License-Identifier: MIT
 * Generated from spec/moves.toml by spec/generate_moves.py.
 *
 * Limits of moves and of their parameters.
 */
#ifndef PASSO_LIMITS_H
#define PASSO_LIMITS_H

#include <stdint.h>

/* Longest line: its substeps, and therefore the steps of each axis, have 30 bits. */
#define PASSO_SUBSTEPS_MAX       1073741823u
#define PASSO_SUBSTEPS_MAX_WORDS "2^30 - 1"

/* Largest unsigned number, in its unit. */
#define PASSO_NUMBER_MAX 4294967295u

/* Largest signed number, in its unit. */
#define PASSO_SIGNED_MAX 2147483647u

/* Largest whole number. */
#define PASSO_WHOLE_MAX 4294967295u

/* Digits after the decimal point. */
#define PASSO_DECIMALS_MAX 30u

/* Shortest tick, as a power of two clocks. */
#define PASSO_TICK_LOG2_MIN       7u
#define PASSO_TICK_LOG2_MIN_WORDS "7"

/* Longest tick, as a power of two clocks. */
#define PASSO_TICK_LOG2_MAX       16u
#define PASSO_TICK_LOG2_MAX_WORDS "16"

/* Longest move, as a power of two clocks: two days at 100 MHz; see passo_plan.c. */
#define PASSO_MOVE_CLOCKS_LOG2       44u
#define PASSO_MOVE_CLOCKS_LOG2_WORDS "44"

/* Speeds and similar quantities are UQ32.32, signed ones Q31.32: an integer x stands for x / 2^32. */
#define PASSO_UNIT_Q32 UINT64_C(4294967296)

/* A sigmoid's alpha is in units of 1 / 4096. */
#define PASSO_ALPHA_ONE 4096u

/* Smallest alpha. */
#define PASSO_ALPHA_MIN       3u
#define PASSO_ALPHA_MIN_WORDS "3"

/* Largest alpha. */
#define PASSO_ALPHA_MAX       5u
#define PASSO_ALPHA_MAX_WORDS "5"

/* The alpha of the core's table after configuration. */
#define PASSO_ALPHA_RESET 5u

#endif
