/* SPDX-License-Identifier: MIT
 * The assumed state of the channel, the expected end of its motions, and whether a motion may start.
 */
#include "passo_driver.h"

bool passo_driver_is_broken(const struct passo *passo)
{
	return passo->assumed >= PASSO_ASSUMED_BROKEN;
}

bool passo_driver_is_stopped(const struct passo *passo)
{
	return passo->assumed == PASSO_ASSUMED_STOPPED || passo->assumed == PASSO_ASSUMED_BROKEN_STOPPED;
}

bool passo_driver_is_turning(const struct passo *passo)
{
	return passo->expects >= PASSO_EXPECT_TURNING;
}

enum passo_error passo_driver_fault_of(enum passo_cause cause)
{
	static const uint8_t faults[] = {
	    [PASSO_CAUSE_LINE_UNDERRUN] = PASSO_ERROR_LINE_UNDERRUN,
	    [PASSO_CAUSE_RAMP_UNDERRUN] = PASSO_ERROR_RAMP_UNDERRUN,
	    [PASSO_CAUSE_STEP_OVERRUN] = PASSO_ERROR_STEP_OVERRUN,
	    [PASSO_CAUSE_LIMIT] = PASSO_ERROR_LIMIT,
	    [PASSO_CAUSE_ALARM] = PASSO_ERROR_ALARM,
	    [PASSO_CAUSE_TRIGGER] = PASSO_ERROR_TRIGGER,
	    [PASSO_CAUSE_WATCHDOG] = PASSO_ERROR_WATCHDOG,
	    [PASSO_CAUSE_ESTOP] = PASSO_ERROR_ESTOP,
	    [PASSO_CAUSE_FOLLOWING_ERROR] = PASSO_ERROR_FOLLOWING,
	};

	return (unsigned)cause <= PASSO_CAUSE_FOLLOWING_ERROR ? (enum passo_error)faults[cause] : PASSO_OK;
}

void passo_driver_assume_worse(struct passo *passo, enum passo_assumed worse)
{
	if (passo->assumed == PASSO_ASSUMED_READY)
		passo->assumed = worse;
	else if (passo->assumed != worse)
		passo->assumed = PASSO_ASSUMED_BROKEN_STOPPED;
}

void passo_driver_break(struct passo *passo)
{
	passo_driver_assume_worse(passo, PASSO_ASSUMED_BROKEN);
	if (!passo_driver_is_turning(passo))
		passo->expects = PASSO_EXPECT_END;
	passo->idle_looks = 0;
}

void passo_driver_expect(struct passo *passo, const struct passo_line *line)
{
	for (unsigned i = 0; i < passo->machine.axes; i++) {
		const bool backward = (line->directions >> i & 1u) != 0u;
		const uint32_t steps = backward ? 0u - line->steps[i] : line->steps[i];
		passo->axis[i].expected = (int32_t)((uint32_t)passo->axis[i].expected + steps);
		if (steps == 0u)
			continue;
		passo->axis[i].backward = backward;
		passo->movers = (uint8_t)(passo->movers | 1u << i);
	}
	if (line->endless)
		passo->expects = PASSO_EXPECT_END;
	else if (passo->expects == PASSO_EXPECT_NOTHING)
		passo->expects = PASSO_EXPECT_POSITIONS;
	passo->idle_looks = 0;
}

void passo_driver_ended(struct passo *passo, const int32_t *positions)
{
	for (unsigned i = 0; i < passo->axes; i++)
		passo->axis[i].expected = positions[i];
	passo->expects = PASSO_EXPECT_NOTHING;
	passo->idle_looks = passo->movers = 0;
	passo->aborts = false;
}

enum passo_error passo_driver_take_over(struct passo *passo)
{
	const uint32_t rate = passo_driver_rate(passo);
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = PASSO_OK;

	/* raster values that wait do not show in the state */
	const bool rests = passo_driver_at_rest(passo) && !(passo->inherits && passo->has_outputs);
	if (passo->inherits)
		error = passo_driver_disown(passo);
	if (error == PASSO_OK && passo->snapshot.state == PASSO_STATE_IDLE && !rests)
		error = passo_driver_command(passo, (struct passo_channel_command){.abort = true});
	if (error == PASSO_OK && !rests)
		error = passo_driver_command(passo, (struct passo_channel_command){.clear = true});
	if (error == PASSO_OK)
		error = passo_driver_write(passo, PASSO_CHANNEL_RATE_TARGET, &rate, 1);
	if (error == PASSO_OK)
		error = passo_driver_look(passo, false);
	if (error == PASSO_OK)
		error = passo_driver_positions(passo, positions, false);
	if (error != PASSO_OK)
		return error;
	passo_driver_ended(passo, positions);
	passo->inherits = false;
	passo->output.power = 0;
	passo->output.raster = false;
	const bool is_kept = passo->snapshot.state == PASSO_STATE_STOPPED; /* by e-stop or an alarm */
	passo->assumed = is_kept ? PASSO_ASSUMED_STOPPED : PASSO_ASSUMED_READY;
	passo->fault = is_kept ? passo_driver_fault_of(passo->snapshot.cause) : PASSO_OK;
	if (is_kept)
		return passo->fault;
	return passo_driver_at_rest(passo) ? PASSO_OK : PASSO_ERROR_MOVING;
}

enum passo_error passo_driver_ready(struct passo *passo, bool needs_rest)
{
	enum passo_error error = passo_driver_require_sent(passo, PASSO_POST_RUN);

	if (error != PASSO_OK)
		return error;
	if (passo->task.kind != PASSO_TASK_NONE && !passo->task.inside)
		return PASSO_ERROR_UNDER_WAY;
	if (passo_driver_is_broken(passo))
		return PASSO_ERROR_BROKEN;
	if (passo_driver_is_stopped(passo))
		return PASSO_ERROR_STOPPED;
	if (passo->stream != PASSO_STREAM_NONE)
		return PASSO_ERROR_STREAMING;
	error = needs_rest ? passo_driver_look_at_rest(passo) : passo_driver_look(passo, false);
	if (error != PASSO_OK)
		return error;
	if (passo->snapshot.state == PASSO_STATE_STOPPED || passo->snapshot.stopping)
		return PASSO_ERROR_STOPPED;
	if (passo->zero_due || (passo_driver_is_turning(passo) && passo_driver_at_rest(passo))) {
		int32_t positions[PASSO_AXES_MAX];
		error = passo_driver_positions(passo, positions, false);
		if (error != PASSO_OK)
			return error;
		passo_driver_ended(passo, positions);
	}
	if (passo_driver_is_turning(passo) || (needs_rest && !passo_driver_at_rest(passo)))
		return PASSO_ERROR_MOVING;
	return PASSO_OK;
}
