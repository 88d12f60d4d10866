/* SPDX-License-Identifier: MIT
 * Command table: each row has the keys and the function of a command.
 */
#include "passo_commands.h"

#include <string.h>

#include "passo_call.h"
#include "passo_number.h"

#define ROWS (PASSO_TABLE_SIZE / PASSO_POINTS_PER_LINE)

struct command {
	const char *name;
	bool (*run)(const struct passo_call *call);
	const struct passo_key *keys;
	uint8_t count;
	uint8_t bare; /* number of keys that can be given as values alone */
	bool passes;  /* is also executed while a move waits for room */
	const char *text;
};

#define CHANNEL {.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"}

static const struct passo_key CHANNEL_KEYS[] = {CHANNEL};
static const struct passo_key AXIS_KEYS[] = {PASSO_VALUE("axis", axis, AXIS, ""), CHANNEL};
static const struct passo_key ON_KEYS[] = {PASSO_VALUE("on", on, FLAG, NULL), CHANNEL};
static const struct passo_key PERCENT_KEYS[] = {PASSO_WHOLE("percent", number, 1, 100, NULL), CHANNEL};
static const struct passo_key RPM_KEYS[] = {PASSO_VALUE("rpm", rpm, NUMBER, NULL), CHANNEL};
static const struct passo_key HELP_KEYS[] = {
    {.name = "command", .reader = PASSO_READ_NOTHING, .otherwise = ""}};
static const struct passo_key TABLE_KEYS[] = {
    PASSO_WHOLE("row", number, 0, ROWS - 1u, ""),
    PASSO_VALUE("points", points, POINTS, ""),
};
static const struct passo_key ANGLE_KEYS[] = {
    PASSO_WHOLE("steps_per_turn", steps_per_turn, 1, UINT32_MAX, NULL),
    PASSO_VALUE("axis", axis, AXIS, "0"),
    CHANNEL,
};
static const struct passo_key TURN_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, "0"),
    PASSO_WHOLE("steps_per_turn", steps_per_turn, 1, UINT32_MAX, NULL),
    PASSO_VALUE("rpm", rpm, NUMBER, NULL),
    PASSO_VALUE("top_rpm", top_rpm, NUMBER, "rpm"),
    PASSO_VALUE("minimum_rpm", minimum_rpm, NUMBER, "0"),
    PASSO_VALUE("acceleration", acceleration, NUMBER, NULL),
    PASSO_VALUE("backwards", on, FLAG, "0"),
    CHANNEL,
};

bool passo_answer(const struct passo_call *call, enum passo_error error)
{
	if (error != PASSO_OK)
		return passo_complain_error(&call->console->sink, error);
	passo_say(&call->console->sink, "ok");
	return true;
}

int64_t passo_thousandths(int64_t value)
{
	return (value >> 32) * 1000 + (((value & UINT32_MAX) * 1000 + (INT64_C(1) << 31)) >> 32);
}

static bool run_help(const struct passo_call *call);

/* Commands without keys in their row read their own keys, or have none. */
#define TAKES(keys) (keys), PASSO_COUNT(keys)
static const struct command COMMANDS[] = {
    {"move", passo_run_move, NULL, 0, 0, false, "queue a move; help move lists its forms"},
    {"turn", passo_run_turn, TAKES(TURN_KEYS), 0, false, "rotate continuously, from rest"},
    {"rpm", passo_run_rpm, TAKES(RPM_KEYS), 1, false, "change the speed of the rotation; 0 ends it"},
    {"hold", passo_run_hold, TAKES(CHANNEL_KEYS), 0, true, "feed hold: slow down to rest on the path"},
    {"resume", passo_run_resume, TAKES(CHANNEL_KEYS), 0, true, "continue after hold"},
    {"override", passo_run_override, TAKES(PERCENT_KEYS), 1, true, "feed override of all motion, 1 to 100"},
    {"stop", passo_run_stop, TAKES(CHANNEL_KEYS), 0, true, "soft stop, flush the queues; then clear"},
    {"abort", passo_run_abort, TAKES(CHANNEL_KEYS), 0, true, "hard stop, flush the queues; then clear"},
    {"clear", passo_run_clear, TAKES(CHANNEL_KEYS), 0, false, "leave the stopped state"},
    {"status", passo_run_status, TAKES(CHANNEL_KEYS), 0, true, "state of the channel"},
    {"position", passo_run_position, TAKES(CHANNEL_KEYS), 0, true, "steps made by each axis"},
    {"angle", passo_run_angle, TAKES(ANGLE_KEYS), 1, true, "degrees of an axis and rpm of the motion"},
    {"enable", passo_run_enable, TAKES(AXIS_KEYS), 1, false, "enable the drive of an axis, or all"},
    {"disable", passo_run_disable, TAKES(AXIS_KEYS), 1, false, "disable it, at rest or when stopped"},
    {"zero", passo_run_zero, TAKES(CHANNEL_KEYS), 0, false, "set all positions to 0"},
    {"sync", passo_run_sync, TAKES(ON_KEYS), 1, true, "1: motions wait for start, or the sync input; 0: not"},
    {"start", passo_run_start, NULL, 0, 0, true, "start the waiting motions of all channels on one clock"},
    {"config", passo_run_config, NULL, 0, 0, false, "show or change settings; help config lists them"},
    {"table", passo_run_table, TAKES(TABLE_KEYS), 2, false, "load 16 of 256 points of a shape, or check it"},
    {"open", passo_run_open, NULL, 0, 0, false, "connect to the core again"},
    {"version", passo_run_version, NULL, 0, 0, true, "versions of console and core"},
    {"help", run_help, TAKES(HELP_KEYS), 1, true, "this list, or the keys of one command"},
};

static const struct command *find_command(const char *name)
{
	if (strcmp(name, "?") == 0)
		name = "help";
	for (unsigned i = 0; i < PASSO_COUNT(COMMANDS); i++) {
		if (strcmp(COMMANDS[i].name, name) == 0)
			return &COMMANDS[i];
	}
	return NULL;
}

static void show_keys(const struct passo_sink *sink, const struct command *command)
{
	if (command->run == passo_run_move) {
		passo_forms_help(sink);
	} else if (command->run == passo_run_config) {
		passo_config_help(sink);
	} else {
		passo_say(sink, "  %s", command->name);
		passo_keys_help(sink, command->keys, command->count);
		passo_say(sink, "\n");
	}
}

static bool run_help(const struct passo_call *call)
{
	const struct passo_sink *sink = &call->console->sink;
	const char *name = passo_words_find(call->words, "command");

	if (name != NULL) {
		const struct command *command = find_command(name);

		if (command == NULL)
			return passo_complain(sink, "unknown command %q", name);
		show_keys(sink, command);
	} else {
		for (unsigned i = 0; i < PASSO_COUNT(COMMANDS); i++)
			passo_say(sink, "  %s: %s\n", COMMANDS[i].name, COMMANDS[i].text);
	}
	return passo_answer(call, PASSO_OK);
}

static bool execute(const struct passo_call *call, const struct command *command)
{
	bool reads_itself = command->run == passo_run_move || command->run == passo_run_config;

	if (reads_itself)
		return command->run(call);
	return passo_keys_check(call->reading, command->keys, command->count, command->bare, call->words)
	    && passo_keys_read(call->reading, command->keys, command->count, call->words, call->values)
	    && command->run(call);
}

/* Reads which channel a line means, 0 unless it says; `channels` is 0 without a core. */
static bool find_channel(
    const struct passo_reading *reading, const struct passo_words *words, uint8_t channels, uint32_t *channel)
{
	const char *text = passo_words_find(words, CHANNEL_KEYS[0].name);
	const struct passo_item all = {.text = text, .length = text != NULL ? strlen(text) : 0u};

	*channel = 0;
	if (text == NULL)
		return true;
	if (!passo_number_whole(reading, CHANNEL_KEYS, all, 0, PASSO_CHANNELS_MAX - 1u, channel))
		return false;
	if (channels == 1u && *channel != 0u)
		return passo_complain(reading->sink, "the core has only channel 0, not %u", *channel);
	if (channels != 0u && *channel >= channels)
		return passo_complain(reading->sink, "the core has channels 0 to %u, not %u",
		    (uint32_t)channels - 1u, *channel);
	return true;
}

void passo_commands_execute(struct passo_console *console, char *line)
{
	struct passo_words words;
	struct passo_values values = {.on = true};
	struct passo_reading reading = {.sink = &console->sink,
	    .clock_hz = console->clock_hz,
	    .axes = console->opened ? passo_machine(&console->channel[0].passo)->axes : PASSO_AXES_MAX};
	struct passo_call call = {
	    .console = console, .reading = &reading, .words = &words, .values = &values};
	uint32_t channel;
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
	if (console->waits && !command->passes) {
		passo_complain(&console->sink, "WAITING: a move waits for room: send %s after its answer",
		    command->name);
		return;
	}
	words.count--;
	memmove(&words.word[0], &words.word[1], words.count * sizeof words.word[0]);
	if (!find_channel(&reading, &words, passo_commands_channels(console), &channel))
		return;
	call.channel = &console->channel[channel];
	if (execute(&call, command))
		passo_say(&console->sink, "\n");
}

void passo_commands_try_again(struct passo_console *console)
{
	char line[PASSO_LINE_MAX + 1u];

	memcpy(line, console->waiting, sizeof line);
	console->waits = false;
	passo_commands_execute(console, line);
}

void passo_say_error_note(struct passo_console *console, enum passo_error error)
{
	if (error != PASSO_OK)
		passo_say(&console->sink, "note: %s: %s\n", passo_error_name(error), passo_error_text(error));
}
