/* SPDX-License-Identifier: MIT
 * Readings: state, angles, speeds.
 */
#include "passo_driver.h"

enum passo_error passo_read_state(struct passo *passo, struct passo_snapshot *snapshot)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!snapshot)
		return PASSO_ERROR_ARGUMENT_POINTER;
	error = passo_driver_look(passo, false);
	if (error == PASSO_OK)
		*snapshot = passo->snapshot;
	return error;
}

enum passo_error passo_angle(struct passo *passo, uint8_t axis, uint32_t steps_per_turn, int64_t *degrees)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_check_axis(passo, axis);

	if (error == PASSO_OK && (!degrees || steps_per_turn == 0u))
		error = degrees ? PASSO_ERROR_ARGUMENT_STEPS_PER_TURN : PASSO_ERROR_ARGUMENT_POINTER;
	if (error == PASSO_OK)
		error = passo_positions(passo, positions);
	if (error == PASSO_OK)
		*degrees = passo_angle_of(positions[axis], steps_per_turn);
	return error;
}

enum passo_error passo_rpm(struct passo *passo, uint32_t steps_per_turn, uint64_t *rpm)
{
	enum passo_error error = passo_driver_check(passo);

	if (error != PASSO_OK)
		return error;
	if (!rpm || steps_per_turn == 0u)
		return rpm ? PASSO_ERROR_ARGUMENT_STEPS_PER_TURN : PASSO_ERROR_ARGUMENT_POINTER;
	error = passo_driver_look(passo, false);
	if (error != PASSO_OK)
		return error;
	const struct passo_snapshot *snapshot = &passo->snapshot;
	/* UQ0.32 * UQ1.16 = UQ0.48 */
	const uint64_t velocity =
	    snapshot->state == PASSO_STATE_RUN ? (uint64_t)snapshot->velocity * snapshot->rate : 0u;
	*rpm = passo->oversampling
	         ? passo_rpm_of(velocity, passo->oversampling, passo->machine.clock_hz, steps_per_turn)
	         : 0u;
	return PASSO_OK;
}

enum passo_error passo_lost_steps(struct passo *passo, uint8_t axis, uint32_t *lost)
{
	enum passo_error error = passo_driver_check_axis(passo, axis);

	if (error != PASSO_OK)
		return error;
	if (!lost)
		return PASSO_ERROR_ARGUMENT_POINTER;
	const unsigned address =
	    passo->base + PASSO_CHANNEL_AXIS_BASE + axis * PASSO_CHANNEL_AXIS_STRIDE + PASSO_AXIS_LOST_STEPS;
	return passo_host_read(passo->host, (uint16_t)address, lost, 1);
}

const char *passo_state_name(enum passo_state state)
{
	static const char *const names[] = PASSO_STATE_NAMES;

	return (unsigned)state <= PASSO_STATE_STOPPED ? names[state] : "UNKNOWN";
}

const char *passo_cause_text(enum passo_cause cause)
{
	static const char *const texts[] = {
	    [PASSO_CAUSE_NONE] = "not stopped",
	    [PASSO_CAUSE_STOP] = "soft stop by command",
	    [PASSO_CAUSE_ABORT] = "hard stop by command",
	    [PASSO_CAUSE_LINE_UNDERRUN] = "a line ended and none was queued",
	    [PASSO_CAUSE_RAMP_UNDERRUN] = "ran out of ramps at speed",
	    [PASSO_CAUSE_STEP_OVERRUN] = "steps came faster than the pin timing of an axis allows",
	    [PASSO_CAUSE_LIMIT] = "an axis stepped toward an active limit switch",
	    [PASSO_CAUSE_ALARM] = "the alarm of an axis",
	    [PASSO_CAUSE_TRIGGER] = "the trigger",
	    [PASSO_CAUSE_WATCHDOG] = "watchdog timeout, no frame from the host",
	    [PASSO_CAUSE_ESTOP] = "e-stop",
	    [PASSO_CAUSE_FOLLOWING_ERROR] = "following error over its limit",
	};

	return (unsigned)cause <= PASSO_CAUSE_FOLLOWING_ERROR ? texts[cause] : "unknown cause";
}
