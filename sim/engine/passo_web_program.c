/* SPDX-License-Identifier: MIT
 * G-code on the web page, played as by `passo run` (sim/passo/part.py).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo_rests.h"
#include "passo_web.h"

enum {
	LOOPS_PER_SECOND = 1000, /* polls of the driver */
	PATIENCE = 3600,         /* seconds without a line that are too many */
	LOOK_AHEAD = 48,
	AXES = 6,
	SLEWS_PER_SECOND = 20, /* of hold and stop, from full speed */
	NANOMETERS = 1000000,
	REFUSED_MOST = 20, /* bad lines that are reported */
	LINE = 256,
	REST = 8, /* pulses that time passes for after the end */
};

enum progress { DONE, GOES_ON, FAILED = -1 };

struct limits {
	double steps_per_mm, speed, acceleration, jump, jerk;
};

/* The machine as the page gives it, in the order of sim/passo/page/machine_file.js. */
struct web_machine {
	double clock_hz, axes, junction_deviation, arc_tolerance, profile;
	double core_axes; /* a frame holds more lines for a core with fewer, which the ramps depend on */
	double step_high, step_low, dir_setup, dir_hold; /* clocks */
	double spindle_maximum, left_out, inputs, power;
	double motors; /* 0: one for each axis, and no map */
	double plus[PASSO_AXES_MAX], minus[PASSO_AXES_MAX];
	struct limits mixed, axis[AXES];
};

static struct {
	struct web_machine machine;
	char *text;
	size_t length, at; /* at: of the next line */
	uint32_t lines;    /* taken */
	uint32_t refused;
	uint32_t chords;
	uint64_t quiet; /* clock of the last chord */
	uint16_t inputs;
	struct passo_program_settings settings;
	struct passo_program program;
	struct passo_path_item items[LOOK_AHEAD];
	struct passo_host host;
	struct passo passo;
} web;

static uint64_t q32(double value)
{
	return (uint64_t)(value * 4294967296.0 + 0.5);
}

static struct passo_path_axis limits(const struct limits *own)
{
	return (struct passo_path_axis){.steps_per_mm = q32(own->steps_per_mm),
	    .speed = q32(own->speed),
	    .acceleration = q32(own->acceleration),
	    .jump = q32(own->jump),
	    .jerk = q32(own->jerk)};
}

static void read_settings(void)
{
	const struct web_machine *machine = &web.machine;
	const uint8_t axes = (uint8_t)machine->axes;
	struct passo_path_settings *path = &web.settings.path;

	web.settings = (struct passo_program_settings){
	    .path = {.machine = {.clock_hz = (uint32_t)machine->clock_hz, .tick_log2 = 7, .axes = axes},
		.motors.count = (uint8_t)machine->motors,
		.mixed = limits(&machine->mixed),
		.junction_deviation = q32(machine->junction_deviation),
		.profile = (enum passo_profile)machine->profile},
	    .gcode = {.axes = axes,
		.arc_tolerance = (uint32_t)(machine->arc_tolerance * NANOMETERS + 0.5),
		.spindle_maximum = (uint32_t)machine->spindle_maximum,
		.left_out = (uint8_t)machine->left_out,
		.inputs = (uint8_t)machine->inputs,
		.power = machine->power != 0.0},
	    .inputs = &web.inputs};
	for (unsigned motor = 0; motor < PASSO_AXES_MAX; motor++) {
		path->motors.plus[motor] = (uint8_t)machine->plus[motor];
		path->motors.minus[motor] = (uint8_t)machine->minus[motor];
	}
	for (unsigned i = 0; i < axes; i++)
		path->axis[i] = limits(&machine->axis[i]);
}

/* The line that begins at `*at`; moves on. */
static const char *next_line(size_t *at, size_t *length)
{
	const char *line = web.text + *at;

	*length = passo_gcode_line_count(line, web.length - *at);
	*at += *length;
	return line;
}

static void refuse(uint32_t number, enum passo_gcode_error error)
{
	char text[LINE];

	if (error == PASSO_GCODE_OK)
		snprintf(text, sizeof text, "%u: no probe is fitted\n", (unsigned)number);
	else
		snprintf(text, sizeof text, "%u: error:%u: %s\n", (unsigned)number, (unsigned)error,
		    passo_gcode_error_text(error));
	web_write(NULL, text);
}

/* Writes what is wrong with the lines, a line each; returns the number of bad ones. Cuts the text at the end
 * of the program. */
static uint32_t check(void)
{
	struct passo_gcode *gcode = &web.program.gcode;
	uint32_t number = 0, bad = 0;

	passo_gcode_open(gcode, &web.settings.gcode);
	for (size_t at = 0, length; at < web.length;) {
		const char *line = next_line(&at, &length);
		struct passo_gcode_action action;
		const enum passo_gcode_error error = passo_program_line(&web.program, line, length);

		number++;
		if (error != PASSO_GCODE_OK && bad++ < REFUSED_MOST)
			refuse(number, error);
		while (error == PASSO_GCODE_OK && passo_gcode_next(gcode, &action)) {
			if (action.kind == PASSO_GCODE_PROBE && bad++ < REFUSED_MOST)
				refuse(number, PASSO_GCODE_OK);
			if (action.kind == PASSO_GCODE_END)
				web.length = at;
		}
	}
	return bad;
}

static enum passo_error open_driver(void)
{
	const struct passo_hardware hardware = {.transfer = passo_engine_host_transfer,
	    .microseconds = passo_engine_host_microseconds,
	    .wait = passo_engine_host_wait,
	    .context = web_engine()};
	const struct web_machine *machine = &web.machine;
	const uint32_t slew = (uint32_t)machine->clock_hz / SLEWS_PER_SECOND;
	const struct passo_axis_config config = {.step_high_ns = (uint32_t)machine->step_high,
	    .step_low_ns = (uint32_t)machine->step_low,
	    .dir_setup_ns = (uint32_t)machine->dir_setup,
	    .dir_hold_ns = (uint32_t)machine->dir_hold,
	    .in_clocks = true};
	const uint8_t motors = (uint8_t)(machine->motors != 0.0 ? machine->motors : machine->axes);
	enum passo_error error = passo_open(&web.passo, &web.host, &hardware,
	    &(struct passo_options){.clock_hz = (uint32_t)machine->clock_hz});

	for (uint8_t axis = 0; axis < motors && error == PASSO_OK; axis++) {
		error = passo_configure_axis(&web.passo, axis, &config);
		if (error == PASSO_OK)
			error = passo_enable(&web.passo, axis, true);
	}
	if (error == PASSO_OK)
		error = passo_configure_motion(&web.passo, slew, slew, 1 << 16);
	if (error == PASSO_OK)
		error = passo_program_open(&web.program, &web.passo, &web.settings, web.items, LOOK_AHEAD);
	return error;
}

/* One turn of the main loop, as in sim/passo/host_loop.py. */
static enum passo_error turn(uint64_t period)
{
	struct passo_engine *engine = web_engine();
	const uint64_t began = passo_engine_clock(engine);
	const enum passo_error error = passo_program_poll(&web.program);
	const uint64_t look = passo_engine_clock(engine) - began;
	const bool rests = passo_program_rests(&web.program);

	web_run(period);
	if (rests && look > 0u)
		passo_engine_pass_looks(engine, look + period, look);
	return error;
}

static enum passo_error feed(void)
{
	enum passo_error error = PASSO_OK;
	size_t length;

	while (error == PASSO_OK && passo_program_is_ready(&web.program)) {
		if (web.at < web.length) {
			const char *line = next_line(&web.at, &length);

			passo_program_line(&web.program, line, length);
			web.lines++;
		} else {
			passo_program_end(&web.program);
		}
		error = passo_program_poll(&web.program);
	}
	return error;
}

EXPORT("machine") struct web_machine *web_machine(void)
{
	return &web.machine;
}

/* Room for a program; null if memory is short. */
EXPORT("program") char *web_program(uint32_t length)
{
	free(web.text);
	web.length = length;
	web.text = malloc(length + 1u);
	return web.text;
}

/* The error of the program's text as a single line of G-code, for the last machine that was begun. */
EXPORT("tries") uint32_t web_tries(void)
{
	struct passo_gcode_line line;

	passo_gcode_open(&web.program.gcode, &web.settings.gcode);
	passo_gcode_line_read(&line, web.text, web.length);
	return (uint32_t)passo_gcode_execute(&web.program.gcode, line.text);
}

/* Lines that are refused; the first ones have been written. */
EXPORT("refused") uint32_t web_refused(void)
{
	return web.refused;
}

/* Checks the program and opens the machine: web_go() follows, or what is wrong was written. */
EXPORT("begin") int32_t web_begin(void)
{
	web.at = web.lines = web.chords = web.refused = 0;
	web.quiet = 0;
	if (!web_start((uint32_t)web.machine.core_axes, (uint32_t)web.machine.clock_hz)) {
		web_write(NULL, "out of memory");
		return FAILED;
	}
	read_settings();
	web.refused = check();
	if (web.refused > 0u)
		return FAILED;
	const enum passo_error error = open_driver();
	if (error != PASSO_OK)
		web_write(NULL, passo_error_text(error));
	return error == PASSO_OK ? GOES_ON : FAILED;
}

/* Plays a number of turns of the main loop. */
EXPORT("go") int32_t web_go(uint32_t turns)
{
	const struct web_machine *machine = &web.machine;
	const uint64_t hz = (uint64_t)machine->clock_hz;

	for (; turns > 0u; turns--) {
		enum passo_error error = passo_program_is_done(&web.program) ? PASSO_OK : feed();

		if (error == PASSO_OK)
			error = turn(hz / LOOPS_PER_SECOND);
		if (error != PASSO_OK) {
			web_write(NULL, passo_error_text(error));
			return FAILED;
		}
		if (passo_program_is_done(&web.program)) {
			web_run((uint64_t)(REST
			                   * (machine->step_high + machine->step_low + machine->dir_setup
			                       + machine->dir_hold)));
			return DONE;
		}
		if (web.program.player.chords != web.chords) {
			web.chords = web.program.player.chords;
			web.quiet = passo_engine_clock(web_engine());
		}
		if (passo_engine_clock(web_engine()) - web.quiet > PATIENCE * hz) {
			web_write(NULL, "timeout: no motion for an hour of simulated time");
			return FAILED;
		}
	}
	return GOES_ON;
}

/* Lines taken so far, and bytes. */
EXPORT("taken") uint32_t web_taken(void)
{
	return web.lines;
}

EXPORT("taken_bytes") uint32_t web_taken_bytes(void)
{
	return (uint32_t)web.at;
}

/* Bytes up to the end of the program. */
EXPORT("length") uint32_t web_length(void)
{
	return (uint32_t)web.length;
}
