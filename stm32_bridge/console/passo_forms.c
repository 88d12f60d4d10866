/* SPDX-License-Identifier: MIT */
#include "passo_forms.h"

#include <string.h>

enum method { IN_TIME, BY_SPEED, BELOW_SPEED, AT_SPEED, AXES, TURN, SIGMOID, JERK, STRAIGHT, METHODS };

union move {
	struct passo_move_in_time in_time;
	struct passo_move_by_speed by_speed;
	struct passo_move_below_speed below_speed;
	struct passo_move_at_speed at_speed;
	struct passo_move_axes axes;
	struct passo_move_turn turn;
	struct passo_move_sigmoid sigmoid;
	struct passo_move_jerk jerk;
	struct passo_move_straight straight;
};

#define OR_0 "0"
/* A key whose value goes into a member of the move; limits are for every axis. */
#define KEY(text, method, member, read, default_text)                                                        \
	{.name = (text),                                                                                     \
	    .reader = PASSO_READ_##read,                                                                     \
	    .otherwise = (default_text),                                                                     \
	    .offset = offsetof(struct passo_move_##method, member),                                          \
	    .stride = sizeof(struct passo_axis_limits)}
#define METHOD {.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""}
#define SPEEDS(method)                                                                                       \
	KEY("start_speed", method, start_speed, NUMBER, OR_0), KEY("speed", method, speed, NUMBER, NULL),    \
	    KEY("stop_speed", method, stop_speed, NUMBER, OR_0)

static const struct passo_key IN_TIME_KEYS[] = {
    METHOD,
    KEY("steps", in_time, steps, STEPS, NULL),
    KEY("profile", in_time, profile, SHAPE, NULL),
    KEY("total_time", in_time, total_clocks, TIME, NULL),
    KEY("ramp_time", in_time, ramp_clocks, TIME, NULL),
};

static const struct passo_key BY_SPEED_KEYS[] = {
    METHOD,
    KEY("steps", by_speed, steps, STEPS, NULL),
    KEY("profile", by_speed, profile, SHAPE, NULL),
    SPEEDS(by_speed),
    KEY("acceleration", by_speed, acceleration, NUMBER, OR_0),
    KEY("deceleration", by_speed, deceleration, NUMBER, OR_0),
    KEY("ramp_time", by_speed, ramp_clocks, TIME, OR_0),
};

static const struct passo_key BELOW_SPEED_KEYS[] = {
    METHOD,
    KEY("steps", below_speed, steps, STEPS, NULL),
    KEY("profile", below_speed, profile, PROFILE, NULL),
    KEY("total_time", below_speed, total_clocks, TIME, NULL),
    KEY("speed", below_speed, speed, NUMBER, NULL),
};

static const struct passo_key AT_SPEED_KEYS[] = {
    METHOD,
    KEY("steps", at_speed, steps, STEPS, NULL),
    KEY("profile", at_speed, profile, PROFILE, NULL),
    KEY("speed", at_speed, speed, NUMBER, NULL),
    KEY("ramp_time", at_speed, ramp_clocks, TIME, NULL),
};

static const struct passo_key AXES_KEYS[] = {
    METHOD,
    KEY("steps", axes, steps, STEPS, NULL),
    KEY("start_speed", axes, start_speed, NUMBER, OR_0),
    KEY("speed", axes, speed, NUMBER, NULL),
    KEY("ramp_time", axes, ramp_clocks, TIME, NULL),
};

static const struct passo_key TURN_KEYS[] = {
    METHOD,
    KEY("axis", turn, axis, AXIS, OR_0),
    KEY("axes", turn, axis, AXES, ""),
    {.name = "steps_per_turn",
	.reader = PASSO_READ_WHOLE,
	.low = 1,
	.high = UINT32_MAX,
	.offset = offsetof(struct passo_move_turn, steps_per_turn)},
    KEY("angle", turn, angle, SIGNED, NULL),
    KEY("rpm", turn, rpm, NUMBER, NULL),
    KEY("minimum_rpm", turn, minimum_rpm, NUMBER, OR_0),
    KEY("acceleration", turn, acceleration, NUMBER, NULL),
};

static const struct passo_key SIGMOID_KEYS[] = {
    METHOD,
    KEY("steps", sigmoid, steps, STEPS, NULL),
    SPEEDS(sigmoid),
    KEY("accelerate_time", sigmoid, accelerate_clocks, TIME, NULL),
    KEY("decelerate_time", sigmoid, decelerate_clocks, TIME, "accelerate_time"),
    KEY("alpha", sigmoid, alpha, ALPHA, "5"),
};

static const struct passo_key JERK_KEYS[] = {
    METHOD,
    KEY("steps", jerk, steps, STEPS, NULL),
    SPEEDS(jerk),
    KEY("acceleration", jerk, acceleration, NUMBER, NULL),
    KEY("jerk", jerk, jerk, NUMBER, NULL),
};

static const struct passo_key STRAIGHT_KEYS[] = {
    METHOD,
    KEY("distance", straight, distance, DISTANCE, NULL),
    KEY("feed", straight, feed, NUMBER, NULL),
    KEY("steps_per_mm", straight, limits[0].steps_per_mm, PER_AXIS, OR_0),
    KEY("speed", straight, limits[0].speed, PER_AXIS, NULL),
    KEY("acceleration", straight, limits[0].acceleration, PER_AXIS, NULL),
    KEY("jerk", straight, limits[0].jerk, PER_AXIS, OR_0),
};

#define FORM(text, table) {.name = (text), .keys = (table), .count = sizeof(table) / sizeof(table)[0]}

static const struct form {
	const char *name;
	const struct passo_key *keys;
	unsigned count;
} FORMS[METHODS] = {
    [IN_TIME] = FORM("in_time", IN_TIME_KEYS),
    [BY_SPEED] = FORM("by_speed", BY_SPEED_KEYS),
    [BELOW_SPEED] = FORM("below_speed", BELOW_SPEED_KEYS),
    [AT_SPEED] = FORM("at_speed", AT_SPEED_KEYS),
    [AXES] = FORM("axes", AXES_KEYS),
    [TURN] = FORM("turn", TURN_KEYS),
    [SIGMOID] = FORM("sigmoid", SIGMOID_KEYS),
    [JERK] = FORM("jerk", JERK_KEYS),
    [STRAIGHT] = FORM("straight", STRAIGHT_KEYS),
};

/* The keys of the two forms that are found by what is given. */
#define EITHER_MAX                                                                                           \
	(sizeof IN_TIME_KEYS / sizeof IN_TIME_KEYS[0] + sizeof BY_SPEED_KEYS / sizeof BY_SPEED_KEYS[0])

static bool has_key(enum method method, const char *name)
{
	return passo_key_find(FORMS[method].keys, FORMS[method].count, name) >= 0;
}

/* The form by its name; METHODS after a complaint. */
static enum method form_by_name(const struct passo_sink *sink, const char *name)
{
	for (enum method method = IN_TIME; method < METHODS; method++) {
		if (strcmp(FORMS[method].name, name) == 0)
			return method;
	}
	passo_say(sink, "error: method must be one of ");
	for (enum method method = IN_TIME; method < METHODS; method++)
		passo_say(sink, "%s%s", method == IN_TIME ? "" : ", ", FORMS[method].name);
	passo_say(sink, ", not %q\n", name);
	return METHODS;
}

/* By time or by speed: what is given tells. */
static enum method form_by_keys(const struct passo_reading *reading, struct passo_words *words)
{
	struct passo_key either[EITHER_MAX];
	unsigned count = FORMS[IN_TIME].count;
	const char *of_time = NULL, *of_speed = NULL;

	memcpy(either, IN_TIME_KEYS, sizeof IN_TIME_KEYS);
	for (unsigned i = 0; i < FORMS[BY_SPEED].count; i++) {
		if (!has_key(IN_TIME, BY_SPEED_KEYS[i].name))
			either[count++] = BY_SPEED_KEYS[i];
	}
	if (!passo_keys_check(reading, either, count, 0, words))
		return METHODS;
	for (unsigned i = 0; i < words->count; i++) {
		const char *key = words->word[i].key;

		if (of_time == NULL && !has_key(BY_SPEED, key))
			of_time = key;
		if (of_speed == NULL && !has_key(IN_TIME, key))
			of_speed = key;
	}
	if (of_time != NULL && of_speed != NULL) {
		passo_complain(reading->sink, "%s and %s exclude each other: a move goes by time or by speed",
		    of_time, of_speed);
		return METHODS;
	}
	if (of_time == NULL && passo_words_find(words, "speed") == NULL) {
		passo_complain(reading->sink, "total_time or speed is missing");
		return METHODS;
	}
	return of_time != NULL ? IN_TIME : BY_SPEED;
}

static bool check_by_speed(
    const struct passo_sink *sink, const struct passo_words *words, const struct passo_move_by_speed *move)
{
	bool acceleration = passo_words_find(words, "acceleration") != NULL;
	bool deceleration = passo_words_find(words, "deceleration") != NULL;

	if (acceleration && passo_words_find(words, "ramp_time") != NULL)
		return passo_complain(sink, "acceleration and ramp_time exclude each other");
	if (deceleration && !acceleration)
		return passo_complain(sink, "deceleration needs acceleration");
	if (acceleration && move->acceleration == 0u)
		return passo_complain(sink, "acceleration must be greater than 0");
	if (deceleration && move->deceleration == 0u)
		return passo_complain(sink, "deceleration must be greater than 0");
	return true;
}

static enum passo_error queue(
    struct passo *passo, enum method method, const union move *move, const struct passo_user_shape *shape)
{
	switch (method) {
	case IN_TIME:
		return shape ? passo_move_user_in_time(passo, &move->in_time, shape)
		             : passo_move_in_time(passo, &move->in_time);
	case BY_SPEED:
		return shape ? passo_move_user_by_speed(passo, &move->by_speed, shape)
		             : passo_move_by_speed(passo, &move->by_speed);
	case BELOW_SPEED:
		return passo_move_below_speed(passo, &move->below_speed);
	case AT_SPEED:
		return passo_move_at_speed(passo, &move->at_speed);
	case AXES:
		return passo_move_axes(passo, &move->axes);
	case TURN:
		return passo_move_turn(passo, &move->turn);
	case SIGMOID:
		return passo_move_sigmoid(passo, &move->sigmoid);
	case JERK:
		return passo_move_jerk(passo, &move->jerk);
	case STRAIGHT:
		return passo_move_straight(passo, &move->straight);
	case METHODS:
		break;
	}
	return PASSO_ERROR_ARGUMENT;
}

bool passo_forms_move(struct passo *passo, struct passo_reading *reading, struct passo_words *words,
    const struct passo_loaded_table *table)
{
	const char *name = passo_words_find(words, "method");
	enum method method = name != NULL ? form_by_name(reading->sink, name) : form_by_keys(reading, words);
	const struct passo_user_shape shape = {.bank = PASSO_SHAPE_SIGMOID, .table = table->points};
	union move move;
	enum passo_error error;

	if (method == METHODS)
		return false;
	memset(&move, 0, sizeof move);
	if (!passo_keys_check(reading, FORMS[method].keys, FORMS[method].count, 0, words)
	    || !passo_keys_read(reading, FORMS[method].keys, FORMS[method].count, words, &move))
		return false;
	if (method == BY_SPEED && !check_by_speed(reading->sink, words, &move.by_speed))
		return false;
	if (reading->user_shape && table->loaded != PASSO_TABLE_LOADED)
		return passo_complain(reading->sink, "table is missing");
	error = queue(passo, method, &move, reading->user_shape ? &shape : NULL);
	return error == PASSO_OK || passo_complain_error(reading->sink, error);
}

void passo_forms_help(const struct passo_sink *sink)
{
	for (enum method method = IN_TIME; method < METHODS; method++) {
		passo_say(
		    sink, method <= BY_SPEED ? "  move [method=%s]" : "  move method=%s", FORMS[method].name);
		passo_keys_help(sink, FORMS[method].keys + 1, FORMS[method].count - 1u);
		passo_say(sink, "\n");
	}
}

bool passo_complain_error(const struct passo_sink *sink, enum passo_error error)
{
	return passo_complain(sink, "%s: %s", passo_error_name(error), passo_error_text(error));
}
