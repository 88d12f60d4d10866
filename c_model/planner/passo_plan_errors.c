/* SPDX-License-Identifier: MIT
 * Names and descriptions of the planner's errors.
 */
#include "passo_plan.h"

_Static_assert(PASSO_AXES_MAX == 8u, "BAD_AXES states the limit");

static const struct {
	const char *name, *text;
} ERRORS[] = {
    [PASSO_PLAN_OK] = {"OK", "The plan is valid."},
    [PASSO_PLAN_BAD_CLOCK] = {"BAD_CLOCK",
	"The clock must be above 0 Hz and a tick 2^" PASSO_TICK_LOG2_MIN_WORDS
	" to 2^" PASSO_TICK_LOG2_MAX_WORDS " clocks."},
    [PASSO_PLAN_BAD_AXES] = {"BAD_AXES", "A move has 1 to 8 axes."},
    [PASSO_PLAN_BAD_PROFILE] = {"BAD_PROFILE", "The profile must be " PASSO_PROFILES_WORDS "."},
    [PASSO_PLAN_NO_STEPS] = {"NO_STEPS", "No axis has any steps."},
    [PASSO_PLAN_TOO_MANY_STEPS] = {"TOO_MANY_STEPS",
	"An axis can move at most " PASSO_SUBSTEPS_MAX_WORDS " steps in one move."},
    [PASSO_PLAN_NO_TIME] = {"NO_TIME", "The total time is less than one tick."},
    [PASSO_PLAN_RAMP_TOO_LONG] = {"RAMP_TOO_LONG", "The ramp time is more than half the total time."},
    [PASSO_PLAN_TOO_LONG] = {"TOO_LONG",
	"A phase takes 2^32 ticks or more, or the move 2^" PASSO_MOVE_CLOCKS_LOG2_WORDS " clocks."},
    [PASSO_PLAN_TOO_FAST] = {"TOO_FAST", "The dominant axis would exceed one step every two clocks."},
    [PASSO_PLAN_NO_SPEED] = {"NO_SPEED", "The speed is 0."},
    [PASSO_PLAN_NO_ACCELERATION] = {"NO_ACCELERATION", "A change of speed needs acceleration or ramp time."},
    [PASSO_PLAN_START_ABOVE_SPEED] = {"START_ABOVE_SPEED", "The start speed is above the speed."},
    [PASSO_PLAN_STOP_ABOVE_SPEED] = {"STOP_ABOVE_SPEED", "The stop speed is above the speed."},
    [PASSO_PLAN_SPEED_TOO_LOW] = {"SPEED_TOO_LOW", "The steps take more than the total time at this speed."},
    [PASSO_PLAN_BAD_AXIS] = {"BAD_AXIS", "The core has no such axis."},
    [PASSO_PLAN_NO_STEPS_PER_TURN] = {"NO_STEPS_PER_TURN", "The steps per turn are 0."},
    [PASSO_PLAN_MINIMUM_ABOVE_SPEED] = {"MINIMUM_ABOVE_SPEED", "The minimum rpm is above the rpm."},
    [PASSO_PLAN_BELOW_MINIMUM] = {"BELOW_MINIMUM", "The rpm is below the minimum rpm."},
    [PASSO_PLAN_ABOVE_TOP] = {"ABOVE_TOP", "The rpm or the present velocity is above the top rpm."},
    [PASSO_PLAN_BAD_ALPHA] = {"BAD_ALPHA",
	"Alpha must be " PASSO_ALPHA_MIN_WORDS " to " PASSO_ALPHA_MAX_WORDS "."},
    [PASSO_PLAN_NO_JERK] = {"NO_JERK", "The jerk is 0."},
    [PASSO_PLAN_NO_FEED] = {"NO_FEED", "The feed is 0."},
    [PASSO_PLAN_NO_SCALE] = {"NO_SCALE", "A moving axis has no steps per millimeter."},
    [PASSO_PLAN_NO_AXIS_SPEED] = {"NO_AXIS_SPEED", "The speed limit of a moving axis is 0."},
    [PASSO_PLAN_NO_AXIS_ACCELERATION] = {"NO_AXIS_ACCELERATION",
	"The acceleration limit of a moving axis is 0."},
    [PASSO_PLAN_BAD_BANK] = {"BAD_BANK", "A table must go into bank 1, 2 or 3."},
    [PASSO_PLAN_TABLE_START] = {"TABLE_START", "A shape must start at 0."},
    [PASSO_PLAN_TABLE_FALLS] = {"TABLE_FALLS", "A shape must not decrease."},
    [PASSO_PLAN_PATH_FULL] = {"PATH_FULL", "The path has no room for another line yet."},
    [PASSO_PLAN_TOO_FAR] = {"TOO_FAR", "A target is 2^30 mm or more from the origin."},
#ifndef PASSO_WITHOUT_GOTO
    [PASSO_PLAN_TOO_NEAR] = {"TOO_NEAR", "The axis cannot come to rest before the target."},
#endif
};

static bool is_known(enum passo_plan_error error)
{
	return (unsigned)error < sizeof(ERRORS) / sizeof(ERRORS[0]);
}

const char *passo_plan_error_name(enum passo_plan_error error)
{
	return is_known(error) ? ERRORS[error].name : "UNKNOWN";
}

const char *passo_plan_error_text(enum passo_plan_error error)
{
	return is_known(error) ? ERRORS[error].text : "This is not a planner error.";
}
