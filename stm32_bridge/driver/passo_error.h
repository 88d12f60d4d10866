/* SPDX-License-Identifier: MIT
 * Errors of the link library and the driver.
 */
#ifndef PASSO_ERROR_H
#define PASSO_ERROR_H

/* Result of every function of the link library and the driver. A call that returns an error has not changed
 * the core, unless the comment of the error says otherwise. After a link error it is unknown whether the core
 * executed the last write. */
enum passo_error {
	PASSO_OK = 0,
	PASSO_PENDING, /* not an error: the posted frame is still in flight */

	/* the call */
	PASSO_ERROR_NOT_OPEN, /* passo_open() has not succeeded: call it; passo_fault() repeats its error */
	PASSO_ERROR_UNITS,    /* the axis has no steps per unit, or the position overflows */
	PASSO_ERROR_TIMEOUT,  /* the wait timed out; the motion continues */

	/* link errors; reported after the last attempt */
	PASSO_ERROR_TRANSFER,   /* the hardware's transfer function failed */
	PASSO_ERROR_STUCK_LOW,  /* MISO is stuck low */
	PASSO_ERROR_STUCK_HIGH, /* MISO is stuck high */
	PASSO_ERROR_NO_ACK,     /* the core saw an incomplete frame */
	PASSO_ERROR_DAMAGED,    /* the reply failed its check */
	PASSO_ERROR_SEQUENCE,   /* the reply belongs to another frame */
	PASSO_ERROR_BAD_CRC,    /* the core received only corrupt frames */

	/* the core */
	PASSO_ERROR_NOT_PASSO,     /* the device is not a Passo core */
	PASSO_ERROR_VERSION,       /* unsupported version of the register map or the link */
	PASSO_ERROR_PARAMETERS,    /* channels, axes or ticks do not match the options */
	PASSO_ERROR_CLOCK,         /* the core runs at another clock than the options say: passo_machine() */
	PASSO_ERROR_CLOCK_UNKNOWN, /* neither the core nor the options tell the clock */
	PASSO_ERROR_CORE_RESET,    /* the core was reset, or another host wrote to it: open it again */

	/* the channel */
	PASSO_ERROR_NOT_PREPARED, /* no motion is armed and waiting for start */
	PASSO_ERROR_MOVING,       /* only possible at rest, but a motion is running or queued */
	PASSO_ERROR_NOT_TURNING,  /* only possible during continuous rotation */
	PASSO_ERROR_STREAMING,    /* a stream is being fed: wait for its end, or stop it */
	PASSO_ERROR_FULL,         /* the queues are full: try again later */
	PASSO_ERROR_STOPPED,      /* the channel is stopped: clear it first */
	PASSO_ERROR_NOT_STOPPED,  /* a stop or abort is not acknowledged yet: every poll resends it */
	PASSO_ERROR_NOT_HELD, /* the same for hold, resume, override or sync: the slower setting is resent */
	PASSO_ERROR_BROKEN,   /* a link error interrupted a command: stop or abort, then clear */
	PASSO_ERROR_NOT_CONFIGURED, /* an axis has unknown pin settings: configure it again */
	PASSO_ERROR_TABLE,          /* needs another shape table; tables load only at rest */
	PASSO_ERROR_PINS_TOO_SLOW,  /* an axis would step faster than its pin timing allows */
	PASSO_ERROR_SUPPLY,         /* the source of a stream supplied an invalid line or ramp */

	/* inputs, homing, probing */
	PASSO_ERROR_NO_INPUTS,         /* the core was built without inputs */
	PASSO_ERROR_FILTER_TOO_LONG,   /* the glitch filter exceeds its register */
	PASSO_ERROR_WATCHDOG_TOO_LONG, /* a watchdog time exceeds its register */
	PASSO_ERROR_NO_SOURCE,         /* a trigger without a source */
	PASSO_ERROR_NO_SWITCH,         /* no such switch or probe is configured */
	PASSO_ERROR_NO_DISTANCE,       /* homing without a distance or without a back-off */
	PASSO_ERROR_NO_STOP_TIME,      /* homing and probing need a stop time: passo_configure_motion() */
	PASSO_ERROR_UNDER_WAY,         /* homing, probing or goto in progress: wait or stop it */
	PASSO_ERROR_SWITCH_MISSED,     /* the switch or probe did not trigger within the distance; at rest */
	PASSO_ERROR_SWITCH_LEVEL,      /* it is already at the target level; at rest */
	PASSO_ERROR_INPUTS_UNKNOWN,    /* an input that a motion or trigger waits for is not stable */

	/* goto */
	PASSO_ERROR_NO_CLOCK, /* the hardware has no microsecond clock */
	PASSO_ERROR_LATE, /* the host was too late to retarget the motion: it continues unchanged, or stops */

	/* outputs */
	PASSO_ERROR_NO_OUTPUTS,      /* the core was built without outputs, or without RASTER or COMPARE */
	PASSO_ERROR_POWER,           /* above PASSO_POWER_FULL, or not 0 on a raster line */
	PASSO_ERROR_REFERENCE,       /* power reference: 0, or above half a substep per clock */
	PASSO_ERROR_ABOVE_REFERENCE, /* a move faster than the reference of its speed-proportional power */
	PASSO_ERROR_PWM,             /* PWM frequency: 0, below its resolution, or above half the clock */
	PASSO_ERROR_LAG_TOO_LONG,    /* the output delay exceeds its register */
	PASSO_ERROR_PITCH,           /* raster pitch: 0, or exceeds its register */
	PASSO_ERROR_INTERVAL,        /* compare interval: 0 */
	PASSO_ERROR_PULSE,           /* width of compare pulses: 0, or exceeds its register */

	/* encoders */
	PASSO_ERROR_NO_ENCODERS,     /* the core was built without encoders */
	PASSO_ERROR_ENCODER_FILTER,  /* the encoder filter exceeds its register */
	PASSO_ERROR_RATIO,           /* counts per step: 0 */
	PASSO_ERROR_FOLLOWING_LIMIT, /* limit of the following error: 0 */
	PASSO_ERROR_OFF_SCALE,       /* the following error is saturated: home the axis */
	PASSO_ERROR_NO_COUNTS,       /* a thread without counts */
	PASSO_ERROR_STEEP,           /* a thread with more than 64 steps per count */
	PASSO_ERROR_FOLLOW_SPEED,    /* top speed of the encoder: 0, or above half a clock per clock */

	/* trackers */
	PASSO_ERROR_NO_TRACKERS,    /* the core was built without trackers */
	PASSO_ERROR_TRACKER_LIMITS, /* acceleration 0 or too small, or not below a speed below a step per tick
	                             */

	/* how a motion ended */
	PASSO_ERROR_LINE_UNDERRUN, /* stopped: a line ended and no other was queued */
	PASSO_ERROR_RAMP_UNDERRUN, /* soft stop: the ramp queue ran empty at speed */
	PASSO_ERROR_STEP_OVERRUN,  /* stopped: steps came faster than the pin timing allows */
	PASSO_ERROR_POSITION,      /* the motion ended at the wrong position */
	PASSO_ERROR_LIMIT,         /* stopped: an axis stepped toward an active limit switch */
	PASSO_ERROR_ALARM,         /* stopped, latched: an axis alarm is or was active */
	PASSO_ERROR_TRIGGER,       /* stopped by the trigger */
	PASSO_ERROR_WATCHDOG,      /* soft stop: watchdog timeout, no frame from the host */
	PASSO_ERROR_ESTOP,         /* stopped, latched: e-stop; the drives are off */
	PASSO_ERROR_FOLLOWING, /* stopped: following error over its limit, or thread lost the spindle phase */

	PASSO_ERROR_COUNT, /* number of the codes above */

	/* The core rejected the frame: this plus an enum passo_verdict from BAD_LENGTH on. */
	PASSO_ERROR_REFUSED = 0x100,
	/* The planner rejected the move: this plus an enum passo_plan_error. */
	PASSO_ERROR_PLAN = 0x200,
	/* The same, for a speed below 1/65536 per second, a distance below 1/65536 mm or degree, or a time
	 * below 100 us: a unit macro of passo_units.h seems to be missing. */
	PASSO_ERROR_ABSURD = 0x300,
	/* An invalid argument: which one, and why. The first code is that of a null pointer. */
	PASSO_ERROR_ARGUMENT = 0x400,
	PASSO_ERROR_ARGUMENT_POINTER = PASSO_ERROR_ARGUMENT, /* a pointer, or one in a struct, is null */
	PASSO_ERROR_ARGUMENT_AXIS,                           /* the channel does not have the axis */
	PASSO_ERROR_ARGUMENT_CHANNEL,        /* beyond PASSO_CHANNELS_MAX, or of another core */
	PASSO_ERROR_ARGUMENT_PIN_TIME,       /* longer than PASSO_PIN_CLOCKS_MAX clocks */
	PASSO_ERROR_ARGUMENT_DRAIN_VELOCITY, /* above half a substep per clock */
	PASSO_ERROR_ARGUMENT_RATE,           /* an override of 0, or above 100 % */
	PASSO_ERROR_ARGUMENT_STEPS_PER_TURN, /* 0 */
	PASSO_ERROR_ARGUMENT_SHAPE,          /* the bank does not exist, or the points are no shape */
	PASSO_ERROR_ARGUMENT_PLAN,           /* not made by the planner */
	PASSO_ERROR_ARGUMENT_LENGTH,         /* frame length: not 1 .. PASSO_FRAME_PAYLOAD_MAX words */
	PASSO_ERROR_ARGUMENT_POSTED,         /* a frame is already pending, or a read is required first */
	PASSO_ERROR_ARGUMENT_END,            /* the codes above are from ARGUMENT up to here */
	PASSO_ERROR_MAX = 0x4FF
};

/* Name ("CORE_RESET", "BUSY" of a rejected frame, "TOO_FAST" of the planner) and message of an error, for any
 * value. Never null. */
const char *passo_error_name(enum passo_error error);
const char *passo_error_text(enum passo_error error);

#endif
