/* SPDX-License-Identifier: MIT
 * Names and descriptions of the planner's errors.
 */
#include <stddef.h>

#include "passo_plan.h"
#include "passo_strings.h"

_Static_assert(PASSO_AXES_MAX == 8u, "BAD_AXES states the limit");

/* X(name, text) in the order of the codes. */
#define ERRORS(X)                                                                                            \
	X(OK, "The plan is valid.")                                                                          \
	X(BAD_CLOCK, "The clock must be above 0 Hz and a tick 2^" PASSO_TICK_LOG2_MIN_WORDS                  \
		     " to 2^" PASSO_TICK_LOG2_MAX_WORDS " clocks.")                                          \
	X(BAD_AXES, "A move has 1 to 8 axes.")                                                               \
	X(BAD_PROFILE, "The profile must be " PASSO_PROFILES_WORDS ".")                                      \
	X(NO_STEPS, "No axis has any steps.")                                                                \
	X(TOO_MANY_STEPS, "An axis can move at most " PASSO_SUBSTEPS_MAX_WORDS " steps in one move.")        \
	X(NO_TIME, "The total time is less than one tick.")                                                  \
	X(RAMP_TOO_LONG, "The ramp time is more than half the total time.")                                  \
	X(TOO_LONG,                                                                                          \
	    "A phase takes 2^32 ticks or more, or the move 2^" PASSO_MOVE_CLOCKS_LOG2_WORDS " clocks.")      \
	X(TOO_FAST, "The dominant axis would exceed one step every two clocks.")                             \
	X(NO_SPEED, "The speed is 0.")                                                                       \
	X(NO_ACCELERATION, "A change of speed needs acceleration or ramp time.")                             \
	X(START_ABOVE_SPEED, "The start speed is above the speed.")                                          \
	X(STOP_ABOVE_SPEED, "The stop speed is above the speed.")                                            \
	X(SPEED_TOO_LOW, "The steps take more than the total time at this speed.")                           \
	X(BAD_AXIS, "The core has no such axis.")                                                            \
	X(NO_STEPS_PER_TURN, "The steps per turn are 0.")                                                    \
	X(MINIMUM_ABOVE_SPEED, "The minimum rpm is above the rpm.")                                          \
	X(BELOW_MINIMUM, "The rpm is below the minimum rpm.")                                                \
	X(ABOVE_TOP, "The rpm or the present velocity is above the top rpm.")                                \
	X(BAD_ALPHA, "Alpha must be " PASSO_ALPHA_MIN_WORDS " to " PASSO_ALPHA_MAX_WORDS ".")                \
	X(NO_JERK, "The jerk is 0.")                                                                         \
	X(NO_FEED, "The feed is 0.")                                                                         \
	X(NO_SCALE, "A moving axis has no steps per millimeter.")                                            \
	X(NO_AXIS_SPEED, "The speed limit of a moving axis is 0.")                                           \
	X(NO_AXIS_ACCELERATION, "The acceleration limit of a moving axis is 0.")                             \
	X(BAD_BANK, "A table must go into bank 1, 2 or 3.")                                                  \
	X(TABLE_START, "A shape must start at 0.")                                                           \
	X(TABLE_FALLS, "A shape must not decrease.")                                                         \
	X(PATH_FULL, "The path has no room for another line yet.")                                           \
	X(TOO_FAR, "A target is 2^30 mm or more from the origin.")
#ifdef PASSO_WITHOUT_GOTO
#define ERRORS_OF_GOTO(X)
#else
#define ERRORS_OF_GOTO(X) X(TOO_NEAR, "The axis cannot come to rest before the target.")
#endif

static const char NAMES[] = ERRORS(PASSO_STRING_NAME) ERRORS_OF_GOTO(PASSO_STRING_NAME);
static const char TEXTS[] = ERRORS(PASSO_STRING_TEXT) ERRORS_OF_GOTO(PASSO_STRING_TEXT);

struct errors {
	ERRORS(PASSO_STRING_PLACE) ERRORS_OF_GOTO(PASSO_STRING_PLACE)
};
#define IN_ORDER(name, text) _Static_assert(offsetof(struct errors, name) == PASSO_PLAN_##name, #name);
ERRORS(IN_ORDER)
ERRORS_OF_GOTO(IN_ORDER)

/* The string of an error, or `unknown`. */
static const char *find(enum passo_plan_error error, const char *strings, const char *unknown)
{
	return (unsigned)error < sizeof(struct errors) ? passo_string(strings, (unsigned)error) : unknown;
}

const char *passo_plan_error_name(enum passo_plan_error error)
{
	return find(error, NAMES, "UNKNOWN");
}

const char *passo_plan_error_text(enum passo_plan_error error)
{
	return find(error, TEXTS, "This is not a planner error.");
}
