/* SPDX-License-Identifier: MIT
 * G-code on the web page, played as by `passo run` (sim/passo/part.py).
 */
#include <stdlib.h>
#include <string.h>

#include "passo_program.h"
#include "passo_web.h"

enum {
	ROUND = 1000,       /* microseconds between two polls */
	PATIENCE = 3600000, /* rounds without a line that are too many */
	LOOK_AHEAD = 48,
	AXES = 6,
	SLEWS_PER_SECOND = 20, /* of hold and stop, from full speed */
	NANOMETERS = 1000000,
};

/* The machine as the page gives it, in the order of sim/passo/web.py. */
struct web_machine {
	double clock_hz, axes, junction_deviation, arc_tolerance, profile;
	double core_axes; /* a frame holds more lines for a core with fewer, which the ramps depend on */
	double step_high, step_low, dir_setup, dir_hold; /* clocks */
	struct {
		double steps_per_mm, speed, acceleration, jump, jerk;
	} axis[AXES];
};

static struct {
	struct web_machine machine;
	char *text;
	size_t length;
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

static void read_settings(void)
{
	const struct web_machine *machine = &web.machine;
	const uint8_t axes = (uint8_t)machine->axes;

	web.settings = (struct passo_program_settings){
	    .path = {.machine = {.clock_hz = (uint32_t)machine->clock_hz, .tick_log2 = 7, .axes = axes},
		.junction_deviation = q32(machine->junction_deviation),
		.profile = (enum passo_profile)machine->profile},
	    .gcode = {.axes = axes, .arc_tolerance = (uint32_t)(machine->arc_tolerance * NANOMETERS + 0.5)}};
	for (unsigned i = 0; i < axes; i++)
		web.settings.path.axis[i] =
		    (struct passo_path_axis){.steps_per_mm = q32(machine->axis[i].steps_per_mm),
			.speed = q32(machine->axis[i].speed),
			.acceleration = q32(machine->axis[i].acceleration),
			.jump = q32(machine->axis[i].jump),
			.jerk = q32(machine->axis[i].jerk)};
}

/* The line that begins at `*at`; moves on. */
static const char *next_line(size_t *at, size_t *length)
{
	const char *line = web.text + *at;

	*length = passo_gcode_line_count(line, web.length - *at);
	*at += *length;
	return line;
}

/* The number of the first bad line, whose error has been written; 0: all are good. Cuts the text at the end
 * of the program. */
static uint32_t check(void)
{
	struct passo_gcode *gcode = &web.program.gcode;
	uint32_t number = 0;

	passo_gcode_open(gcode, &web.settings.gcode);
	for (size_t at = 0, length; at < web.length;) {
		const char *line = next_line(&at, &length);
		struct passo_gcode_action action;
		const enum passo_gcode_error error = passo_program_line(&web.program, line, length);

		number++;
		if (error != PASSO_GCODE_OK)
			web_write(NULL, passo_gcode_error_text(error));
		while (error == PASSO_GCODE_OK && passo_gcode_next(gcode, &action)) {
			if (action.kind == PASSO_GCODE_PROBE) {
				web_write(NULL, "no probe is fitted");
				return number;
			}
			if (action.kind == PASSO_GCODE_END)
				web.length = at;
		}
		if (error != PASSO_GCODE_OK)
			return number;
	}
	return 0;
}

static uint32_t microseconds(void *context)
{
	return web_advance(context, 0);
}

static void wait(void *context, uint32_t duration)
{
	web_advance(context, duration + 1);
}

static enum passo_error open_driver(void)
{
	const struct passo_hardware hardware = {
	    .transfer = web_transfer, .microseconds = microseconds, .wait = wait, .irq = web_irq};
	const struct web_machine *machine = &web.machine;
	const uint32_t slew = (uint32_t)machine->clock_hz / SLEWS_PER_SECOND;
	const struct passo_axis_config config = {.step_high_ns = (uint32_t)machine->step_high,
	    .step_low_ns = (uint32_t)machine->step_low,
	    .dir_setup_ns = (uint32_t)machine->dir_setup,
	    .dir_hold_ns = (uint32_t)machine->dir_hold,
	    .in_clocks = true};
	enum passo_error error = passo_open(&web.passo, &web.host, &hardware,
	    &(struct passo_options){.clock_hz = (uint32_t)machine->clock_hz});

	for (uint8_t axis = 0; axis < (uint8_t)machine->axes && error == PASSO_OK; axis++) {
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

static enum passo_error play(void)
{
	enum passo_error error = PASSO_OK;
	size_t at = 0, length;
	uint32_t chords = 0;

	for (unsigned quiet = 0; error == PASSO_OK && quiet < PATIENCE; quiet++) {
		while (error == PASSO_OK && passo_program_is_ready(&web.program)) {
			if (at < web.length) {
				const char *line = next_line(&at, &length);

				passo_program_line(&web.program, line, length);
			} else {
				passo_program_end(&web.program);
			}
			error = passo_program_poll(&web.program);
		}
		if (error == PASSO_OK)
			error = passo_program_poll(&web.program);
		web_advance(NULL, ROUND);
		if (passo_program_is_done(&web.program))
			return error;
		if (web.program.player.chords != chords)
			quiet = 0;
		chords = web.program.player.chords;
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

/* Plays the program on the machine. 0: played; the number of a bad line, or -1: what is wrong was written. */
EXPORT("play") int32_t web_play(void)
{
	if (!web_start((uint32_t)web.machine.core_axes, (uint32_t)web.machine.clock_hz)) {
		web_write(NULL, "out of memory");
		return -1;
	}
	read_settings();
	const uint32_t bad = check();
	if (bad > 0)
		return (int32_t)bad;
	enum passo_error error = open_driver();
	if (error == PASSO_OK)
		error = play();
	if (error != PASSO_OK)
		web_write(NULL, passo_error_text(error));
	return error == PASSO_OK ? 0 : -1;
}
