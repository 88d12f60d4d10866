/* SPDX-License-Identifier: MIT
 * Generated from spec/moves.toml by spec/generate_moves.py.
 *
 * Keys of the move forms.
 */
#include "passo_form_tables.h"

static const struct passo_key IN_TIME_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_in_time, steps)},
	{.name = "profile", .reader = PASSO_READ_SHAPE, .offset = offsetof(struct passo_move_in_time, profile)},
	{.name = "total_time", .reader = PASSO_READ_TIME, .offset = offsetof(struct passo_move_in_time, total_clocks)},
	{.name = "ramp_time", .reader = PASSO_READ_TIME, .offset = offsetof(struct passo_move_in_time, ramp_clocks)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key BY_SPEED_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_by_speed, steps)},
	{.name = "profile", .reader = PASSO_READ_SHAPE, .offset = offsetof(struct passo_move_by_speed, profile)},
	{.name = "start_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_by_speed, start_speed)},
	{.name = "speed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_by_speed, speed)},
	{.name = "stop_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_by_speed, stop_speed)},
	{.name = "acceleration", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_by_speed, acceleration)},
	{.name = "deceleration", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_by_speed, deceleration)},
	{.name = "ramp_time", .reader = PASSO_READ_TIME, .otherwise = "0", .offset = offsetof(struct passo_move_by_speed, ramp_clocks)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_rule BY_SPEED_RULES[] = {
	{PASSO_RULE_EXCLUDES, 6u, 8u}, /* acceleration */
	{PASSO_RULE_NEEDS, 7u, 6u}, /* deceleration */
	{PASSO_RULE_ABOVE_ZERO, 6u, 6u}, /* acceleration */
	{PASSO_RULE_ABOVE_ZERO, 7u, 7u}, /* deceleration */
};

static const struct passo_key BELOW_SPEED_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_below_speed, steps)},
	{.name = "profile", .reader = PASSO_READ_PROFILE, .offset = offsetof(struct passo_move_below_speed, profile)},
	{.name = "total_time", .reader = PASSO_READ_TIME, .offset = offsetof(struct passo_move_below_speed, total_clocks)},
	{.name = "speed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_below_speed, speed)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key AT_SPEED_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_at_speed, steps)},
	{.name = "profile", .reader = PASSO_READ_PROFILE, .offset = offsetof(struct passo_move_at_speed, profile)},
	{.name = "speed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_at_speed, speed)},
	{.name = "ramp_time", .reader = PASSO_READ_TIME, .offset = offsetof(struct passo_move_at_speed, ramp_clocks)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key AXES_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_axes, steps)},
	{.name = "start_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_axes, start_speed)},
	{.name = "speed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_axes, speed)},
	{.name = "ramp_time", .reader = PASSO_READ_TIME, .offset = offsetof(struct passo_move_axes, ramp_clocks)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key TURN_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "axis", .reader = PASSO_READ_AXIS, .otherwise = "0", .offset = offsetof(struct passo_move_turn, axis)},
	{.name = "axes", .reader = PASSO_READ_AXES, .otherwise = ""},
	{.name = "steps_per_turn", .reader = PASSO_READ_WHOLE, .low = 1u, .high = PASSO_WHOLE_MAX, .offset = offsetof(struct passo_move_turn, steps_per_turn)},
	{.name = "angle", .reader = PASSO_READ_SIGNED, .offset = offsetof(struct passo_move_turn, angle)},
	{.name = "rpm", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_turn, rpm)},
	{.name = "minimum_rpm", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_turn, minimum_rpm)},
	{.name = "acceleration", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_turn, acceleration)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key SIGMOID_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_sigmoid, steps)},
	{.name = "start_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_sigmoid, start_speed)},
	{.name = "speed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_sigmoid, speed)},
	{.name = "stop_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_sigmoid, stop_speed)},
	{.name = "accelerate_time", .reader = PASSO_READ_TIME, .offset = offsetof(struct passo_move_sigmoid, accelerate_clocks)},
	{.name = "decelerate_time", .reader = PASSO_READ_TIME, .otherwise = "accelerate_time", .offset = offsetof(struct passo_move_sigmoid, decelerate_clocks)},
	{.name = "alpha", .reader = PASSO_READ_ALPHA, .otherwise = "5", .offset = offsetof(struct passo_move_sigmoid, alpha)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key JERK_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps", .reader = PASSO_READ_STEPS, .offset = offsetof(struct passo_move_jerk, steps)},
	{.name = "start_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_jerk, start_speed)},
	{.name = "speed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_jerk, speed)},
	{.name = "stop_speed", .reader = PASSO_READ_NUMBER, .otherwise = "0", .offset = offsetof(struct passo_move_jerk, stop_speed)},
	{.name = "acceleration", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_jerk, acceleration)},
	{.name = "jerk", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_jerk, jerk)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

static const struct passo_key STRAIGHT_KEYS[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "distance", .reader = PASSO_READ_DISTANCE, .offset = offsetof(struct passo_move_straight, distance)},
	{.name = "feed", .reader = PASSO_READ_NUMBER, .offset = offsetof(struct passo_move_straight, feed)},
	{.name = "steps_per_mm", .reader = PASSO_READ_PER_AXIS, .otherwise = "0", .offset = offsetof(struct passo_move_straight, limits[0].steps_per_mm)},
	{.name = "speed", .reader = PASSO_READ_PER_AXIS, .offset = offsetof(struct passo_move_straight, limits[0].speed)},
	{.name = "acceleration", .reader = PASSO_READ_PER_AXIS, .offset = offsetof(struct passo_move_straight, limits[0].acceleration)},
	{.name = "jerk", .reader = PASSO_READ_PER_AXIS, .otherwise = "0", .offset = offsetof(struct passo_move_straight, limits[0].jerk)},
	{.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
};

const struct passo_form_table passo_form_tables[PASSO_FORM_COUNT] = {
	[PASSO_FORM_IN_TIME] = {.name = "in_time", .keys = IN_TIME_KEYS, .count = 6u, .told_by = "total_time"},
	[PASSO_FORM_BY_SPEED] = {.name = "by_speed", .keys = BY_SPEED_KEYS, .count = 10u, .rules = BY_SPEED_RULES, .rule_count = 4u, .told_by = "speed"},
	[PASSO_FORM_BELOW_SPEED] = {.name = "below_speed", .keys = BELOW_SPEED_KEYS, .count = 6u},
	[PASSO_FORM_AT_SPEED] = {.name = "at_speed", .keys = AT_SPEED_KEYS, .count = 6u},
	[PASSO_FORM_AXES] = {.name = "axes", .keys = AXES_KEYS, .count = 6u},
	[PASSO_FORM_TURN] = {.name = "turn", .keys = TURN_KEYS, .count = 9u},
	[PASSO_FORM_SIGMOID] = {.name = "sigmoid", .keys = SIGMOID_KEYS, .count = 9u},
	[PASSO_FORM_JERK] = {.name = "jerk", .keys = JERK_KEYS, .count = 8u},
	[PASSO_FORM_STRAIGHT] = {.name = "straight", .keys = STRAIGHT_KEYS, .count = 8u},
};

const struct passo_key passo_form_told_keys[] = {
	{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},
	{.name = "steps"},
	{.name = "profile"},
	{.name = "total_time"},
	{.name = "ramp_time"},
	{.name = "channel"},
	{.name = "start_speed"},
	{.name = "speed"},
	{.name = "stop_speed"},
	{.name = "acceleration"},
	{.name = "deceleration"},
};
const unsigned passo_form_told_count = 11u;
