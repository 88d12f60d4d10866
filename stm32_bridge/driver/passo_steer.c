/* SPDX-License-Identifier: MIT
 * Changing the ramps of a running motion.
 *
 * The core takes a change some time after the host has read its state. Meanwhile speed and position continue
 * to change: a change is planned for everything that is possible within `late` of the first read. The clock
 * of the host shows whether that was met.
 */
#include "passo_driver.h"
#include "passo_math.h"
#include "passo_plan_draft.h"

#define LATE_MICROSECONDS 1000u
#define LATE_MAX (UINT32_C(1) << 30)
#define MICROSECONDS_PER_SECOND 1000000u
#define TRIES 3u
#define TRIES_TO_STOP 5u /* each of them takes its time from the one before */
/* Steps that the ramps are ahead of the position: four in the step queue, and a fraction. */
#define STEPS_AHEAD 5
/* Ticks until a ramp that was received changes the speed. */
#define TICKS_AHEAD 4u
#define WAY_BITS 16u
#define REGISTER_LSB (PASSO_ONE_Q48 / PASSO_UNIT_Q32) /* of VELOCITY */

static uint64_t larger(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

void passo_driver_turns(struct passo *passo, const struct passo_turning *turning, bool backward,
    const struct passo_plan *plan, const int32_t *aim)
{
	passo->expects = PASSO_EXPECT_TURNING;
	passo->turning = *turning;
	passo->backward = backward;
	passo->velocity_peak = passo->velocity_top = plan->velocity_peak;
	passo->has_aim = passo->aimed = aim != NULL;
	passo->aim = aim ? *aim : 0;
	passo->late = LATE_MICROSECONDS;
}

bool passo_driver_steers(struct passo *passo, struct passo_steering *steering)
{
	const uint32_t took = passo_driver_now(passo) - steering->since;

	if (steering->tries == (steering->stop ? TRIES_TO_STOP : TRIES))
		return false;
	/* a slow host comes to rest a bit later, rather than not at all */
	if (steering->stop && steering->tries != 0u && steering->late < took)
		steering->late = took < LATE_MAX / 2u ? 2u * took : LATE_MAX;
	steering->tries++;
	return true;
}

uint64_t passo_driver_speed_of(const struct passo *passo, uint64_t velocity)
{
	return passo_mul_div_ceil(velocity, passo->machine.clock_hz, REGISTER_LSB * passo->oversampling);
}

/* A motion that waits for its inputs to be known takes no ramps: it is flushed, NOT_TURNING. */
static enum passo_error withdraw(struct passo *passo)
{
	const struct passo_output output = passo->output;
	enum passo_error error = passo_driver_gate(passo, PASSO_GATE_CLOSED);

	if (error == PASSO_OK)
		error = passo_driver_look(passo, false);
	const bool waits = passo->snapshot.state == PASSO_STATE_IDLE;
	if (error == PASSO_OK && waits)
		error = passo_driver_take_over(passo);
	passo->output = output;
	return error == PASSO_OK && waits ? PASSO_ERROR_NOT_TURNING : error;
}

/* Reads the state of a motion whose ramps can be changed. */
static enum passo_error look(struct passo *passo, bool stop)
{
	enum passo_error error = passo_driver_require_sent(passo, PASSO_POST_RUN);

	if (error != PASSO_OK)
		return error;
	if (passo_driver_is_broken(passo))
		return PASSO_ERROR_BROKEN;
	if (passo->expects != PASSO_EXPECT_TURNING)
		return PASSO_ERROR_NOT_TURNING;
	error = passo_driver_look(passo, false);
	if (error == PASSO_OK && passo->snapshot.state == PASSO_STATE_IDLE
	    && passo->snapshot.line_room != passo->line_places)
		error = stop || passo->has_aim ? withdraw(passo) : PASSO_ERROR_INPUTS_UNKNOWN;
	if (error == PASSO_OK && (passo->snapshot.state == PASSO_STATE_STOPPED || passo->snapshot.stopping))
		error = PASSO_ERROR_STOPPED;
	return error;
}

/* Bounds of the velocity: it approaches that of the ramps, then goes to rest if they end at a target. */
static void bound(
    const struct passo *passo, uint64_t acceleration, uint64_t clocks, struct passo_sight *sight)
{
	const uint64_t read = (uint64_t)passo->snapshot.velocity << 16, peak = passo->velocity_peak;
	const uint64_t speed = passo_mul_div_ceil(acceleration, clocks, passo->machine.clock_hz);
	const uint64_t change =
	    passo_mul_div_ceil(speed, REGISTER_LSB * passo->oversampling, passo->machine.clock_hz);
	/* the register has only the upper 32 bits; at the peak all bits are known from the plan */
	const bool is_there = peak >> 16 == passo->snapshot.velocity;
	const uint64_t low = is_there ? peak : read;
	const uint64_t high =
	    is_there ? peak : passo_smaller(read + REGISTER_LSB - 1u, larger(passo->velocity_top, read));

	sight->low = low > change ? low - change : 0u;
	if (!passo->has_aim)
		sight->low = larger(sight->low, passo_smaller(low, peak));
	sight->high = passo_smaller(high + change, larger(high, peak));
	if (read == 0u && passo->turning.minimum_rpm != 0u)
		sight->high = peak; /* it starts with a jump */
}

/* Minimum remaining steps to the target. */
static enum passo_error measure(struct passo *passo, uint64_t clocks, struct passo_sight *sight)
{
	int32_t positions[PASSO_AXES_MAX];
	enum passo_error error = passo_driver_positions(passo, positions, false);

	if (error != PASSO_OK)
		return error;
	const uint64_t speed = passo_driver_speed_of(passo, sight->high);
	const uint64_t passed =
	    (passo_mul_div_ceil(speed, clocks, passo->machine.clock_hz) >> (32u - WAY_BITS)) + 1u;
	const uint32_t far = (uint32_t)passo->aim - (uint32_t)positions[passo->turning.axis];
	const int64_t ahead = (int64_t)(int32_t)(passo->backward ? 0u - far : far) - STEPS_AHEAD;
	sight->way =
	    ahead > 0 && (uint64_t)ahead << WAY_BITS > passed ? ((uint64_t)ahead << WAY_BITS) - passed : 0u;
	return PASSO_OK;
}

enum passo_error passo_driver_sight(
    struct passo *passo, struct passo_steering *steering, uint64_t acceleration, struct passo_sight *sight)
{
	const struct passo_machine *machine = &passo->machine;
	const uint64_t clocks = passo_mul_div_ceil(steering->late, machine->clock_hz, MICROSECONDS_PER_SECOND)
	                      + ((uint64_t)TICKS_AHEAD << machine->tick_log2);

	steering->since = passo_driver_now(passo);
	enum passo_error error = look(passo, steering->stop);
	if (error != PASSO_OK)
		return error;
	bound(passo, acceleration, clocks, sight);
	if (!passo->has_aim)
		return PASSO_OK;
	return measure(passo, clocks, sight);
}

/* Pushes the ramps and converts a rejection. */
static enum passo_error push(struct passo *passo, const struct passo_plan *plan)
{
	if (passo->snapshot.ramp_room < plan->ramp_count)
		return PASSO_ERROR_FULL;
	enum passo_error error = passo_driver_push_ramps(passo, plan);
	if (error == PASSO_ERROR_STOPPED && passo_driver_look(passo, false) == PASSO_OK
	    && passo->snapshot.state != PASSO_STATE_STOPPED)
		error = PASSO_ERROR_NOT_TURNING; /* its end is already in progress */
	return error;
}

enum passo_error passo_driver_steer(
    struct passo *passo, struct passo_steering *steering, const struct passo_plan *plan)
{
	if (passo_driver_now(passo) - steering->since > steering->late)
		return PASSO_ERROR_LATE;
	enum passo_error error = push(passo, plan);
	if (error != PASSO_OK)
		return error;
	passo->velocity_peak = steering->stop ? 0u : plan->velocity_peak;
	passo->velocity_top = larger(passo->velocity_top, passo->velocity_peak);
	steering->overdue = passo_driver_now(passo) - steering->since > steering->late;
	return steering->overdue ? PASSO_ERROR_LATE : PASSO_OK;
}

enum passo_error passo_driver_steered(
    struct passo *passo, const struct passo_steering *steering, enum passo_error error)
{
	if (error == PASSO_OK && steering->stop)
		passo->expects = PASSO_EXPECT_TURN_END;
	if (!steering->stop)
		return error == PASSO_ERROR_LATE && steering->overdue ? PASSO_OK : error;
	/* a stop by ramp that is late, not acknowledged, or behind a hold that is not, becomes a soft stop */
	if (error == PASSO_ERROR_LATE || passo_driver_is_link_error(error)
	    || (error == PASSO_ERROR_NOT_HELD && passo->expects == PASSO_EXPECT_TURNING))
		passo_driver_halt(passo, PASSO_DUE_STOP);
	return error;
}
