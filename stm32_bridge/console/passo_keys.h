/* SPDX-License-Identifier: MIT
 * A line's words and the tables of keys that say what they mean.
 *
 * A command or a form of a move is a table of keys; the same table reads the values, checks them, fills in
 * what is not given, and prints the help. Whatever is wrong is told in one line; nothing is done then.
 */
#ifndef PASSO_KEYS_H
#define PASSO_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_say.h"

#define PASSO_WORDS_MAX 24u

/* What a value is, and what it becomes. */
enum passo_reader {
	PASSO_READ_NOTHING,      /* somebody else reads it */
	PASSO_READ_WHOLE,        /* uint32_t, low .. high */
	PASSO_READ_FLAG,         /* bool, 0 or 1 */
	PASSO_READ_AXIS,         /* uint8_t, 0 .. axes - 1 */
	PASSO_READ_AXES,         /* axis + 1 .. axes: only checked */
	PASSO_READ_STEPS,        /* int32_t[], one per axis */
	PASSO_READ_NUMBER,       /* uint64_t UQ32.32 */
	PASSO_READ_SIGNED,       /* int64_t Q31.32 */
	PASSO_READ_TIME,         /* uint64_t clocks, to the nearest */
	PASSO_READ_PIN_TIME,     /* uint32_t clocks, rounded up, 1 .. PASSO_PIN_CLOCKS_MAX */
	PASSO_READ_MICROSECONDS, /* uint32_t, to the nearest, saturates */
	PASSO_READ_ALPHA,        /* uint32_t in 1/PASSO_ALPHA_ONE */
	PASSO_READ_DISTANCE,     /* int64_t[] Q31.32, one per axis */
	PASSO_READ_PER_AXIS,     /* uint64_t in each passo_axis_limits: one number for all axes, or a list */
	PASSO_READ_PROFILE,      /* enum passo_profile */
	PASSO_READ_SHAPE,        /* the same, or the user's own */
	PASSO_READ_POINTS        /* uint16_t[16] */
};

struct passo_key {
	const char *name;
	/* What stands for a missing value: null: it must be given; "": the value stays as it is; the name of
	 * another key: its value; otherwise a text to read. */
	const char *otherwise;
	uint32_t low, high; /* of a whole number */
	uint16_t offset;    /* where the value goes in the struct that is read into */
	enum passo_reader reader;
};

#define PASSO_POINTS_PER_LINE 16u

/* A line cut into words: key=value, or a value alone, whose key is then "". */
struct passo_words {
	unsigned count;
	struct {
		const char *key, *value;
	} word[PASSO_WORDS_MAX];
};

/* What values depend on, and what reading them tells beside the values. */
struct passo_reading {
	const struct passo_sink *sink; /* errors go here */
	uint32_t clock_hz;
	uint8_t axes;      /* of the core */
	uint8_t axis;      /* of the key axis, if it was there */
	uint8_t list_axes; /* axes in the last list of distances */
	bool user_shape;   /* the profile is the user's own */
	uint32_t given;    /* bit i: the key i was given */
};

/* Cut a text into words, in place; complain and return false if there are too many. */
bool passo_words_split(const struct passo_sink *sink, char *text, struct passo_words *words);

/* The value of a key in a line, or null. */
const char *passo_words_find(const struct passo_words *words, const char *key);

/* The place of a key in a table, or -1. */
int passo_key_find(const struct passo_key *keys, unsigned count, const char *name);

/* Complain and return false if a word is no key=value of the table or comes twice. The first `bare` keys of
 * the table can also be given as values alone; their words get their keys here. */
bool passo_keys_check(const struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    unsigned bare, struct passo_words *words);

/* Read all values of a table into a struct; complain and return false at the first that is wrong. */
bool passo_keys_read(struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    const struct passo_words *words, void *values);

/* Print " key=value" for each key, in brackets if it need not be given; from a range of the table. */
void passo_keys_help(const struct passo_sink *sink, const struct passo_key *keys, unsigned count);

#endif
