/* SPDX-License-Identifier: MIT
 * HAL component of LinuxCNC: a Passo core behind the servo thread. The motion is in passo_servo.h; here are
 * the pins and the sentences.
 *
 *     loadrt passo device=/dev/spidev0.0 axes=3
 *     addf passo.0.read servo-thread
 *     ... motion-command-handler, motion-controller
 *     addf passo.0.write servo-thread
 * docs/hosts.md has the table of pins.
 */
#include <math.h>
#include <stdatomic.h>
#include <stdint.h>

#include "passo.h"
#include "passo_encoder.h"
#include "passo_hal.h"
#include "passo_inputs.h"
#include "passo_linux.h"
#include "passo_linux_private.h"
#include "passo_outputs.h"
#include "passo_servo.h"
#include "passo_words.h"
#include "rtapi.h"
#include "rtapi_app.h"

MODULE_LICENSE("Dual MIT/GPL");
MODULE_DESCRIPTION("Passo motion coprocessor");

static char *device = "/dev/spidev0.0";
RTAPI_MP_STRING(device, "/dev/spidevB.C, or unix:PATH of passo serve");
static int axes = 3;
RTAPI_MP_INT(axes, "stepgens, the first axes of the core");
static int speed_hz = 0;
RTAPI_MP_INT(speed_hz, "of SCLK; 0: 4 MHz");
static int clock_hz = 0;
RTAPI_MP_INT(clock_hz, "of a core that does not tell its clock");
static int buffer = 0;
RTAPI_MP_INT(buffer, "periods by which the thread may be late without effect; 0: 2");
static char *encoders = "";
RTAPI_MP_STRING(encoders, "those of the core that have pins: encoders=0,3");
static int watchdog_ms = 500;
RTAPI_MP_INT(watchdog_ms, "after which a core with inputs stops without a host; 0: never");

#define PASSO_NAME "passo"
#define PREFIX PASSO_NAME ".0."
#define ONE 4294967296.0 /* 2^32 */
#define NS 1e-9
#define US 1e-6
#define MS 1000u  /* microseconds; also nanoseconds of a microsecond */
#define GROUPS 4u /* inputs of an axis: limits low and high, home, alarm */
#define INPUTS_MAX (GROUPS * PASSO_AXES_MAX + 1u)
#define OUTPUTS 8u
#define INPUT_WORDS 5u /* from INPUT_LEVELS to TRIGGER_STATE */
#define BYTE 8u
#define WORD_BITS 32u
#define EXIT_WAITS 2000u
#define PULSE_NS 5000 /* as hostmot2 has them */
#define SHARE 5u      /* of a period that the wire may be busy: a fifth */
#define TURNS_MAX 4u
#define LOOK_WORDS 0.2 /* a read of the state, in a period */
#define PAST 16u       /* reads of the encoders from which their speed is computed */
#define COMMA ','

struct stepgen {
	hal_float command, feedback, velocity;
	hal_s32 counts;
	hal_bit enable, index_enable;
	hal_float scale, maxvel, maxaccel, stopaccel;
	hal_u32 steplen, stepspace, dirsetup, dirhold;
	hal_bit step_invert, dir_invert, enable_invert, home_invert, limit_invert, alarm_invert;
	int32_t before; /* counts */
	double origin;  /* steps of the core where the position is 0 */
};

struct encoder {
	bool used;
	hal_s32 count, raw;
	hal_float position, velocity;
	hal_bit index_enable, reset;
	hal_float scale;
	hal_bit index_invert, index_mask;
	int32_t zero, before[PAST]; /* raw counts of the reads before */
	bool waits;                 /* for an index after the number `indexes` */
	uint8_t indexes;
};

struct pins {
	struct stepgen stepgen[PASSO_AXES_MAX];
	struct encoder encoder[PASSO_AXES_MAX];
	hal_bit input[INPUTS_MAX], input_not[INPUTS_MAX];
	hal_bit output[OUTPUTS];
	hal_float power;
	hal_bit has_bit, fault;
	hal_s32 state, cause, depth;
	hal_u32 lag, slowed, frames, retries, words;
	hal_float trim;
};

/* Off; on; after a fault, until all stepgens are disabled. */
enum phase { OFF, ON, FAULTY };

static int component;
static struct pins *pins;
static struct passo passo;
static struct passo_host host;
static struct passo_linux linux_host;
static struct passo_servo servo;
static enum phase phase;
static bool drives_due; /* the drives are to be switched off, when at rest */
static long period_ns;
static unsigned inputs; /* of the core; 0: none */
static uint8_t first_encoder, last_encoder;
static bool has_encoders;
static unsigned turns = 1; /* calls in which positions and inputs are read once: the wire is slow */
static unsigned turn;      /* that of this call; the positions have the first one */
static uint32_t read_at[PAST], reads; /* microseconds, of the encoders; their number */
static bool outputs;
/* A call may take longer than HAL waits before it unloads the component. */
static atomic_bool leaving;
static atomic_uint under_way;

/* ---------------------------------------------------------------------------------------- sentences ---- */

#define TELL(...) rtapi_print_msg(RTAPI_MSG_ERR, PASSO_NAME ": " __VA_ARGS__)

static void set_fault(void)
{
	phase = FAULTY;
	SET(pins->fault, 1);
}

static void tell_error(const char *doing, enum passo_error error)
{
	const struct passo_snapshot *snapshot = passo_snapshot(&passo);

	TELL("%s: %s: %s Disable and enable the machine to go on.\n", doing, passo_error_name(error),
	    passo_error_text(error));
	if (snapshot->cause == PASSO_CAUSE_WATCHDOG)
		SET(pins->has_bit, 1);
	set_fault();
}

static void tell_problem(void)
{
	const unsigned axis = servo.axis;

	switch (servo.problem) {
	case PASSO_SERVO_PERIOD:
		TELL("the servo period is %ld ns: set SERVO_PERIOD to %u to %u\n", period_ns,
		    PASSO_SERVO_PERIOD_MIN, PASSO_SERVO_PERIOD_MAX);
		break;
	case PASSO_SERVO_AXES:
		TELL("the core has %u axes: load it with axes=1 to %u\n", passo_machine(&passo)->axes,
		    passo_machine(&passo)->axes);
		break;
	case PASSO_SERVO_SPEED:
		TELL("stepgen.%02u.maxvel is too low: set it to the MAX_VELOCITY of the joint\n", axis);
		break;
	case PASSO_SERVO_ACCELERATION:
		TELL("stepgen.%02u.maxaccel is too low: set it to the MAX_ACCELERATION of the joint, or "
		     "more\n",
		    axis);
		break;
	case PASSO_SERVO_STOP:
		TELL("stepgen.%02u.stopaccel is too low: set it to what the axis bears\n", axis);
		break;
	case PASSO_SERVO_PINS:
		TELL("stepgen.%02u.maxvel needs more steps than steplen and stepspace allow: lower one of "
		     "them\n",
		    axis);
		break;
	default:
		TELL("to stop from maxvel within stopaccel takes %u periods, the core has %u lines: raise "
		     "stopaccel\n",
		    servo.stop, servo.places);
	}
	set_fault();
}

/* --------------------------------------------------------------------------------------------- on ---- */

static bool is_enabled(void)
{
	bool found = false;

	for (int axis = 0; axis < axes; axis++)
		found = found || GET(pins->stepgen[axis].enable);
	return found;
}

/* false: said what is wrong. */
static bool check_axis(int axis)
{
	const struct stepgen *own = &pins->stepgen[axis];
	const double scale = GET(own->scale), maxvel = GET(own->maxvel), maxaccel = GET(own->maxaccel);
	const double stopaccel = GET(own->stopaccel);

	if (!isfinite(scale) || scale <= 0) {
		TELL("stepgen.%02d.position-scale is %g: set it to the steps per unit, above 0; dir-invert "
		     "turns the "
		     "axis around\n",
		    axis, scale);
	} else if (!isfinite(maxvel) || maxvel <= 0 || maxvel * scale > INT32_MAX) {
		TELL("stepgen.%02d.maxvel is %g: set it to the MAX_VELOCITY of the joint\n", axis, maxvel);
	} else if (!isfinite(maxaccel) || maxaccel <= 0 || maxaccel * scale > INT32_MAX) {
		TELL("stepgen.%02d.maxaccel is %g: set it to the MAX_ACCELERATION of the joint, or more\n",
		    axis, maxaccel);
	} else if (!isfinite(stopaccel) || stopaccel < 0 || stopaccel * scale > INT32_MAX) {
		TELL("stepgen.%02d.stopaccel is %g: set it to what the axis bears; 0: as maxaccel\n", axis,
		    stopaccel);
	} else {
		return true;
	}
	set_fault();
	return false;
}

static enum passo_error configure_axis(int axis, struct passo_servo_options *options)
{
	const struct stepgen *own = &pins->stepgen[axis];
	const struct passo_axis_config config = {
	    .step_high_ns = GET(own->steplen),
	    .step_low_ns = GET(own->stepspace),
	    .dir_setup_ns = GET(own->dirsetup),
	    .dir_hold_ns = GET(own->dirhold),
	    .step_inverted = GET(own->step_invert),
	    .direction_inverted = GET(own->dir_invert),
	    .enable_inverted = GET(own->enable_invert),
	};
	const struct passo_input_config switches = {
	    .limit_low_inverted = GET(own->limit_invert),
	    .limit_high_inverted = GET(own->limit_invert),
	    .home_inverted = GET(own->home_invert),
	    .alarm_inverted = GET(own->alarm_invert),
	};
	enum passo_error error = passo_configure_axis(&passo, (uint8_t)axis, &config);

	if (error == PASSO_OK && inputs > 0)
		error = passo_configure_inputs(&passo, (uint8_t)axis, &switches);
	options->axis[axis].speed = (uint64_t)(GET(own->maxvel) * GET(own->scale) * ONE);
	options->axis[axis].acceleration = (uint64_t)(GET(own->maxaccel) * GET(own->scale) * ONE);
	options->axis[axis].stop =
	    (uint64_t)((GET(own->stopaccel) > 0 ? GET(own->stopaccel) : GET(own->maxaccel)) * GET(own->scale)
	               * ONE);
	return error;
}

static enum passo_error configure_encoder(uint8_t axis)
{
	const struct passo_encoder_config config = {
	    .index_inverted = GET(pins->encoder[axis].index_invert),
	    .index_gated = GET(pins->encoder[axis].index_mask),
	    .ratio = UINT32_C(1) << 16, /* its following error is not looked at */
	    .limit = UINT16_MAX,
	    .stop = PASSO_FOLLOWING_SHOW,
	};

	return passo_configure_encoder(&passo, axis, &config);
}

static enum passo_error configure(void)
{
	struct passo_servo_options options = {
	    .period_ns = (uint32_t)period_ns, .buffer = (uint32_t)buffer, .axes = (uint8_t)axes};
	struct passo_snapshot snapshot;
	enum passo_error error = passo_read_state(&passo, &snapshot);

	if (error == PASSO_OK && snapshot.state != PASSO_STATE_IDLE)
		error = passo_clear(&passo);
	if (error == PASSO_OK && inputs > 0)
		error = passo_clear_estop(&passo);
	for (int axis = 0; axis < axes && error == PASSO_OK; axis++)
		error = configure_axis(axis, &options);
	for (uint8_t axis = 0; axis < PASSO_AXES_MAX && error == PASSO_OK; axis++) {
		if (pins->encoder[axis].used)
			error = configure_encoder(axis);
	}
	return error == PASSO_OK ? passo_servo_check(&servo, &passo, &options) : error;
}

/* Calls in which positions and inputs are read once, so that the frames take no more than their share of the
 * wire; see passo_frame.h. */
static unsigned turns_of(long period)
{
	const unsigned all = passo_axes(&passo);
	const unsigned spaced = servo.options.buffer > 0 ? servo.options.buffer : PASSO_SERVO_BUFFER;
	const double most = (double)period * NS * linux_host.speed_hz / (WORD_BITS * SHARE);
	const double read =
	    all + PASSO_FRAME_OVERHEAD + (inputs > 0 ? INPUT_WORDS + PASSO_FRAME_OVERHEAD : 0);
	double words = PASSO_LINE_WORDS(passo_machine(&passo)->axes) + outputs + PASSO_FRAME_OVERHEAD;

	words += (double)(PASSO_RAMP_WORDS + PASSO_FRAME_OVERHEAD) / spaced + LOOK_WORDS;
	if (has_encoders)
		words += last_encoder - first_encoder + 1u + PASSO_FRAME_OVERHEAD;
	for (unsigned found = 1; found < TURNS_MAX; found++) {
		if (words + read / found <= most)
			return found;
	}
	return TURNS_MAX;
}

static void switch_on(void)
{
	for (int axis = 0; axis < axes; axis++) {
		if (!check_axis(axis))
			return;
	}
	enum passo_error error = configure();
	if (error == PASSO_ERROR_ARGUMENT && servo.problem != PASSO_SERVO_OK) {
		tell_problem();
		return;
	}
	if (error == PASSO_OK)
		error = passo_servo_start(&servo);
	for (int axis = 0; axis < axes && error == PASSO_OK; axis++) {
		if (GET(pins->stepgen[axis].enable))
			error = passo_enable(&passo, (uint8_t)axis, true);
	}
	SET(pins->lag, servo.lag);
	turns = turns_of(period_ns);
	if (error == PASSO_OK)
		phase = ON;
	else if (error != PASSO_ERROR_MOVING) /* until it is at rest */
		tell_error("enable", error);
}

/* -------------------------------------------------------------------------------------------- off ---- */

static void switch_off(void)
{
	if (passo_servo_is_on(&servo))
		passo_servo_stop(&servo);
	phase = OFF;
	SET(pins->fault, 0);
	drives_due = true;
}

/* The drives and outputs, once the axes are at rest. */
static void go_off(void)
{
	enum passo_error error = PASSO_OK;

	passo_poll(&passo);
	if (!drives_due)
		return;
	if (passo_snapshot(&passo)->state == PASSO_STATE_STOPPED)
		error = passo_clear(&passo);
	for (int axis = 0; axis < axes && error == PASSO_OK; axis++)
		error = passo_enable(&passo, (uint8_t)axis, false);
	if (error == PASSO_OK && outputs)
		error = passo_set_levels(&passo, 0);
	drives_due = error == PASSO_ERROR_MOVING;
}

/* ---------------------------------------------------------------------------------------- periods ---- */

static uint32_t output_word(void)
{
	struct passo_output output = {0};
	uint32_t word = 0;

	if (!outputs)
		return 0;
	for (unsigned i = 0; i < OUTPUTS; i++)
		output.levels |= (uint8_t)((unsigned)(GET(pins->output[i]) != 0) << i);
	if (GET(pins->power) > 0)
		output.power =
		    GET(pins->power) < 1 ? (uint32_t)(GET(pins->power) * PASSO_POWER_FULL) : PASSO_POWER_FULL;
	return passo_output_word(&passo, &output, &word) == PASSO_OK ? word : 0;
}

static void command(void)
{
	int64_t places[PASSO_AXES_MAX];

	for (int axis = 0; axis < axes; axis++) {
		const struct stepgen *own = &pins->stepgen[axis];
		const double steps = GET(own->command) * GET(own->scale) + own->origin;

		places[axis] = servo.place[axis];
		if (!GET(own->enable))
			continue;
		if (!(fabs(steps) < INT32_MAX)) {
			TELL("stepgen.%02d.position-cmd is %g: beyond 2^31 steps\n", axis, GET(own->command));
			passo_servo_stop(&servo);
			set_fault();
			return;
		}
		places[axis] = (int64_t)(steps * ONE);
	}
	servo.output = output_word();
	const enum passo_error error = passo_servo_write(&servo, places);
	if (error != PASSO_OK)
		tell_error("motion", error);
}

/* In simulated time a period passes between two calls, frames included. */
static void pass_period(long period)
{
	static uint32_t due;
	const uint32_t left =
	    (due += (uint32_t)(period / (long)MS)) - host.hardware.microseconds(&linux_host);

	if (left > (uint32_t)period)
		due -= left; /* it is late, or begins */
	else
		host.hardware.wait(&linux_host, left);
}

static void write_pins(long period)
{
	if (period_ns != 0 && period != period_ns && phase == ON) {
		TELL("the servo period changes from %ld to %ld ns: let all functions of passo run in one "
		     "thread\n",
		    period_ns, period);
		passo_servo_stop(&servo);
		set_fault();
	}
	period_ns = period;
	if (phase != OFF && !is_enabled())
		switch_off();
	else if (phase == OFF && is_enabled() && !drives_due && !GET(pins->has_bit))
		switch_on();
	if (phase == ON)
		command();
	else
		go_off();
	SET(pins->depth, (int32_t)servo.depth);
	SET(pins->slowed, servo.slowed);
	SET(pins->trim, servo.trim * 1e-3);
	if (linux_host.served && !linux_host.real_time)
		pass_period(period);
}

static void read_inputs(void)
{
	uint32_t words[INPUT_WORDS];

	if (passo_host_read(
		&host, PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_INPUT_LEVELS, words, INPUT_WORDS)
	    != PASSO_OK)
		return;
	for (unsigned i = 0; i < inputs; i++) {
		const bool level =
		    i + 1u == inputs
			? (words[INPUT_WORDS - 1u] >> PASSO_CHANNEL_TRIGGER_STATE_PROBE_LSB & 1u) != 0u
			: (words[0] >> (i % GROUPS * BYTE + i / GROUPS) & 1u) != 0u;
		SET(pins->input[i], level);
		SET(pins->input_not[i], !level);
	}
}

static void read_stepgens(long period)
{
	int32_t counts[PASSO_AXES_MAX];

	if (passo_positions(&passo, counts) != PASSO_OK)
		return;
	for (int axis = 0; axis < axes; axis++) {
		struct stepgen *own = &pins->stepgen[axis];
		const double scale = GET(own->scale) > 0 ? GET(own->scale) : 1;
		const double time = (double)period * NS * turns;

		SET(own->counts, counts[axis]);
		SET(own->feedback, (counts[axis] - own->origin) / scale);
		SET(own->velocity, (counts[axis] - own->before) / (scale * time));
		own->before = counts[axis];
	}
}

/* Periods after the counts were read, in whole steps like them. */
static void extrapolate(long period)
{
	for (int axis = 0; axis < axes; axis++) {
		const struct stepgen *own = &pins->stepgen[axis];
		const double scale = GET(own->scale) > 0 ? GET(own->scale) : 1,
			     time = turn * (double)period * NS;

		SET(own->feedback,
		    (rint(own->before + GET(own->velocity) * scale * time) - own->origin) / scale);
	}
}

/* Where an axis was at the index: its counts and those of the encoder belong to the same clock. */
static bool set_origin(uint8_t axis, uint16_t latch)
{
	struct stepgen *own = &pins->stepgen[axis];
	const struct encoder *encoder = &pins->encoder[axis];
	uint32_t words[PASSO_CHANNEL_ENCODER_POSITION_BASE - PASSO_CHANNEL_POSITION_BASE + PASSO_AXES_MAX];
	const unsigned at = PASSO_CHANNEL_ENCODER_POSITION_BASE - PASSO_CHANNEL_POSITION_BASE + axis;

	if (passo_host_read(&host, PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_POSITION_BASE, words, at + 1u)
	    != PASSO_OK)
		return false;
	const double since = (int16_t)((uint16_t)words[at] - latch);
	own->origin = rint(
	    (int32_t)(words[axis] + passo.axis[axis].offset) - since / GET(encoder->scale) * GET(own->scale));
	return true;
}

static void look_for_index(uint8_t axis)
{
	struct encoder *own = &pins->encoder[axis];
	const hal_bit of_axis = axis < axes ? pins->stepgen[axis].index_enable : NULL;
	const uint16_t address =
	    PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_ENCODER_BASE + PASSO_ENCODER_INDEX;
	uint32_t word;

	if (!GET(own->index_enable) && !(of_axis && GET(of_axis))) {
		own->waits = false;
		return;
	}
	if (passo_host_read(&host, (uint16_t)(address + axis * PASSO_CHANNEL_ENCODER_STRIDE), &word, 1)
	    != PASSO_OK)
		return;
	const struct passo_encoder_index index = passo_unpack_encoder_index(word);
	if (!own->waits || index.indexes == own->indexes) {
		own->waits = true;
		own->indexes = index.indexes;
		return;
	}
	if (of_axis && GET(of_axis)) {
		if (!set_origin(axis, index.latch))
			return;
		SET(of_axis, 0);
	}
	if (GET(own->index_enable)) {
		own->zero = GET(own->raw) - (int16_t)((uint16_t)GET(own->raw) - index.latch);
		SET(own->index_enable, 0);
	}
	own->waits = false;
}

static void read_encoders(void)
{
	const unsigned address =
	    PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_ENCODER_POSITION_BASE + first_encoder;
	uint32_t words[PASSO_AXES_MAX];

	if (passo_host_read(&host, (uint16_t)address, words, last_encoder - first_encoder + 1u) != PASSO_OK)
		return;
	const uint32_t at = host.hardware.microseconds(&linux_host), now = reads++ % PAST;
	const uint32_t time = reads > PAST ? at - read_at[now] : 0u;

	read_at[now] = at;
	for (uint8_t axis = first_encoder; axis <= last_encoder; axis++) {
		struct encoder *own = &pins->encoder[axis];
		if (!own->used)
			continue;
		const double scale = isfinite(GET(own->scale)) && GET(own->scale) != 0 ? GET(own->scale) : 1;

		SET(own->scale, scale);
		SET(own->raw, (int32_t)words[axis - first_encoder]);
		look_for_index(axis);
		if (GET(own->reset))
			own->zero = GET(own->raw);
		SET(own->count, (int32_t)((uint32_t)GET(own->raw) - (uint32_t)own->zero));
		SET(own->position, GET(own->count) / scale);
		if (time > 0)
			SET(own->velocity, (int32_t)((uint32_t)GET(own->raw) - (uint32_t)own->before[now])
			                       / (scale * time * US));
		own->before[now] = GET(own->raw);
	}
}

static void read_pins(long period)
{
	const struct passo_snapshot *snapshot = passo_snapshot(&passo);

	if (has_encoders)
		read_encoders(); /* first: an index changes the origin of the positions */
	turn = (turn + 1u) % turns;
	if (turn == 0u)
		read_stepgens(period);
	else
		extrapolate(period);
	if (inputs > 0 && turn + 1u == turns)
		read_inputs();
	SET(pins->state, (int32_t)snapshot->state);
	SET(pins->cause, (int32_t)snapshot->cause);
	SET(pins->frames, host.counters.frames);
	SET(pins->retries, host.counters.retries);
	SET(pins->words, linux_host.words);
}

/* A function of HAL: `arg` is read_pins() or write_pins(). */
static void call(void *arg, long period)
{
	void (*const *const function)(long) = arg;

	atomic_fetch_add(&under_way, 1u);
	if (!atomic_load(&leaving))
		(*function)(period);
	atomic_fetch_sub(&under_way, 1u);
}

/* ------------------------------------------------------------------------------------------- load ---- */

/* The list of encoders: digits with commas between them. */
static bool encoder_is_wanted(uint8_t axis)
{
	for (const char *text = encoders; *text; text++) {
		if (*text == '0' + axis)
			return true;
	}
	return false;
}

/* false: said what is wrong. */
static bool check_encoders(void)
{
	const uint8_t there = passo_axes(&passo);

	for (const char *text = encoders; *text; text++) {
		const bool is_digit = (text - encoders) % 2 == 0;
		if (is_digit ? *text < '0' || *text >= '0' + there : *text != COMMA) {
			TELL("encoders=%s: numbers of encoders from 0 to %u, with commas between them\n",
			    encoders, there - 1u);
			return false;
		}
		if (!is_digit)
			continue;
		const uint8_t axis = (uint8_t)(*text - '0');
		if (!has_encoders || axis < first_encoder)
			first_encoder = axis;
		if (!has_encoders || axis > last_encoder)
			last_encoder = axis;
		has_encoders = true;
	}
	if (has_encoders && !passo.has_encoders) {
		TELL("encoders=%s: the core has no encoders: build it with ENCODERS=1\n", encoders);
		return false;
	}
	return true;
}

static int make_stepgen(int axis)
{
	struct stepgen *own = &pins->stepgen[axis];
	const char *const name = PREFIX "stepgen.%02d.%s";
	int failed = 0;

	failed |= new_float(component, HAL_IN, &own->command, 0, name, axis, "position-cmd");
	failed |= new_float(component, HAL_OUT, &own->feedback, 0, name, axis, "position-fb");
	failed |= new_float(component, HAL_OUT, &own->velocity, 0, name, axis, "velocity-fb");
	failed |= new_s32(component, HAL_OUT, &own->counts, 0, name, axis, "counts");
	failed |= new_bit(component, HAL_IN, &own->enable, 0, name, axis, "enable");
	failed |= new_float(component, HAL_RW, &own->scale, 1, name, axis, "position-scale");
	failed |= new_float(component, HAL_RW, &own->maxvel, 0, name, axis, "maxvel");
	failed |= new_float(component, HAL_RW, &own->maxaccel, 0, name, axis, "maxaccel");
	failed |= new_float(component, HAL_RW, &own->stopaccel, 0, name, axis, "stopaccel");
	failed |= new_u32(component, HAL_RW, &own->steplen, PULSE_NS, name, axis, "steplen");
	failed |= new_u32(component, HAL_RW, &own->stepspace, PULSE_NS, name, axis, "stepspace");
	failed |= new_u32(component, HAL_RW, &own->dirsetup, PULSE_NS, name, axis, "dirsetup");
	failed |= new_u32(component, HAL_RW, &own->dirhold, PULSE_NS, name, axis, "dirhold");
	failed |= new_bit(component, HAL_RW, &own->step_invert, 0, name, axis, "step-invert");
	failed |= new_bit(component, HAL_RW, &own->dir_invert, 0, name, axis, "dir-invert");
	failed |= new_bit(component, HAL_RW, &own->enable_invert, 0, name, axis, "enable-invert");
	failed |= new_bit(component, HAL_RW, &own->home_invert, 0, name, axis, "home-invert");
	failed |= new_bit(component, HAL_RW, &own->limit_invert, 0, name, axis, "limit-invert");
	failed |= new_bit(component, HAL_RW, &own->alarm_invert, 0, name, axis, "alarm-invert");
	if (pins->encoder[axis].used)
		failed |= new_bit(component, HAL_IO, &own->index_enable, 0, name, axis, "index-enable");
	return failed;
}

static int make_encoder(uint8_t axis)
{
	struct encoder *own = &pins->encoder[axis];
	const char *const name = PREFIX "encoder.%02d.%s";
	int failed = 0;

	failed |= new_s32(component, HAL_OUT, &own->count, 0, name, axis, "count");
	failed |= new_s32(component, HAL_OUT, &own->raw, 0, name, axis, "rawcounts");
	failed |= new_float(component, HAL_OUT, &own->position, 0, name, axis, "position");
	failed |= new_float(component, HAL_OUT, &own->velocity, 0, name, axis, "velocity");
	failed |= new_bit(component, HAL_IO, &own->index_enable, 0, name, axis, "index-enable");
	failed |= new_bit(component, HAL_IN, &own->reset, 0, name, axis, "reset");
	failed |= new_float(component, HAL_RW, &own->scale, 1, name, axis, "scale");
	failed |= new_bit(component, HAL_RW, &own->index_invert, 0, name, axis, "index-invert");
	failed |= new_bit(component, HAL_RW, &own->index_mask, 0, name, axis, "index-mask");
	return failed;
}

static int make_inputs_and_outputs(void)
{
	int failed = 0;

	for (unsigned i = 0; i < inputs; i++) {
		failed |= new_bit(component, HAL_OUT, &pins->input[i], 0, PREFIX "gpio.%03u.in", i);
		failed |= new_bit(component, HAL_OUT, &pins->input_not[i], 0, PREFIX "gpio.%03u.in-not", i);
	}
	for (unsigned i = 0; outputs && i < OUTPUTS; i++)
		failed |= new_bit(component, HAL_IN, &pins->output[i], 0, PREFIX "output.%02u", i);
	if (outputs)
		failed |= new_float(component, HAL_IN, &pins->power, 0, PREFIX "power");
	return failed;
}

static int make_pins(void)
{
	static void (*const READ)(long) = read_pins;
	static void (*const WRITE)(long) = write_pins;
	int failed = 0;

	pins = hal_malloc(sizeof *pins);
	if (!pins)
		return -1;
	*pins = (struct pins){0};
	for (uint8_t axis = 0; axis < PASSO_AXES_MAX; axis++) {
		pins->encoder[axis].used = encoder_is_wanted(axis);
		if (pins->encoder[axis].used)
			failed |= make_encoder(axis);
	}
	for (int axis = 0; axis < axes; axis++)
		failed |= make_stepgen(axis);
	failed |= make_inputs_and_outputs();
	failed |= new_bit(component, HAL_IO, &pins->has_bit, 0, PREFIX "watchdog.has-bit");
	failed |= new_bit(component, HAL_OUT, &pins->fault, 0, PREFIX "fault");
	failed |= new_s32(component, HAL_OUT, &pins->state, 0, PREFIX "state");
	failed |= new_s32(component, HAL_OUT, &pins->cause, 0, PREFIX "cause");
	failed |= new_s32(component, HAL_OUT, &pins->depth, 0, PREFIX "queue.depth");
	failed |= new_u32(component, HAL_OUT, &pins->lag, 0, PREFIX "queue.lag");
	failed |= new_u32(component, HAL_OUT, &pins->slowed, 0, PREFIX "queue.slowed");
	failed |= new_float(component, HAL_OUT, &pins->trim, 0, PREFIX "queue.trim-ppm");
	failed |= new_u32(component, HAL_OUT, &pins->frames, 0, PREFIX "link.frames");
	failed |= new_u32(component, HAL_OUT, &pins->retries, 0, PREFIX "link.retries");
	failed |= new_u32(component, HAL_OUT, &pins->words, 0, PREFIX "link.words");
	failed |= hal_export_funct(PREFIX "read", call, (void *)&READ, 1, 0, component);
	failed |= hal_export_funct(PREFIX "write", call, (void *)&WRITE, 1, 0, component);
	return failed;
}

/* false: said what is wrong. */
static bool open_core(void)
{
	const struct passo_linux_options options = {
	    .device = device, .speed_hz = (uint32_t)speed_hz, .axes = (uint8_t)axes};
	const struct passo_options wanted = {.clock_hz = (uint32_t)clock_hz};

	if (axes < 1 || axes > (int)PASSO_AXES_MAX) {
		TELL("axes=%d: a core has 1 to %u axes\n", axes, PASSO_AXES_MAX);
		return false;
	}
	if (speed_hz < 0 || clock_hz < 0 || buffer < 0 || watchdog_ms < 0) {
		TELL("speed_hz, clock_hz, buffer and watchdog_ms are not negative\n");
		return false;
	}
	enum passo_error error = passo_open_linux(&passo, &host, &linux_host, &options, &wanted);
	if (error == PASSO_ERROR_MOVING) /* of a host that is gone; the stop ends before the first enable */
		error = passo_stop(&passo);
	if (error != PASSO_OK && error != PASSO_ERROR_ESTOP && error != PASSO_ERROR_ALARM) {
		TELL("%s\n", linux_host.problem);
		return false;
	}
	inputs = passo_has_inputs(&passo) ? GROUPS * (unsigned)axes + 1u : 0u;
	outputs = passo.has_outputs;
	if (!check_encoders())
		return false;
	if (inputs == 0 && watchdog_ms > 0)
		TELL("the core has no inputs, and so no watchdog: build it with INPUTS=1, or load with "
		     "watchdog_ms=0 if the drives may stay on when the host fails\n");
	if (inputs == 0)
		return watchdog_ms == 0;
	const uint64_t time = passo_clocks(&passo, (uint32_t)watchdog_ms * MS);
	if (passo_configure_watchdog(&passo, time, time) == PASSO_OK)
		return true;
	TELL("watchdog_ms=%d: at most %u\n", watchdog_ms,
	    (unsigned)(PASSO_WATCHDOG_CLOCKS_MAX * MS / passo_machine(&passo)->clock_hz));
	return false;
}

int rtapi_app_main(void)
{
	component = hal_init(PASSO_NAME);
	if (component < 0)
		return component;
	if (!open_core() || make_pins() != 0) {
		passo_close_linux(&linux_host);
		hal_exit(component);
		return -1;
	}
	drives_due = true;
	hal_ready(component);
	return 0;
}

void rtapi_app_exit(void)
{
	atomic_store(&leaving, true);
	for (unsigned waits = 0; atomic_load(&under_way) != 0u && waits < EXIT_WAITS; waits++)
		passo_linux_sleep(NULL, MS);
	if (passo_servo_is_on(&servo))
		passo_servo_stop(&servo);
	passo_close_linux(&linux_host);
	hal_exit(component);
}
