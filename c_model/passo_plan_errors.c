/* SPDX-License-Identifier: MIT
 * What the further methods refuse, in words.
 */
#include "passo_plan.h"

enum { FIRST = PASSO_METHOD_SPEED_TOO_LOW, COUNT = PASSO_METHOD_ERRORS_END - FIRST };

static const struct {
	const char *name, *text;
} ERRORS[COUNT] = {
    [PASSO_METHOD_SPEED_TOO_LOW - FIRST] = {"SPEED_TOO_LOW",
	"At the highest speed so many steps take more than the total time."},
    [PASSO_METHOD_BAD_AXIS - FIRST] = {"BAD_AXIS", "The axis is not one of the machine's."},
    [PASSO_METHOD_NO_STEPS_PER_TURN - FIRST] = {"NO_STEPS_PER_TURN", "A turn must have steps."},
    [PASSO_METHOD_MINIMUM_ABOVE_SPEED - FIRST] = {"MINIMUM_ABOVE_SPEED", "The minimum rpm is above the rpm."},
    [PASSO_METHOD_BELOW_MINIMUM - FIRST] = {"BELOW_MINIMUM", "The rpm is below the minimum rpm."},
    [PASSO_METHOD_ABOVE_TOP - FIRST] = {"ABOVE_TOP", "The rpm or the present velocity is above the top rpm."},
    [PASSO_METHOD_BAD_ALPHA - FIRST] = {"BAD_ALPHA", "Alpha must be 3 to 5."},
    [PASSO_METHOD_NO_JERK - FIRST] = {"NO_JERK", "The jerk is 0."},
    [PASSO_METHOD_NO_FEED - FIRST] = {"NO_FEED", "The feed is 0."},
    [PASSO_METHOD_NO_SCALE - FIRST] = {"NO_SCALE", "An axis that moves has no steps per millimetre."},
    [PASSO_METHOD_NO_AXIS_SPEED - FIRST] = {"NO_AXIS_SPEED", "The largest speed of an axis that moves is 0."},
    [PASSO_METHOD_NO_AXIS_ACCELERATION - FIRST] = {"NO_AXIS_ACCELERATION",
	"The largest acceleration of an axis that moves is 0."},
    [PASSO_METHOD_BAD_BANK - FIRST] = {"BAD_BANK", "A table belongs in one of the banks 1 to 3."},
    [PASSO_METHOD_TABLE_START - FIRST] = {"TABLE_START", "A shape must start at 0."},
    [PASSO_METHOD_TABLE_FALLS - FIRST] = {"TABLE_FALLS", "A shape must never fall."},
};

static bool is_known(uint32_t error)
{
	return error >= FIRST && error < PASSO_METHOD_ERRORS_END;
}

const char *passo_method_error_name(uint32_t error)
{
	return is_known(error) ? ERRORS[error - FIRST].name : passo_plan_error_name(error);
}

const char *passo_method_error_text(uint32_t error)
{
	return is_known(error) ? ERRORS[error - FIRST].text : passo_plan_error_text(error);
}
