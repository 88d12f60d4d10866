/* SPDX-License-Identifier: MIT */
#include "passo_grbl_state.h"

#include "passo_gcode_error.h"

#define TAKEN PASSO_GRBL_TAKEN
#define WAITS PASSO_GRBL_WAITS
#define BUSY PASSO_GCODE_NOT_IDLE
#define LOCKED PASSO_GCODE_LOCKED

struct rule {
	char name[6];
	uint8_t line[PASSO_GRBL_KINDS];
	uint8_t request[PASSO_GRBL_ASK_REPORT]; /* a report is answered in all states */
};

/* clang-format off */
static const struct rule RULES[PASSO_GRBL_STATES] = {
	/*                         G-code  $J=     $G      $$      $X      $C      others */
	[PASSO_GRBL_STATE_HOME]  = {"Home",  {WAITS,  WAITS, WAITS, WAITS, WAITS, WAITS, WAITS},
		{PASSO_GRBL_ACT_FAILS, 0, 0, PASSO_GRBL_ACT_STOPS, 0}},
	[PASSO_GRBL_STATE_SLEEP] = {"Sleep", {WAITS,  WAITS, WAITS, WAITS, WAITS, WAITS, WAITS},
		{PASSO_GRBL_ACT_RESETS, 0, 0, 0, 0}},
	[PASSO_GRBL_STATE_ALARM] = {"Alarm", {LOCKED, BUSY,  TAKEN, TAKEN, TAKEN, BUSY,  TAKEN},
		{PASSO_GRBL_ACT_RESETS, 0, 0, 0, 0}},
	[PASSO_GRBL_STATE_DOOR]  = {"Door",  {WAITS,  WAITS, WAITS, WAITS, WAITS, WAITS, WAITS},
		{PASSO_GRBL_ACT_RESETS, 0, 0, 0, PASSO_GRBL_ACT_GOES_ON}},
	[PASSO_GRBL_STATE_HOLD]  = {"Hold",  {WAITS,  WAITS, WAITS, WAITS, WAITS, WAITS, WAITS},
		{PASSO_GRBL_ACT_RESETS, 0, 0, PASSO_GRBL_ACT_OPENS, PASSO_GRBL_ACT_GOES_ON}},
#ifndef PASSO_PLAIN_GCODE
	[PASSO_GRBL_STATE_TOOL]  = {"Tool",  {WAITS,  WAITS, WAITS, WAITS, WAITS, WAITS, WAITS},
		{PASSO_GRBL_ACT_RESETS, 0, 0, PASSO_GRBL_ACT_OPENS, PASSO_GRBL_ACT_GOES_ON, PASSO_GRBL_ACT_ADMITS}},
	[PASSO_GRBL_STATE_TOUCH] = {"Tool",  {TAKEN,  TAKEN, TAKEN, TAKEN, TAKEN, BUSY,  TAKEN},
		{PASSO_GRBL_ACT_RESETS, 0, PASSO_GRBL_ACT_HOLDS, PASSO_GRBL_ACT_OPENS, PASSO_GRBL_ACT_GOES_ON}},
#endif
	[PASSO_GRBL_STATE_CHECK] = {"Check", {TAKEN,  BUSY,  TAKEN, TAKEN, TAKEN, TAKEN, BUSY},
		{PASSO_GRBL_ACT_RESETS, 0, 0, 0, 0}},
	[PASSO_GRBL_STATE_JOG]   = {"Jog",   {LOCKED, TAKEN, TAKEN, BUSY,  TAKEN, BUSY,  BUSY},
		{PASSO_GRBL_ACT_RESETS, PASSO_GRBL_ACT_CANCELS, PASSO_GRBL_ACT_CANCELS, PASSO_GRBL_ACT_CLOSES, 0}},
	[PASSO_GRBL_STATE_RUN]   = {"Run",   {TAKEN,  BUSY,  TAKEN, BUSY,  TAKEN, BUSY,  BUSY},
		{PASSO_GRBL_ACT_RESETS, 0, PASSO_GRBL_ACT_HOLDS, PASSO_GRBL_ACT_OPENS, 0}},
	[PASSO_GRBL_STATE_IDLE]  = {"Idle",  {TAKEN,  TAKEN, TAKEN, TAKEN, TAKEN, TAKEN, TAKEN},
		{PASSO_GRBL_ACT_RESETS, 0, PASSO_GRBL_ACT_HOLDS, PASSO_GRBL_ACT_OPENS, 0}},
};
/* clang-format on */

uint8_t passo_grbl_line_rule(enum passo_grbl_state state, enum passo_grbl_kind kind)
{
	return RULES[state].line[kind];
}

enum passo_grbl_act passo_grbl_request_rule(enum passo_grbl_state state, enum passo_grbl_request request)
{
	if (request == PASSO_GRBL_ASK_REPORT)
		return PASSO_GRBL_ACT_REPORTS;
	return (enum passo_grbl_act)RULES[state].request[request];
}

const char *passo_grbl_state_name(enum passo_grbl_state state)
{
	return RULES[state].name;
}
