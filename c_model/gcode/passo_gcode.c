/* SPDX-License-Identifier: MIT
 * The interpreter: checks a line and accepts it.
 */
#include "passo_gcode.h"

#include "passo_gcode_private.h"

static const passo_gcode_command POWER_UP[PASSO_GCODE_MODES] = {
    [PASSO_GCODE_MOTION] = 0,
    [PASSO_GCODE_SYSTEM] = 540,
    [PASSO_GCODE_PLANE] = 170,
    [PASSO_GCODE_UNITS] = 210,
    [PASSO_GCODE_DISTANCE] = 900,
    [PASSO_GCODE_FEED_MODE] = 940,
    [PASSO_GCODE_PATH] = 640,
    [PASSO_GCODE_TOOL_LENGTH] = 490,
    [PASSO_GCODE_CUTTER] = 400,
    [PASSO_GCODE_ARC_DISTANCE] = 911,
    [PASSO_GCODE_SPINDLE] = 50,
    [PASSO_GCODE_RETRACT] = 980,
#ifndef PASSO_PLAIN_GCODE
    [PASSO_GCODE_DIAMETER] = 80,
    [PASSO_GCODE_SURFACE] = 970,
#endif
};

passo_gcode_command passo_gcode_power_up(const struct passo_gcode *gcode, unsigned group)
{
	if (group == PASSO_GCODE_PLANE && !passo_gcode_is_linear(gcode, 1) && passo_gcode_is_linear(gcode, 2))
		return PASSO_GCODE_G(18, 0);
	return POWER_UP[group];
}

void passo_gcode_copy(const struct passo_gcode *gcode, const int64_t *from, int64_t *to)
{
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
		to[axis] = from[axis];
}

static void clear_job(struct passo_gcode *gcode)
{
	struct passo_gcode_job *job = &gcode->job;

	job->change = job->output = job->dwell = job->offsets = job->via = job->motion = job->pause =
	    job->end = false;
	job->turns = job->drills = false;
#ifndef PASSO_PLAIN_GCODE
	job->settles = job->listens = false;
#endif
	job->probe = PASSO_GCODE_NONE;
}

void passo_gcode_open(struct passo_gcode *gcode, const struct passo_gcode_settings *settings)
{
	*gcode = (struct passo_gcode){.settings = *settings, .spindle_percent = 100};
	passo_gcode_reset(gcode);
}

void passo_gcode_configure(struct passo_gcode *gcode, const struct passo_gcode_settings *settings)
{
	const struct passo_gcode_settings before = gcode->settings;

	gcode->settings = *settings;
	gcode->settings.axes = before.axes;
#ifndef PASSO_PLAIN_GCODE
	gcode->settings.left_out = before.left_out;
#endif
}

void passo_gcode_set_offsets(struct passo_gcode *gcode, const struct passo_gcode_offsets *offsets)
{
	gcode->offsets = *offsets;
}

void passo_gcode_reset(struct passo_gcode *gcode)
{
	for (unsigned group = 0; group < PASSO_GCODE_MODES; group++)
		gcode->mode[group] = passo_gcode_power_up(gcode, group);
	for (unsigned axis = 0; axis < PASSO_GCODE_AXES_MAX; axis++)
		gcode->shift[axis] = 0;
	gcode->flood = gcode->mist = false;
#ifndef PASSO_PLAIN_GCODE
	gcode->digital = 0;
	gcode->power = PASSO_GCODE_POWER_OF_SPINDLE;
	gcode->surface = gcode->fastest = 0;
#endif
	gcode->tool_length = gcode->feed = gcode->spindle = 0;
	gcode->tolerance = 0;
	gcode->line = 0;
	gcode->tool = gcode->loaded;
	clear_job(gcode);
}

void passo_gcode_set_position(struct passo_gcode *gcode, const int64_t *position)
{
	passo_gcode_copy(gcode, position, gcode->position);
	clear_job(gcode);
}

void passo_gcode_load(struct passo_gcode *gcode, uint8_t tool)
{
	gcode->loaded = tool;
}

#ifndef PASSO_PLAIN_GCODE
void passo_gcode_stop_spindle(struct passo_gcode *gcode)
{
	gcode->mode[PASSO_GCODE_SPINDLE] = PASSO_GCODE_M(5);
}
#endif

void passo_gcode_set_length(struct passo_gcode *gcode, int64_t length)
{
	gcode->tool_length = length;
	gcode->mode[PASSO_GCODE_TOOL_LENGTH] = PASSO_GCODE_G(43, 1);
}

static void accept_coolant(struct passo_gcode *gcode, passo_gcode_command command)
{
	gcode->mist = command == PASSO_GCODE_M(7) || (gcode->mist && command != PASSO_GCODE_M(9));
	gcode->flood = command == PASSO_GCODE_M(8) || (gcode->flood && command != PASSO_GCODE_M(9));
}

/* M62 and M64: on. M64, M65 and M68: not with the motion. The power is that of the last word: S and M3 to M5
 * take it back. */
static void accept_port(struct passo_gcode *gcode, const struct passo_gcode_check *check)
{
#ifdef PASSO_PLAIN_GCODE
	(void)gcode, (void)check;
#else
	const struct passo_gcode_block *block = &check->block;
	const passo_gcode_command command = block->command[PASSO_GCODE_PORT];

	if ((block->words & PASSO_GCODE_WORD('S')) || block->command[PASSO_GCODE_SPINDLE] != PASSO_GCODE_NONE)
		gcode->power = PASSO_GCODE_POWER_OF_SPINDLE;
	if (command == PASSO_GCODE_M(62) || command == PASSO_GCODE_M(64))
		gcode->digital |= check->digital;
	else if (command == PASSO_GCODE_M(63) || command == PASSO_GCODE_M(65))
		gcode->digital &= (uint8_t)~check->digital;
	else if (command >= PASSO_GCODE_M(67))
		gcode->power = check->power;
	gcode->job.settles =
	    command == PASSO_GCODE_M(64) || command == PASSO_GCODE_M(65) || command == PASSO_GCODE_M(68);
#endif
}

static void accept_command(struct passo_gcode *gcode, const struct passo_gcode_check *check)
{
	switch (check->block.command[PASSO_GCODE_COMMAND]) {
	case PASSO_GCODE_G(10, 0):
#ifndef PASSO_PLAIN_GCODE
		if (check->entry > 0) {
			gcode->offsets.tool_length[check->entry - 1] = (int32_t)check->set[0];
			break;
		}
#endif
		passo_gcode_copy(gcode, check->set, gcode->offsets.system[check->system]);
		break;
	case PASSO_GCODE_G(28, 1):
		passo_gcode_copy(gcode, gcode->position, gcode->offsets.home[0]);
		break;
	case PASSO_GCODE_G(30, 1):
		passo_gcode_copy(gcode, gcode->position, gcode->offsets.home[1]);
		break;
	case PASSO_GCODE_G(92, 0):
		passo_gcode_copy(gcode, check->set, gcode->shift);
		break;
	case PASSO_GCODE_G(92, 1):
		for (unsigned axis = 0; axis < PASSO_GCODE_AXES_MAX; axis++)
			gcode->shift[axis] = 0;
		break;
	default:
		break;
	}
}

/* A change is over when passo_gcode_load() says so. */
static void accept_tool(struct passo_gcode *gcode, const struct passo_gcode_check *check)
{
	if (passo_gcode_has_word(check, 'T'))
		gcode->tool = (uint8_t)(check->block.value['T' - 'A'] / PASSO_GCODE_MILLION);
#ifndef PASSO_PLAIN_GCODE
	const passo_gcode_command change = check->block.command[PASSO_GCODE_TOOL_CHANGE];

	if (change == PASSO_GCODE_M(61))
		gcode->tool = gcode->loaded = check->loaded;
	gcode->job.change = change == PASSO_GCODE_M(6) && check->loaded != gcode->loaded;
#endif
	gcode->tool_length = check->tool_length;
}

static void accept(struct passo_gcode *gcode, const struct passo_gcode_check *check)
{
	const struct passo_gcode_block *block = &check->block;
	const passo_gcode_command program = block->command[PASSO_GCODE_PROGRAM];
	const uint32_t output = passo_gcode_output(gcode);

	if (block->words & PASSO_GCODE_WORD('N'))
		gcode->line = (uint32_t)(block->value['N' - 'A'] / PASSO_GCODE_MILLION);
	accept_tool(gcode, check);
#ifdef PASSO_PLAIN_GCODE
	if (block->words & PASSO_GCODE_WORD('S'))
		gcode->spindle = block->value['S' - 'A'];
#else
	gcode->spindle = check->spindle;
	gcode->surface = check->surface;
	gcode->fastest = check->fastest;
#endif
	gcode->feed = check->feed;
	gcode->tolerance = check->tolerance;
	gcode->drill = check->drill;
	for (unsigned group = 0; group < PASSO_GCODE_MODES; group++)
		gcode->mode[group] = check->mode[group];
	accept_coolant(gcode, block->command[PASSO_GCODE_COOLANT]);
	accept_port(gcode, check);
	accept_command(gcode, check);
	if (gcode->job.motion)
		passo_gcode_copy(gcode, gcode->job.destination, gcode->position);
	gcode->job.output = passo_gcode_output(gcode) != output;
	gcode->job.pause = program == 0;
	gcode->job.end = program == PASSO_GCODE_M(2) || program == PASSO_GCODE_M(30);
}

static enum passo_gcode_error begin(
    struct passo_gcode *gcode, struct passo_gcode_check *check, const char *text)
{
	const uint32_t axis_words = passo_gcode_axis_words(gcode->settings.left_out, gcode->settings.axes);
	const enum passo_gcode_error error = passo_gcode_parse(text, axis_words, &check->block);

	clear_job(gcode);
	check->gcode = gcode;
	check->job = &gcode->job;
	check->unused = check->block.words;
	check->moves = false;
	check->feed = check->inverse = 0;
	check->tolerance = 0;
	check->drill = gcode->drill;
	check->tool_length = gcode->tool_length;
	check->system = check->entry = 0;
	check->axis_words = check->block.words & axis_words;
	for (unsigned group = 0; group < PASSO_GCODE_MODES; group++) {
		const passo_gcode_command given = check->block.command[group];

		check->mode[group] = given == PASSO_GCODE_NONE ? gcode->mode[group] : given;
	}
	return error;
}

static enum passo_gcode_error finish(struct passo_gcode_check *check, enum passo_gcode_error error)
{
	if (error == PASSO_GCODE_OK)
		error = passo_gcode_check_words(check);
	if (error == PASSO_GCODE_OK)
		error = passo_gcode_check_motion(check);
	return error == PASSO_GCODE_OK && check->unused ? PASSO_GCODE_UNUSED : error;
}

enum passo_gcode_error passo_gcode_execute(struct passo_gcode *gcode, const char *text)
{
	struct passo_gcode_check check;
	const enum passo_gcode_error error = finish(&check, begin(gcode, &check, text));

	if (error == PASSO_GCODE_OK)
		accept(gcode, &check);
	else
		clear_job(gcode);
	return error;
}

enum passo_gcode_error passo_gcode_jog(struct passo_gcode *gcode, const char *text)
{
	struct passo_gcode_check check;
	enum passo_gcode_error error = begin(gcode, &check, text);

	for (unsigned group = 0; group < PASSO_GCODE_GROUPS; group++) {
		const passo_gcode_command given = check.block.command[group];
		const bool allowed = group == PASSO_GCODE_UNITS || group == PASSO_GCODE_DISTANCE
		                  || given == PASSO_GCODE_G(53, 0);

		if (error == PASSO_GCODE_OK && given != PASSO_GCODE_NONE && !allowed)
			error = PASSO_GCODE_JOG;
	}
	if (error == PASSO_GCODE_OK
	    && (check.block.words & ~(check.axis_words | PASSO_GCODE_WORD('F') | PASSO_GCODE_WORD('N'))))
		error = PASSO_GCODE_JOG;
	if (error == PASSO_GCODE_OK && check.axis_words == 0)
		error = PASSO_GCODE_NO_AXIS_WORDS;
	if (error == PASSO_GCODE_OK && !(check.block.words & PASSO_GCODE_WORD('F')))
		error = PASSO_GCODE_NO_FEED;
	check.mode[PASSO_GCODE_MOTION] = 10;
	check.mode[PASSO_GCODE_FEED_MODE] = 940;
	error = finish(&check, error);
	if (error == PASSO_GCODE_OK)
		passo_gcode_copy(gcode, gcode->job.destination, gcode->position);
	else
		clear_job(gcode);
	return error;
}
