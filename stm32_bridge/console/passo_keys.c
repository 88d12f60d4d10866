/* SPDX-License-Identifier: MIT */
#include "passo_keys.h"

#include <string.h>

#include "passo_decimal.h"
#include "passo_plan.h"

#define NUMBER_MAX UINT32_MAX /* s, steps/s, steps/s^2, rpm ... */
#define SIGNED_MAX INT32_MAX  /* degrees, millimetres */
#define PIN_CLOCKS_MAX 65535u
#define ALPHA_ONE 4096u
#define POINT_MAX 65535u

static const char *const PROFILES[] = {
    [PASSO_PROFILE_LINEAR] = "linear",
    [PASSO_PROFILE_COSINE] = "cosine",
    [PASSO_PROFILE_SIGMOID] = "sigmoid",
    [PASSO_PROFILE_JERK] = "jerk",
};
#define PROFILE_COUNT (sizeof PROFILES / sizeof PROFILES[0])

/* A text that ends at a comma or at its own end. */
struct item {
	const char *text;
	size_t length;
};

/* -------------------------------------------------------------------------------------------- words ---- */

static bool is_blank(char c)
{
	return c == ' ' || c == '\t';
}

bool passo_words_split(const struct passo_sink *sink, char *text, struct passo_words *words)
{
	words->count = 0;
	for (;;) {
		while (is_blank(*text))
			text++;
		if (*text == '\0')
			return true;
		if (words->count == PASSO_WORDS_MAX)
			return passo_complain(sink, "more than %u words", (uint32_t)PASSO_WORDS_MAX);
		words->word[words->count].key = "";
		words->word[words->count].value = text;
		for (; *text != '\0' && !is_blank(*text); text++) {
			if (*text == '=' && *words->word[words->count].key == '\0') {
				*text = '\0';
				words->word[words->count].key = words->word[words->count].value;
				words->word[words->count].value = text + 1;
				if (*words->word[words->count].key == '\0')
					return passo_complain(sink, "there is no key before =");
			}
		}
		if (*text != '\0')
			*text++ = '\0';
		words->count++;
	}
}

const char *passo_words_find(const struct passo_words *words, const char *key)
{
	for (unsigned i = 0; i < words->count; i++) {
		if (strcmp(words->word[i].key, key) == 0)
			return words->word[i].value;
	}
	return NULL;
}

int passo_key_find(const struct passo_key *keys, unsigned count, const char *name)
{
	for (unsigned i = 0; i < count; i++) {
		if (strcmp(keys[i].name, name) == 0)
			return (int)i;
	}
	return -1;
}

static bool complain_unknown(
    const struct passo_sink *sink, const struct passo_key *keys, unsigned count, const char *name)
{
	passo_say(sink, "error: unknown key %q; known are ", name);
	for (unsigned i = 0; i < count; i++)
		passo_say(sink, "%s%s", i == 0u ? "" : ", ", keys[i].name);
	passo_say(sink, "\n");
	return false;
}

bool passo_keys_check(const struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    unsigned bare, struct passo_words *words)
{
	for (unsigned i = 0, used = 0; i < words->count; i++) {
		const char *name = words->word[i].key;

		if (*name == '\0') {
			if (used == bare)
				return passo_complain(
				    reading->sink, "%q is not key=value", words->word[i].value);
			name = keys[used++].name;
		} else if (passo_key_find(keys, count, name) < 0) {
			if (count == 0u)
				return passo_complain(reading->sink, "there is no key %q here", name);
			return complain_unknown(reading->sink, keys, count, name);
		}
		words->word[i].key = "";
		if (passo_words_find(words, name) != NULL)
			return passo_complain(reading->sink, "%s is given twice", name);
		words->word[i].key = name;
	}
	return true;
}

/* -------------------------------------------------------------------------------------------- items ---- */

/* Take the next item off a list. */
static struct item next_item(const char **list)
{
	struct item item = {.text = *list, .length = strcspn(*list, ",")};

	*list += item.length;
	if (**list == ',')
		(*list)++;
	else
		*list = NULL;
	return item;
}

static unsigned count_items(const char *list)
{
	unsigned count = 1;

	for (; *list != '\0'; list++)
		count += *list == ',';
	return count;
}

/* A number within a limit of the amount, exactly as it is written, times 10^power. */
static bool read_decimal(const struct passo_reading *reading, const struct passo_key *key, struct item item,
    int power, bool is_signed, struct passo_decimal *number)
{
	uint32_t limit = is_signed ? SIGNED_MAX : NUMBER_MAX;

	if (!passo_decimal_read(number, item.text, item.length, power))
		return passo_complain(reading->sink, "%s must be a number, not %Q", key->name, item.text,
		    (uint32_t)item.length);
	if (number->negative && !is_signed && !passo_decimal_is_zero(number))
		return passo_complain(reading->sink, "%s must not be negative", key->name);
	if (passo_decimal_exceeds(number, limit))
		return number->negative
		         ? passo_complain(reading->sink, "%s must be at least -%u", key->name, limit)
		         : passo_complain(reading->sink, "%s must be at most %u", key->name, limit);
	if (number->too_fine)
		return passo_complain(
		    reading->sink, "%s has more than %u decimals", key->name, (uint32_t)PASSO_DECIMALS_MAX);
	return true;
}

static bool read_number(const struct passo_reading *reading, const struct passo_key *key, struct item item,
    uint64_t factor, uint64_t *value)
{
	struct passo_decimal number;

	if (!read_decimal(reading, key, item, 0, false, &number))
		return false;
	*value = passo_decimal_times(&number, factor);
	return true;
}

static bool read_signed(
    const struct passo_reading *reading, const struct passo_key *key, struct item item, int64_t *value)
{
	struct passo_decimal number;

	if (!read_decimal(reading, key, item, 0, true, &number))
		return false;
	*value = (int64_t)passo_decimal_times(&number, PASSO_UNIT_Q32);
	if (number.negative)
		*value = -*value;
	return true;
}

static bool read_whole(const struct passo_reading *reading, const struct passo_key *key, struct item item,
    uint32_t low, uint32_t high, uint32_t *value)
{
	struct passo_decimal number;

	if (!passo_decimal_read(&number, item.text, item.length, 0) || !number.is_whole)
		return passo_complain(reading->sink, "%s must be a whole number, not %Q", key->name,
		    item.text, (uint32_t)item.length);
	if ((number.negative && number.whole != 0u) || number.whole < low || number.whole > high)
		return passo_complain(reading->sink, "%s must be %u to %u", key->name, low, high);
	*value = (uint32_t)number.whole;
	return true;
}

/* --------------------------------------------------------------------------------------------- times ---- */

/* Split a time into number and unit. Clocks are the unit without a power. */
static struct item cut_unit(const char *text, int *power, bool *clocks)
{
	static const struct {
		const char *name;
		int power;
	} UNITS[] = {{"clocks", 0}, {"ns", -9}, {"us", -6}, {"ms", -3}, {"s", 0}};
	struct item item = {.text = text, .length = strlen(text)};

	*power = 0;
	*clocks = false;
	for (unsigned i = 0; i < sizeof UNITS / sizeof UNITS[0]; i++) {
		size_t length = strlen(UNITS[i].name);

		if (item.length > length && strcmp(text + item.length - length, UNITS[i].name) == 0) {
			item.length -= length;
			*power = UNITS[i].power;
			*clocks = i == 0u;
			break;
		}
	}
	return item;
}

/* A time in clocks: to the nearest, or rounded up. */
static bool read_time(const struct passo_reading *reading, const struct passo_key *key, const char *text,
    bool round_up, uint64_t *clocks)
{
	struct passo_decimal number;
	int power;
	bool in_clocks;
	struct item item = cut_unit(text, &power, &in_clocks);
	uint32_t factor = in_clocks ? 1u : reading->clock_hz;

	if (!read_decimal(reading, key, item, power, false, &number))
		return false;
	*clocks = round_up ? passo_decimal_times_ceil(&number, factor) : passo_decimal_times(&number, factor);
	return true;
}

static bool read_microseconds(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint32_t *value)
{
	struct passo_reading in_microseconds = *reading;
	uint64_t wide;

	if (strstr(text, "clocks") != NULL)
		return passo_complain(
		    reading->sink, "%s must be in s, ms, us or ns, not %q", key->name, text);
	in_microseconds.clock_hz = 1000000u;
	if (!read_time(&in_microseconds, key, text, false, &wide))
		return false;
	*value = wide > UINT32_MAX ? UINT32_MAX : (uint32_t)wide;
	return true;
}

static bool read_pin_time(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, uint32_t *value)
{
	uint64_t clocks;

	if (!read_time(reading, key, text, true, &clocks))
		return false;
	if (clocks > PIN_CLOCKS_MAX)
		return passo_complain(reading->sink, "%s is %u clocks, at most %u are possible", key->name,
		    clocks > UINT32_MAX ? UINT32_MAX : (uint32_t)clocks, PIN_CLOCKS_MAX);
	*value = clocks == 0u ? 1u : (uint32_t)clocks;
	return true;
}

/* --------------------------------------------------------------------------------------------- lists ---- */

static bool read_steps(
    const struct passo_reading *reading, const struct passo_key *key, const char *list, int32_t *steps)
{
	uint32_t axes = count_items(list);
	struct passo_decimal number;

	for (const char *rest = list; rest != NULL;) {
		struct item item = next_item(&rest);

		if (!passo_decimal_read(&number, item.text, item.length, 0) || !number.is_whole)
			return passo_complain(
			    reading->sink, "%s must be a list of whole numbers, one per axis", key->name);
	}
	if (axes > reading->axes)
		return passo_complain(reading->sink, "%s has %u axes, 1 to %u are possible", key->name, axes,
		    (uint32_t)reading->axes);
	for (uint32_t axis = 0; list != NULL; axis++) {
		struct item item = next_item(&list);

		passo_decimal_read(&number, item.text, item.length, 0);
		if (number.whole > PASSO_SUBSTEPS_MAX)
			return passo_complain(reading->sink,
			    "axis %u has too many steps, at most %u are possible", axis, PASSO_SUBSTEPS_MAX);
		steps[axis] = number.negative ? -(int32_t)number.whole : (int32_t)number.whole;
	}
	return true;
}

static bool read_distance(
    struct passo_reading *reading, const struct passo_key *key, const char *list, int64_t *distance)
{
	uint32_t axes = count_items(list);

	if (axes > reading->axes)
		return passo_complain(reading->sink, "%s must be a list of 1 to %u numbers, one per axis",
		    key->name, (uint32_t)reading->axes);
	reading->list_axes = (uint8_t)axes;
	for (unsigned axis = 0; list != NULL; axis++) {
		if (!read_signed(reading, key, next_item(&list), &distance[axis]))
			return false;
	}
	return true;
}

/* One number for all axes that have a distance, or a list. */
static bool read_per_axis(
    const struct passo_reading *reading, const struct passo_key *key, const char *list, char *place)
{
	uint32_t axes = count_items(list);
	uint64_t value = 0;

	if (axes != 1u && axes != reading->list_axes)
		return passo_complain(reading->sink, "%s has %u axes, but distance has %u", key->name, axes,
		    (uint32_t)reading->list_axes);
	for (unsigned axis = 0; axis < reading->list_axes; axis++) {
		if (list != NULL && !read_number(reading, key, next_item(&list), PASSO_UNIT_Q32, &value))
			return false;
		memcpy(place + axis * key->stride, &value, sizeof value);
	}
	return true;
}

static bool read_points(
    const struct passo_reading *reading, const struct passo_key *key, const char *list, uint16_t *points)
{
	uint32_t count = count_items(list), value;

	if (count != PASSO_POINTS_PER_LINE)
		return passo_complain(reading->sink, "%s must be a list of %u numbers, not %u", key->name,
		    (uint32_t)PASSO_POINTS_PER_LINE, count);
	for (unsigned i = 0; list != NULL; i++) {
		if (!read_whole(reading, key, next_item(&list), 0, POINT_MAX, &value))
			return false;
		points[i] = (uint16_t)value;
	}
	return true;
}

static bool read_profile(
    struct passo_reading *reading, const struct passo_key *key, const char *text, enum passo_profile *profile)
{
	bool or_user = key->reader == PASSO_READ_SHAPE;

	for (unsigned i = 0; i < PROFILE_COUNT; i++) {
		if (strcmp(text, PROFILES[i]) == 0) {
			*profile = (enum passo_profile)i;
			return true;
		}
	}
	if (or_user && strcmp(text, "user") == 0) {
		*profile = PASSO_PROFILE_LINEAR; /* the planner does not look at it */
		reading->user_shape = true;
		return true;
	}
	passo_say(reading->sink, "error: %s must be one of ", key->name);
	for (unsigned i = 0; i < PROFILE_COUNT; i++)
		passo_say(reading->sink, "%s%s", i == 0u ? "" : ", ", PROFILES[i]);
	passo_say(reading->sink, "%s, not %q\n", or_user ? ", user" : "", text);
	return false;
}

/* -------------------------------------------------------------------------------------------- values ---- */

/* `text` is the whole value; an item of it, if it must be a single one. */
static bool read_value(
    struct passo_reading *reading, const struct passo_key *key, const char *text, char *values)
{
	void *place = values + key->offset;
	struct item all = {.text = text, .length = strlen(text)};
	uint64_t wide;
	uint32_t whole;

	switch (key->reader) {
	case PASSO_READ_NOTHING:
		return true;
	case PASSO_READ_WHOLE:
		return read_whole(reading, key, all, key->low, key->high, place);
	case PASSO_READ_FLAG:
		if (!read_whole(reading, key, all, 0, 1, &whole))
			return false;
		*(bool *)place = whole != 0u;
		return true;
	case PASSO_READ_AXIS:
		if (!read_whole(reading, key, all, 0, reading->axes - 1u, &whole))
			return false;
		reading->axis = *(uint8_t *)place = (uint8_t)whole;
		return true;
	case PASSO_READ_AXES:
		return read_whole(reading, key, all, reading->axis + 1u, reading->axes, &whole);
	case PASSO_READ_STEPS:
		return read_steps(reading, key, text, place);
	case PASSO_READ_NUMBER:
		return read_number(reading, key, all, PASSO_UNIT_Q32, place);
	case PASSO_READ_SIGNED:
		return read_signed(reading, key, all, place);
	case PASSO_READ_MICROSECONDS:
		return read_microseconds(reading, key, text, place);
	case PASSO_READ_TIME:
		return read_time(reading, key, text, false, place);
	case PASSO_READ_PIN_TIME:
		return read_pin_time(reading, key, text, place);
	case PASSO_READ_ALPHA:
		if (!read_number(reading, key, all, ALPHA_ONE, &wide))
			return false;
		*(uint32_t *)place = wide > UINT32_MAX ? UINT32_MAX : (uint32_t)wide;
		return true;
	case PASSO_READ_DISTANCE:
		return read_distance(reading, key, text, place);
	case PASSO_READ_PER_AXIS:
		return read_per_axis(reading, key, text, place);
	case PASSO_READ_PROFILE:
	case PASSO_READ_SHAPE:
		return read_profile(reading, key, text, place);
	case PASSO_READ_POINTS:
		return read_points(reading, key, text, place);
	}
	return false;
}

bool passo_keys_read(struct passo_reading *reading, const struct passo_key *keys, unsigned count,
    const struct passo_words *words, void *values)
{
	reading->given = 0;
	reading->axis = 0;
	reading->list_axes = 0;
	reading->user_shape = false;
	for (unsigned i = 0; i < count; i++) {
		const char *text = passo_words_find(words, keys[i].name);

		if (text != NULL) {
			reading->given |= UINT32_C(1) << i;
		} else {
			text = keys[i].otherwise;
			if (text == NULL)
				return passo_complain(reading->sink, "%s is missing", keys[i].name);
			if (passo_key_find(keys, count, text) >= 0)
				text = passo_words_find(words, text);
			if (text == NULL || *text == '\0')
				continue;
		}
		if (!read_value(reading, &keys[i], text, values))
			return false;
	}
	return true;
}

void passo_keys_help(const struct passo_sink *sink, const struct passo_key *keys, unsigned count)
{
	static const char *const PLACEHOLDERS[] = {
	    [PASSO_READ_NOTHING] = "name",
	    [PASSO_READ_WHOLE] = "n",
	    [PASSO_READ_FLAG] = "0|1",
	    [PASSO_READ_AXIS] = "axis",
	    [PASSO_READ_AXES] = "n",
	    [PASSO_READ_STEPS] = "n,..",
	    [PASSO_READ_NUMBER] = "x",
	    [PASSO_READ_SIGNED] = "x",
	    [PASSO_READ_TIME] = "time",
	    [PASSO_READ_PIN_TIME] = "time",
	    [PASSO_READ_MICROSECONDS] = "time",
	    [PASSO_READ_ALPHA] = "x",
	    [PASSO_READ_DISTANCE] = "x,..",
	    [PASSO_READ_PER_AXIS] = "x[,..]",
	    [PASSO_READ_PROFILE] = "linear|cosine|sigmoid|jerk",
	    [PASSO_READ_SHAPE] = "linear|cosine|sigmoid|jerk|user",
	    [PASSO_READ_POINTS] = "n,..(16)",
	};

	for (unsigned i = 0; i < count; i++) {
		const char *otherwise = keys[i].otherwise;

		passo_say(sink, otherwise == NULL ? " %s=%s" : " [%s=%s", keys[i].name,
		    PLACEHOLDERS[keys[i].reader]);
		if (otherwise != NULL)
			passo_say(sink, *otherwise == '\0' ? "]" : ", or %s]", otherwise);
	}
}
