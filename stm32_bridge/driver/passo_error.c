/* SPDX-License-Identifier: MIT
 * Names and messages of the errors.
 */
#include "passo_error.h"

#include <stdbool.h>
#include <stddef.h>

#include "passo_plan.h"
#include "passo_registers.h"

struct words {
	const char *name, *text;
};

static const struct words errors[PASSO_ERROR_COUNT] = {
    [PASSO_OK] = {"OK", "no error"},
    [PASSO_PENDING] = {"PENDING", "the frame is still in flight"},
    [PASSO_ERROR_NOT_OPEN] = {"NOT_OPEN", "the core is not open; the error of passo_open() says why"},
    [PASSO_ERROR_UNITS] = {"UNITS", "the axis has no steps per unit, or the position overflows"},
    [PASSO_ERROR_TIMEOUT] = {"TIMEOUT", "timeout; the motion continues"},
    [PASSO_ERROR_TRANSFER] = {"TRANSFER", "the SPI transfer failed"},
    [PASSO_ERROR_STUCK_LOW] = {"STUCK_LOW", "MISO stays low: no core, no power or no connection"},
    [PASSO_ERROR_STUCK_HIGH] = {"STUCK_HIGH", "MISO stays high: no core, no power or no connection"},
    [PASSO_ERROR_NO_ACK] = {"NO_ACK", "the core saw an incomplete frame"},
    [PASSO_ERROR_DAMAGED] = {"DAMAGED", "the reply failed its check"},
    [PASSO_ERROR_SEQUENCE] = {"SEQUENCE", "the reply belongs to another frame"},
    [PASSO_ERROR_BAD_CRC] = {"BAD_CRC", "the core received only corrupt frames"},
    [PASSO_ERROR_NOT_PASSO] = {"NOT_PASSO", "the device is not a Passo core"},
    [PASSO_ERROR_VERSION] = {"VERSION", "the register map has an unsupported version"},
    [PASSO_ERROR_PARAMETERS] = {"PARAMETERS", "the core's channels, axes or ticks do not match"},
    [PASSO_ERROR_CORE_RESET] = {"CORE_RESET",
	"the core was reset, or another host wrote to it: open it again"},
    [PASSO_ERROR_NOT_PREPARED] = {"NOT_PREPARED", "no motion is armed and waiting for start"},
    [PASSO_ERROR_MOVING] = {"MOVING", "only possible at rest"},
    [PASSO_ERROR_NOT_TURNING] = {"NOT_TURNING", "only possible in continuous rotation"},
    [PASSO_ERROR_STREAMING] = {"STREAMING", "a stream is being fed"},
    [PASSO_ERROR_FULL] = {"FULL", "the queues are full: try again later"},
    [PASSO_ERROR_STOPPED] = {"STOPPED", "the channel is stopped: clear it first"},
    [PASSO_ERROR_NOT_STOPPED] = {"NOT_STOPPED", "the stop is not acknowledged yet; it is resent"},
    [PASSO_ERROR_NOT_HELD] = {"NOT_HELD", "hold or rate is not acknowledged yet; the slower one is resent"},
    [PASSO_ERROR_NOT_CONFIGURED] = {"NOT_CONFIGURED", "pin settings of an axis are unknown: configure it"},
    [PASSO_ERROR_BROKEN] = {"BROKEN", "a command was cut off: stop or abort, then clear"},
    [PASSO_ERROR_TABLE] = {"TABLE", "needs another shape table; tables load only at rest"},
    [PASSO_ERROR_PINS_TOO_SLOW] = {"PINS_TOO_SLOW", "an axis would step faster than its pin timing allows"},
    [PASSO_ERROR_SUPPLY] = {"SUPPLY", "the stream source supplied an invalid line or ramp"},
    [PASSO_ERROR_NO_INPUTS] = {"NO_INPUTS", "the core was built without inputs"},
    [PASSO_ERROR_FILTER_TOO_LONG] = {"FILTER_TOO_LONG", "the input filter must be at most 65535 clocks"},
    [PASSO_ERROR_WATCHDOG_TOO_LONG] = {"WATCHDOG_TOO_LONG",
	"watchdog times must be at most 1023 x 65536 clocks"},
    [PASSO_ERROR_NO_SOURCE] = {"NO_SOURCE", "a trigger needs a source"},
    [PASSO_ERROR_NO_SWITCH] = {"NO_SWITCH", "no such switch or probe is configured"},
    [PASSO_ERROR_NO_DISTANCE] = {"NO_DISTANCE", "homing needs a distance and a back-off"},
    [PASSO_ERROR_NO_STOP_TIME] = {"NO_STOP_TIME",
	"homing and probing need a stop time: passo_configure_motion()"},
    [PASSO_ERROR_UNDER_WAY] = {"UNDER_WAY", "homing, probing or goto in progress: wait or stop it"},
    [PASSO_ERROR_SWITCH_MISSED] = {"SWITCH_MISSED",
	"the switch or probe did not trigger within the distance"},
    [PASSO_ERROR_SWITCH_LEVEL] = {"SWITCH_LEVEL", "the switch or probe is already at the target level"},
    [PASSO_ERROR_INPUTS_UNKNOWN] = {"INPUTS_UNKNOWN", "an input is not stable yet; motions wait for it"},
#ifndef PASSO_WITHOUT_GOTO
    [PASSO_ERROR_NO_CLOCK] = {"NO_CLOCK", "the hardware has no microsecond clock"},
#endif
    [PASSO_ERROR_LATE] = {"LATE", "the host was too late to retarget the motion"},
#ifndef PASSO_WITHOUT_PARTS /* of calls that are left out */
    [PASSO_ERROR_NO_OUTPUTS] = {"NO_OUTPUTS", "the core was built without outputs"},
    [PASSO_ERROR_POWER] = {"POWER", "power must be at most 65535, and 0 on a raster line"},
    [PASSO_ERROR_REFERENCE] = {"REFERENCE", "the power reference must be above 0 and at most 1/2"},
    [PASSO_ERROR_ABOVE_REFERENCE] = {"ABOVE_REFERENCE", "faster than the power reference"},
    [PASSO_ERROR_PWM] = {"PWM", "the PWM frequency is 0, too low, or above half the clock"},
    [PASSO_ERROR_LAG_TOO_LONG] = {"LAG_TOO_LONG", "the output delay must be at most 65535 clocks"},
    [PASSO_ERROR_PITCH] = {"PITCH", "the raster pitch must be 1 to 2^30 - 1 substeps"},
    [PASSO_ERROR_INTERVAL] = {"INTERVAL", "the compare interval is 0"},
    [PASSO_ERROR_PULSE] = {"PULSE", "the compare pulse must be 1 to 65535 clocks"},
    [PASSO_ERROR_NO_ENCODERS] = {"NO_ENCODERS", "the core was built without encoders"},
    [PASSO_ERROR_ENCODER_FILTER] = {"ENCODER_FILTER", "the encoder filter must be at most 255 clocks"},
    [PASSO_ERROR_RATIO] = {"RATIO", "the encoder's counts per step are 0"},
    [PASSO_ERROR_FOLLOWING_LIMIT] = {"FOLLOWING_LIMIT", "the following-error limit is 0"},
    [PASSO_ERROR_OFF_SCALE] = {"OFF_SCALE", "the following error is saturated: home the axis"},
    [PASSO_ERROR_NO_COUNTS] = {"NO_COUNTS", "a thread needs at least one encoder count"},
    [PASSO_ERROR_STEEP] = {"STEEP", "a thread must have at most 64 steps per count"},
    [PASSO_ERROR_FOLLOW_SPEED] = {"FOLLOW_SPEED", "the encoder's top speed is 0 or too high"},
#endif
    [PASSO_ERROR_LINE_UNDERRUN] = {"LINE_UNDERRUN", "stopped: a line ended and none was queued"},
    [PASSO_ERROR_RAMP_UNDERRUN] = {"RAMP_UNDERRUN", "stopped: ran out of ramps at speed"},
    [PASSO_ERROR_STEP_OVERRUN] = {"STEP_OVERRUN", "stopped: steps came faster than the pin timing allows"},
    [PASSO_ERROR_POSITION] = {"POSITION", "the motion ended at the wrong position"},
    [PASSO_ERROR_LIMIT] = {"LIMIT", "stopped: an axis stepped toward an active limit switch"},
    [PASSO_ERROR_ALARM] = {"ALARM", "stopped: axis alarm; clear it when the alarm is over"},
    [PASSO_ERROR_TRIGGER] = {"TRIGGER", "stopped by the trigger"},
    [PASSO_ERROR_WATCHDOG] = {"WATCHDOG", "stopped: watchdog timeout, no frame from the host"},
    [PASSO_ERROR_ESTOP] = {"ESTOP", "e-stop: release it, clear it, clear the channel, enable the drives"},
    [PASSO_ERROR_FOLLOWING] = {"FOLLOWING",
	"stopped: following error over its limit, or thread lost the spindle phase"},
};

static const struct words refusals[PASSO_VERDICT_BAD_VALUE + 1u] = {
    [PASSO_VERDICT_BAD_CRC] = {"BAD_CRC", "rejected: wrong CRC"},
    [PASSO_VERDICT_BAD_LENGTH] = {"BAD_LENGTH", "rejected: invalid length"},
    [PASSO_VERDICT_BAD_OPERATION] = {"BAD_OPERATION", "rejected: the register has no such operation"},
    [PASSO_VERDICT_UNKNOWN_ADDRESS] = {"UNKNOWN_ADDRESS", "rejected: no register at this address"},
    [PASSO_VERDICT_READ_ONLY] = {"READ_ONLY", "rejected: the register is read-only"},
    [PASSO_VERDICT_QUEUE_FULL] = {"QUEUE_FULL", "rejected: not enough room in the queue"},
    [PASSO_VERDICT_BUSY] = {"BUSY", "rejected: not allowed in the channel's state"},
    [PASSO_VERDICT_BAD_VALUE] = {"BAD_VALUE", "rejected: a value is out of range"},
};

static const struct words unknown = {"UNKNOWN", "unknown error"};

static const struct words absurd = {"ABSURD", "implausibly slow or short move: unit macro missing?"};

#define ARGUMENT(which) [PASSO_ERROR_ARGUMENT_##which - PASSO_ERROR_ARGUMENT]
static const char *const arguments[PASSO_ERROR_ARGUMENT_END - PASSO_ERROR_ARGUMENT] = {
    ARGUMENT(POINTER) = "null pointer",
    ARGUMENT(AXIS) = "no such axis on the channel",
    ARGUMENT(CHANNEL) = "no such channel on the core",
    ARGUMENT(CLOCK) = "clock_hz is 0",
    ARGUMENT(PIN_TIME) = "a pin time is too long",
    ARGUMENT(DRAIN_VELOCITY) = "drain velocity is above half a substep per clock",
    ARGUMENT(RATE) = "override must be 1 to 100 %",
    ARGUMENT(STEPS_PER_TURN) = "steps_per_turn is 0",
    ARGUMENT(SHAPE) = "no such table bank, or not a valid shape",
    ARGUMENT(PLAN) = "the plan was not made by the planner",
    ARGUMENT(LENGTH) = "invalid frame length",
    ARGUMENT(POSTED) = "a frame is already pending, or a read is required first",
};

static bool is_argument(enum passo_error error)
{
	return error >= PASSO_ERROR_ARGUMENT && error < PASSO_ERROR_ARGUMENT_END;
}

static const struct words *find(unsigned code)
{
	const struct words *found = &unknown;

	if (code < PASSO_ERROR_COUNT)
		found = &errors[code];
	else if (code >= PASSO_ERROR_REFUSED && code - PASSO_ERROR_REFUSED <= PASSO_VERDICT_BAD_VALUE)
		found = &refusals[code - PASSO_ERROR_REFUSED];
	return found->name ? found : &unknown;
}

const char *passo_error_name(enum passo_error error)
{
	if (is_argument(error))
		return "ARGUMENT";
	if (error >= PASSO_ERROR_ABSURD && error < PASSO_ERROR_ARGUMENT)
		return absurd.name;
	if (error >= PASSO_ERROR_PLAN && error < PASSO_ERROR_ABSURD)
		return passo_plan_error_name((enum passo_plan_error)(error - PASSO_ERROR_PLAN));
	return find((unsigned)error)->name;
}

const char *passo_error_text(enum passo_error error)
{
	if (is_argument(error))
		return arguments[error - PASSO_ERROR_ARGUMENT];
	if (error >= PASSO_ERROR_ABSURD && error < PASSO_ERROR_ARGUMENT)
		return absurd.text;
	if (error >= PASSO_ERROR_PLAN && error < PASSO_ERROR_ABSURD)
		return passo_plan_error_text((enum passo_plan_error)(error - PASSO_ERROR_PLAN));
	return find((unsigned)error)->text;
}
