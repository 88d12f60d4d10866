/* SPDX-License-Identifier: MIT
 * Commands that open and configure the core.
 */
#include <string.h>

#include "passo_call.h"
#include "passo_commands.h"
#include "passo_value.h"

#define BAUD_MIN 115200u
#define BAUD_MAX 1000000u
#define CLOCK_HZ_MIN 1000000u

static const struct passo_key CONFIG_AXIS_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, NULL),
    {.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"},
    PASSO_VALUE("step_high", config.step_high_ns, PIN_TIME, ""),
    PASSO_VALUE("step_low", config.step_low_ns, PIN_TIME, ""),
    PASSO_VALUE("dir_setup", config.dir_setup_ns, PIN_TIME, ""),
    PASSO_VALUE("dir_hold", config.dir_hold_ns, PIN_TIME, ""),
    PASSO_VALUE("step_inverted", config.step_inverted, FLAG, ""),
    PASSO_VALUE("direction_inverted", config.direction_inverted, FLAG, ""),
    PASSO_VALUE("enable_inverted", config.enable_inverted, FLAG, ""),
    PASSO_VALUE("both_edges", config.both_edges, FLAG, ""),
    PASSO_VALUE("steps_per_unit", config.steps_per_unit, NUMBER, ""),
};
static const struct passo_key CONFIG_KEYS[] = {
    PASSO_WHOLE("clock_hz", clock_hz, CLOCK_HZ_MIN, UINT32_MAX, ""),
    PASSO_VALUE("hold_time", hold_microseconds, MICROSECONDS, ""),
    PASSO_VALUE("stop_time", stop_microseconds, MICROSECONDS, ""),
    PASSO_VALUE("flow", flow_waits, FLOW, ""),
    PASSO_VALUE("need_enable", need_enable, FLAG, ""),
    PASSO_WHOLE("baud", baud, BAUD_MIN, BAUD_MAX, ""),
    PASSO_VALUE("spi_slow", on, FLAG, ""),
    PASSO_VALUE("input_filter", filter_microseconds, MICROSECONDS, ""),
    PASSO_VALUE("watchdog", watchdog_microseconds, MICROSECONDS, ""),
    PASSO_VALUE("watchdog_disable", disable_microseconds, MICROSECONDS, ""),
};

/* Changes only the settings that are given. */
static bool config_axis(const struct passo_call *call)
{
	struct passo_console *console = call->console;
	struct passo_axis_config *config = &call->values->config;
	uint8_t axis;

	if (!passo_keys_check(call->reading, CONFIG_AXIS_KEYS, PASSO_COUNT(CONFIG_AXIS_KEYS), 0, call->words)
	    || !passo_keys_read(call->reading, CONFIG_AXIS_KEYS, 1, call->words, call->values))
		return false;
	axis = call->values->axis;
	*config = call->channel->axis[axis];
	if (!passo_keys_read(
		call->reading, CONFIG_AXIS_KEYS, PASSO_COUNT(CONFIG_AXIS_KEYS), call->words, call->values))
		return false;
	if (call->reading->given >> 2 != 0u) { /* more than axis and channel */
		if (console->opened
		    && !passo_answer(call, passo_configure_axis(&call->channel->passo, axis, config)))
			return false;
		call->channel->axis[axis] = *config;
		return console->opened || passo_answer(call, PASSO_OK);
	}
	passo_say(&console->sink, "ok axis=%u step_high=%uclocks step_low=%uclocks dir_setup=%uclocks",
	    (uint32_t)axis, config->step_high_ns, config->step_low_ns, config->dir_setup_ns);
	passo_say(&console->sink, " dir_hold=%uclocks step_inverted=%u direction_inverted=%u",
	    config->dir_hold_ns, (uint32_t)config->step_inverted, (uint32_t)config->direction_inverted);
	passo_say(&console->sink, " enable_inverted=%u both_edges=%u steps_per_unit=%m",
	    (uint32_t)config->enable_inverted, (uint32_t)config->both_edges,
	    passo_thousandths((int64_t)config->steps_per_unit));
	return true;
}

/* A new clock changes all times: the core is reopened with default settings; one of another clock, soon after
 * with its own. */
static enum passo_error set_clock(struct passo_console *console, uint32_t clock_hz)
{
	enum passo_error error;

	if (passo_commands_is_moving(console))
		return PASSO_ERROR_MOVING;
	console->clock_hz = console->given_hz = clock_hz;
	passo_commands_reset_times(console);
	error = passo_commands_open(console);
	if (error == PASSO_ERROR_CLOCK)
		console->given_hz = 0;
	return error;
}

/* Filter and watchdog of the core. */
static enum passo_error set_core(struct passo_console *console, const struct passo_values *values)
{
	const uint32_t filter = console->filter_microseconds, watchdog = console->watchdog_microseconds,
		       disable = console->disable_microseconds;
	enum passo_error error = console->opened ? PASSO_ERROR_NO_INPUTS : PASSO_ERROR_NOT_OPEN;

	console->filter_microseconds = values->filter_microseconds;
	console->watchdog_microseconds = values->watchdog_microseconds;
	console->disable_microseconds = values->disable_microseconds;
	if (passo_has_inputs(&console->channel[0].passo))
		error = passo_commands_set_core(console);
	if (error != PASSO_OK) {
		console->filter_microseconds = filter;
		console->watchdog_microseconds = watchdog;
		console->disable_microseconds = disable;
	}
	return error;
}

static bool config_board(const struct passo_call *call)
{
	struct passo_console *console = call->console;
	const struct passo_console_board *board = &console->board;
	bool has_clock = passo_words_find(call->words, "clock_hz") != NULL;
	bool has_baud = passo_words_find(call->words, "baud") != NULL;
	bool has_spi = passo_words_find(call->words, "spi_slow") != NULL;
	bool has_inputs = passo_words_find(call->words, "input_filter") != NULL
	               || passo_words_find(call->words, "watchdog") != NULL
	               || passo_words_find(call->words, "watchdog_disable") != NULL;
	struct passo_values *values = call->values;
	enum passo_error error = PASSO_OK;

	values->filter_microseconds = console->filter_microseconds;
	values->watchdog_microseconds = console->watchdog_microseconds;
	values->disable_microseconds = console->disable_microseconds;
	values->hold_microseconds = console->hold_microseconds;
	values->stop_microseconds = console->stop_microseconds;
	values->flow_waits = console->flow_waits;
	values->need_enable = console->need_enable;
	if (!passo_keys_check(call->reading, CONFIG_KEYS, PASSO_COUNT(CONFIG_KEYS), 0, call->words)
	    || !passo_keys_read(call->reading, CONFIG_KEYS, PASSO_COUNT(CONFIG_KEYS), call->words, values))
		return false;
	if ((has_baud && board->set_baud == NULL) || (has_spi && board->set_spi_fast == NULL))
		return passo_complain(&console->sink, "not available without a board");
	if (has_clock)
		error = set_clock(console, values->clock_hz);
	for (unsigned i = 0; i < passo_commands_channels(console) && error == PASSO_OK; i++) {
		struct passo *passo = &console->channel[i].passo;

		error = passo_configure_motion(passo, passo_clocks(passo, values->hold_microseconds),
		    passo_clocks(passo, values->stop_microseconds), 0);
	}
	if (error == PASSO_OK && has_inputs)
		error = set_core(console, values);
	if (error == PASSO_ERROR_CLOCK)
		return passo_complain(&console->sink, "CLOCK: the core runs at %u Hz, not %u Hz",
		    passo_machine(&console->channel[0].passo)->clock_hz, values->clock_hz);
	if (!passo_answer(call, error))
		return false;
	console->hold_microseconds = values->hold_microseconds;
	console->stop_microseconds = values->stop_microseconds;
	console->flow_waits = values->flow_waits;
	console->need_enable = values->need_enable;
	if (has_spi) {
		console->spi_slow = values->on;
		board->set_spi_fast(board->context, !values->on && console->clock_hz >= board->spi_fast_hz);
	}
	if (has_baud) {
		console->baud = values->baud;
		passo_say(&console->sink, "\n"); /* still at the old baud rate */
		board->set_baud(board->context, values->baud);
	}
	return !has_baud;
}

bool passo_run_config(const struct passo_call *call)
{
	struct passo_console *console = call->console;

	if (passo_words_find(call->words, "axis") != NULL)
		return config_axis(call);
	if (call->words->count > 0u)
		return config_board(call);
	passo_say(&console->sink, "ok clock_hz=%u hold_time=%uus stop_time=%uus", console->clock_hz,
	    console->hold_microseconds, console->stop_microseconds);
	passo_say(&console->sink, " flow=%s need_enable=%u", passo_value_flow(console->flow_waits),
	    (uint32_t)console->need_enable);
	if (console->opened && passo_has_inputs(&console->channel[0].passo))
		passo_say(&console->sink, " input_filter=%uus watchdog=%uus watchdog_disable=%uus",
		    console->filter_microseconds, console->watchdog_microseconds,
		    console->disable_microseconds);
	if (console->board.set_baud)
		passo_say(&console->sink, " baud=%u spi_slow=%u", console->baud, (uint32_t)console->spi_slow);
	return true;
}

void passo_config_help(const struct passo_sink *sink)
{
	passo_say(sink, "  config");
	passo_keys_help(sink, CONFIG_AXIS_KEYS, PASSO_COUNT(CONFIG_AXIS_KEYS));
	passo_say(sink, "\n  config");
	passo_keys_help(sink, CONFIG_KEYS, PASSO_COUNT(CONFIG_KEYS));
	passo_say(sink, "\n");
}

/* Loads a row, or checks the table and prints its properties. */
bool passo_run_table(const struct passo_call *call)
{
	struct passo_loaded_table *table = &call->console->table;
	const struct passo_sink *sink = &call->console->sink;
	uint32_t row = call->values->number;
	struct passo_table_facts facts;
	enum passo_plan_error error;

	if (call->reading->given == 1u || call->reading->given == 2u)
		return passo_complain(sink, "row and points must be given together");
	if (call->reading->given != 0u) {
		memcpy(table->points + row * PASSO_POINTS_PER_LINE, call->values->points,
		    sizeof call->values->points);
		table->loaded |= (uint16_t)(1u << row);
		return passo_answer(call, PASSO_OK);
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
