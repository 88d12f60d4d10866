/* SPDX-License-Identifier: MIT
 * The machine that the settings describe.
 */
#include "passo_driver.h"
#include "passo_encoder.h"
#include "passo_grbl_private.h"
#include "passo_inputs.h"
#include "passo_math.h"
#include "passo_outputs.h"

#define ONE (UINT64_C(1) << 32)
#define SECONDS_PER_MINUTE 60u
#define MILLION ((uint64_t)PASSO_GCODE_MILLION)
#define MILLI UINT64_C(1000)
#define PWM_HZ 20000u
#define ALWAYS 255 /* of the time until drives are switched off */

/* Settings of X that messages name. */
#define SPEED_NUMBER 110u
#define BACKLASH_NUMBER 160u
#define TAKE_UP_NUMBER 810u

/* UQ32.32 of millionths. */
static uint64_t fixed(int64_t millionths, uint32_t divisor)
{
	return passo_mul_div((uint64_t)millionths, ONE, MILLION * divisor);
}

/* A machine with a jerk for every axis has profile jerk. */
static void set_profile(struct passo_path_settings *path, const struct passo_grbl_settings *settings)
{
#ifdef PASSO_LINEAR_PATHS
	(void)path, (void)settings;
#else
	bool limited = true;

	for (unsigned axis = 0; axis < path->machine.axes; axis++) {
		path->axis[axis].jerk = fixed(settings->axis[PASSO_GRBL_JERK][axis], 1);
		limited = limited && path->axis[axis].jerk > 0;
	}
	if (limited)
		path->profile = PASSO_PROFILE_JERK;
	else if (path->profile == PASSO_PROFILE_JERK)
		path->profile = PASSO_PROFILE_LINEAR;
#endif
}

static struct passo_path_settings path_of(const struct passo_grbl *grbl)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	struct passo_path_settings path = grbl->setup->path;

	for (unsigned axis = 0; axis < path.machine.axes; axis++) {
		path.axis[axis].steps_per_mm = fixed(settings->axis[PASSO_GRBL_STEPS][axis], 1);
		path.axis[axis].speed = fixed(settings->axis[PASSO_GRBL_SPEED][axis], SECONDS_PER_MINUTE);
		path.axis[axis].acceleration = fixed(settings->axis[PASSO_GRBL_ACCELERATION][axis], 1);
	}
	set_profile(&path, settings);
	path.junction_deviation = fixed(settings->value[PASSO_GRBL_DEVIATION], 1);
	return path;
}

static enum passo_gcode_error of_plan(enum passo_plan_error error)
{
	if (error == PASSO_PLAN_OK)
		return PASSO_GCODE_OK;
	return error == PASSO_PLAN_TOO_FAST ? PASSO_GCODE_TOO_FAST : PASSO_GCODE_STATEMENT;
}

enum passo_error passo_grbl_drive(struct passo_grbl *grbl, bool on)
{
	struct passo *passo = grbl->player->feed->passo;
	enum passo_error error = PASSO_OK;

	for (uint8_t motor = 0; error == PASSO_OK && motor < passo_grbl_motors(grbl); motor++)
		error = passo_enable(passo, motor, on);
	grbl->driven = on || error != PASSO_OK;
	grbl->moved_at = passo_driver_now(passo);
	return error;
}

/* Drives that are off stay off until something moves, or is set. */
void passo_grbl_mind_drives(struct passo_grbl *grbl)
{
	const uint32_t now = passo_driver_now(grbl->player->feed->passo);
	const int64_t delay = grbl->stored.settings.value[PASSO_GRBL_IDLE_DELAY] / PASSO_GCODE_MILLION;

	if (!passo_grbl_is_idle(grbl)) {
		grbl->moved_at = now;
		if (!grbl->driven)
			passo_grbl_drive(grbl, true);
	} else if (grbl->driven && delay != ALWAYS && now - grbl->moved_at >= (uint32_t)delay * 1000u) {
		passo_grbl_drive(grbl, false);
	}
}

/* Of the pins, in clocks. */
struct timing {
	uint64_t pulse, turn; /* STEP active and inactive; before and after a change of DIR */
};

/* A setting in microseconds, rounded up. */
static uint64_t clocks_of(const struct passo_grbl *grbl, enum passo_grbl_setting setting)
{
	return passo_mul_div_ceil(
	    (uint64_t)grbl->stored.settings.value[setting], grbl->path.machine.clock_hz, MILLION * MILLION);
}

/* Whether an axis at its speed, and where it reverses at a corner, leaves the pins their times: the core has
 * four places for steps that wait while DIR turns, two of them are for this. */
static bool is_in_time(
    const struct passo_grbl *grbl, const struct passo_path_axis *axis, struct timing timing)
{
	const uint64_t hz = grbl->path.machine.clock_hz, both = timing.pulse + timing.turn;
	const uint64_t steps = passo_mul_div(axis->speed, axis->steps_per_mm, ONE); /* per second */
	const uint64_t swift = passo_mul_div(hz * ONE, ONE, axis->steps_per_mm) / both;
	const uint64_t brake = passo_mul_div(axis->acceleration, both, hz);
	const uint64_t most = swift > brake ? swift - brake : 0;
	const uint64_t corner = passo_mul_div(8u * axis->acceleration, grbl->path.junction_deviation, ONE);

	return passo_mul_div(steps, 2u * timing.pulse, ONE) <= hz
	    && (axis->speed <= most || corner <= passo_mul_div(most, most, ONE));
}

/* Errors: PULSE_TOO_SHORT, below half a clock; STATEMENT, above what the core can count; TOO_FAST. */
static enum passo_gcode_error check_pins(const struct passo_grbl *grbl, struct timing timing)
{
	const uint64_t pulse = (uint64_t)grbl->stored.settings.value[PASSO_GRBL_PULSE];

	if (passo_mul_div(2u * pulse, grbl->path.machine.clock_hz, MILLION * MILLION) == 0)
		return PASSO_GCODE_PULSE_TOO_SHORT;
	if (timing.pulse > PASSO_PIN_CLOCKS_MAX || timing.turn > PASSO_PIN_CLOCKS_MAX)
		return PASSO_GCODE_STATEMENT;
	for (unsigned motor = 0; motor < passo_grbl_motors(grbl); motor++) {
		struct passo_path_axis mixed;

		if (!is_in_time(grbl, passo_path_motor_limits(&grbl->path, motor, &mixed), timing))
			return PASSO_GCODE_TOO_FAST;
	}
	return PASSO_GCODE_OK;
}

static enum passo_error apply_pins(struct passo_grbl *grbl, struct timing timing)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	struct passo *passo = grbl->player->feed->passo;
	struct passo_axis_config config = {.in_clocks = true,
	    .step_high_ns = (uint32_t)timing.pulse,
	    .step_low_ns = (uint32_t)timing.pulse,
	    .dir_setup_ns = (uint32_t)timing.turn,
	    .dir_hold_ns = (uint32_t)timing.turn,
	    .enable_inverted = passo_grbl_is_on(settings, PASSO_GRBL_ENABLES_INVERTED)};
	enum passo_error error = PASSO_OK;

	for (uint8_t motor = 0; error == PASSO_OK && motor < passo_grbl_motors(grbl); motor++) {
		config.step_inverted = passo_grbl_has_axis(settings, PASSO_GRBL_STEPS_INVERTED, motor);
		config.direction_inverted = passo_grbl_has_axis(settings, PASSO_GRBL_DIRS_INVERTED, motor);
		error = passo_configure_axis(passo, motor, &config);
	}
	return error == PASSO_OK ? passo_grbl_drive(grbl, true) : error;
}

/* A limit that is also a home is there whether or not limits stop. */
static enum passo_error apply_inputs(struct passo_grbl *grbl)
{
	const struct passo_grbl_setup *setup = grbl->setup;
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	struct passo *passo = grbl->player->feed->passo;
	const bool inverted = passo_grbl_is_on(settings, PASSO_GRBL_LIMITS_INVERTED);
	const bool hard = passo_grbl_is_on(settings, PASSO_GRBL_HARD_LIMITS);
	const uint64_t filter = passo_mul_div(
	    (uint64_t)settings->value[PASSO_GRBL_DEBOUNCE], grbl->path.machine.clock_hz, MILLION * 1000u);
	enum passo_error error = passo_configure_filter(passo, filter);

	for (uint8_t motor = 0; error == PASSO_OK && motor < passo_grbl_motors(grbl); motor++) {
		const unsigned axis = passo_grbl_axis_of(grbl, motor);
		const bool by_limit = (setup->homed >> axis & 1u) > (setup->homes >> axis & 1u);
		const bool used = hard || (by_limit && passo_grbl_is_on(settings, PASSO_GRBL_HOMING));
		const bool low = setup->limits_low >> motor & 1u, high = setup->limits_high >> motor & 1u;

		/* Inputs without a switch are grounded. */
		error = passo_configure_inputs(passo, motor,
		    &(struct passo_input_config){.limit_low = used && low,
			.limit_high = used && high,
			.home = setup->homes >> motor & 1u,
			.limit_low_inverted = inverted && low,
			.limit_high_inverted = inverted && high,
			.home_inverted = inverted,
			.limit_soft = true});
	}
	if (error == PASSO_OK && setup->probe)
		error = passo_configure_probe(passo, passo_grbl_is_on(settings, PASSO_GRBL_PROBE_INVERTED));
	return error;
}

#ifndef PASSO_CARTESIAN
enum passo_error passo_grbl_apply_encoders(struct passo_grbl *grbl)
{
	enum passo_error error = PASSO_OK;

	for (uint8_t motor = 0; error == PASSO_OK && motor < passo_grbl_motors(grbl); motor++) {
		if (!passo_grbl_has_encoder(grbl, motor))
			continue;
		const uint64_t *encoder = &grbl->setup->encoders[2u * motor];
		const uint64_t ratio = passo_mul_div(encoder[0], UINT64_C(1) << 16,
		    grbl->path.axis[passo_grbl_axis_of(grbl, motor)].steps_per_mm);

		error = passo_configure_encoder(grbl->player->feed->passo, motor,
		    &(struct passo_encoder_config){.ratio = ratio <= UINT32_MAX ? (uint32_t)ratio : 0u,
			.limit = (uint16_t)encoder[1],
			.stop = PASSO_FOLLOWING_SOFT});
	}
	return error;
}
#endif

/* Full power in proportion is at the highest speed of all axes. */
static enum passo_error apply_outputs(struct passo_grbl *grbl)
{
	uint64_t fastest = 0;

	for (unsigned axis = 0; axis < grbl->path.machine.axes; axis++) {
		const uint64_t speed = grbl->path.axis[axis].speed;

		fastest = speed > fastest ? speed : fastest;
	}
	return passo_configure_outputs(grbl->player->feed->passo,
	    &(struct passo_outputs_config){
		.pwm_hz = PWM_HZ, .reference = passo_path_velocity(grbl->player->feed->path, fastest)});
}

/* Machine coordinates are those after $H: 0 is at the high end. */
static void apply_travel(struct passo_grbl *grbl)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;

	grbl->limits = (struct passo_player_machine){
	    .axis = grbl->path.axis, .limited = passo_grbl_is_on(settings, PASSO_GRBL_SOFT_LIMITS)};
#ifndef PASSO_WITHOUT_THREADS
	grbl->limits.deviation = grbl->path.junction_deviation;
	grbl->limits.spindle = (uint8_t)passo_grbl_motors(grbl);
#endif
	for (unsigned axis = 0; axis < grbl->path.machine.axes; axis++)
		grbl->limits.low[axis] = -settings->axis[PASSO_GRBL_TRAVEL][axis];
#ifndef PASSO_PLAIN_GCODE
	grbl->limits.spin_up = (uint32_t)settings->value[PASSO_GRBL_SPIN_UP];
	grbl->limits.at_speed = grbl->setup->at_speed;
#endif
	grbl->player->machine = &grbl->limits;
}

#ifdef PASSO_CARTESIAN
static bool can_square(struct passo_grbl *grbl)
{
	(void)grbl;
	return true;
}
#else
/* Motors that square leave their switches within the bound, whatever their offsets; and those of an axis that
 * is square are at their switches within it. */
static bool can_square(struct passo_grbl *grbl)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	const int64_t *offset = settings->axis[PASSO_GRBL_OFFSET];
	const int64_t pull_off = settings->value[PASSO_GRBL_PULL_OFF];
	const int64_t racking = grbl->setup->racking * INT64_C(1000);
	bool can = grbl->setup->squared == 0 || pull_off <= racking;

	for (unsigned motor = 0; motor < passo_grbl_motors(grbl); motor++) {
		const unsigned axis = passo_grbl_axis_of(grbl, motor);
		const int64_t most = (grbl->setup->squared >> axis & 1) != 0 ? pull_off : 0;

		can = can && offset[motor] <= most && -offset[motor] <= most;
		for (unsigned other = 0; other < motor; other++) {
			const int64_t apart = offset[motor] - offset[other];

			can = can
			   && (passo_grbl_axis_of(grbl, other) != axis
			       || (apart <= racking && -apart <= racking));
		}
	}
	if (!can)
		passo_grbl_say(grbl,
		    "[MSG:Where motors square $27 is at most the racking, $170 and up at most $27, and no "
		    "further apart than the racking]\r\n");
	return can;
}
#endif

#ifdef PASSO_WITHOUT_TRACKERS
static enum passo_gcode_error check_backlash(const struct passo_grbl *grbl, struct timing timing)
{
	(void)grbl, (void)timing;
	return PASSO_GCODE_OK;
}

static enum passo_error apply_backlash(const struct passo_grbl *grbl)
{
	(void)grbl;
	return PASSO_OK;
}
#else
/* Of its backlash, to nearest. */
static uint64_t backlash_steps(const struct passo_grbl *grbl, uint8_t axis)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	const uint64_t twice = passo_mul_div(2u * (uint64_t)settings->axis[PASSO_GRBL_BACKLASH][axis],
	    (uint64_t)settings->axis[PASSO_GRBL_STEPS][axis], MILLION * MILLION);

	return (twice + 1u) / 2u;
}

struct passo_track passo_grbl_track(const struct passo_grbl *grbl, uint8_t axis)
{
	const struct passo_path_axis *limits = &grbl->path.axis[axis];
	const int64_t own = grbl->stored.settings.axis[PASSO_GRBL_TAKE_UP][axis];

	return (struct passo_track){.axis = axis,
	    .backlash = (uint16_t)backlash_steps(grbl, axis),
	    .top_speed = passo_mul_div(limits->speed, limits->steps_per_mm, ONE),
	    .acceleration =
		passo_mul_div(own > 0 ? fixed(own, 1) : limits->acceleration, limits->steps_per_mm, ONE)};
}

uint64_t passo_grbl_take_up_speed(const struct passo_track *track)
{
	const uint64_t most =
	    passo_isqrt128(passo_multiply(track->acceleration, (uint64_t)track->backlash << 32));

	return most < track->top_speed ? most : track->top_speed;
}

/* A bound of a setting, per second or `per` of them: `most`, or `least`, in steps, UQ32.32. */
static enum passo_gcode_error refuse(
    struct passo_grbl *grbl, unsigned number, uint8_t axis, uint64_t most, uint64_t least, uint32_t per)
{
	const uint64_t scale = grbl->path.axis[axis].steps_per_mm;
	const uint64_t bound = least > 0 ? passo_mul_div_ceil(least, per * MILLI, scale)
	                                 : passo_mul_div(most, per * MILLI, scale);

	passo_grbl_say(grbl, "[MSG:With backlash $");
	passo_grbl_say_number(grbl, number + axis);
	passo_grbl_say(grbl, least > 0 ? " is at least " : " is at most ");
	passo_grbl_say_thousandths(grbl, (int64_t)(bound * MILLI));
	passo_grbl_say(grbl, "]\r\n");
	return PASSO_GCODE_TOO_FAST;
}

static enum passo_gcode_error refuse_backlash(struct passo_grbl *grbl, uint8_t axis, const char *why)
{
	passo_grbl_say(grbl, "[MSG:$");
	passo_grbl_say_number(grbl, BACKLASH_NUMBER + axis);
	passo_grbl_say(grbl, why);
	return PASSO_GCODE_STATEMENT;
}

static bool shares_motors(const struct passo_grbl *grbl, uint8_t axis)
{
#ifdef PASSO_CARTESIAN
	(void)grbl, (void)axis;
#else
	const struct passo_motors *motors = &grbl->path.motors;

	for (unsigned motor = 0; motor < motors->count; motor++) {
		const unsigned axes = (unsigned)motors->plus[motor] | motors->minus[motor];

		if ((axes >> axis & 1u) != 0u && (axes & (axes - 1u)) != 0u)
			return true;
	}
#endif
	return false;
}

/* What the pins can do with both hands at their speeds, and a tracker: while DIR turns it makes a step at
 * most, so that places are left for those of the path. */
static enum passo_gcode_error check_track(
    struct passo_grbl *grbl, const struct passo_track *track, struct timing timing)
{
	const uint64_t hz = grbl->path.machine.clock_hz, both = timing.pulse + timing.turn;
	const uint64_t ticks = /* per second */
	    passo_mul_div(hz, ONE, PASSO_TRACKER_TICK(passo_axes(grbl->player->feed->passo)));
	const uint64_t pins = passo_mul_div(hz, ONE, 2u * timing.pulse);
	const uint64_t take_up = passo_grbl_take_up_speed(track);
	const uint64_t swift = 2u * take_up < pins ? pins - take_up : pins / 2u;
	const uint64_t top = swift < ticks ? swift : ticks - 1u;
	const uint64_t turn = passo_mul_div(passo_mul_div(hz, ONE, both), hz, 2u * both);
	const uint64_t quick = passo_mul_div(track->top_speed, ticks, ONE);
	const uint64_t least = passo_mul_div(ticks, ticks, ONE) / ONE + ticks / ONE + 2u;

	if (track->top_speed > top)
		return refuse(grbl, SPEED_NUMBER, track->axis, top, 0, SECONDS_PER_MINUTE);
	if (track->acceleration > (turn < quick ? turn : quick))
		return refuse(grbl, TAKE_UP_NUMBER, track->axis, turn < quick ? turn : quick, 0, 1);
	if (track->acceleration < least)
		return refuse(grbl, TAKE_UP_NUMBER, track->axis, 0, least, 1);
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_axis(struct passo_grbl *grbl, uint8_t axis, struct timing timing)
{
	const struct passo_track track = passo_grbl_track(grbl, axis);
	const uint64_t steps = backlash_steps(grbl, axis);

	if (grbl->stored.settings.axis[PASSO_GRBL_BACKLASH][axis] == 0)
		return PASSO_GCODE_OK;
	if (!grbl->player->feed->passo->has_trackers)
		return refuse_backlash(grbl, axis, ": the core has no trackers]\r\n");
	if (shares_motors(grbl, axis))
		return refuse_backlash(grbl, axis, ": the axis shares its motors]\r\n");
	if (steps < 1u || steps > UINT16_MAX)
		return refuse_backlash(grbl, axis, " is 1 to 65535 steps]\r\n");
	return check_track(grbl, &track, timing);
}

static enum passo_gcode_error check_backlash(struct passo_grbl *grbl, struct timing timing)
{
	enum passo_gcode_error error = PASSO_GCODE_OK;

	for (uint8_t axis = 0; error == PASSO_GCODE_OK && axis < grbl->path.machine.axes; axis++)
		error = check_axis(grbl, axis, timing);
	return error;
}

/* Those that have taken up backlash go to their place without, within the limits that they have. */
static enum passo_error apply_backlash(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;
	enum passo_error error = PASSO_OK;

	for (unsigned i = 0; error == PASSO_OK && i < 2u * passo_grbl_motors(grbl); i++) {
		const bool aims = i >= passo_grbl_motors(grbl); /* when all have their limits */
		const uint8_t motor = (uint8_t)(i % passo_grbl_motors(grbl));
		struct passo_track track = passo_grbl_track(grbl, (uint8_t)passo_grbl_axis_of(grbl, motor));

		track.axis = motor;
		if (track.backlash > 0 && !aims)
			error = passo_configure_tracker(passo, &track);
		else if (aims && (track.backlash > 0 || ((uint32_t)passo->tracked >> motor & 1u) != 0u))
			error = passo_track_to(passo, &track, 0);
	}
	if (error == PASSO_OK)
		error = passo_track_again(passo);
	grbl->stopping = grbl->stopping || passo_is_moving(passo);
	return error;
}
#endif

enum passo_gcode_error passo_grbl_apply(struct passo_grbl *grbl)
{
	const struct passo_grbl_settings *settings = &grbl->stored.settings;
	struct passo_path_planner *path = grbl->player->feed->path;
	struct passo *passo = grbl->player->feed->passo;

	grbl->path = path_of(grbl);
	const struct timing timing = {clocks_of(grbl, PASSO_GRBL_PULSE), clocks_of(grbl, PASSO_GRBL_TURN)};
	const enum passo_gcode_error planned =
	    of_plan(passo_path_open(path, &grbl->path, path->items, path->capacity));
	if (planned != PASSO_GCODE_OK)
		return planned;
	if (!can_square(grbl))
		return PASSO_GCODE_STATEMENT;
	const enum passo_gcode_error pins = check_pins(grbl, timing);
	if (pins != PASSO_GCODE_OK)
		return pins;
	const enum passo_gcode_error backlash = check_backlash(grbl, timing);
	if (backlash != PASSO_GCODE_OK)
		return backlash;
	apply_travel(grbl);
	passo_gcode_configure(grbl->player->gcode,
	    &(struct passo_gcode_settings){
		.arc_tolerance = (uint32_t)settings->value[PASSO_GRBL_ARC_TOLERANCE],
		.spindle_minimum =
		    (uint32_t)(settings->value[PASSO_GRBL_SPINDLE_LEAST] / PASSO_GCODE_MILLION),
		.spindle_maximum = (uint32_t)(settings->value[PASSO_GRBL_SPINDLE] / PASSO_GCODE_MILLION),
		.laser = passo_grbl_is_on(settings, PASSO_GRBL_LASER),
#ifndef PASSO_PLAIN_GCODE
		.inputs = passo->has_inputs ? (uint8_t)(1u + passo_grbl_motors(grbl)) : 0,
		.power = passo->has_outputs,
#endif
#ifndef PASSO_WITHOUT_THREADS
		.turn_counts = grbl->setup->turn_counts,
#endif
	    });
	enum passo_error error = apply_pins(grbl, timing);
	if (error == PASSO_OK && passo->has_inputs)
		error = apply_inputs(grbl);
	if (error == PASSO_OK && passo->has_outputs)
		error = apply_outputs(grbl);
#ifndef PASSO_CARTESIAN
	if (error == PASSO_OK)
		error = passo_grbl_apply_encoders(grbl);
	if (error == PASSO_ERROR_RATIO)
		return PASSO_GCODE_STATEMENT;
#endif
	if (error == PASSO_OK)
		error = apply_backlash(grbl);
	if (error == PASSO_OK)
		error = passo_player_restart(grbl->player);
	passo_grbl_override(grbl);
	if (error == PASSO_ERROR_FILTER_TOO_LONG)
		return PASSO_GCODE_STATEMENT;
	return error == PASSO_OK ? PASSO_GCODE_OK : PASSO_GCODE_NOT_IDLE;
}
