/* SPDX-License-Identifier: MIT
 * Histories on a noisy link: nothing fails, and all moves are made.
 */
#include "bridge_host.h"

struct supply {
	unsigned lines, ramps, wanted;
};

static bool next_line(void *context, struct passo_line *line)
{
	struct supply *supply = context;

	*line = (struct passo_line){.substeps = 64, .steps = {7}, .directions = supply->lines % 2u ? 1u : 0u};
	line->last = ++supply->lines == supply->wanted;
	return true;
}

/* 64 substeps at 1/64 are 32 ticks of 128 clocks */
static bool next_ramp(void *context, struct passo_ramp *ramp)
{
	struct supply *supply = context;

	*ramp = (struct passo_ramp){.velocity_end = PASSO_ONE_Q48 / 64, .progress_step = PASSO_ONE_Q48 / 32};
	ramp->ticks = supply->ramps == 0 ? 0 : 32;
	ramp->last = supply->ramps++ == supply->wanted;
	return true;
}

static void stream(struct bridge *bridge)
{
	struct supply supply = {.wanted = 3u + scenario_draw(bridge->random, 8)};
	const struct passo_source source = {next_line, next_ramp, &supply};

	bridge_finish(bridge);
	if (bridge->world->failed_at)
		return;
	bridge_must(bridge, "stream", passo_stream(&bridge->passo, &source));
	bridge->wanted[0] += supply.wanted % 2u ? 7 : 0;
	bridge->wanted_pulses[0] += 7 * (int64_t)supply.wanted;
	bridge->counts->lines += supply.wanted;
	bridge_finish(bridge);
}

static void toggle_enable(struct bridge *bridge)
{
	const uint8_t axis = (uint8_t)scenario_draw(bridge->random, bridge->world->model.parameters.axes);

	enum passo_error error = passo_enable(&bridge->passo, axis, false);
	bridge_note(bridge, "disable", error);
	if (error != PASSO_OK)
		return;
	bridge_count_pins(bridge);
	bridge->disabled[axis] = true;
	bridge_poll(bridge, 3);
	bridge_count_pins(bridge);
	bridge->disabled[axis] = false;
	bridge_must(bridge, "enable", passo_enable(&bridge->passo, axis, true));
}

void bridge_play_noise(struct bridge *bridge)
{
	static const uint32_t rates[] = {100000, 10000, 1000};
	struct scenario_random *random = bridge->random;
	enum passo_error error;

	bridge->wire.one_in = rates[scenario_draw(random, 3)];
	bridge->wire.worse = scenario_chance(random, 50) ? 5u : 0u;
	for (unsigned i = 6u + scenario_draw(random, 6); i != 0u && !bridge->world->failed_at; i--) {
		switch (scenario_draw(random, 16)) {
		case 0:
			bridge_must(bridge, "hold", passo_hold(&bridge->passo));
			bridge_poll(bridge, scenario_draw(random, 12));
			bridge_must(bridge, "resume", passo_resume(&bridge->passo));
			break;
		case 1:
			bridge_must(bridge, "override",
			    passo_override(&bridge->passo, 20u + scenario_draw(random, 81)));
			break;
		case 2:
			bridge_must(bridge, "stop", passo_stop(&bridge->passo));
			bridge_check_stopped(bridge, "stop");
			bridge_recover(bridge);
			break;
		case 3:
			bridge_must(bridge, "abort", passo_abort(&bridge->passo));
			bridge_check_stopped(bridge, "abort");
			bridge_recover(bridge);
			break;
		case 4:
			stream(bridge);
			break;
		case 5:
			bridge_finish(bridge);
			toggle_enable(bridge);
			break;
		case 6:
			bridge_poll(bridge, scenario_draw(random, 8));
			break;
		default:
			if (!bridge_move(bridge, &error) && error != PASSO_ERROR_FULL
			    && error != PASSO_ERROR_TABLE)
				bridge_must(bridge, "move", error);
			break;
		}
	}
	if (!bridge->world->failed_at)
		bridge_finish(bridge);
}
