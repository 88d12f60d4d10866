/* SPDX-License-Identifier: MIT
 * Each command is a row of the table below: its keys, and what it does. It says "ok" with what it has to
 * tell, or complains, and returns whether the end of the line is still to be said.
 */
#include "passo_commands.h"

#include <string.h>

#define BAUD_MIN 115200u
#define BAUD_MAX 1000000u
#define CLOCK_HZ_MIN 1000000u
#define ROWS (PASSO_TABLE_SIZE / PASSO_POINTS_PER_LINE)

#define COUNT(table) (sizeof(table) / sizeof(table)[0])

/* The values of all commands but `move`. */
struct values {
	uint8_t axis;
	uint32_t number; /* percent, row */
	uint16_t points[PASSO_POINTS_PER_LINE];
	bool on;
	uint32_t steps_per_turn;
	uint64_t rpm, top_rpm, minimum_rpm, acceleration;
	uint32_t clock_hz, baud, hold_microseconds, stop_microseconds;
	struct passo_axis_config config;
};

/* What a command works with. */
struct call {
	struct passo_console *console;
	struct passo_reading *reading;
	struct passo_words *words;
	struct values *values;
};

struct command {
	const char *name;
	bool (*run)(const struct call *call);
	const struct passo_key *keys;
	uint8_t count;
	uint8_t bare; /* so many of the keys can be given as values alone */
	const char *text;
};

#define VALUE(text, member, read, default_text)                                                              \
	{.name = (text),                                                                                     \
	    .reader = PASSO_READ_##read,                                                                     \
	    .otherwise = (default_text),                                                                     \
	    .offset = offsetof(struct values, member)}
#define WHOLE(text, member, lowest, highest, default_text)                                                   \
	{.name = (text),                                                                                     \
	    .reader = PASSO_READ_WHOLE,                                                                      \
	    .otherwise = (default_text),                                                                     \
	    .low = (lowest),                                                                                 \
	    .high = (highest),                                                                               \
	    .offset = offsetof(struct values, member)}

static const struct passo_key AXIS_KEYS[] = {VALUE("axis", axis, AXIS, "")};
static const struct passo_key ON_KEYS[] = {VALUE("on", on, FLAG, NULL)};
static const struct passo_key PERCENT_KEYS[] = {WHOLE("percent", number, 1, 100, NULL)};
static const struct passo_key RPM_KEYS[] = {VALUE("rpm", rpm, NUMBER, NULL)};
static const struct passo_key HELP_KEYS[] = {
    {.name = "command", .reader = PASSO_READ_NOTHING, .otherwise = ""}};
static const struct passo_key TABLE_KEYS[] = {
    WHOLE("row", number, 0, ROWS - 1u, ""),
    VALUE("points", points, POINTS, ""),
};
static const struct passo_key ANGLE_KEYS[] = {
    WHOLE("steps_per_turn", steps_per_turn, 1, UINT32_MAX, NULL),
    VALUE("axis", axis, AXIS, "0"),
};
static const struct passo_key TURN_KEYS[] = {
    VALUE("axis", axis, AXIS, "0"),
    WHOLE("steps_per_turn", steps_per_turn, 1, UINT32_MAX, NULL),
    VALUE("rpm", rpm, NUMBER, NULL),
    VALUE("top_rpm", top_rpm, NUMBER, "rpm"),
    VALUE("minimum_rpm", minimum_rpm, NUMBER, "0"),
    VALUE("acceleration", acceleration, NUMBER, NULL),
    VALUE("backwards", on, FLAG, "0"),
};
static const struct passo_key CONFIG_AXIS_KEYS[] = {
    VALUE("axis", axis, AXIS, NULL),
    VALUE("step_high", config.step_high_ns, PIN_TIME, ""),
    VALUE("step_low", config.step_low_ns, PIN_TIME, ""),
    VALUE("dir_setup", config.dir_setup_ns, PIN_TIME, ""),
    VALUE("dir_hold", config.dir_hold_ns, PIN_TIME, ""),
    VALUE("step_inverted", config.step_inverted, FLAG, ""),
    VALUE("direction_inverted", config.direction_inverted, FLAG, ""),
    VALUE("enable_inverted", config.enable_inverted, FLAG, ""),
    VALUE("both_edges", config.both_edges, FLAG, ""),
    VALUE("steps_per_unit", config.steps_per_unit, NUMBER, ""),
};
static const struct passo_key CONFIG_KEYS[] = {
    WHOLE("clock_hz", clock_hz, CLOCK_HZ_MIN, UINT32_MAX, ""),
    VALUE("hold_time", hold_microseconds, MICROSECONDS, ""),
    VALUE("stop_time", stop_microseconds, MICROSECONDS, ""),
    WHOLE("baud", baud, BAUD_MIN, BAUD_MAX, ""),
    VALUE("spi_slow", on, FLAG, ""),
};

/* "ok", or the complaint. */
static bool answer(const struct call *call, enum passo_error error)
{
	if (error != PASSO_OK)
		return passo_complain_error(&call->console->sink, error);
	passo_say(&call->console->sink, "ok");
	return true;
}

/* In thousandths, to the nearest; `value` has 32 binary places. */
static int64_t thousandths(int64_t value)
{
	return (value >> 32) * 1000 + (((value & UINT32_MAX) * 1000 + (INT64_C(1) << 31)) >> 32);
}

/* -------------------------------------------------------------------------------------------- motion ---- */

static bool run_move(const struct call *call)
{
	struct passo_console *console = call->console;

	return passo_forms_move(&console->passo, call->reading, call->words, &console->table)
	    && answer(call, PASSO_OK);
}

static bool run_turn(const struct call *call)
{
	const struct values *values = call->values;
	struct passo_turning turning = {.axis = values->axis,
	    .steps_per_turn = values->steps_per_turn,
	    .backwards = values->on,
	    .top_rpm = values->top_rpm,
	    .minimum_rpm = values->minimum_rpm,
	    .acceleration = values->acceleration};

	return answer(call, passo_turn_start(&call->console->passo, &turning, values->rpm));
}

static bool run_rpm(const struct call *call)
{
	struct passo *passo = &call->console->passo;
	uint64_t rpm = call->values->rpm;

	return answer(call, rpm == 0u ? passo_turn_stop(passo) : passo_turn_speed(passo, rpm));
}

static bool run_hold(const struct call *call)
{
	return answer(call, passo_hold(&call->console->passo));
}

static bool run_resume(const struct call *call)
{
	return answer(call, passo_resume(&call->console->passo));
}

static bool run_override(const struct call *call)
{
	return answer(call, passo_override(&call->console->passo, call->values->number));
}

static bool run_stop(const struct call *call)
{
	return answer(call, passo_stop(&call->console->passo));
}

static bool run_abort(const struct call *call)
{
	return answer(call, passo_abort(&call->console->passo));
}

static bool run_sync(const struct call *call)
{
	return answer(call, passo_wait_for_sync(&call->console->passo, call->values->on));
}

static bool run_zero(const struct call *call)
{
	return answer(call, passo_zero(&call->console->passo));
}

/* Of one axis, or of all. */
static bool run_enable(const struct call *call)
{
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; axis < call->reading->axes && error == PASSO_OK; axis++) {
		if (call->reading->given == 0u || axis == call->values->axis)
			error = passo_enable(&call->console->passo, axis, call->values->on);
	}
	return answer(call, error);
}

static bool run_disable(const struct call *call)
{
	call->values->on = false;
	return run_enable(call);
}

/* ------------------------------------------------------------------------------------------- reading ---- */

static bool run_status(const struct call *call)
{
	static const char *const CAUSES[] = {
	    [PASSO_CAUSE_NONE] = "NONE",
	    [PASSO_CAUSE_STOP] = "STOP",
	    [PASSO_CAUSE_ABORT] = "ABORT",
	    [PASSO_CAUSE_LINE_UNDERRUN] = "LINE_UNDERRUN",
	    [PASSO_CAUSE_RAMP_UNDERRUN] = "RAMP_UNDERRUN",
	    [PASSO_CAUSE_STEP_OVERRUN] = "STEP_OVERRUN",
	};
	struct passo_console *console = call->console;
	struct passo_snapshot now;

	if (!answer(call, passo_read_state(&console->passo, &now)))
		return false;
	passo_say(&console->sink, " state=%s cause=%s moving=%u rate=%m", passo_state_name(now.state),
	    now.cause < COUNT(CAUSES) ? CAUSES[now.cause] : "?", (uint32_t)passo_is_moving(&console->passo),
	    (int64_t)now.rate * 100000 / PASSO_RATE_FULL);
	passo_say(&console->sink, " lines=%u ramps=%u drained=%u overrun=%u fault=%s retries=%u",
	    (uint32_t)now.line_room, (uint32_t)now.ramp_room, (uint32_t)now.drained, (uint32_t)now.overrun,
	    passo_error_name(passo_fault(&console->passo)), console->host.counters.retries);
	if (console->board.lost_bytes)
		passo_say(
		    &console->sink, " lost_bytes=%u", console->board.lost_bytes(console->board.context));
	return true;
}

static bool run_position(const struct call *call)
{
	int32_t positions[PASSO_AXES_MAX];

	if (!answer(call, passo_positions(&call->console->passo, positions)))
		return false;
	for (unsigned axis = 0; axis < call->reading->axes; axis++)
		passo_say(&call->console->sink, axis == 0u ? " position=%d" : ",%d", positions[axis]);
	return true;
}

static bool run_angle(const struct call *call)
{
	const struct values *values = call->values;
	struct passo *passo = &call->console->passo;
	int64_t degrees;
	uint64_t rpm;
	enum passo_error error = passo_angle(passo, values->axis, values->steps_per_turn, &degrees);

	if (error == PASSO_OK)
		error = passo_rpm(passo, values->steps_per_turn, &rpm);
	if (!answer(call, error))
		return false;
	passo_say(&call->console->sink, " angle=%m rpm=%m", thousandths(degrees), thousandths((int64_t)rpm));
	return true;
}

static bool run_version(const struct call *call)
{
	struct passo_console *console = call->console;
	uint32_t version;

	if (!answer(call, passo_host_read(&console->host, PASSO_ADDRESS_VERSION, &version, 1)))
		return false;
	passo_say(&console->sink, " console=" PASSO_CONSOLE_VERSION " core=%u.%u.%u axes=%u clock_hz=%u",
	    version >> 16, version >> 8 & 0xFFu, version & 0xFFu, (uint32_t)call->reading->axes,
	    console->clock_hz);
	return true;
}

/* ------------------------------------------------------------------------------------------ settings ---- */

void passo_commands_reset_axes(struct passo_console *console)
{
	uint32_t clocks = (console->clock_hz + 999999u) / 1000000u;

	for (unsigned axis = 0; axis < PASSO_AXES_MAX; axis++)
		console->axis[axis] = (struct passo_axis_config){.in_clocks = true,
		    .step_high_ns = clocks,
		    .step_low_ns = clocks,
		    .dir_setup_ns = clocks,
		    .dir_hold_ns = clocks};
}

/* Give the core the settings. */
static enum passo_error set_up(struct passo_console *console)
{
	struct passo *passo = &console->passo;
	enum passo_error error =
	    passo_configure_motion(passo, console->hold_microseconds, console->stop_microseconds, 0);

	for (uint8_t axis = 0; axis < passo_machine(passo)->axes && error == PASSO_OK; axis++)
		error = passo_configure_axis(passo, axis, &console->axis[axis]);
	console->unset = error != PASSO_OK;
	return error;
}

enum passo_error passo_commands_open(struct passo_console *console)
{
	const struct passo_options options = {.clock_hz = console->clock_hz};
	enum passo_error error = passo_open(&console->passo, &console->host, &console->hardware, &options);

	console->opened = error == PASSO_OK || error == PASSO_ERROR_MOVING;
	console->unset = true;
	console->noted = PASSO_OK;
	return error == PASSO_OK ? set_up(console) : error;
}

/* A core that was reset does not move any more, whatever was queued. */
static bool is_moving(const struct passo_console *console)
{
	return console->opened && !console->host.lost && passo_is_moving(&console->passo);
}

static bool run_open(const struct call *call)
{
	if (is_moving(call->console))
		return answer(call, PASSO_ERROR_MOVING);
	return answer(call, passo_commands_open(call->console));
}

static bool run_clear(const struct call *call)
{
	enum passo_error error = passo_clear(&call->console->passo);

	if (error == PASSO_OK && call->console->unset)
		error = set_up(call->console);
	return answer(call, error);
}

/* Only what is given changes. */
static bool config_axis(const struct call *call)
{
	struct passo_console *console = call->console;
	struct passo_axis_config *config = &call->values->config;
	uint8_t axis;

	if (!passo_keys_check(call->reading, CONFIG_AXIS_KEYS, COUNT(CONFIG_AXIS_KEYS), 0, call->words)
	    || !passo_keys_read(call->reading, CONFIG_AXIS_KEYS, 1, call->words, call->values))
		return false;
	axis = call->values->axis;
	*config = console->axis[axis];
	if (!passo_keys_read(
		call->reading, CONFIG_AXIS_KEYS, COUNT(CONFIG_AXIS_KEYS), call->words, call->values))
		return false;
	if (call->words->count > 1u) {
		if (console->opened && !answer(call, passo_configure_axis(&console->passo, axis, config)))
			return false;
		console->axis[axis] = *config;
		return console->opened || answer(call, PASSO_OK);
	}
	passo_say(&console->sink, "ok axis=%u step_high=%uclocks step_low=%uclocks dir_setup=%uclocks",
	    (uint32_t)axis, config->step_high_ns, config->step_low_ns, config->dir_setup_ns);
	passo_say(&console->sink, " dir_hold=%uclocks step_inverted=%u direction_inverted=%u",
	    config->dir_hold_ns, (uint32_t)config->step_inverted, (uint32_t)config->direction_inverted);
	passo_say(&console->sink, " enable_inverted=%u both_edges=%u steps_per_unit=%m",
	    (uint32_t)config->enable_inverted, (uint32_t)config->both_edges,
	    thousandths((int64_t)config->steps_per_unit));
	return true;
}

/* Another clock means that all times are others: the core is opened anew, with the settings of a start. */
static enum passo_error set_clock(struct passo_console *console, uint32_t clock_hz)
{
	if (is_moving(console))
		return PASSO_ERROR_MOVING;
	console->clock_hz = clock_hz;
	passo_commands_reset_axes(console);
	return passo_commands_open(console);
}

static bool config_board(const struct call *call)
{
	struct passo_console *console = call->console;
	const struct passo_console_board *board = &console->board;
	bool has_clock = passo_words_find(call->words, "clock_hz") != NULL;
	bool has_baud = passo_words_find(call->words, "baud") != NULL;
	bool has_spi = passo_words_find(call->words, "spi_slow") != NULL;
	struct values *values = call->values;
	enum passo_error error = PASSO_OK;

	values->hold_microseconds = console->hold_microseconds;
	values->stop_microseconds = console->stop_microseconds;
	if (!passo_keys_check(call->reading, CONFIG_KEYS, COUNT(CONFIG_KEYS), 0, call->words)
	    || !passo_keys_read(call->reading, CONFIG_KEYS, COUNT(CONFIG_KEYS), call->words, values))
		return false;
	if ((has_baud && board->set_baud == NULL) || (has_spi && board->set_spi_fast == NULL))
		return passo_complain(&console->sink, "there is no board whose lines could be set");
	if (has_clock)
		error = set_clock(console, values->clock_hz);
	if (error == PASSO_OK && console->opened)
		error = passo_configure_motion(
		    &console->passo, values->hold_microseconds, values->stop_microseconds, 0);
	if (!answer(call, error))
		return false;
	console->hold_microseconds = values->hold_microseconds;
	console->stop_microseconds = values->stop_microseconds;
	if (has_spi) {
		console->spi_slow = values->on;
		board->set_spi_fast(board->context, !values->on);
	}
	if (has_baud) {
		console->baud = values->baud;
		passo_say(&console->sink, "\n"); /* before the other speed */
		board->set_baud(board->context, values->baud);
	}
	return !has_baud;
}

static bool run_config(const struct call *call)
{
	struct passo_console *console = call->console;

	if (passo_words_find(call->words, "axis") != NULL)
		return config_axis(call);
	if (call->words->count > 0u)
		return config_board(call);
	passo_say(&console->sink, "ok clock_hz=%u hold_time=%uus stop_time=%uus", console->clock_hz,
	    console->hold_microseconds, console->stop_microseconds);
	if (console->board.set_baud)
		passo_say(&console->sink, " baud=%u spi_slow=%u", console->baud, (uint32_t)console->spi_slow);
	return true;
}

/* Load a row, or tell what the table is. */
static bool run_table(const struct call *call)
{
	struct passo_loaded_table *table = &call->console->table;
	const struct passo_sink *sink = &call->console->sink;
	uint32_t row = call->values->number;
	struct passo_table_facts facts;
	enum passo_plan_error error;

	if (call->reading->given == 1u || call->reading->given == 2u)
		return passo_complain(sink, "row and points belong together");
	if (call->reading->given != 0u) {
		memcpy(table->points + row * PASSO_POINTS_PER_LINE, call->values->points,
		    sizeof call->values->points);
		table->loaded |= (uint16_t)(1u << row);
		return answer(call, PASSO_OK);
	}
	if (table->loaded != PASSO_TABLE_LOADED)
		return passo_complain(sink, "table is missing");
	error = passo_table_check(table->points, &facts);
	if (error != PASSO_PLAN_OK)
		return passo_complain(sink, "%s: point %u: %s", passo_plan_error_name(error),
		    (uint32_t)facts.worst, passo_plan_error_text(error));
	passo_say(
	    sink, "ok mean=%m symmetric=%u", (int64_t)facts.mean * 1000 >> 24, (uint32_t)facts.symmetric);
	return true;
}

/* ---------------------------------------------------------------------------------------------- table ----
 */

static bool run_help(const struct call *call);

/* What a command is and takes. Those without a number of keys read their own. */
#define TAKES(keys) (keys), COUNT(keys)
static const struct command COMMANDS[] = {
    {"move", run_move, NULL, 0, 0, "queue a move; help move lists its forms"},
    {"turn", run_turn, TAKES(TURN_KEYS), 0, "turn without end, from rest"},
    {"rpm", run_rpm, TAKES(RPM_KEYS), 1, "another speed while turning without end; 0 ends it"},
    {"hold", run_hold, NULL, 0, 0, "slow down along the path, to 0"},
    {"resume", run_resume, NULL, 0, 0, "go on after hold"},
    {"override", run_override, TAKES(PERCENT_KEYS), 1, "slow down all motion to a percentage"},
    {"stop", run_stop, NULL, 0, 0, "slow down, stop, drop what is queued; then clear"},
    {"abort", run_abort, NULL, 0, 0, "stop at once, drop what is queued; then clear"},
    {"clear", run_clear, NULL, 0, 0, "leave the stopped state"},
    {"status", run_status, NULL, 0, 0, "what the channel does"},
    {"position", run_position, NULL, 0, 0, "steps made by each axis"},
    {"angle", run_angle, TAKES(ANGLE_KEYS), 1, "degrees of an axis and rpm of the motion"},
    {"enable", run_enable, TAKES(AXIS_KEYS), 1, "switch on the drive of an axis, or all"},
    {"disable", run_disable, TAKES(AXIS_KEYS), 1, "switch it off, at rest or when stopped"},
    {"zero", run_zero, NULL, 0, 0, "call the present positions 0"},
    {"sync", run_sync, TAKES(ON_KEYS), 1, "let motions wait for the sync input, or no longer"},
    {"config", run_config, NULL, 0, 0, "show or change settings; help config lists them"},
    {"table", run_table, TAKES(TABLE_KEYS), 2, "load 16 of the 256 points of a shape, or check it"},
    {"open", run_open, NULL, 0, 0, "make contact with the core again"},
    {"version", run_version, NULL, 0, 0, "of console and core"},
    {"help", run_help, TAKES(HELP_KEYS), 1, "this list, or the keys of one command"},
};

static const struct command *find_command(const char *name)
{
	for (unsigned i = 0; i < COUNT(COMMANDS); i++) {
		if (strcmp(COMMANDS[i].name, name) == 0)
			return &COMMANDS[i];
	}
	return NULL;
}

static void show_keys(const struct passo_sink *sink, const struct command *command)
{
	if (command->run == run_move) {
		passo_forms_help(sink);
	} else if (command->run == run_config) {
		passo_say(sink, "  config");
		passo_keys_help(sink, CONFIG_AXIS_KEYS, COUNT(CONFIG_AXIS_KEYS));
		passo_say(sink, "\n  config");
		passo_keys_help(sink, CONFIG_KEYS, COUNT(CONFIG_KEYS));
		passo_say(sink, "\n");
	} else {
		passo_say(sink, "  %s", command->name);
		passo_keys_help(sink, command->keys, command->count);
		passo_say(sink, "\n");
	}
}

static bool run_help(const struct call *call)
{
	const struct passo_sink *sink = &call->console->sink;
	const char *name = passo_words_find(call->words, "command");

	if (name != NULL) {
		const struct command *command = find_command(name);

		if (command == NULL)
			return passo_complain(sink, "unknown command %q", name);
		show_keys(sink, command);
	} else {
		for (unsigned i = 0; i < COUNT(COMMANDS); i++)
			passo_say(sink, "  %s: %s\n", COMMANDS[i].name, COMMANDS[i].text);
	}
	return answer(call, PASSO_OK);
}

static bool execute(const struct call *call, const struct command *command)
{
	bool reads_itself = command->run == run_move || command->run == run_config;

	if (reads_itself)
		return command->run(call);
	return passo_keys_check(call->reading, command->keys, command->count, command->bare, call->words)
	    && passo_keys_read(call->reading, command->keys, command->count, call->words, call->values)
	    && command->run(call);
}

void passo_commands_execute(struct passo_console *console, char *line)
{
	struct passo_words words;
	struct values values = {.on = true};
	struct passo_reading reading = {.sink = &console->sink,
	    .clock_hz = console->clock_hz,
	    .axes = console->opened ? passo_machine(&console->passo)->axes : PASSO_AXES_MAX};
	const struct call call = {console, &reading, &words, &values};
	const struct command *command;
	char *comment = strchr(line, '#');

	if (comment)
		*comment = '\0';
	if (!passo_words_split(&console->sink, line, &words))
		return;
	if (words.count == 0u) {
		passo_say(&console->sink, "ok\n");
		return;
	}
	command = *words.word[0].key == '\0' ? find_command(words.word[0].value) : NULL;
	if (command == NULL) {
		passo_complain(&console->sink, "unknown command %q; help lists the commands",
		    *words.word[0].key == '\0' ? words.word[0].value : words.word[0].key);
		return;
	}
	words.count--;
	memmove(&words.word[0], &words.word[1], words.count * sizeof words.word[0]);
	if (execute(&call, command))
		passo_say(&console->sink, "\n");
}

void passo_say_error_note(struct passo_console *console, enum passo_error error)
{
	if (error != PASSO_OK)
		passo_say(&console->sink, "note: %s: %s\n", passo_error_name(error), passo_error_text(error));
}
