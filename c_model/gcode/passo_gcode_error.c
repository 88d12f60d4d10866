/* SPDX-License-Identifier: MIT */
#include "passo_gcode_error.h"

const char *passo_gcode_error_text(enum passo_gcode_error error)
{
	switch (error) {
	case PASSO_GCODE_OK:
		return "ok";
	case PASSO_GCODE_LETTER:
		return "a word does not begin with a letter";
	case PASSO_GCODE_NUMBER:
		return "the number of a word is missing, malformed or above 999999999";
	case PASSO_GCODE_STATEMENT:
		return "unknown $ command";
	case PASSO_GCODE_NEGATIVE:
		return "negative value not allowed";
	case PASSO_GCODE_NO_HOMING:
		return "homing is not enabled";
	case PASSO_GCODE_PULSE_TOO_SHORT:
		return "step pulse shorter than the minimum";
	case PASSO_GCODE_STORAGE:
		return "the settings could not be read or written";
	case PASSO_GCODE_NOT_IDLE:
		return "allowed only when idle";
	case PASSO_GCODE_LOCKED:
		return "no G-code during an alarm or a jog";
	case PASSO_GCODE_SOFT_LIMITS_NEED_HOMING:
		return "soft limits need homing";
	case PASSO_GCODE_LINE_OVERFLOW:
		return "the line is too long; it was not executed";
	case PASSO_GCODE_TOO_FAST:
		return "the step rate would be too high";
	case PASSO_GCODE_LINE_LENGTH:
		return "the line is too long to be stored";
	case PASSO_GCODE_TRAVEL:
		return "the jog would leave the travel of the machine";
	case PASSO_GCODE_JOG:
		return "a jog takes '=', a feed, axes, and only G20 G21 G53 G90 G91";
	case PASSO_GCODE_UNSUPPORTED:
		return "unsupported or invalid command or word";
	case PASSO_GCODE_MODAL_GROUP:
		return "two commands of one modal group";
	case PASSO_GCODE_NO_FEED:
		return "the feed is not set";
	case PASSO_GCODE_NOT_INTEGER:
		return "the number of a G or M command must be an integer";
	case PASSO_GCODE_TWO_COMMANDS:
		return "two commands that use the axis words";
	case PASSO_GCODE_REPEATED:
		return "a word is repeated";
	case PASSO_GCODE_NO_AXIS_WORDS:
		return "the command needs axis words";
	case PASSO_GCODE_LINE_NUMBER:
		return "line number above 9999999";
	case PASSO_GCODE_NO_VALUE:
		return "the command needs a word that is missing";
	case PASSO_GCODE_COORDINATES:
		return "coordinate system must be G54 to G59";
	case PASSO_GCODE_G53:
		return "G53 needs G0 or G1";
	case PASSO_GCODE_AXIS_WORDS:
		return "axis words without a command that uses them";
	case PASSO_GCODE_NO_PLANE_WORDS:
		return "an arc needs an axis word in its plane";
	case PASSO_GCODE_TARGET:
		return "invalid target";
	case PASSO_GCODE_RADIUS:
		return "radius too small to reach the target";
	case PASSO_GCODE_NO_OFFSETS:
		return "an arc needs an offset or radius in its plane";
	case PASSO_GCODE_UNUSED:
		return "unused word: no command of the line takes it";
	case PASSO_GCODE_TOOL_AXIS:
		return "tool lengths are those of Z alone";
	case PASSO_GCODE_SPINDLE_STOPPED:
		return "the motion needs a spindle that turns: M3 or M4, and S";
	case PASSO_GCODE_TOOL_LENGTH_UNKNOWN:
		return "no tool length could be measured";
	case PASSO_GCODE_NO_PORT:
		return "the machine has no such input or output";
	case PASSO_GCODE_TOOL:
		return "tool number above 255, or not in the tool table";
	}
	return "unknown error";
}
