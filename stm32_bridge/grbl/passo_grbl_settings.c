/* SPDX-License-Identifier: MIT
 * Numbers, kinds and ranges of the settings.
 */
#include "passo_grbl_settings.h"

#include <stddef.h>

/* Ranges are whole numbers; `positive`: above 0 as well. */
struct kind {
	uint16_t number; /* of an axis: that of X, the others follow */
	bool whole, positive;
	uint32_t most;
};

static const struct kind KINDS[PASSO_GRBL_SETTINGS] = {
    [PASSO_GRBL_PULSE] = {0, false, true, 1000},
    [PASSO_GRBL_IDLE_DELAY] = {1, true, false, 255},
    [PASSO_GRBL_STEPS_INVERTED] = {2, true, false, 63},
    [PASSO_GRBL_DIRS_INVERTED] = {3, true, false, 63},
    [PASSO_GRBL_ENABLES_INVERTED] = {4, true, false, 1},
    [PASSO_GRBL_LIMITS_INVERTED] = {5, true, false, 1},
    [PASSO_GRBL_PROBE_INVERTED] = {6, true, false, 1},
    [PASSO_GRBL_REPORT] = {10, true, false, 255},
    [PASSO_GRBL_DEVIATION] = {11, false, false, 1000},
    [PASSO_GRBL_ARC_TOLERANCE] = {12, false, true, 1000},
    [PASSO_GRBL_INCHES] = {13, true, false, 1},
    [PASSO_GRBL_SOFT_LIMITS] = {20, true, false, 1},
    [PASSO_GRBL_HARD_LIMITS] = {21, true, false, 1},
    [PASSO_GRBL_HOMING] = {22, true, false, 1},
    [PASSO_GRBL_HOMES_LOW] = {23, true, false, 63},
    [PASSO_GRBL_HOME_FEED] = {24, false, true, 1000000},
    [PASSO_GRBL_HOME_SEEK] = {25, false, true, 1000000},
    [PASSO_GRBL_DEBOUNCE] = {26, false, false, 1000},
    [PASSO_GRBL_PULL_OFF] = {27, false, true, 1000},
    [PASSO_GRBL_TURN] = {29, false, false, 1000},
    [PASSO_GRBL_SPINDLE] = {30, true, false, 1000000},
    [PASSO_GRBL_SPINDLE_LEAST] = {31, true, false, 1000000},
    [PASSO_GRBL_LASER] = {32, true, false, 1},
#ifndef PASSO_PLAIN_GCODE
    [PASSO_GRBL_TOUCH_DISTANCE] = {342, false, true, 1000},
    [PASSO_GRBL_TOUCH_FEED] = {343, false, true, 1000000},
    [PASSO_GRBL_TOUCH_SEEK] = {344, false, true, 1000000},
    [PASSO_GRBL_TOUCH_PULL_OFF] = {345, false, true, 1000000},
    [PASSO_GRBL_SPIN_UP] = {394, false, false, 60},
#endif
};

static const struct kind AXIS_KINDS[PASSO_GRBL_AXIS_SETTINGS] = {
    [PASSO_GRBL_STEPS] = {100, false, true, 1000000},
    [PASSO_GRBL_SPEED] = {110, false, true, 10000000},
    [PASSO_GRBL_ACCELERATION] = {120, false, true, 1000000},
    [PASSO_GRBL_TRAVEL] = {130, false, true, 100000},
#ifndef PASSO_WITHOUT_TRACKERS
    [PASSO_GRBL_BACKLASH] = {160, false, false, 1000},
    [PASSO_GRBL_TAKE_UP] = {810, false, false, 1000000},
#endif
#ifndef PASSO_LINEAR_PATHS
    [PASSO_GRBL_JERK] = {800, false, false, 999999999},
#endif
#ifndef PASSO_CARTESIAN
    [PASSO_GRBL_OFFSET] = {170, false, false, 1000},
#endif
};

static bool is_signed(const struct kind *kind)
{
#ifndef PASSO_CARTESIAN
	return kind == &AXIS_KINDS[PASSO_GRBL_OFFSET];
#else
	(void)kind;
	return false;
#endif
}

static unsigned count_of(const struct kind *kind, struct passo_grbl_counts counts)
{
#ifndef PASSO_CARTESIAN
	if (is_signed(kind))
		return counts.offsets;
#endif
	(void)kind;
	return counts.axes;
}

static const struct kind *find(unsigned number, struct passo_grbl_counts counts)
{
	for (unsigned i = 0; i < PASSO_GRBL_SETTINGS; i++) {
		if (KINDS[i].number == number)
			return &KINDS[i];
	}
	for (unsigned i = 0; i < PASSO_GRBL_AXIS_SETTINGS; i++) {
		if (number - AXIS_KINDS[i].number < count_of(&AXIS_KINDS[i], counts))
			return &AXIS_KINDS[i];
	}
	return NULL;
}

int64_t *passo_grbl_setting(
    struct passo_grbl_settings *settings, unsigned number, struct passo_grbl_counts counts)
{
	const struct kind *kind = find(number, counts);

	if (!kind)
		return NULL;
	return kind >= KINDS && kind < KINDS + PASSO_GRBL_SETTINGS
	         ? &settings->value[kind - KINDS]
	         : &settings->axis[kind - AXIS_KINDS][number - kind->number];
}

uint32_t passo_grbl_setting_most(unsigned number, struct passo_grbl_counts counts, bool *positive)
{
	const struct kind *kind = find(number, counts);

	*positive = kind && kind->positive;
	return kind ? kind->most : 0;
}

unsigned passo_grbl_setting_number(unsigned index, struct passo_grbl_counts counts, bool *whole)
{
	if (index < PASSO_GRBL_SETTINGS) {
		*whole = KINDS[index].whole;
		return KINDS[index].number;
	}
	index -= PASSO_GRBL_SETTINGS;
	*whole = false;
	for (unsigned i = 0; i < PASSO_GRBL_AXIS_SETTINGS; i++) {
		const unsigned count = count_of(&AXIS_KINDS[i], counts);

		if (index < count)
			return AXIS_KINDS[i].number + index;
		index -= count;
	}
	return PASSO_GRBL_NO_SETTING;
}

bool passo_grbl_is_on(const struct passo_grbl_settings *settings, enum passo_grbl_setting setting)
{
	return settings->value[setting] != 0;
}

bool passo_grbl_has_axis(
    const struct passo_grbl_settings *settings, enum passo_grbl_setting mask, unsigned axis)
{
	return (settings->value[mask] / PASSO_GCODE_MILLION >> axis & 1) != 0;
}

enum passo_gcode_error passo_grbl_set(
    struct passo_grbl_settings *settings, unsigned number, struct passo_grbl_counts counts, int64_t value)
{
	const struct kind *kind = find(number, counts);

	if (!kind)
		return PASSO_GCODE_STATEMENT;
	const bool minus = is_signed(kind) && value < 0;
	const int64_t size = minus ? -value : value;

	if (size < 0)
		return PASSO_GCODE_NEGATIVE;
	if (kind->whole && value % PASSO_GCODE_MILLION != 0)
		return PASSO_GCODE_NUMBER;
	if (kind == &KINDS[PASSO_GRBL_PULSE] && value == 0)
		return PASSO_GCODE_PULSE_TOO_SHORT;
	if (size > kind->most * (int64_t)PASSO_GCODE_MILLION || (kind->positive && value == 0))
		return PASSO_GCODE_STATEMENT;
	if (kind == &KINDS[PASSO_GRBL_SOFT_LIMITS] && value != 0
	    && !passo_grbl_is_on(settings, PASSO_GRBL_HOMING))
		return PASSO_GCODE_SOFT_LIMITS_NEED_HOMING;
	*passo_grbl_setting(settings, number, counts) = value;
	if (!passo_grbl_is_on(settings, PASSO_GRBL_HOMING))
		settings->value[PASSO_GRBL_SOFT_LIMITS] = 0;
	return PASSO_GCODE_OK;
}
