/* SPDX-License-Identifier: MIT
 * Descriptions of actions and events.
 */
#include "address.h"
#include "scenario.h"

const char *scenario_event_name(enum world_event_kind kind)
{
	static const char *const names[EVENT_KINDS] = {"state", "gap", "stop", "slew tick", "rate", "line",
	    "ramp", "tick", "STEP", "DIR", "waiting step", "quiet"};

	return kind < EVENT_KINDS ? names[kind] : "nothing";
}

static const char *register_name(uint16_t address)
{
	static const char *const of_channel[] = {
	    "COMMAND", "RATE_TARGET", "RATE_SLEW", "STOP_SLEW", "DRAIN_VELOCITY"};
	static const char *const of_axis[] = {"PINS", "STEP_TIMING", "DIR_TIMING", "LOST_STEPS", "ENABLE"};
	const unsigned place = place_of(address);

	if (passo_bank_at(address) != 0u)
		return "TABLE";
	if (address < PASSO_ADDRESS_CHANNEL_BASE)
		return address == PASSO_ADDRESS_RUN ? "RUN" : "";
	if (place < 5u)
		return of_channel[place];
	if (place >= PASSO_CHANNEL_AXIS_BASE && place % PASSO_CHANNEL_AXIS_STRIDE < 5u)
		return of_axis[place % PASSO_CHANNEL_AXIS_STRIDE];
	return place == PASSO_CHANNEL_STATE         ? "STATE"
	     : place == PASSO_CHANNEL_LINE          ? "LINE"
	     : place == PASSO_CHANNEL_RAMP          ? "RAMP"
	     : place >= PASSO_CHANNEL_POSITION_BASE ? "POSITION"
	                                            : "";
}

void scenario_print(const struct action *action, char *text, size_t size)
{
	static const char *const operations[] = {"", "read", "write", "push"};
	static const char *const faults[] = {"", " (bad CRC)", " (repeated)", " (cut)", " (bad value)"};
	size_t at;

	if (action->kind == ACTION_INPUT) {
		static const char *const inputs[] = {"rst", "sclk", "mosi", "cs", "sync", "estop_n",
		    "limit_low", "limit_high", "home", "alarm", "probe", "encoder_a", "encoder_b",
		    "encoder_index", "shaft"};

		snprintf(text, size, "%s %x: %u edges, %u clocks apart, %d counts", inputs[action->input],
		    action->mask, action->edges, action->clocks, action->turn);
		return;
	}
	if (action->kind != ACTION_FRAME) {
		snprintf(text, size, "%s for %u clocks", action->kind == ACTION_SYNC ? "sync" : "rst",
		    action->clocks);
		return;
	}
	at = (size_t)snprintf(text, size, "%s %03x %s%s", operations[action->operation & 3u], action->address,
	    register_name(action->address), faults[action->fault]);
	for (unsigned i = 0;
	    i < action->length && action->operation != PASSO_OPERATION_READ && at + 12u < size; i++)
		at += (size_t)snprintf(text + at, size - at, " %x", action->payload[i]);
}
