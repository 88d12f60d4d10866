/* SPDX-License-Identifier: MIT
 * Command table: each row has the keys and the function of a command.
 */
#include "passo_command_table.h"

#include <string.h>

#define ROWS (PASSO_TABLE_SIZE / PASSO_POINTS_PER_LINE)

#define CHANNEL {.name = "channel", .reader = PASSO_READ_CHANNEL, .otherwise = "0"}

const struct passo_key passo_channel_key = CHANNEL;
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
    PASSO_VALUE("backward", on, FLAG, "0"),
    CHANNEL,
};

static const struct passo_key INPUT_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, ""),
    CHANNEL,
    PASSO_VALUE("probe", probe, LEVEL, ""),
    PASSO_VALUE("limit_low", inputs.limit_low, LEVEL, ""),
    PASSO_VALUE("limit_high", inputs.limit_high, LEVEL, ""),
    PASSO_VALUE("home", inputs.home, LEVEL, ""),
    PASSO_VALUE("alarm", inputs.alarm, LEVEL, ""),
    PASSO_VALUE("limit_soft", inputs.limit_soft, FLAG, ""),
    PASSO_VALUE("alarm_soft", inputs.alarm_soft, FLAG, ""),
    PASSO_VALUE("alarm_disables", inputs.alarm_disables, FLAG, ""),
};
static const struct passo_key INPUTS_KEYS[] = {PASSO_VALUE("clear", clear, FLAG, "0"), CHANNEL};
static const struct passo_key TRIGGER_KEYS[] = {
    PASSO_VALUE("source", source, SOURCE, ""),
    CHANNEL,
    PASSO_VALUE("axis", axis, AXIS, ""),
    PASSO_VALUE("edge", edge, EDGE, ""),
    PASSO_VALUE("action", action, ACTION, ""),
};
static const struct passo_key WAIT_TRIGGER_KEYS[] = {
    PASSO_VALUE("timeout", timeout_microseconds, MICROSECONDS, "10"), CHANNEL};
static const struct passo_key HOME_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, NULL),
    PASSO_VALUE("source", source, SOURCE, "home"),
    PASSO_VALUE("distance", distance, INTEGER, NULL),
    PASSO_WHOLE("back_off", back_off, 0, PASSO_SUBSTEPS_MAX, NULL),
    PASSO_WHOLE("pull_off", pull_off, 0, PASSO_SUBSTEPS_MAX, "0"),
    PASSO_VALUE("speed", speed, NUMBER, NULL),
    PASSO_VALUE("slow_speed", slow_speed, NUMBER, NULL),
    PASSO_VALUE("acceleration", acceleration, NUMBER, NULL),
    PASSO_VALUE("position", position, INTEGER, "0"),
    CHANNEL,
};
static const struct passo_key PROBE_KEYS[] = {
    PASSO_VALUE("steps", steps, STEPS, NULL),
    PASSO_VALUE("speed", speed, NUMBER, NULL),
    PASSO_VALUE("acceleration", acceleration, NUMBER, NULL),
    PASSO_VALUE("away", away, FLAG, "0"),
    PASSO_VALUE("optional", optional, FLAG, "0"),
    CHANNEL,
};
static const struct passo_key JOG_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, "0"),
    PASSO_VALUE("steps", distance, INTEGER, ""),
    PASSO_VALUE("backward", backward, FLAG, "0"),
    PASSO_VALUE("speed", speed, NUMBER, NULL),
    PASSO_VALUE("top_speed", top_speed, NUMBER, "speed"),
    PASSO_VALUE("acceleration", acceleration, NUMBER, NULL),
    CHANNEL,
};
#ifndef PASSO_WITHOUT_GOTO /* for the flash of a small controller */
static const struct passo_key GOTO_KEYS[] = {
    PASSO_VALUE("target", distance, INTEGER, NULL),
    PASSO_VALUE("axis", axis, AXIS, "0"),
    PASSO_VALUE("speed", speed, NUMBER, NULL),
    PASSO_VALUE("top_speed", top_speed, NUMBER, "speed"),
    PASSO_VALUE("acceleration", acceleration, NUMBER, NULL),
    PASSO_VALUE("late", timeout_microseconds, MICROSECONDS, "1ms"),
    CHANNEL,
};
#endif
#ifndef PASSO_WITHOUT_TRACKERS /* for the same */
static const struct passo_key TRACKER_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, NULL),
    CHANNEL,
    PASSO_VALUE("speed", tracker.speed, NUMBER, ""),
    PASSO_VALUE("acceleration", tracker.acceleration, NUMBER, ""),
    PASSO_WHOLE("backlash", tracker.backlash, 0, UINT16_MAX, ""),
};
static const struct passo_key TRACK_KEYS[] = {
    PASSO_VALUE("target", distance, INTEGER, NULL), PASSO_VALUE("axis", axis, AXIS, "0"), CHANNEL};
static const struct passo_key UNTRACK_KEYS[] = {PASSO_VALUE("axis", axis, AXIS, NULL), CHANNEL};
#endif
#ifndef PASSO_WITHOUT_PARTS /* for the same */
static const struct passo_key OUTPUT_KEYS[] = {
    PASSO_WHOLE("levels", levels, 0, UINT8_MAX, ""),
    PASSO_VALUE("pwm", pwm, NUMBER, ""),
    PASSO_VALUE("lag", lag, TIME, ""),
    PASSO_VALUE("reference", reference, NUMBER, ""),
    CHANNEL,
};
static const struct passo_key COMPARE_KEYS[] = {
    PASSO_VALUE("on", on, FLAG, "1"),
    CHANNEL,
    PASSO_VALUE("axis", axis, AXIS, ""),
    PASSO_VALUE("position", position, INTEGER, ""),
    PASSO_VALUE("interval", interval, INTEGER, ""),
    PASSO_VALUE("width", width, TIME, ""),
};
static const struct passo_key ENCODER_KEYS[] = {
    PASSO_VALUE("axis", axis, AXIS, ""),
    CHANNEL,
    PASSO_WHOLE("filter", filter, 0, UINT32_MAX, ""),
    PASSO_VALUE("counts_per_step", encoder.counts_per_step, NUMBER, ""),
    PASSO_VALUE("limit", encoder.limit, NUMBER, ""),
    PASSO_VALUE("stop", encoder.stop, STOP, ""),
    PASSO_VALUE("inverted", encoder.inverted, FLAG, ""),
    PASSO_VALUE("index_inverted", encoder.index_inverted, FLAG, ""),
    PASSO_VALUE("index_gated", encoder.index_gated, FLAG, ""),
};
static const struct passo_key ADOPT_KEYS[] = {PASSO_VALUE("axis", axis, AXIS, NULL), CHANNEL};
static const struct passo_key THREAD_KEYS[] = {
    PASSO_VALUE("encoder", axis, AXIS, NULL),
    PASSO_WHOLE("counts_per_turn", counts_per_turn, 1, UINT32_MAX, NULL),
    PASSO_VALUE("steps", steps, STEPS, NULL),
    PASSO_VALUE("turns", turns, NUMBER, NULL),
    PASSO_VALUE("top_rpm", top_rpm, NUMBER, NULL),
    PASSO_VALUE("wait_index", wait_index, FLAG, "1"),
    PASSO_VALUE("endless", endless, FLAG, "0"),
    CHANNEL,
};
#endif
static const struct passo_key SPEED_KEYS[] = {PASSO_VALUE("speed", speed, NUMBER, NULL), CHANNEL};

/* Commands without keys in their row read their own keys, or have none. */
#define TAKES(keys) (keys), PASSO_COUNT(keys)
const struct passo_command passo_command_table[] = {
    {"move", passo_run_move, NULL, 0, 0, false, "queue a move; help move lists its forms"},
    {"turn", passo_run_turn, TAKES(TURN_KEYS), 0, false, "rotate continuously, from rest"},
    {"rpm", passo_run_rpm, TAKES(RPM_KEYS), 1, false, "change the speed of the rotation; 0 ends it"},
    {"hold", passo_run_hold, TAKES(CHANNEL_KEYS), 0, true, "feed hold: decelerate to rest on the path"},
    {"resume", passo_run_resume, TAKES(CHANNEL_KEYS), 0, true, "continue after hold"},
    {"override", passo_run_override, TAKES(PERCENT_KEYS), 1, true, "feed override, 1 to 100"},
    {"stop", passo_run_stop, TAKES(CHANNEL_KEYS), 0, true, "soft stop; then clear"},
    {"abort", passo_run_abort, TAKES(CHANNEL_KEYS), 0, true, "hard stop; then clear"},
    {"clear", passo_run_clear, TAKES(CHANNEL_KEYS), 0, false, "leave the stopped state"},
    {"status", passo_run_status, TAKES(CHANNEL_KEYS), 0, true, "state of the channel"},
    {"position", passo_run_position, TAKES(CHANNEL_KEYS), 0, true, "position of each axis, in steps"},
    {"angle", passo_run_angle, TAKES(ANGLE_KEYS), 1, true, "degrees of an axis and rpm of the motion"},
    {"enable", passo_run_enable, TAKES(AXIS_KEYS), 1, false, "enable the drive of an axis, or all"},
    {"disable", passo_run_disable, TAKES(AXIS_KEYS), 1, false, "disable it; at rest or stopped"},
    {"zero", passo_run_zero, TAKES(CHANNEL_KEYS), 0, false, "set all positions to 0"},
    {"sync", passo_run_sync, TAKES(ON_KEYS), 1, true, "1: motions wait for start or the sync input; 0: not"},
    {"start", passo_run_start, NULL, 0, 0, true, "start all waiting motions"},
    {"input", passo_run_input, TAKES(INPUT_KEYS), 0, false, "configure the inputs of an axis, or show them"},
    {"inputs", passo_run_inputs, TAKES(INPUTS_KEYS), 0, true, "active inputs, and those active since clear"},
    {"home", passo_run_home, TAKES(HOME_KEYS), 0, false, "run a homing cycle on one axis"},
    {"probe", passo_run_probe, TAKES(PROBE_KEYS), 0, false, "move until the probe triggers"},
    {"jog", passo_run_jog, TAKES(JOG_KEYS), 0, false, "jog one axis by a distance or until canceled"},
    {"jog_speed", passo_run_jog_speed, TAKES(SPEED_KEYS), 1, false, "change the speed of an endless jog"},
    {"jog_cancel", passo_run_jog_cancel, TAKES(CHANNEL_KEYS), 0, true, "end a jog: decelerate to rest"},
#ifndef PASSO_WITHOUT_GOTO
    {"goto", passo_run_goto, TAKES(GOTO_KEYS), 1, false,
	"move one axis to a position; retargetable in motion"},
#endif
    {"trigger", passo_run_trigger, TAKES(TRIGGER_KEYS), 1, false, "arm the trigger, or show its status"},
    {"wait_trigger", passo_run_wait_trigger, TAKES(WAIT_TRIGGER_KEYS), 1, false,
	"wait for the edge of the trigger"},
#ifndef PASSO_WITHOUT_PARTS
    {"output", passo_run_output, TAKES(OUTPUT_KEYS), 0, false,
	"set levels and the power pin, or show the settings"},
    {"outputs", passo_run_outputs, TAKES(CHANNEL_KEYS), 0, true, "state of the outputs"},
    {"compare", passo_run_compare, TAKES(COMPARE_KEYS), 1, false,
	"output a pulse at given positions; 0: off"},
    {"encoder", passo_run_encoder, TAKES(ENCODER_KEYS), 0, false,
	"configure the encoder of an axis, or show its settings"},
    {"encoders", passo_run_encoders, TAKES(CHANNEL_KEYS), 0, true, "encoder and thread status"},
    {"adopt", passo_run_adopt, TAKES(ADOPT_KEYS), 1, false, "set an axis position from its encoder"},
    {"thread", passo_run_thread, TAKES(THREAD_KEYS), 0, false, "a straight line clocked by an encoder"},
#endif
#ifndef PASSO_WITHOUT_TRACKERS
    {"tracker", passo_run_tracker, TAKES(TRACKER_KEYS), 1, true,
	"configure the tracker of an axis, or show it"},
    {"track", passo_run_track, TAKES(TRACK_KEYS), 1, true, "send the tracker of an axis to a target"},
    {"untrack", passo_run_untrack, TAKES(UNTRACK_KEYS), 1, true, "slow a tracker down to rest"},
#endif
    {"config", passo_run_config, NULL, 0, 0, false, "show or change settings; help config lists them"},
    {"table", passo_run_table, TAKES(TABLE_KEYS), 2, false, "load 16 of 256 points of a shape, or check it"},
    {"open", passo_run_open, NULL, 0, 0, false, "connect to the core again"},
#ifdef PASSO_BOTH /* an image with grbl */
    {"grbl", passo_run_grbl, NULL, 0, 0, false, "restart as grbl"},
#endif
    {"version", passo_run_version, NULL, 0, 0, true, "versions of console and core"},
    {"help", passo_run_help, TAKES(HELP_KEYS), 1, true, "this list, or the keys of one command"},
};

const unsigned passo_command_count = PASSO_COUNT(passo_command_table);

const struct passo_command *passo_command_find(const char *name)
{
	if (strcmp(name, "?") == 0)
		name = "help";
	for (unsigned i = 0; i < passo_command_count; i++) {
		if (strcmp(passo_command_table[i].name, name) == 0)
			return &passo_command_table[i];
	}
	return NULL;
}
