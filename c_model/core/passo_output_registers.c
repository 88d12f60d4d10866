/* SPDX-License-Identifier: MIT
 * Registers of the outputs of a channel. See rtl/passo_output_registers.v.
 */
#include "passo_core_outputs.h"
#include "passo_registers.h"

bool passo_output_registers_object(uint8_t address, uint32_t data, uint8_t axes)
{
	return address == PASSO_CHANNEL_COMPARE_PULSE
	    && (data >> PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB & 7u) >= axes;
}

void passo_output_registers_reset(struct passo_output_registers *registers)
{
	*registers = (struct passo_output_registers){
	    .settings = {.lag = PASSO_CHANNEL_OUTPUT_LAG_LAG_RESET,
		.pwm_step = PASSO_CHANNEL_PWM_STEP_RESET,
		.power_reference = PASSO_CHANNEL_POWER_REFERENCE_RESET,
		.pitch = PASSO_CHANNEL_RASTER_PITCH_PITCH_RESET,
		.compare_axis = PASSO_CHANNEL_COMPARE_PULSE_AXIS_RESET,
		.compare_width = PASSO_CHANNEL_COMPARE_PULSE_WIDTH_RESET,
		.compare_interval = PASSO_CHANNEL_COMPARE_INTERVAL_INTERVAL_RESET},
	};
}

void passo_output_registers_clock(
    struct passo_output_registers *registers, bool write, uint8_t address, uint32_t data)
{
	struct passo_output_settings *settings = &registers->settings;

	registers->write_levels = write && address == PASSO_CHANNEL_OUTPUT_LEVELS;
	registers->write_power =
	    write && (address == PASSO_CHANNEL_PWM_STEP || address == PASSO_CHANNEL_POWER_REFERENCE);
	registers->write_pulse = write && address == PASSO_CHANNEL_COMPARE_PULSE;
	registers->write_distance = write && address == PASSO_CHANNEL_COMPARE_DISTANCE;
	if (!write)
		return;
	switch (address) {
	case PASSO_CHANNEL_OUTPUT_LAG:
		settings->lag = (uint16_t)data;
		break;
	case PASSO_CHANNEL_PWM_STEP:
		settings->pwm_step = data;
		break;
	case PASSO_CHANNEL_POWER_REFERENCE:
		settings->power_reference = data;
		break;
	case PASSO_CHANNEL_RASTER_PITCH:
		settings->pitch = data;
		break;
	case PASSO_CHANNEL_COMPARE_PULSE:
		settings->compare_axis = (uint8_t)(data >> PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB);
		settings->compare_width = (uint16_t)data;
		break;
	case PASSO_CHANNEL_COMPARE_INTERVAL:
		settings->compare_interval = data;
		break;
	default:
		break;
	}
}
