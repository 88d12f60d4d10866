/* SPDX-License-Identifier: MIT
 * The states of the controller, and the effect of lines and real-time requests in each: the table in
 * docs/gcode.md.
 */
#ifndef PASSO_GRBL_STATE_H
#define PASSO_GRBL_STATE_H

#include <stdint.h>

/* In order of priority: during homing the state is always Home. */
enum passo_grbl_state {
	PASSO_GRBL_STATE_HOME,
	PASSO_GRBL_STATE_SLEEP,
	PASSO_GRBL_STATE_ALARM,
	PASSO_GRBL_STATE_DOOR,
	PASSO_GRBL_STATE_HOLD,
#ifndef PASSO_PLAIN_GCODE
	PASSO_GRBL_STATE_TOOL,  /* a tool is being changed: the lines of the program wait */
	PASSO_GRBL_STATE_TOUCH, /* other ones are taken */
#endif
	PASSO_GRBL_STATE_CHECK,
	PASSO_GRBL_STATE_JOG,
	PASSO_GRBL_STATE_RUN,
	PASSO_GRBL_STATE_IDLE,
	PASSO_GRBL_STATES
};

/* Kinds of lines, by what they require. */
enum passo_grbl_kind {
	PASSO_GRBL_KIND_GCODE,
	PASSO_GRBL_KIND_JOG,      /* $J= */
	PASSO_GRBL_KIND_MODES,    /* $, $G */
	PASSO_GRBL_KIND_SETTINGS, /* $$ */
	PASSO_GRBL_KIND_UNLOCK,   /* $X */
	PASSO_GRBL_KIND_CHECK,    /* $C */
	PASSO_GRBL_KIND_OTHER,    /* $H, $SLP, $TPW, $TLR, $#, $I, $N, $RST=, $n=, and unknown ones */
	PASSO_GRBL_KINDS
};

/* Result of a line: one of these, or error 8 or 9. */
#define PASSO_GRBL_TAKEN 0u
#define PASSO_GRBL_WAITS 0xFFu

/* Real-time requests, in the order in which a batch is processed. */
enum passo_grbl_request {
	PASSO_GRBL_ASK_RESET,  /* Ctrl-X; later ones of the batch are dropped */
	PASSO_GRBL_ASK_CANCEL, /* 0x85 */
	PASSO_GRBL_ASK_PAUSE,  /* ! */
	PASSO_GRBL_ASK_OPEN,   /* 0x84 */
	PASSO_GRBL_ASK_RESUME, /* ~, unless ! or 0x84 are in the batch */
#ifndef PASSO_PLAIN_GCODE
	PASSO_GRBL_ASK_ADMIT, /* 0xA3: the sender knows that the tool is to be changed */
#endif
	PASSO_GRBL_ASK_REPORT, /* ?, after the overrides */
	PASSO_GRBL_ASKS
};

enum passo_grbl_act {
	PASSO_GRBL_ACT_NOTHING,
	PASSO_GRBL_ACT_RESETS,
	PASSO_GRBL_ACT_FAILS,   /* the same, with alarm 6 */
	PASSO_GRBL_ACT_HOLDS,   /* on the path; lines wait */
	PASSO_GRBL_ACT_OPENS,   /* the same, as Door */
	PASSO_GRBL_ACT_CANCELS, /* jog cancel: immediate deceleration; received jogs are dropped */
	PASSO_GRBL_ACT_CLOSES,  /* cancels, then Door */
	PASSO_GRBL_ACT_STOPS,   /* alarm 7 */
	PASSO_GRBL_ACT_GOES_ON,
#ifndef PASSO_PLAIN_GCODE
	PASSO_GRBL_ACT_ADMITS, /* lines that follow are not the program's */
#endif
	PASSO_GRBL_ACT_REPORTS
};

/* PASSO_GRBL_TAKEN, PASSO_GRBL_WAITS, or an error. */
uint8_t passo_grbl_line_rule(enum passo_grbl_state state, enum passo_grbl_kind kind);
enum passo_grbl_act passo_grbl_request_rule(enum passo_grbl_state state, enum passo_grbl_request request);
/* The name used in status reports. */
const char *passo_grbl_state_name(enum passo_grbl_state state);

#endif
