/* SPDX-License-Identifier: MIT
 * Lines: finds the command, its channel and its keys, and executes it.
 */
#include "passo_commands.h"

#include <string.h>

#include "passo_call.h"
#include "passo_command_table.h"
#include "passo_number.h"

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

static void show_keys(const struct passo_sink *sink, const struct passo_command *command)
{
	if (command->run == passo_run_move) {
		passo_forms_help(sink);
		passo_output_help(sink);
	} else if (command->run == passo_run_config) {
		passo_config_help(sink);
	} else {
		passo_say(sink, "  %s", command->name);
		passo_keys_help(sink, command->keys, command->count);
		passo_say(sink, "\n");
	}
}

bool passo_run_help(const struct passo_call *call)
{
	const struct passo_sink *sink = &call->console->sink;
	const char *name = passo_words_find(call->words, "command");

	if (name != NULL) {
		const struct passo_command *command = passo_command_find(name);

		if (command == NULL)
			return passo_complain(sink, "unknown command %q", name);
		show_keys(sink, command);
	} else {
		for (unsigned i = 0; i < passo_command_count; i++)
			passo_say(
			    sink, "  %s: %s\n", passo_command_table[i].name, passo_command_table[i].text);
	}
	return passo_answer(call, PASSO_OK);
}

static bool execute(const struct passo_call *call, const struct passo_command *command)
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
	const char *text = passo_words_find(words, passo_channel_key.name);
	const struct passo_item all = {.text = text, .length = text != NULL ? strlen(text) : 0u};

	*channel = 0;
	if (text == NULL)
		return true;
	if (!passo_number_whole(reading, &passo_channel_key, all, 0, PASSO_CHANNELS_MAX - 1u, channel))
		return false;
	if (channels == 1u && *channel != 0u)
		return passo_complain(reading->sink, "channel must be 0, not %u", *channel);
	if (channels != 0u && *channel >= channels)
		return passo_complain(
		    reading->sink, "channel must be 0 to %u, not %u", (uint32_t)channels - 1u, *channel);
	return true;
}

void passo_commands_execute(struct passo_console *console, char *line)
{
	struct passo_words words;
	struct passo_values values = {.on = true};
	struct passo_reading reading = {.sink = &console->sink,
	    .clock_hz = console->clock_hz,
	    .axes = console->opened ? passo_axes(&console->channel[0].passo) : PASSO_AXES_MAX};
	struct passo_call call = {
	    .console = console, .reading = &reading, .words = &words, .values = &values};
	uint32_t channel;
	const struct passo_command *command;

	line[strcspn(line, "#")] = '\0';
	if (!passo_words_split(&console->sink, line, &words))
		return;
	if (words.count == 0u) {
		passo_say(&console->sink, "ok\n");
		return;
	}
	command = *words.word[0].key == '\0' ? passo_command_find(words.word[0].value) : NULL;
	if (command == NULL) {
		passo_complain(&console->sink, "unknown command %q; help lists the commands",
		    *words.word[0].key == '\0' ? words.word[0].value : words.word[0].key);
		return;
	}
	if (console->waits && !command->passes) {
		passo_complain(&console->sink, "WAITING: %s: send %s after its answer",
		    passo_tasks_name(console->waits), command->name);
		return;
	}
	words.count--;
	for (unsigned i = 0; i < words.count; i++)
		words.word[i] = words.word[i + 1u];
	if (!find_channel(&reading, &words, passo_commands_channels(console), &channel))
		return;
	call.channel = &console->channel[channel];
	if (execute(&call, command))
		passo_say(&console->sink, "\n");
}

void passo_commands_try_again(struct passo_console *console)
{
	char line[PASSO_LINE_MAX + 1u];

	if (console->waits != PASSO_AWAITS_ROOM) {
		passo_tasks_try_again(console);
		return;
	}
	memcpy(line, console->waiting, sizeof line);
	console->waits = PASSO_AWAITS_NOTHING;
	passo_commands_execute(console, line);
}

void passo_say_error_note(struct passo_console *console, enum passo_error error)
{
	if (error != PASSO_OK)
		passo_say(&console->sink, "note: %s: %s\n", passo_error_name(error), passo_error_text(error));
}
