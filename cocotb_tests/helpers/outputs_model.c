/* SPDX-License-Identifier: MIT
 * The outputs of a channel in the C model, for a test of that module alone: inputs and outputs as numbers, in
 * the order of helpers/outputs.py.
 */
#include "passo_core_outputs.h"
#include "passo_registers.h"

enum input {
	RST,
	BUS_FRAME,
	BUS_COMMIT,
	BUS_CHECK,
	BUS_WRITE,
	SELECT,
	BUS_DATA,
	LAG,
	PWM_STEP,
	POWER_REFERENCE,
	PITCH,
	COMPARE_AXIS,
	COMPARE_WIDTH,
	COMPARE_INTERVAL,
	WRITE_PULSE,
	WRITE_DISTANCE,
	WRITE_LEVELS,
	WRITE_POWER,
	LINE_BEGINS,
	SUBSTEP,
	WORD,
	STOPPED,
	CLEAR,
	RUNNING,
	RUNNING_NEXT,
	VELOCITY,
	RATE,
	WAITS,
	STEP_MADE,
	STEP_DIRECTION
};

enum output { OUTPUTS, POWER, COMPARE, ROOM, RASTER_EMPTY, OVERFLOW_FLAG, QUIET, REFUSAL };

uint64_t outputs_model_size(void)
{
	return sizeof(struct passo_outputs_unit);
}

void outputs_model_clock(struct passo_outputs_unit *unit, const uint32_t *in, uint32_t *out)
{
	const struct passo_outputs_wires wires = {
	    .bus = {.push = in[SELECT] != 0u,
		.frame = in[BUS_FRAME] != 0u,
		.commit = in[BUS_COMMIT] != 0u,
		.check = in[BUS_CHECK] != 0u,
		.write = in[BUS_WRITE] != 0u,
		.data = in[BUS_DATA]},
	    .settings = {.lag = (uint16_t)in[LAG],
		.pwm_step = in[PWM_STEP],
		.power_reference = in[POWER_REFERENCE],
		.pitch = in[PITCH],
		.compare_axis = (uint8_t)in[COMPARE_AXIS],
		.compare_width = (uint16_t)in[COMPARE_WIDTH],
		.compare_interval = in[COMPARE_INTERVAL]},
	    .word = {.power = (uint16_t)in[WORD],
		.levels = (uint8_t)(in[WORD] >> 16),
		.proportional = (in[WORD] >> 24 & 1u) != 0u,
		.raster = (in[WORD] >> 25 & 1u) != 0u},
	    .write_pulse = in[WRITE_PULSE] != 0u,
	    .write_distance = in[WRITE_DISTANCE] != 0u,
	    .write_levels = in[WRITE_LEVELS] != 0u,
	    .write_power = in[WRITE_POWER] != 0u,
	    .line_begins = in[LINE_BEGINS] != 0u,
	    .substep = in[SUBSTEP] != 0u,
	    .stopped = in[STOPPED] != 0u,
	    .clear = in[CLEAR] != 0u,
	    .running = in[RUNNING] != 0u,
	    .running_next = in[RUNNING_NEXT] != 0u,
	    .velocity = in[VELOCITY],
	    .rate = in[RATE],
	    .waits = in[WAITS] != 0u,
	    .step_made = (uint8_t)in[STEP_MADE],
	    .step_direction = (uint8_t)in[STEP_DIRECTION],
	};
	const bool checks = wires.bus.push && wires.bus.check;

	out[REFUSAL] =
	    checks && in[RST] == 0u ? passo_raster_refusal(&unit->raster, wires.stopped) : PASSO_VERDICT_OK;
	passo_outputs_clock(unit, &wires);
	if (in[RST] != 0u)
		passo_outputs_reset(unit);
	out[OUTPUTS] = unit->levels;
	out[POWER] = unit->pwm.pin;
	out[COMPARE] = unit->compare.pin;
	out[ROOM] = unit->raster.room;
	out[RASTER_EMPTY] = unit->raster_empty;
	out[OVERFLOW_FLAG] = unit->overflow;
	out[QUIET] = passo_outputs_quiet(unit);
}
