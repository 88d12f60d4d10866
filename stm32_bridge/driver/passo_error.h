/* SPDX-License-Identifier: MIT
 * What can go wrong between a host and the core, one enum for link library and driver.
 */
#ifndef PASSO_ERROR_H
#define PASSO_ERROR_H

/* All functions of the link library and the driver return one of these. Unless its sentence says otherwise
 * the call that returns an error has changed nothing in the core. */
enum passo_error {
	PASSO_OK = 0,
	PASSO_PENDING, /* no error: the frame that was posted is not settled yet */

	/* the call */
	PASSO_ERROR_ARGUMENT, /* a null pointer, an axis that is not there, a value out of range */
	PASSO_ERROR_NOT_OPEN, /* passo_open() has not succeeded */
	PASSO_ERROR_UNITS,    /* the axis has no steps per unit, or the position is too far for them */
	PASSO_ERROR_TIMEOUT,  /* the time given for waiting is over; the motion goes on */

	/* the wire; after the last try */
	PASSO_ERROR_TRANSFER,   /* the hardware's transfer function failed */
	PASSO_ERROR_STUCK_LOW,  /* MISO stays low */
	PASSO_ERROR_STUCK_HIGH, /* MISO stays high */
	PASSO_ERROR_NO_ACK,     /* the core took the frame for unfinished */
	PASSO_ERROR_DAMAGED,    /* the reply does not agree with its check */
	PASSO_ERROR_SEQUENCE,   /* the reply belongs to another frame */
	PASSO_ERROR_BAD_CRC,    /* the core received damaged frames only */

	/* the core */
	PASSO_ERROR_NOT_PASSO,  /* something else answers */
	PASSO_ERROR_VERSION,    /* a core with another register map or link */
	PASSO_ERROR_PARAMETERS, /* a core with other channels, axes or ticks than expected */
	PASSO_ERROR_CORE_RESET, /* the core was reset, or another host wrote to it: open it again */

	/* the channel */
	PASSO_ERROR_MOVING,      /* only possible at rest, but a motion runs or waits */
	PASSO_ERROR_NOT_TURNING, /* only possible while turning without end */
	PASSO_ERROR_STREAMING,   /* a stream is being fed: wait for its end, or stop it */
	PASSO_ERROR_FULL,        /* the queues have no room for it now: try again later */
	PASSO_ERROR_STOPPED,     /* the channel is stopped: clear it first */
	PASSO_ERROR_NOT_STOPPED, /* a stop or abort was not acknowledged: every poll sends it again */
	PASSO_ERROR_NOT_HELD,    /* a hold, resume, override or sync was not: every poll sends the slower */
	PASSO_ERROR_BROKEN,      /* a link error broke off a command; stop or abort, then clear */
	PASSO_ERROR_NOT_CONFIGURED, /* the pins of an axis are not known: configure it again */
	PASSO_ERROR_TABLE,          /* it needs another shape table, which can only be loaded at rest */
	PASSO_ERROR_PINS_TOO_SLOW,  /* an axis would make steps faster than its pin timing allows */
	PASSO_ERROR_SUPPLY, /* the source of a stream gave a line or ramp that the core would refuse */

	/* how a motion ended */
	PASSO_ERROR_LINE_UNDERRUN, /* stopped: a line ended and the next was not there */
	PASSO_ERROR_RAMP_UNDERRUN, /* stopped softly: the ramps ran out at speed */
	PASSO_ERROR_STEP_OVERRUN,  /* stopped: steps came faster than the pin timing allows */
	PASSO_ERROR_POSITION,      /* the motion ended at another position than commanded */

	PASSO_ERROR_COUNT, /* number of the above */

	/* The core refused the frame: this plus enum passo_verdict, from BAD_LENGTH on. */
	PASSO_ERROR_REFUSED = 0x100,
	/* The planner refused the move: this plus enum passo_plan_error. */
	PASSO_ERROR_PLAN = 0x200,
	PASSO_ERROR_MAX = 0x2FF
};

/* Name ("CORE_RESET", "REFUSED: BUSY", "PLAN: TOO_FAST") without its group, and a sentence. Never null. */
const char *passo_error_name(enum passo_error error);
const char *passo_error_text(enum passo_error error);

#endif
