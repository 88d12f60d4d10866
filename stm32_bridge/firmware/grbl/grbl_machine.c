/* SPDX-License-Identifier: MIT */
#include "grbl_machine.h"

#define POLLS 2000u   /* of the feed in a second, at least */
#define RESERVES 200u /* in a second: the core has so much, however the lines come */

#define MILLION ((int64_t)PASSO_GCODE_MILLION)
#define AXES_USED (AXES > 0 ? AXES : GRBL_AXES_MAX)
#define AXES_NEEDED ((MOTORS > 0 ? MOTORS : AXES > 0 ? AXES : 1) + (TURN_COUNTS > 0))
#define UM_PER_MM 1000
#define SPIN_UP 10     /* s, where an input says when it is over */
#define LINEAR_AXES 2u /* X and Y; Z and what follows are slow */

static const uint16_t VALUES[PASSO_GRBL_SETTINGS] = {
    [PASSO_GRBL_IDLE_DELAY] = 255,
    [PASSO_GRBL_REPORT] = 3,
    [PASSO_GRBL_HOMING] = HOMED != 0,
    [PASSO_GRBL_HARD_LIMITS] = (LIMITS_LOW | LIMITS_HIGH) != 0,
    [PASSO_GRBL_HOMES_LOW] = 0,
    [PASSO_GRBL_HOME_FEED] = 120,
    [PASSO_GRBL_HOME_SEEK] = 1200,
    [PASSO_GRBL_PULL_OFF] = 1,
    [PASSO_GRBL_TURN] = 1,
    [PASSO_GRBL_SPINDLE] = 1000,
#ifndef PASSO_PLAIN_GCODE
    [PASSO_GRBL_TOUCH_DISTANCE] = 30,
    [PASSO_GRBL_TOUCH_FEED] = 25,
    [PASSO_GRBL_TOUCH_SEEK] = 200,
    [PASSO_GRBL_TOUCH_PULL_OFF] = 200,
    [PASSO_GRBL_SPIN_UP] = AT_SPEED != 0 ? SPIN_UP : 0,
#endif
};

static const uint16_t AXIS_VALUES[PASSO_GRBL_AXIS_SETTINGS][2] = {
    [PASSO_GRBL_STEPS] = {80, 400},
    [PASSO_GRBL_SPEED] = {12000, 720},
    [PASSO_GRBL_ACCELERATION] = {1000, 100},
    [PASSO_GRBL_TRAVEL] = {200, 200},
};

static void grbl_defaults(struct passo_grbl_settings *settings)
{
	for (unsigned i = 0; i < PASSO_GRBL_SETTINGS; i++)
		settings->value[i] = VALUES[i] * MILLION;
	settings->value[PASSO_GRBL_PULSE] = 2 * MILLION;
	settings->value[PASSO_GRBL_DEBOUNCE] = 2 * MILLION / 5; /* that a core of 160 MHz can count */
	settings->value[PASSO_GRBL_DEVIATION] = MILLION / 100;
	settings->value[PASSO_GRBL_ARC_TOLERANCE] = MILLION / 500;
	for (unsigned i = 0; i < PASSO_GRBL_AXIS_SETTINGS * PASSO_GCODE_AXES_MAX; i++) {
		const unsigned setting = i / PASSO_GCODE_AXES_MAX, axis = i % PASSO_GCODE_AXES_MAX;

		settings->axis[setting][axis] = AXIS_VALUES[setting][axis >= LINEAR_AXES] * MILLION;
	}
	if (SQUARED != 0 && RACKING < UM_PER_MM) /* the pull-off is not more */
		settings->value[PASSO_GRBL_PULL_OFF] = RACKING * MILLION / UM_PER_MM;
}

_Static_assert(AXES <= GRBL_AXES_MAX, "the image has fewer axes");
#ifdef PASSO_PLAIN_GCODE
_Static_assert(AXES_LEFT_OUT == 0, "the image has the axes X Y Z A B C without a gap");
_Static_assert(AT_SPEED == 0, "the image does not wait for a spindle");
#endif
_Static_assert(AT_SPEED <= PASSO_PATH_AXES_MAX && (HOMES << 1 >> AT_SPEED & 1) == 0,
    "the input of a spindle is the home input of a motor that has no home switch");
#ifdef PASSO_CARTESIAN
_Static_assert(MOTORS == 0, "the image has a motor for each axis");
_Static_assert(!HAS_ENCODERS, "the image has no encoders");
#else
static const uint64_t ENCODER[2u * PASSO_AXES_MAX] = {ENCODERS};

_Static_assert(
    MOTORS == 0 || (MOTORS >= AXES && MOTORS <= PASSO_PATH_AXES_MAX), "the image has fewer motors");

static void set_motors(struct passo_path_settings *path)
{
	const uint64_t plus = MOTORS_PLUS, minus = MOTORS_MINUS;

	path->motors.count = MOTORS;
	for (unsigned motor = 0; motor < path->motors.count; motor++) {
		path->motors.plus[motor] = (uint8_t)(plus >> 8u * motor);
		path->motors.minus[motor] = (uint8_t)(minus >> 8u * motor);
	}
	path->mixed = (struct passo_path_axis){.speed = (uint64_t)MOTORS_SPEED << 32,
	    .acceleration = (uint64_t)MOTORS_ACCELERATION << 32,
	    .jerk = (uint64_t)MOTORS_JERK << 32};
}
#endif

#ifdef PASSO_WITHOUT_THREADS
_Static_assert(TURN_COUNTS == 0, "the image has no threads");
#endif
_Static_assert(TURN_COUNTS <= UINT16_MAX, "a turn has at most 65535 counts");

enum passo_error grbl_machine_check(struct passo *passo)
{
	const bool inputs = (LIMITS_LOW | LIMITS_HIGH | HOMES | PROBE | AT_SPEED) != 0;

	if (passo_machine(passo)->axes < AXES_NEEDED)
		return PASSO_ERROR_PARAMETERS;
	if (inputs && !passo->has_inputs)
		return PASSO_ERROR_NO_INPUTS;
#ifndef PASSO_CARTESIAN
	if ((HAS_ENCODERS || TURN_COUNTS > 0) && !passo->has_encoders)
		return PASSO_ERROR_NO_ENCODERS;
#endif
	return OUTPUTS != 0 && !passo->has_outputs ? PASSO_ERROR_NO_OUTPUTS : PASSO_OK;
}

void grbl_machine(
    struct passo_grbl_setup *setup, const struct passo *passo, const struct passo_storage_pages *pages)
{
	*setup = (struct passo_grbl_setup){.path = {.machine = *passo_machine(passo),
					       .profile = PASSO_PROFILE_LINEAR,
					       .reserve_clocks = passo_machine(passo)->clock_hz / RESERVES,
					       .polls = POLLS},
	    .limits_low = LIMITS_LOW,
	    .limits_high = LIMITS_HIGH,
	    .homes = HOMES,
	    .homed = HOMED,
	    .probe = PROBE,
	    .defaults = grbl_defaults,
	    .pages = pages};
	if (TURN_COUNTS > 0)
		setup->path.machine.axes--; /* the inputs of the last one are those of the spindle */
	if (setup->path.machine.axes > AXES_USED)
		setup->path.machine.axes = AXES_USED;
#ifndef PASSO_WITHOUT_THREADS
	setup->turn_counts = TURN_COUNTS;
#endif
#ifndef PASSO_PLAIN_GCODE
	setup->at_speed = AT_SPEED;
#endif
#ifndef PASSO_CARTESIAN
	set_motors(&setup->path);
	setup->squared = SQUARED;
	setup->racking = RACKING;
	setup->encoders = HAS_ENCODERS ? ENCODER : NULL;
#endif
}
