/* SPDX-License-Identifier: MIT
 * Generated from spec/passo.rdl by spec/generate_registers.py.
 *
 * What each register takes.
 */
#ifndef PASSO_REGISTER_RULES_H
#define PASSO_REGISTER_RULES_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_registers.h"

enum passo_part {
	PASSO_PART_NONE,
	PASSO_PART_COMPARE,
	PASSO_PART_ENCODERS,
	PASSO_PART_INPUTS,
	PASSO_PART_OUTPUTS,
	PASSO_PART_RASTER,
	PASSO_PART_TRACKERS
};

struct passo_rule {
	bool read, write, push; /* none: there is no such register */
	bool per_axis;          /* a word for each axis */
	bool needs_quiet;       /* the channel, for a write */
	enum passo_part part;   /* it exists only with this */
	bool nonzero;           /* what may be written */
	uint32_t defined, maximum;
};

static inline struct passo_rule passo_shape_rule(void)
{
	return (struct passo_rule){.write = true, .defined = 0x0000FFFFu, .maximum = 0x0000FFFFu};
}

static inline struct passo_rule passo_core_rule(unsigned address)
{
	switch (address) {
	case PASSO_ADDRESS_IDENTIFICATION:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_VERSION:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_PARAMETERS:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_RUN:
		return (struct passo_rule){.read = true, .write = true, .defined = 0x0007FFFFu, .maximum = 0x0007FFFFu};
	case PASSO_ADDRESS_REFUSALS_0:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_REFUSALS_1:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_CLOCK:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_BUILD:
		return (struct passo_rule){.read = true};
	case PASSO_ADDRESS_INPUT_FILTER:
		return (struct passo_rule){.write = true, .part = PASSO_PART_INPUTS, .defined = 0x0000FFFFu, .maximum = 0x0000FFFFu};
	case PASSO_ADDRESS_WATCHDOG:
		return (struct passo_rule){.write = true, .part = PASSO_PART_INPUTS, .defined = 0x000FFFFFu, .maximum = 0x000FFFFFu};
	case PASSO_ADDRESS_ESTOP:
		return (struct passo_rule){.read = true, .part = PASSO_PART_INPUTS};
	case PASSO_ADDRESS_ESTOP_CLEAR:
		return (struct passo_rule){.write = true, .part = PASSO_PART_INPUTS, .defined = 0x00000001u, .maximum = 0x00000001u};
	default:
		return (struct passo_rule){0};
	}
}

static inline struct passo_rule passo_channel_rule(unsigned address)
{
	switch (address) {
	case PASSO_CHANNEL_COMMAND:
		return (struct passo_rule){.write = true, .defined = 0x0000000Fu, .maximum = 0x0000000Fu};
	case PASSO_CHANNEL_RATE_TARGET:
		return (struct passo_rule){.write = true, .defined = 0x0001FFFFu, .maximum = 0x00010000u};
	case PASSO_CHANNEL_RATE_SLEW:
		return (struct passo_rule){.write = true, .defined = 0x0001FFFFu, .maximum = 0x00010000u};
	case PASSO_CHANNEL_STOP_SLEW:
		return (struct passo_rule){.write = true, .defined = 0x0001FFFFu, .maximum = 0x00010000u};
	case PASSO_CHANNEL_DRAIN_VELOCITY:
		return (struct passo_rule){.write = true, .nonzero = true, .defined = 0xFFFFFFFFu, .maximum = 0x80000000u};
	case PASSO_CHANNEL_STATE:
		return (struct passo_rule){.read = true};
	case PASSO_CHANNEL_RATE:
		return (struct passo_rule){.read = true};
	case PASSO_CHANNEL_ROOM:
		return (struct passo_rule){.read = true};
	case PASSO_CHANNEL_VELOCITY:
		return (struct passo_rule){.read = true};
	case PASSO_CHANNEL_INPUT_LEVELS:
		return (struct passo_rule){.read = true, .part = PASSO_PART_INPUTS};
	case PASSO_CHANNEL_INPUT_FLAGS:
		return (struct passo_rule){.read = true, .part = PASSO_PART_INPUTS};
	case PASSO_CHANNEL_INPUT_CLEAR:
		return (struct passo_rule){.write = true, .part = PASSO_PART_INPUTS, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_TRIGGER:
		return (struct passo_rule){.write = true, .part = PASSO_PART_INPUTS, .defined = 0x00013177u, .maximum = 0x00013177u};
	case PASSO_CHANNEL_TRIGGER_STATE:
		return (struct passo_rule){.read = true, .part = PASSO_PART_INPUTS};
	case PASSO_CHANNEL_PROBE:
		return (struct passo_rule){.write = true, .part = PASSO_PART_INPUTS, .defined = 0x00000003u, .maximum = 0x00000003u};
	case PASSO_CHANNEL_LINE:
		return (struct passo_rule){.push = true, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_RAMP:
		return (struct passo_rule){.push = true, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_RASTER:
		return (struct passo_rule){.push = true, .part = PASSO_PART_RASTER, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_OUTPUT_LEVELS:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_OUTPUTS, .defined = 0x000000FFu, .maximum = 0x000000FFu};
	case PASSO_CHANNEL_OUTPUT_LAG:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_OUTPUTS, .defined = 0x0000FFFFu, .maximum = 0x0000FFFFu};
	case PASSO_CHANNEL_PWM_STEP:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_OUTPUTS, .defined = 0x00FFFFFFu, .maximum = 0x00800000u};
	case PASSO_CHANNEL_POWER_REFERENCE:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_OUTPUTS, .defined = 0xFFFFFFFFu, .maximum = 0x80000000u};
	case PASSO_CHANNEL_RASTER_PITCH:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_RASTER, .defined = 0x3FFFFFFFu, .maximum = 0x3FFFFFFFu};
	case PASSO_CHANNEL_COMPARE_PULSE:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_COMPARE, .defined = 0x0007FFFFu, .maximum = 0x0007FFFFu};
	case PASSO_CHANNEL_COMPARE_DISTANCE:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_COMPARE, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_COMPARE_INTERVAL:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_COMPARE, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_OUTPUT_STATE:
		return (struct passo_rule){.read = true, .part = PASSO_PART_OUTPUTS};
	case PASSO_CHANNEL_POSITION_BASE + 0u:
	case PASSO_CHANNEL_POSITION_BASE + 1u:
	case PASSO_CHANNEL_POSITION_BASE + 2u:
	case PASSO_CHANNEL_POSITION_BASE + 3u:
	case PASSO_CHANNEL_POSITION_BASE + 4u:
	case PASSO_CHANNEL_POSITION_BASE + 5u:
	case PASSO_CHANNEL_POSITION_BASE + 6u:
	case PASSO_CHANNEL_POSITION_BASE + 7u:
		return (struct passo_rule){.read = true, .per_axis = true};
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 0u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 1u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 2u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 3u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 4u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 5u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 6u:
	case PASSO_CHANNEL_TRIGGER_POSITION_BASE + 7u:
		return (struct passo_rule){.read = true, .per_axis = true, .part = PASSO_PART_INPUTS};
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 0u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 1u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 2u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 3u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 4u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 5u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 6u:
	case PASSO_CHANNEL_ENCODER_POSITION_BASE + 7u:
		return (struct passo_rule){.read = true, .per_axis = true, .part = PASSO_PART_ENCODERS};
	case PASSO_CHANNEL_FOLLOW:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_ENCODERS, .defined = 0x000000FFu, .maximum = 0x000000FFu};
	case PASSO_CHANNEL_FOLLOW_LIMIT:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_ENCODERS, .defined = 0xFFFFFFFFu, .maximum = 0x80000000u};
	case PASSO_CHANNEL_ENCODER_FILTER:
		return (struct passo_rule){.write = true, .part = PASSO_PART_ENCODERS, .defined = 0x000000FFu, .maximum = 0x000000FFu};
	case PASSO_CHANNEL_FOLLOW_STATE:
		return (struct passo_rule){.read = true, .part = PASSO_PART_ENCODERS};
	case PASSO_CHANNEL_TRACKER_ENABLE:
		return (struct passo_rule){.write = true, .part = PASSO_PART_TRACKERS, .defined = 0x000000FFu, .maximum = 0x000000FFu};
	case PASSO_CHANNEL_TRACKER_STATE:
		return (struct passo_rule){.read = true, .part = PASSO_PART_TRACKERS};
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 0u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 1u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 2u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 3u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 4u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 5u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 6u:
	case PASSO_CHANNEL_TRACKER_POSITION_BASE + 7u:
		return (struct passo_rule){.read = true, .per_axis = true, .part = PASSO_PART_TRACKERS};
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 0u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 1u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 2u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 3u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 4u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 5u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 6u:
	case PASSO_CHANNEL_TRACKER_TARGET_BASE + 7u:
		return (struct passo_rule){.write = true, .per_axis = true, .part = PASSO_PART_TRACKERS, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 0u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 1u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 2u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 3u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 4u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 5u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 6u:
	case PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE + 7u:
		return (struct passo_rule){.write = true, .per_axis = true, .part = PASSO_PART_TRACKERS, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	default:
		return (struct passo_rule){0};
	}
}

static inline struct passo_rule passo_axis_rule(unsigned address)
{
	switch (address) {
	case PASSO_AXIS_PINS:
		return (struct passo_rule){.write = true, .needs_quiet = true, .defined = 0x0000001Eu, .maximum = 0x0000001Eu};
	case PASSO_AXIS_STEP_TIMING:
		return (struct passo_rule){.write = true, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_AXIS_DIR_TIMING:
		return (struct passo_rule){.write = true, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_AXIS_LOST_STEPS:
		return (struct passo_rule){.read = true};
	case PASSO_AXIS_ENABLE:
		return (struct passo_rule){.write = true, .defined = 0x00000001u, .maximum = 0x00000001u};
	case PASSO_AXIS_INPUTS:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_INPUTS, .defined = 0x0000007Fu, .maximum = 0x0000007Fu};
	case PASSO_AXIS_TRACKER_SPEED:
		return (struct passo_rule){.write = true, .part = PASSO_PART_TRACKERS, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_AXIS_TRACKER_ACCELERATION:
		return (struct passo_rule){.write = true, .needs_quiet = true, .part = PASSO_PART_TRACKERS, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	default:
		return (struct passo_rule){0};
	}
}

static inline struct passo_rule passo_encoder_rule(unsigned address)
{
	switch (address) {
	case PASSO_ENCODER_SETUP:
		return (struct passo_rule){.write = true, .part = PASSO_PART_ENCODERS, .defined = 0x0000001Fu, .maximum = 0x0000001Fu};
	case PASSO_ENCODER_RATIO:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_ENCODERS, .defined = 0xFFFFFFFFu, .maximum = 0xFFFFFFFFu};
	case PASSO_ENCODER_LIMIT:
		return (struct passo_rule){.write = true, .nonzero = true, .part = PASSO_PART_ENCODERS, .defined = 0x0000FFFFu, .maximum = 0x0000FFFFu};
	case PASSO_ENCODER_ERROR:
		return (struct passo_rule){.read = true, .part = PASSO_PART_ENCODERS};
	case PASSO_ENCODER_GREATEST:
		return (struct passo_rule){.read = true, .part = PASSO_PART_ENCODERS};
	case PASSO_ENCODER_INDEX:
		return (struct passo_rule){.read = true, .part = PASSO_PART_ENCODERS};
	default:
		return (struct passo_rule){0};
	}
}

#endif
