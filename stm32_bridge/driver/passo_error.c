/* SPDX-License-Identifier: MIT
 * Names and messages of the errors.
 */
#include "passo_error.h"

#include <stdbool.h>
#include <stddef.h>

#include "passo_plan.h"
#include "passo_registers.h"
#include "passo_strings.h"

/* X(name, text) in the order of the codes; G, P and T are those of calls that PASSO_WITHOUT_GOTO,
 * PASSO_WITHOUT_PARTS and PASSO_WITHOUT_TRACKERS leave out. */
#define ERRORS(X, G, P, T)                                                                                   \
	X(NOT_OPEN, "the core is not open; the error of passo_open() says why")                              \
	X(UNITS, "the axis has no steps per unit, or the position overflows")                                \
	X(TIMEOUT, "timeout; the motion continues")                                                          \
	X(TRANSFER, "the SPI transfer failed")                                                               \
	X(STUCK_LOW, "MISO stays low: no core, no power or no connection")                                   \
	X(STUCK_HIGH, "MISO stays high: no core, no power or no connection")                                 \
	X(NO_ACK, "the core saw an incomplete frame")                                                        \
	X(DAMAGED, "the reply failed its check")                                                             \
	X(SEQUENCE, "the reply belongs to another frame")                                                    \
	X(BAD_CRC, "the core received only corrupt frames")                                                  \
	X(NOT_PASSO, "the device is not a Passo core")                                                       \
	X(VERSION, "the register map has an unsupported version")                                            \
	X(PARAMETERS, "the core's channels, axes or ticks do not match")                                     \
	X(CLOCK, "the core runs at another clock")                                                           \
	X(CLOCK_UNKNOWN, "the core does not tell its clock: set it")                                         \
	X(CORE_RESET, "the core was reset, or another host wrote to it: open it again")                      \
	X(NOT_PREPARED, "no motion waits for the start")                                                     \
	X(MOVING, "only possible at rest")                                                                   \
	X(NOT_TURNING, "only possible in continuous rotation")                                               \
	X(STREAMING, "a stream is being fed")                                                                \
	X(FULL, "the queues are full: try again later")                                                      \
	X(STOPPED, "the channel is stopped: clear it first")                                                 \
	X(NOT_STOPPED, "stop not acknowledged yet; resent")                                                  \
	X(NOT_HELD, "hold or rate not acknowledged yet; the slower is resent")                               \
	X(BROKEN, "a command was cut off: stop or abort, then clear")                                        \
	X(NOT_CONFIGURED, "pin settings of an axis are unknown: configure it")                               \
	X(TABLE, "needs another shape table; tables load only at rest")                                      \
	X(PINS_TOO_SLOW, "an axis would step faster than its pin timing allows")                             \
	X(SUPPLY, "the stream source supplied an invalid line or ramp")                                      \
	X(NO_INPUTS, "the core has no inputs")                                                               \
	X(FILTER_TOO_LONG, "the input filter must be at most 65535 clocks")                                  \
	X(WATCHDOG_TOO_LONG, "watchdog times must be at most 1023 x 65536 clocks")                           \
	X(NO_SOURCE, "a trigger needs a source")                                                             \
	X(NO_SWITCH, "no such switch or probe is configured")                                                \
	X(NO_DISTANCE, "homing needs a distance and a back-off")                                             \
	X(NO_STOP_TIME, "homing and probing need a stop time: passo_configure_motion()")                     \
	X(UNDER_WAY, "homing, probing or goto in progress: wait or stop it")                                 \
	X(SWITCH_MISSED, "the switch or probe did not trigger within the distance")                          \
	X(SWITCH_LEVEL, "the switch or probe is already at the target level")                                \
	X(INPUTS_UNKNOWN, "an input is not stable yet; motions wait for it")                                 \
	G(NO_CLOCK, "the hardware has no microsecond clock")                                                 \
	X(LATE, "the host was too late to retarget the motion")                                              \
	X(NO_OUTPUTS, "the core has no such outputs")                                                        \
	P(POWER, "power must be at most 65535, and 0 on a raster line")                                      \
	P(REFERENCE, "the power reference must be above 0 and at most 1/2")                                  \
	P(ABOVE_REFERENCE, "faster than the power reference")                                                \
	P(PWM, "the PWM frequency is 0, too low, or above half the clock")                                   \
	P(LAG_TOO_LONG, "the output delay must be at most 65535 clocks")                                     \
	P(PITCH, "the raster pitch must be 1 to 2^30 - 1 substeps")                                          \
	P(INTERVAL, "the compare interval is 0")                                                             \
	P(PULSE, "the compare pulse must be 1 to 65535 clocks")                                              \
	P(NO_ENCODERS, "the core has no encoders")                                                           \
	P(ENCODER_FILTER, "the encoder filter must be at most 255 clocks")                                   \
	P(RATIO, "the encoder's counts per step are 0")                                                      \
	P(FOLLOWING_LIMIT, "the following-error limit is 0")                                                 \
	P(OFF_SCALE, "the following error is saturated: home the axis")                                      \
	P(NO_COUNTS, "a thread needs at least one encoder count")                                            \
	P(STEEP, "a thread must have at most 64 steps per count")                                            \
	P(FOLLOW_SPEED, "the encoder's top speed is 0 or too high")                                          \
	T(NO_TRACKERS, "the core has no trackers")                                                           \
	T(TRACKER_LIMITS, "a tracker's acceleration is too small or its speed out of range")                 \
	X(LINE_UNDERRUN, "stopped: a line ended and none was queued")                                        \
	X(RAMP_UNDERRUN, "stopped: ran out of ramps at speed")                                               \
	X(STEP_OVERRUN, "stopped: steps came faster than the pin timing allows")                             \
	X(POSITION, "the motion ended at the wrong position")                                                \
	X(LIMIT, "stopped: an axis stepped toward an active limit switch")                                   \
	X(ALARM, "stopped: axis alarm; clear it when the alarm is over")                                     \
	X(TRIGGER, "stopped by the trigger")                                                                 \
	X(WATCHDOG, "stopped: watchdog timeout, no frame from the host")                                     \
	X(ESTOP, "e-stop: release it, clear it, clear the channel, enable the drives")                       \
	X(FOLLOWING, "stopped: following error over its limit, or thread lost the spindle phase")
#define REFUSALS(X)                                                                                          \
	X(BAD_CRC, "rejected: wrong CRC")                                                                    \
	X(BAD_LENGTH, "rejected: invalid length")                                                            \
	X(BAD_OPERATION, "rejected: the register has no such operation")                                     \
	X(UNKNOWN_ADDRESS, "rejected: no register at this address")                                          \
	X(READ_ONLY, "rejected: the register is read-only")                                                  \
	X(QUEUE_FULL, "rejected: not enough room in the queue")                                              \
	X(BUSY, "rejected: not allowed in the channel's state")                                              \
	X(BAD_VALUE, "rejected: a value is out of range")

#define FIRST_REFUSAL PASSO_VERDICT_BAD_CRC
#define FIRST_REFUSED (PASSO_ERROR_REFUSED + (unsigned)FIRST_REFUSAL)

#define LEFT_OUT(name, text) "\0"
#ifdef PASSO_WITHOUT_GOTO
#define OF_GOTO(part) LEFT_OUT
#else
#define OF_GOTO(part) part
#endif
#ifdef PASSO_WITHOUT_PARTS
#define OF_PARTS(part) LEFT_OUT
#else
#define OF_PARTS(part) part
#endif
#ifdef PASSO_WITHOUT_TRACKERS
#define OF_TRACKERS(part) LEFT_OUT
#else
#define OF_TRACKERS(part) part
#endif

static const char error_names[] = "OK\0PENDING\0" ERRORS(PASSO_STRING_NAME, OF_GOTO(PASSO_STRING_NAME),
    OF_PARTS(PASSO_STRING_NAME), OF_TRACKERS(PASSO_STRING_NAME));
static const char error_texts[] = "no error\0the frame is still in flight\0" ERRORS(PASSO_STRING_TEXT,
    OF_GOTO(PASSO_STRING_TEXT), OF_PARTS(PASSO_STRING_TEXT), OF_TRACKERS(PASSO_STRING_TEXT));
static const char refusal_names[] = REFUSALS(PASSO_STRING_NAME);
static const char refusal_texts[] = REFUSALS(PASSO_STRING_TEXT);

struct errors {
	char OK, PENDING;
	ERRORS(PASSO_STRING_PLACE, PASSO_STRING_PLACE, PASSO_STRING_PLACE, PASSO_STRING_PLACE)
};
struct refusals {
	REFUSALS(PASSO_STRING_PLACE)
};
#define IN_ORDER(name, text) _Static_assert(offsetof(struct errors, name) == PASSO_ERROR_##name, #name);
ERRORS(IN_ORDER, IN_ORDER, IN_ORDER, IN_ORDER)
#define REFUSAL_IN_ORDER(name, text)                                                                         \
	_Static_assert(offsetof(struct refusals, name) == PASSO_VERDICT_##name - FIRST_REFUSAL, #name);
REFUSALS(REFUSAL_IN_ORDER)

#define ARGUMENTS(X)                                                                                         \
	X(POINTER, "null pointer")                                                                           \
	X(AXIS, "no such axis on the channel")                                                               \
	X(CHANNEL, "no such channel on the core")                                                            \
	X(PIN_TIME, "a pin time is too long")                                                                \
	X(DRAIN_VELOCITY, "drain velocity is above half a substep per clock")                                \
	X(RATE, "override must be 1 to 100 %")                                                               \
	X(STEPS_PER_TURN, "steps_per_turn is 0")                                                             \
	X(SHAPE, "no such table bank, or not a valid shape")                                                 \
	X(PLAN, "the plan was not made by the planner")                                                      \
	X(LENGTH, "invalid frame length")                                                                    \
	X(POSTED, "a frame is already pending, or a read is required first")

static const char argument_texts[] = ARGUMENTS(PASSO_STRING_TEXT);

struct arguments {
	ARGUMENTS(PASSO_STRING_PLACE)
};
#define ARGUMENT_IN_ORDER(name, text)                                                                        \
	_Static_assert(                                                                                      \
	    offsetof(struct arguments, name) == PASSO_ERROR_ARGUMENT_##name - PASSO_ERROR_ARGUMENT, #name);
ARGUMENTS(ARGUMENT_IN_ORDER)

static bool is_argument(enum passo_error error)
{
	return error >= PASSO_ERROR_ARGUMENT && error < PASSO_ERROR_ARGUMENT_END;
}

static bool is_absurd(enum passo_error error)
{
	return error >= PASSO_ERROR_ABSURD && error < PASSO_ERROR_ARGUMENT;
}

static bool is_of_plan(enum passo_error error)
{
	return error >= PASSO_ERROR_PLAN && error < PASSO_ERROR_ABSURD;
}

/* The string of an error of the driver or of a refusal; `unknown` if there is none. */
static const char *find(unsigned code, const char *errors, const char *refusals, const char *unknown)
{
	const bool refused = code - FIRST_REFUSED <= PASSO_VERDICT_BAD_VALUE - FIRST_REFUSAL;
	const char *at = refused ? refusals : errors;

	if (!refused && code >= PASSO_ERROR_COUNT)
		return unknown;
	at = passo_string(at, refused ? code - FIRST_REFUSED : code);
	return *at != '\0' ? at : unknown;
}

const char *passo_error_name(enum passo_error error)
{
	if (is_argument(error))
		return "ARGUMENT";
	if (is_absurd(error))
		return "ABSURD";
	if (is_of_plan(error))
		return passo_plan_error_name((enum passo_plan_error)(error - PASSO_ERROR_PLAN));
	return find((unsigned)error, error_names, refusal_names, "UNKNOWN");
}

const char *passo_error_text(enum passo_error error)
{
	if (is_argument(error))
		return passo_string(argument_texts, error - PASSO_ERROR_ARGUMENT);
	if (is_absurd(error))
		return "implausibly slow or short move: unit macro missing?";
	if (is_of_plan(error))
		return passo_plan_error_text((enum passo_plan_error)(error - PASSO_ERROR_PLAN));
	return find((unsigned)error, error_texts, refusal_texts, "unknown error");
}
