/* SPDX-License-Identifier: MIT
 * G-code on the web page, played as by `passo run` (sim/passo/part.py).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo_preview.h"
#include "passo_rests.h"
#include "passo_web.h"

enum {
	LOOPS_PER_SECOND = 1000,    /* polls of the driver */
	FOLLOWS_PER_SECOND = 10000, /* the same in step with the spindle */
	PATIENCE = 3600,            /* seconds without a line or step that are too many */
	LOOK_AHEAD = 48,
	AXES = 6,
	SLEWS_PER_SECOND = 20, /* of hold and stop, from full speed */
	NANOMETERS = 1000000,
	REFUSED_MOST = 20, /* bad lines that are reported */
	LINE = 256,
	FILES = 256,
	CHANGES = 1024, /* of the spindle's encoder, which are forgotten at a time */
	REST = 8,       /* pulses that time passes for after the end */
};

enum progress { DONE, GOES_ON, FAILED = -1, SLOW = -2 };

struct limits {
	double steps_per_mm, speed, acceleration, jump, jerk;
};

/* The machine as the page gives it, in the order of sim/passo/page/machine_file.js. */
struct web_machine {
	double clock_hz, axes, junction_deviation, arc_tolerance, profile;
	double core_axes; /* a frame holds more lines for a core with fewer, which the ramps depend on */
	double step_high, step_low, dir_setup, dir_hold; /* clocks */
	double spindle_maximum, left_out, inputs, power;
	double turn_counts, interval, wander, start_up; /* of a simulated spindle, as of its rig; or 0 */
	double spin_up, at_speed; /* us that motions wait for it; the input of M66 that it says so by, or 0 */
	double motors;            /* 0: one for each axis, and no map */
	double plus[PASSO_AXES_MAX], minus[PASSO_AXES_MAX];
	struct limits mixed, axis[AXES];
};

static struct {
	struct web_machine machine;
	char *text;              /* files, each up to its end */
	size_t length, room, at; /* room: behind the length; at: of the next line */
	uint32_t lines;          /* taken */
	uint32_t begun;          /* those before the thread that lines continue */
	uint32_t kept[FILES];    /* lines of each file */
	uint32_t files, refused, unread;
	uint32_t chords;
	uint64_t quiet; /* clock of the last chord or step */
	uint16_t inputs;
	struct passo_program_settings settings;
	struct passo_program program;
	struct passo_path_item items[LOOK_AHEAD];
	struct passo_host host;
	struct passo passo;
	struct passo_rig *rig; /* the spindle; null: there is none */
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
		.power = machine->power != 0.0,
		.turn_counts = (uint16_t)machine->turn_counts},
	    .inputs = &web.inputs,
	    .spin_up = (uint32_t)machine->spin_up,
	    .at_speed = (uint8_t)machine->at_speed};
	web.inputs = 0;
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

/* What is wrong with a line of the last file. */
static void refuse(const struct passo_preview_refusal *refusal)
{
	const unsigned file = (unsigned)web.files, number = (unsigned)refusal->line + 1u;
	char text[LINE];

	if (refusal->error == PASSO_PREVIEW_NO_PROBE)
		snprintf(text, sizeof text, "%u:%u: no probe is fitted\n", file, number);
	else
		snprintf(text, sizeof text, "%u:%u: error:%u: %s\n", file, number, (unsigned)refusal->error,
		    passo_gcode_error_text((enum passo_gcode_error)refusal->error));
	web_write(NULL, text);
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

/* As sim/passo/spindle_at.py: its encoder is at the inputs behind those of the motors. False: memory is
 * short. */
static bool attach_spindle(void)
{
	static struct passo_rig_config config;
	const struct web_machine *machine = &web.machine;
	const uint8_t motors = (uint8_t)(machine->motors != 0.0 ? machine->motors : machine->axes);

	config = (struct passo_rig_config){.seed = 1, .axes = (uint32_t)machine->core_axes, .wheels = 1};
	config.wheel[0] = (struct passo_rig_wheel){.axis = motors,
	    .interval = (uint64_t)machine->interval,
	    .wander = (uint32_t)machine->wander,
	    .per_turn = (uint32_t)machine->turn_counts,
	    .start_up = (uint64_t)machine->start_up};
	config.wheel[0].ready = (uint8_t)machine->at_speed;
	web.program.machine.spindle = motors;
	web.rig = passo_engine_attach(web_engine(), &config);
	return web.rig != NULL;
}

/* The spindle has the speed of the program; lines behind a thread do not change it. Its input is the only one
 * that is not low. */
static void drive_spindle(void)
{
	static struct passo_rig_change changes[CHANGES];
	const struct passo_player *player = &web.program.player;
	const uint32_t output =
	    passo_player_follows(player) ? player->thread.output : passo_gcode_output(&web.program.gcode);
	const uint32_t power = output & UINT16_MAX;

	passo_rig_drive(web.rig, 0, power + (power > 0u));
	while (passo_rig_drain(web.rig, changes, CHANGES) == CHANGES)
		continue;
	if (web.settings.at_speed > 0u)
		web.inputs = (uint16_t)(passo_rig_at_speed(web.rig, 0) << web.settings.at_speed);
}

/* One turn of the main loop, as in sim/passo/host_loop.py. */
static enum passo_error turn(uint64_t period)
{
	struct passo_engine *engine = web_engine();
	const uint64_t began = passo_engine_clock(engine);
	const enum passo_error error = passo_program_poll(&web.program);
	const uint64_t look = passo_engine_clock(engine) - began;
	const bool rests = !passo_player_follows(&web.program.player) && passo_program_rests(&web.program);

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

			if (!passo_player_follows(&web.program.player))
				web.begun = web.lines;
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

/* Room for a text behind the files; null if memory is short. */
EXPORT("room") char *web_room(uint32_t length)
{
	char *text = realloc(web.text, web.length + length + 1u);

	if (!text)
		return NULL;
	web.text = text;
	web.room = length;
	return text + web.length;
}

/* The error of the text in the room as a single line of G-code, for the last machine that was begun. */
EXPORT("tries") uint32_t web_tries(void)
{
	struct passo_gcode_line line;

	passo_gcode_open(&web.program.gcode, &web.settings.gcode);
	passo_gcode_line_read(&line, web.text + web.length, web.room);
	return (uint32_t)passo_gcode_execute(&web.program.gcode, line.text);
}

/* Lines that are refused; the first ones have been written. */
EXPORT("refused") uint32_t web_refused(void)
{
	return web.refused;
}

/* Begins a program for the machine, without any file. */
EXPORT("reset") void web_reset(void)
{
	web.length = web.at = 0;
	web.lines = web.begun = web.chords = web.files = web.refused = web.unread = 0;
	web.quiet = 0;
	read_settings();
	passo_gcode_open(&web.program.gcode, &web.settings.gcode);
}

/* The interpreter behind the files so far: a struct passo_gcode. */
EXPORT("gcode") struct passo_gcode *web_gcode(void)
{
	return &web.program.gcode;
}

/* Checks the text in the room and adds it, up to its end, as a file. What is wrong is written, a line each:
 * the number of the file, of the line, and the error. False: there are too many files. */
EXPORT("add") bool web_add(void)
{
	struct passo_preview_refusal refusals[REFUSED_MOST];
	const char *text = web.text + web.length;

	if (web.files == FILES)
		return false;
	const struct passo_preview_check made =
	    passo_preview_check(&web.program.gcode, text, web.room, refusals, REFUSED_MOST);
	for (uint32_t i = 0; i < made.refused && web.refused + i < REFUSED_MOST; i++)
		refuse(&refusals[i]);
	web.refused += made.refused;
	web.unread += made.unread;
	web.length += made.bytes;
	web.kept[web.files++] = made.lines;
	return true;
}

/* Lines of a file up to its end. */
EXPORT("kept") uint32_t web_kept(uint32_t file)
{
	return web.kept[file];
}

/* Lines with words behind the ends of the files. */
EXPORT("unread") uint32_t web_unread(void)
{
	return web.unread;
}

/* Opens the machine: web_go() follows, or what is wrong was written. */
EXPORT("begin") int32_t web_begin(void)
{
	const struct web_machine *machine = &web.machine;
	const bool counted = machine->turn_counts != 0.0, turns = machine->start_up != 0.0;
	const bool outputs = turns || machine->spin_up != 0.0;

	web.rig = NULL;
	if (!web_start((uint32_t)machine->core_axes, (uint32_t)machine->clock_hz, counted, outputs)) {
		web_write(NULL, "out of memory");
		return FAILED;
	}
	const enum passo_error error = open_driver();
	if (error != PASSO_OK)
		web_write(NULL, passo_error_text(error));
	else if (turns && !attach_spindle())
		web_write(NULL, "out of memory");
	else
		return GOES_ON;
	return FAILED;
}

/* Plays a number of turns of the main loop. SLOW: the spindle was not at its speed in time. */
EXPORT("go") int32_t web_go(uint32_t turns)
{
	const struct web_machine *machine = &web.machine;
	const uint64_t hz = (uint64_t)machine->clock_hz;

	for (; turns > 0u; turns--) {
		enum passo_error error = passo_program_is_done(&web.program) ? PASSO_OK : feed();

		if (web.rig)
			drive_spindle();
		if (error == PASSO_OK)
			error = turn(hz
			             / (passo_player_follows(&web.program.player) ? FOLLOWS_PER_SECOND
			                                                          : LOOPS_PER_SECOND));
		if (error != PASSO_OK) {
			web_write(NULL, passo_error_text(error));
			return FAILED;
		}
		if (web.program.slow)
			return SLOW;
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
			const uint64_t step = web_last_step();

			if (step <= web.quiet) {
				web_write(NULL, "timeout: no step for an hour of simulated time");
				return FAILED;
			}
			web.quiet = step;
		}
	}
	return GOES_ON;
}

/* The line that an error is of. */
EXPORT("blamed") uint32_t web_blamed(void)
{
	return passo_player_follows(&web.program.player) ? web.begun + 1u : web.lines;
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

/* Bytes of the files up to their ends. */
EXPORT("length") uint32_t web_length(void)
{
	return (uint32_t)web.length;
}
