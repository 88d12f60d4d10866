/* SPDX-License-Identifier: MIT */
#include "passo_value.h"

#include <string.h>

#include "passo_decimal.h"
#include "passo_number.h"
#include "passo_plan.h"

#define POINT_MAX ((1u << PASSO_SIGMOID_POINT_BITS) - 1u)

static const char *const PROFILES[] = {
#define NAME(profile, shape, name) name,
    PASSO_PROFILES(NAME)
#undef NAME
};

/* Removes the next item from a list. */
static struct passo_item next_item(const char **list)
{
	struct passo_item item = {.text = *list, .length = strcspn(*list, ",")};

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

static bool read_steps(
    const struct passo_reading *reading, const struct passo_key *key, const char *list, int32_t *steps)
{
	uint32_t axes = count_items(list);
	struct passo_decimal number;

	for (const char *rest = list; rest != NULL;) {
		struct passo_item item = next_item(&rest);

		if (!passo_decimal_read(&number, item.text, item.length, 0) || !number.is_whole)
			return passo_complain(
			    reading->sink, "%s must be a list of whole numbers, one per axis", key->name);
	}
	if (axes > reading->axes)
		return passo_complain(reading->sink, "%s has %u axes; must be 1 to %u", key->name, axes,
		    (uint32_t)reading->axes);
	for (uint32_t axis = 0; list != NULL; axis++) {
		struct passo_item item = next_item(&list);

		passo_decimal_read(&number, item.text, item.length, 0);
		if (number.whole > PASSO_SUBSTEPS_MAX)
			return passo_complain(reading->sink, "axis %u has too many steps; must be at most %u",
			    axis, PASSO_SUBSTEPS_MAX);
		steps[axis] = number.negative ? -(int32_t)number.whole : (int32_t)number.whole;
	}
	return true;
}

static bool read_integer(
    const struct passo_reading *reading, const struct passo_key *key, const char *text, int32_t *value)
{
	struct passo_decimal number;

	if (!passo_decimal_read(&number, text, strlen(text), 0) || !number.is_whole)
		return passo_complain(reading->sink, "%s must be a whole number, not %q", key->name, text);
	if (number.whole > PASSO_SUBSTEPS_MAX)
		return passo_complain(reading->sink, "%s must be at most %u in magnitude", key->name,
		    (uint32_t)PASSO_SUBSTEPS_MAX);
	*value = number.negative ? -(int32_t)number.whole : (int32_t)number.whole;
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
		if (!passo_number_signed(reading, key, next_item(&list), &distance[axis]))
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
		if (list != NULL
		    && !passo_number_read(reading, key, next_item(&list), PASSO_UNIT_Q32, &value))
			return false;
		memcpy(place + axis * sizeof(struct passo_axis_limits), &value, sizeof value);
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
		if (!passo_number_whole(reading, key, next_item(&list), 0, POINT_MAX, &value))
			return false;
		points[i] = (uint16_t)value;
	}
	return true;
}

#ifndef PASSO_WITHOUT_PARTS
static bool read_raster(const struct passo_reading *reading, const struct passo_key *key, const char *list,
    struct passo_raster_values *raster)
{
	const uint32_t count = count_items(list);
	uint32_t value;

	if (count > PASSO_RASTER_MAX)
		return passo_complain(reading->sink, "%s has %u values; must be 1 to %u", key->name, count,
		    (uint32_t)PASSO_RASTER_MAX);
	raster->count = (uint8_t)count;
	for (unsigned i = 0; list != NULL; i++) {
		if (!passo_number_whole(reading, key, next_item(&list), 0, UINT8_MAX, &value))
			return false;
		raster->values[i] = (uint8_t)value;
	}
	return true;
}
#endif

static bool read_profile(
    struct passo_reading *reading, const struct passo_key *key, const char *text, enum passo_profile *profile)
{
	bool or_user = key->reader == PASSO_READ_SHAPE;

	for (unsigned i = 0; i < PASSO_PROFILE_COUNT; i++) {
		if (strcmp(text, PROFILES[i]) == 0) {
			*profile = (enum passo_profile)i;
			return true;
		}
	}
	if (or_user && strcmp(text, PASSO_USER_PROFILE) == 0) {
		*profile = PASSO_PROFILE_LINEAR; /* the planner ignores it */
		reading->user_shape = true;
		return true;
	}
	passo_say(reading->sink, "error: %s must be one of ", key->name);
	for (unsigned i = 0; i < PASSO_PROFILE_COUNT; i++)
		passo_say(reading->sink, "%s%s", i == 0u ? "" : ", ", PROFILES[i]);
	passo_say(reading->sink, "%s, not %q\n", or_user ? ", " PASSO_USER_PROFILE : "", text);
	return false;
}

bool passo_value_read(
    struct passo_reading *reading, const struct passo_key *key, const char *text, void *values)
{
	void *place = (char *)values + key->offset;
	struct passo_item all = {.text = text, .length = strlen(text)};
	uint64_t wide;
	uint32_t whole;

	switch (key->reader) {
	case PASSO_READ_NOTHING:
	case PASSO_READ_CHANNEL:
		return true;
	case PASSO_READ_WHOLE:
		return passo_number_whole(reading, key, all, key->low, key->high, place);
	case PASSO_READ_FLAG:
		if (!passo_number_whole(reading, key, all, 0, 1, &whole))
			return false;
		*(bool *)place = whole != 0u;
		return true;
	case PASSO_READ_FLOW:
		if (strcmp(text, PASSO_FLOW_WAIT) != 0 && strcmp(text, PASSO_FLOW_REFUSE) != 0)
			return passo_complain(reading->sink,
			    "%s must be " PASSO_FLOW_WAIT " or " PASSO_FLOW_REFUSE ", not %q", key->name,
			    text);
		*(bool *)place = strcmp(text, PASSO_FLOW_WAIT) == 0;
		return true;
	case PASSO_READ_AXIS:
		if (!passo_number_whole(reading, key, all, 0, reading->axes - 1u, &whole))
			return false;
		reading->axis = *(uint8_t *)place = (uint8_t)whole;
		return true;
	case PASSO_READ_AXES:
		return passo_number_whole(reading, key, all, reading->axis + 1u, reading->axes, &whole);
	case PASSO_READ_STEPS:
		return read_steps(reading, key, text, place);
	case PASSO_READ_NUMBER:
		return passo_number_read(reading, key, all, PASSO_UNIT_Q32, place);
	case PASSO_READ_SIGNED:
		return passo_number_signed(reading, key, all, place);
	case PASSO_READ_MICROSECONDS:
		return passo_number_microseconds(reading, key, text, place);
	case PASSO_READ_TIME:
		return passo_number_time(reading, key, text, false, place);
	case PASSO_READ_PIN_TIME:
		return passo_number_pin_time(reading, key, text, place);
	case PASSO_READ_ALPHA:
		if (!passo_number_read(reading, key, all, PASSO_ALPHA_ONE, &wide))
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
	case PASSO_READ_INTEGER:
		return read_integer(reading, key, text, place);
	case PASSO_READ_LEVEL:
	case PASSO_READ_SOURCE:
	case PASSO_READ_EDGE:
	case PASSO_READ_ACTION:
		return passo_value_choose(reading, key, text, place);
#ifndef PASSO_WITHOUT_PARTS
	case PASSO_READ_STOP:
		return passo_value_choose(reading, key, text, place);
	case PASSO_READ_RASTER:
		return read_raster(reading, key, text, place);
#endif
	}
	return false;
}

const char *passo_value_flow(bool waits)
{
	return waits ? PASSO_FLOW_WAIT : PASSO_FLOW_REFUSE;
}
