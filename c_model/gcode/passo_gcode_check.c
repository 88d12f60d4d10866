/* SPDX-License-Identifier: MIT
 * Checks of all words but those of a motion, in the order in which grbl names the errors.
 */
#include "passo_gcode_private.h"
#include "passo_math.h"

#define TOOL_MAX 255
#define LINE_NUMBER_MAX 9999999
#define TOOL_LETTER 2u                                        /* Z */
#define NANOMETRE ((UINT64_C(1) << 32) / PASSO_GCODE_MILLION) /* UQ32.32 mm, rounded down */

bool passo_gcode_take(struct passo_gcode_check *check, char letter)
{
	check->unused &= ~PASSO_GCODE_WORD(letter);
	return passo_gcode_has_word(check, letter);
}

static int64_t value_of(const struct passo_gcode_check *check, char letter)
{
	return check->block.value[letter - 'A'];
}

static int64_t whole_of(const struct passo_gcode_check *check, char letter)
{
	return value_of(check, letter) / PASSO_GCODE_MILLION;
}

/* Nanometers of millionths of an inch, to the nearest; 25.4 is 127 / 5. */
static int64_t from_inches(int64_t value)
{
	return (127 * value + (value < 0 ? -2 : 2)) / 5;
}

int64_t passo_gcode_length_of(const struct passo_gcode_check *check, char letter)
{
	const int64_t value = value_of(check, letter);
	const int64_t length =
	    check->mode[PASSO_GCODE_UNITS] == PASSO_GCODE_G(20, 0) ? from_inches(value) : value;

#ifndef PASSO_PLAIN_GCODE
	if (letter == 'X' && check->mode[PASSO_GCODE_DIAMETER] == PASSO_GCODE_G(7, 0))
		return (length + (length > 0)) / 2; /* a diameter */
#endif
	return length;
}

bool passo_gcode_has_axis(const struct passo_gcode_check *check, unsigned axis)
{
	return (check->axis_words
	           & PASSO_GCODE_WORD(passo_gcode_axis_letter(check->gcode->settings.left_out, axis)))
	    != 0;
}

#ifdef PASSO_PLAIN_GCODE
bool passo_gcode_is_linear(const struct passo_gcode *gcode, unsigned letter)
{
	(void)gcode, (void)letter;
	return true;
}

unsigned passo_gcode_linear(const struct passo_gcode *gcode, unsigned letter)
{
	(void)gcode;
	return letter;
}
#else
bool passo_gcode_is_linear(const struct passo_gcode *gcode, unsigned letter)
{
	return (gcode->settings.left_out >> letter & 1) == 0;
}

unsigned passo_gcode_linear(const struct passo_gcode *gcode, unsigned letter)
{
	unsigned axis = 0;

	if (!passo_gcode_is_linear(gcode, letter))
		return gcode->settings.axes;
	for (unsigned before = 0; before < letter; before++)
		axis += passo_gcode_is_linear(gcode, before);
	return axis;
}
#endif

static unsigned tool_axis(const struct passo_gcode *gcode)
{
	return passo_gcode_linear(gcode, TOOL_LETTER);
}

int64_t passo_gcode_axis_value(const struct passo_gcode_check *check, unsigned axis)
{
	const char letter = passo_gcode_axis_letter(check->gcode->settings.left_out, axis);

	return letter >= 'X' ? passo_gcode_length_of(check, letter) : value_of(check, letter);
}

bool passo_gcode_in_range(int64_t nanometres)
{
	return nanometres <= PASSO_GCODE_COORDINATE_MAX && nanometres >= -PASSO_GCODE_COORDINATE_MAX;
}

/* Axis words without a command for them are those of the motion in force, as are the offsets of an arc. */
static enum passo_gcode_error find_user(struct passo_gcode_check *check)
{
	const passo_gcode_command motion = check->block.command[PASSO_GCODE_MOTION];
	const uint32_t offsets =
	    passo_gcode_is_arc(check->mode[PASSO_GCODE_MOTION])
		? check->block.words & (PASSO_GCODE_WORD('I') | PASSO_GCODE_WORD('J') | PASSO_GCODE_WORD('K'))
		: 0;

	check->moves = (motion != PASSO_GCODE_NONE && motion != PASSO_GCODE_G(80, 0))
	            || ((check->axis_words || offsets) && !check->block.takes_axes);
	check->unused &= ~check->axis_words;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_line_number(struct passo_gcode_check *check)
{
	if (passo_gcode_take(check, 'N') && whole_of(check, 'N') > LINE_NUMBER_MAX)
		return PASSO_GCODE_LINE_NUMBER;
	return PASSO_GCODE_OK;
}

static bool needs_feed(passo_gcode_command motion)
{
#ifndef PASSO_WITHOUT_THREADS
	if (passo_gcode_is_thread(motion))
		return false;
#endif
	return motion != PASSO_GCODE_G(0, 0) && motion != PASSO_GCODE_G(80, 0);
}

static bool is_per_turn(passo_gcode_command feed_mode)
{
	return feed_mode == PASSO_GCODE_G(95, 0);
}

/* In G93 each line that moves at a feed has its own; G94 and G95 keep it, but not that of another mode. */
static enum passo_gcode_error check_feed(struct passo_gcode_check *check)
{
	const passo_gcode_command motion = check->mode[PASSO_GCODE_MOTION];
	const bool given = passo_gcode_take(check, 'F');

	if (check->mode[PASSO_GCODE_FEED_MODE] == PASSO_GCODE_G(93, 0)) {
		if (check->moves && needs_feed(motion) && !given)
			return PASSO_GCODE_NO_FEED;
		check->inverse = given ? value_of(check, 'F') : 0;
	} else {
		const passo_gcode_command before = check->gcode->mode[PASSO_GCODE_FEED_MODE];
		const bool changes = PASSO_GCODE_HAS_TOOLS
		                  && is_per_turn(check->mode[PASSO_GCODE_FEED_MODE]) != is_per_turn(before);

		check->feed = given ? passo_gcode_length_of(check, 'F') : changes ? 0 : check->gcode->feed;
	}
	return PASSO_GCODE_OK;
}

#ifdef PASSO_PLAIN_GCODE
static enum passo_gcode_error check_change(struct passo_gcode_check *check)
{
	(void)check;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_table_length(struct passo_gcode_check *check)
{
	(void)check;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_port(struct passo_gcode_check *check)
{
	(void)check;
	return PASSO_GCODE_OK;
}
#else
/* M66: P is the input, L what is waited for, Q the most seconds. There is no analog one, E. */
static enum passo_gcode_error check_input(struct passo_gcode_check *check)
{
	struct passo_gcode_job *job = check->job;
	const bool analog = passo_gcode_take(check, 'E'), waits = passo_gcode_take(check, 'L');
	const int64_t wanted = waits ? whole_of(check, 'L') : 0;

	if (!passo_gcode_take(check, 'P') && !analog)
		return PASSO_GCODE_NO_VALUE;
	if (analog || whole_of(check, 'P') >= check->gcode->settings.inputs)
		return PASSO_GCODE_NO_PORT;
	if (waits && value_of(check, 'L') < 0)
		return PASSO_GCODE_NEGATIVE;
	if (wanted > PASSO_GCODE_WANTED_LOW)
		return PASSO_GCODE_UNSUPPORTED;
	job->timeout = passo_gcode_take(check, 'Q') ? (uint64_t)value_of(check, 'Q') : 0;
	if (wanted != PASSO_GCODE_WANTED_NOW && job->timeout == 0)
		return PASSO_GCODE_NO_VALUE;
	job->input = (uint8_t)whole_of(check, 'P');
	job->wanted = (uint8_t)wanted;
	job->listens = true;
	return PASSO_GCODE_OK;
}

/* M67, M68: E is the output, Q its share of full power in percent. */
static enum passo_gcode_error check_power(struct passo_gcode_check *check)
{
	const bool complete = passo_gcode_take(check, 'E') && passo_gcode_take(check, 'Q');
	const uint64_t full = 100 * (uint64_t)PASSO_GCODE_MILLION, share = (uint64_t)value_of(check, 'Q');

	if (!complete)
		return PASSO_GCODE_NO_VALUE;
	check->power = (uint32_t)passo_mul_div(share < full ? share : full, PASSO_GCODE_POWER_FULL, full);
	return whole_of(check, 'E') > 0 || !check->gcode->settings.power ? PASSO_GCODE_NO_PORT
	                                                                 : PASSO_GCODE_OK;
}

static enum passo_gcode_error check_port(struct passo_gcode_check *check)
{
	const passo_gcode_command command = check->block.command[PASSO_GCODE_PORT];

	if (command == PASSO_GCODE_NONE)
		return PASSO_GCODE_OK;
	if (command == PASSO_GCODE_M(66))
		return check_input(check);
	if (command >= PASSO_GCODE_M(67))
		return check_power(check);
	if (!passo_gcode_take(check, 'P'))
		return PASSO_GCODE_NO_VALUE;
	if (whole_of(check, 'P') >= PASSO_GCODE_DIGITALS)
		return PASSO_GCODE_NO_PORT;
	check->digital = (uint8_t)(1u << whole_of(check, 'P'));
	return PASSO_GCODE_OK;
}

/* M6 loads the tool of T; M61 says which one is loaded. */
static enum passo_gcode_error check_change(struct passo_gcode_check *check)
{
	const passo_gcode_command change = check->block.command[PASSO_GCODE_TOOL_CHANGE];
	const bool selects = passo_gcode_has_word(check, 'T');

	check->loaded = check->gcode->loaded;
	if (change == PASSO_GCODE_M(6))
		check->loaded = selects ? (uint8_t)whole_of(check, 'T') : check->gcode->tool;
	if (change != PASSO_GCODE_M(61))
		return PASSO_GCODE_OK;
	if (!passo_gcode_take(check, 'Q'))
		return PASSO_GCODE_NO_VALUE;
	check->loaded = (uint8_t)whole_of(check, 'Q');
	return whole_of(check, 'Q') > TOOL_MAX ? PASSO_GCODE_TOOL : PASSO_GCODE_OK;
}

/* G43: of H, or of the loaded tool; G43.2: adds that of H. Tool 0 has none. */
static enum passo_gcode_error check_table_length(struct passo_gcode_check *check)
{
	const passo_gcode_command command = check->block.command[PASSO_GCODE_TOOL_LENGTH];
	const bool adds = command == PASSO_GCODE_G(43, 2);

	if (command != PASSO_GCODE_G(43, 0) && !adds)
		return PASSO_GCODE_OK;
	const bool given = passo_gcode_take(check, 'H');
	const int64_t tool = given ? whole_of(check, 'H') : check->loaded;
	if (adds && !given)
		return PASSO_GCODE_NO_VALUE;
	if (tool > (int64_t)PASSO_GCODE_TOOLS)
		return PASSO_GCODE_TOOL;
	check->tool_length =
	    (adds ? check->tool_length : 0) + (tool > 0 ? check->gcode->offsets.tool_length[tool - 1] : 0);
	return PASSO_GCODE_OK;
}
#endif

static enum passo_gcode_error check_tool(struct passo_gcode_check *check)
{
	const passo_gcode_command length = check->block.command[PASSO_GCODE_TOOL_LENGTH];

	passo_gcode_take(check, 'S');
	if (passo_gcode_take(check, 'T') && whole_of(check, 'T') > TOOL_MAX)
		return PASSO_GCODE_TOOL;
	enum passo_gcode_error error = check_change(check);
#ifndef PASSO_PLAIN_GCODE
	if (error == PASSO_GCODE_OK)
		error = passo_gcode_check_spindle(check);
#endif
	if (error == PASSO_GCODE_OK)
		error = check_port(check);
	check->tool_length = length == PASSO_GCODE_G(49, 0) ? 0 : check->gcode->tool_length;
	if (length == PASSO_GCODE_G(43, 1)) {
		if (check->axis_words != PASSO_GCODE_WORD('Z'))
			return PASSO_GCODE_TOOL_AXIS;
		check->tool_length = passo_gcode_axis_value(check, tool_axis(check->gcode));
	}
	if (error == PASSO_GCODE_OK)
		error = check_table_length(check);
	if (error == PASSO_GCODE_OK && !passo_gcode_in_range(check->tool_length))
		error = PASSO_GCODE_TARGET;
	return error;
}

static int64_t tool_offset(const struct passo_gcode_check *check, unsigned axis)
{
	return axis == tool_axis(check->gcode) ? check->tool_length : 0;
}

int64_t passo_gcode_offset_of(const struct passo_gcode_check *check, unsigned axis)
{
	const struct passo_gcode *gcode = check->gcode;
	const unsigned system = (unsigned)(check->mode[PASSO_GCODE_SYSTEM] - 540) / 10;

	return gcode->offsets.system[system][axis] + gcode->shift[axis] + tool_offset(check, axis);
}

#ifndef PASSO_PLAIN_GCODE
/* G10 L1: the length of a tool. */
static enum passo_gcode_error check_entry(struct passo_gcode_check *check, int64_t tool)
{
	if (tool < 1 || tool > (int64_t)PASSO_GCODE_TOOLS)
		return PASSO_GCODE_TOOL;
	if (check->axis_words != PASSO_GCODE_WORD('Z'))
		return PASSO_GCODE_TOOL_AXIS;
	check->entry = (unsigned)tool;
	check->set[0] = passo_gcode_axis_value(check, tool_axis(check->gcode));
	check->job->offsets = true;
	return check->set[0] == (int32_t)check->set[0] ? PASSO_GCODE_OK : PASSO_GCODE_TARGET;
}
#endif

/* G10 L2: the offsets themselves; L20: such that the position gets the given coordinates. */
static enum passo_gcode_error check_g10(struct passo_gcode_check *check)
{
	const struct passo_gcode *gcode = check->gcode;

	if (check->axis_words == 0)
		return PASSO_GCODE_NO_AXIS_WORDS;
	if (!passo_gcode_take(check, 'P') || !passo_gcode_take(check, 'L'))
		return PASSO_GCODE_NO_VALUE;
	const int64_t number = whole_of(check, 'P'), kind = whole_of(check, 'L');
#ifndef PASSO_PLAIN_GCODE
	if (kind == 1 && !passo_gcode_has_word(check, 'R'))
		return check_entry(check, number);
#endif
	if (number > (int64_t)PASSO_GCODE_SYSTEMS)
		return PASSO_GCODE_COORDINATES;
	if ((kind != 2 && kind != 20) || (passo_gcode_has_word(check, 'R')))
		return PASSO_GCODE_UNSUPPORTED;
	check->system = (unsigned)(number > 0 ? number - 1 : (check->mode[PASSO_GCODE_SYSTEM] - 540) / 10);
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++) {
		const int64_t value = passo_gcode_axis_value(check, axis);
		const int64_t rest = gcode->position[axis] - gcode->shift[axis] - tool_offset(check, axis);

		check->set[axis] = gcode->offsets.system[check->system][axis];
		if (passo_gcode_has_axis(check, axis))
			check->set[axis] = kind == 2 ? value : rest - value;
		if (!passo_gcode_in_range(check->set[axis]))
			return PASSO_GCODE_TARGET;
	}
	check->job->offsets = true;
	return PASSO_GCODE_OK;
}

static enum passo_gcode_error check_g92(struct passo_gcode_check *check)
{
	const struct passo_gcode *gcode = check->gcode;

	if (check->axis_words == 0)
		return PASSO_GCODE_NO_AXIS_WORDS;
	for (unsigned axis = 0; axis < gcode->settings.axes; axis++) {
		const int64_t offset = passo_gcode_offset_of(check, axis) - gcode->shift[axis];

		check->set[axis] = gcode->shift[axis];
		if (passo_gcode_has_axis(check, axis))
			check->set[axis] =
			    gcode->position[axis] - offset - passo_gcode_axis_value(check, axis);
		if (!passo_gcode_in_range(check->set[axis]))
			return PASSO_GCODE_TARGET;
	}
	return PASSO_GCODE_OK;
}

/* Through the given point, then the given axes, or all, to the stored position. */
static enum passo_gcode_error check_return(struct passo_gcode_check *check, const int64_t *home)
{
	struct passo_gcode_job *job = check->job;
	const enum passo_gcode_error error = passo_gcode_find_target(check, job->stopover);

	for (unsigned axis = 0; axis < check->gcode->settings.axes; axis++) {
		const bool goes = check->axis_words == 0 || passo_gcode_has_axis(check, axis);

		job->destination[axis] = goes ? home[axis] : job->stopover[axis];
	}
	job->via = check->axis_words != 0;
	job->motion = true;
	job->feed = PASSO_PATH_RAPID;
	return error;
}

/* Whether P and Q of a line are those of a cycle, or of M66 to M68. */
static bool has_other_values(const struct passo_gcode_check *check)
{
#ifndef PASSO_PLAIN_GCODE
	if (check->block.command[PASSO_GCODE_PORT] >= PASSO_GCODE_M(66))
		return true;
#endif
	return check->moves && passo_gcode_is_cycle(check->mode[PASSO_GCODE_MOTION]);
}

/* G61, G61.1: every point is passed. G64: the tolerance is Q, or P alone, unless P is that of G4, G10 or
 * another command; without them it is 0, the path's own. */
static enum passo_gcode_error check_path(struct passo_gcode_check *check)
{
	const passo_gcode_command command = check->block.command[PASSO_GCODE_COMMAND];
	const passo_gcode_command path = check->block.command[PASSO_GCODE_PATH];
	char letter = '\0';

	check->tolerance = check->gcode->tolerance;
	if (path == PASSO_GCODE_NONE)
		return PASSO_GCODE_OK;
	check->tolerance = path == PASSO_GCODE_G(64, 0) ? 0 : PASSO_PATH_UNMERGED;
	if (path != PASSO_GCODE_G(64, 0) || has_other_values(check))
		return PASSO_GCODE_OK;
	if (command != PASSO_GCODE_G(4, 0) && command != PASSO_GCODE_G(10, 0) && passo_gcode_take(check, 'P'))
		letter = 'P';
	if (passo_gcode_take(check, 'Q'))
		letter = 'Q';
	if (letter == '\0')
		return PASSO_GCODE_OK;
	const int64_t length = passo_gcode_length_of(check, letter);
	check->tolerance = length > 0 ? (uint64_t)length * NANOMETRE : PASSO_PATH_UNMERGED;
	return passo_gcode_in_range(length) ? PASSO_GCODE_OK : PASSO_GCODE_TARGET;
}

static enum passo_gcode_error check_command(struct passo_gcode_check *check)
{
	switch (check->block.command[PASSO_GCODE_COMMAND]) {
	case PASSO_GCODE_G(4, 0):
		check->job->dwell = true;
		check->job->microseconds = (uint64_t)value_of(check, 'P');
		return passo_gcode_take(check, 'P') ? PASSO_GCODE_OK : PASSO_GCODE_NO_VALUE;
	case PASSO_GCODE_G(10, 0):
		return check_g10(check);
	case PASSO_GCODE_G(28, 0):
		return check_return(check, check->gcode->offsets.home[0]);
	case PASSO_GCODE_G(30, 0):
		return check_return(check, check->gcode->offsets.home[1]);
	case PASSO_GCODE_G(28, 1):
	case PASSO_GCODE_G(30, 1):
		check->job->offsets = true;
		return PASSO_GCODE_OK;
	case PASSO_GCODE_G(92, 0):
		return check_g92(check);
	default:
		return PASSO_GCODE_OK;
	}
}

enum passo_gcode_error passo_gcode_check_words(struct passo_gcode_check *check)
{
	static enum passo_gcode_error (*const CHECKS[])(struct passo_gcode_check *) = {
	    find_user, check_line_number, check_feed, check_tool, check_path, check_command};
	enum passo_gcode_error error = PASSO_GCODE_OK;

	for (unsigned i = 0; i < sizeof CHECKS / sizeof *CHECKS && error == PASSO_GCODE_OK; i++)
		error = CHECKS[i](check);
	return error;
}
