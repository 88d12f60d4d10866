/* SPDX-License-Identifier: MIT
 * Internal: splitting a line into words, and reading them by a key table.
 *
 * Each command and each move form has a key table, which is used to read and check the values, to fill in
 * defaults, and to print the help. An error is printed in one line; nothing is executed then.
 */
#ifndef PASSO_KEYS_H
#define PASSO_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "passo_say.h"

#define PASSO_WORDS_MAX 24u

/* Type of a value, and its C type and format. */
enum passo_reader {
	PASSO_READ_NOTHING,      /* read elsewhere */
	PASSO_READ_WHOLE,        /* uint32_t, low .. high */
	PASSO_READ_FLAG,         /* bool, 0 or 1 */
	PASSO_READ_FLOW,         /* bool: wait (true) or refuse */
	PASSO_READ_AXIS,         /* uint8_t, 0 .. axes - 1 */
	PASSO_READ_CHANNEL,      /* not stored: it was read before the command */
	PASSO_READ_AXES,         /* axis + 1 .. axes: checked but not stored */
	PASSO_READ_STEPS,        /* int32_t[], one per axis */
	PASSO_READ_NUMBER,       /* uint64_t UQ32.32 */
	PASSO_READ_SIGNED,       /* int64_t Q31.32 */
	PASSO_READ_TIME,         /* uint64_t clocks, rounded to nearest */
	PASSO_READ_PIN_TIME,     /* uint32_t clocks, rounded up, 1 .. PASSO_PIN_CLOCKS_MAX */
	PASSO_READ_MICROSECONDS, /* uint32_t, rounded to nearest, saturates */
	PASSO_READ_ALPHA,        /* uint32_t in 1/PASSO_ALPHA_ONE */
	PASSO_READ_DISTANCE,     /* int64_t[] Q31.32, one per axis */
	PASSO_READ_PER_AXIS,     /* uint64_t in each passo_axis_limits: one number for all axes, or a list */
	PASSO_READ_PROFILE,      /* enum passo_profile */
	PASSO_READ_SHAPE,        /* the same, or a user-defined shape */
	PASSO_READ_POINTS,       /* uint16_t[16] */
	PASSO_READ_INTEGER,      /* int32_t, within the step range of a move */
	/* uint8_t: which of some words */
	PASSO_READ_LEVEL,   /* enum passo_level */
	PASSO_READ_SOURCE,  /* enum passo_trigger_source */
	PASSO_READ_EDGE,    /* 0 rising, 1 falling */
	PASSO_READ_ACTION,  /* enum passo_trigger_action */
#ifndef PASSO_WITHOUT_PARTS /* outputs and encoders: for the flash of a small controller */
	PASSO_READ_STOP,    /* enum passo_following_stop */
	PASSO_READ_RASTER,  /* struct passo_raster_values */
#endif
};

/* Words of PASSO_READ_LEVEL: how an input is connected. */
enum passo_level { PASSO_LEVEL_NONE, PASSO_LEVEL_HIGH, PASSO_LEVEL_LOW };

struct passo_key {
	const char *name;
	/* Default. null: the key is required; "": the value is not changed; the name of another key: its
	 * value; otherwise a text to read. */
	const char *otherwise;
	uint32_t low, high; /* range of an integer */
	uint16_t offset;    /* of the value in the destination struct */
	enum passo_reader reader;
};

#define PASSO_POINTS_PER_LINE 16u

#ifndef PASSO_WITHOUT_PARTS
/* Power values of a raster, 255 is full; limited by the length of a line. */
#define PASSO_RASTER_MAX 128u
struct passo_raster_values {
	uint8_t count;
	uint8_t values[PASSO_RASTER_MAX];
};
#endif

/* A line split into words: key=value, or a value alone, whose key is then "". */
struct passo_words {
	unsigned count;
	struct {
		const char *key, *value;
	} word[PASSO_WORDS_MAX];
};

/* Context of reading values, and results other than the values. */
struct passo_reading {
	const struct passo_sink *sink; /* output for errors */
	uint32_t clock_hz;
	uint8_t axes;      /* of the core */
	uint8_t axis;      /* value of the key `axis`, if given */
	uint8_t list_axes; /* axes in the last list of distances */
	bool user_shape;   /* the profile is a user-defined shape */
	uint32_t given;    /* bit i: key i was given */
};

/* Splits a text into words, in place. Prints an error and returns false if there are too many. */
bool passo_words_split(const struct passo_sink *sink, char *text, struct passo_words *words);

/* The value of a key in a line, or null. */
const char *passo_words_find(const struct passo_words *words, const char *key);

/* The index of a key in a table, or -1. */
int passo_key_find(const struct passo_key *keys, unsigned count, const char *name);

/* Checks that each word is a key=value of the table and occurs only once; otherwise prints an error and
 * returns false. The first `bare` keys of the table can also be given as values alone, whose words get their
 * keys here. */
bool passo_keys_check(const struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    unsigned bare, struct passo_words *words);

/* Reads all values of a table into a struct. Prints an error and returns false at the first invalid value. */
bool passo_keys_read(struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    const struct passo_words *words, void *values);

/* Prints " key=value" for each key, in brackets if it is optional. */
void passo_keys_help(const struct passo_sink *sink, const struct passo_key *keys, unsigned count);

#endif
