/* SPDX-License-Identifier: MIT
 * Homing: Z first, then the other axes, as the settings say.
 */
#include "passo_driver.h"
#include "passo_grbl_private.h"
#include "passo_math.h"

#define MILLION ((uint64_t)PASSO_GCODE_MILLION)
#define MILLI UINT64_C(1000)
#define SECONDS_PER_MINUTE 60u

/* Steps of millionths of a millimeter; UQ32.32 steps/s of millionths of mm/min. */
static int32_t steps_of(const struct passo_grbl *grbl, unsigned axis, uint64_t length)
{
	const uint64_t steps = passo_mul_div(
	    length, (uint64_t)grbl->stored.settings.axis[PASSO_GRBL_STEPS][axis], MILLION * MILLION);

	return steps < PASSO_SUBSTEPS_MAX ? (int32_t)steps : (int32_t)PASSO_SUBSTEPS_MAX;
}

static uint64_t speed_of(const struct passo_grbl *grbl, unsigned axis, enum passo_grbl_setting setting)
{
	const int64_t own = grbl->stored.settings.axis[PASSO_GRBL_SPEED][axis];
	const int64_t wanted = grbl->stored.settings.value[setting];

	return passo_mul_div((uint64_t)(wanted < own ? wanted : own), grbl->path.axis[axis].steps_per_mm,
	    SECONDS_PER_MINUTE * MILLION);
}

#ifndef PASSO_CARTESIAN
/* Bits of the motors that move an axis, as it goes or the other way. */
static uint8_t motors_along(const struct passo_grbl *grbl, unsigned axis, bool backward)
{
	const struct passo_motors *motors = &grbl->path.motors;
	const uint8_t *rows = backward ? motors->minus : motors->plus;
	uint8_t bits = 0;

	for (unsigned motor = 0; motor < motors->count; motor++)
		bits |= (uint8_t)((rows[motor] >> axis & 1u) << motor);
	return bits;
}

static bool squares(const struct passo_grbl *grbl, unsigned axis)
{
	return (grbl->setup->squared >> axis & 1) != 0;
}

static void set_offsets(struct passo_grbl *grbl)
{
	for (unsigned motor = 0; motor < passo_grbl_motors(grbl); motor++) {
		const int64_t offset = grbl->stored.settings.axis[PASSO_GRBL_OFFSET][motor];
		const int32_t size = steps_of(
		    grbl, passo_grbl_axis_of(grbl, motor), (uint64_t)(offset < 0 ? -offset : offset));

		grbl->offset[motor] = offset < 0 ? -size : size;
	}
}

/* Whether motors that square can: see passo_home.h. */
static bool can_stop(struct passo_grbl *grbl, uint8_t count)
{
	const struct passo *passo = grbl->player->feed->passo;

	for (uint8_t i = 0; i < count; i++) {
		if (passo_driver_squares(&grbl->home[i])
		    && passo_driver_check_square(passo, &grbl->home[i]) == PASSO_ERROR_ARGUMENT) {
			passo_grbl_say(grbl, "[MSG:$24 is too fast to stop within half the racking]\r\n");
			return false;
		}
	}
	return true;
}

/* The motor that did not reach its switch within the bound. */
static void tell_skewed(struct passo_grbl *grbl)
{
	uint8_t motor;

	if (!passo_home_is_skewed(grbl->player->feed->passo, &motor))
		return;
	passo_grbl_say(grbl, "[MSG:Motor ");
	passo_grbl_say(grbl, (const char[]){passo_gcode_axis_letter(grbl->player->gcode->settings.left_out,
						passo_grbl_axis_of(grbl, motor)),
				 '\0'});
	for (unsigned other = motor, number = 1; other-- > 0;) {
		number += passo_grbl_axis_of(grbl, other) == passo_grbl_axis_of(grbl, motor);
		if (other == 0 && number > 1)
			passo_grbl_say_number(grbl, number);
	}
	passo_grbl_say(grbl, ": no switch within ");
	passo_grbl_say_thousandths(grbl, (int64_t)(grbl->setup->racking * MILLI));
	passo_grbl_say(grbl, " mm]\r\n");
}
#endif

/* From the back-off to the edge the backlash is taken up before: steps that the path makes in twice the time
 * that this takes at its highest speed. Motors that square have their room already. */
static uint32_t run_up(const struct passo_grbl *grbl, uint8_t axis)
{
#ifndef PASSO_WITHOUT_TRACKERS
	const struct passo_track track = passo_grbl_track(grbl, axis);
	const uint64_t speed = passo_grbl_take_up_speed(&track);

	if (track.backlash > 0 && !squares(grbl, axis)) {
		const uint64_t steps = passo_mul_div_ceil(
		    2u * (uint64_t)track.backlash, speed_of(grbl, axis, PASSO_GRBL_HOME_FEED), speed);

		return steps < PASSO_SUBSTEPS_MAX / 8u ? (uint32_t)steps + 1u : PASSO_SUBSTEPS_MAX / 8u;
	}
#endif
	(void)grbl, (void)axis;
	return 0;
}

static struct passo_home home_of(const struct passo_grbl *grbl, uint8_t axis)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	const bool low = passo_grbl_has_axis(settings, PASSO_GRBL_HOMES_LOW, axis);
	const int32_t off = steps_of(grbl, axis, (uint64_t)settings->value[PASSO_GRBL_PULL_OFF]);
	const uint64_t travel = (uint64_t)settings->axis[PASSO_GRBL_TRAVEL][axis];
	const int32_t distance = steps_of(grbl, axis, travel + travel / 2);

	return (struct passo_home){
	    .axis = axis,
#ifndef PASSO_CARTESIAN
	    .forward = motors_along(grbl, axis, false),
	    .backward = motors_along(grbl, axis, true),
	    .racking =
		squares(grbl, axis) ? (uint32_t)steps_of(grbl, axis, grbl->setup->racking * MILLI) : 0u,
	    .offset = grbl->offset,
#endif
	    .source = grbl->setup->homes >> axis & 1u ? PASSO_TRIGGER_SOURCE_HOME
	            : low                             ? PASSO_TRIGGER_SOURCE_LIMIT_LOW
	                                              : PASSO_TRIGGER_SOURCE_LIMIT_HIGH,
	    .distance = low ? -distance : distance,
	    .back_off = (off > 0 ? (uint32_t)off : 1u) + run_up(grbl, axis),
	    .pull_off = (uint32_t)off,
	    .speed = speed_of(grbl, axis, PASSO_GRBL_HOME_SEEK),
	    .slow_speed = speed_of(grbl, axis, PASSO_GRBL_HOME_FEED),
	    .acceleration = passo_mul_div(
		passo_path_mixed_acceleration(grbl->player->feed->path, grbl->path.axis[axis].acceleration),
		grbl->path.axis[axis].steps_per_mm, UINT64_C(1) << 32),
	    .position = low ? -steps_of(grbl, axis, travel) : 0,
	};
}

enum passo_gcode_error passo_grbl_home(struct passo_grbl *grbl)
{
	static const uint8_t ORDER[PASSO_GCODE_AXES_MAX] = {2, 0, 1, 3, 4, 5};
	struct passo *passo = grbl->player->feed->passo;
	uint8_t count = 0;

	for (unsigned i = 0; i < PASSO_GCODE_AXES_MAX; i++) {
		const uint8_t axis = ORDER[i];

		if (axis < grbl->path.machine.axes && (grbl->setup->homed >> axis & 1u))
			grbl->home[count++] = home_of(grbl, axis);
	}
	if (!passo->has_inputs || count == 0 || !passo_grbl_is_on(&grbl->stored.settings, PASSO_GRBL_HOMING))
		return PASSO_GCODE_NO_HOMING;
	if (!passo_grbl_is_idle(grbl))
		return PASSO_GCODE_NOT_IDLE;
#ifndef PASSO_CARTESIAN
	set_offsets(grbl);
	if (!can_stop(grbl, count))
		return PASSO_GCODE_NO_HOMING;
#endif
	if (passo_grbl_drive(grbl, true) != PASSO_OK || passo_home(passo, grbl->home, count) != PASSO_OK)
		return PASSO_GCODE_NO_HOMING;
	grbl->homes = true;
	return PASSO_GCODE_OK;
}

void passo_grbl_poll_home(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;
	const enum passo_error error = passo_poll(passo);

	if (error != PASSO_OK) {
#ifndef PASSO_CARTESIAN
		tell_skewed(grbl);
#endif
		passo_grbl_fault(grbl, error);
		return;
	}
	if (passo_is_moving(passo) || passo_player_restart(grbl->player) != PASSO_OK)
		return;
	grbl->homes = grbl->locked = grbl->owes = false;
	grbl->starts = 0;
	passo_grbl_answer(grbl, PASSO_GCODE_OK);
}
