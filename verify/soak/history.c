/* SPDX-License-Identifier: MIT */
#include "history.h"

#include <string.h>

#include "history_player.h"
#include "mutants.h"

static void open_world(
    struct world *world, const struct scenario *scenario, const struct world_rtl *rtl, FILE *record)
{
	world_open(world, &scenario->parameters, rtl);
	world->record = record;
	world->half_period = scenario->half_period;
	world->setup = scenario->setup;
	memcpy(world->gap_enabled, scenario->gap_enabled, sizeof world->gap_enabled);
	if (world->machine) {
		world->levels = world->inputs = scenario->levels;
		for (unsigned a = 0; a < scenario->parameters.axes; a++)
			world->shafts[a] = (struct world_shaft){
			    .coupled = (scenario->coupled >> a & 1u) != 0u, .period = scenario->shaft_period};
	}
	world_run(world, 8);
}

void history_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    bool brief, FILE *record, FILE *print, struct history_counts *counts)
{
	static struct scenario scenario;
	static struct world scout;
	struct history_counts ignored = {0};
	struct player player = {.world = &scout, .counts = &ignored};

	scout.latency = world->latency;
	scout.machine = world->machine;
	if (world->pokes)
		scenario_begin_pokes(&scenario, seed, number);
	else if (world->starts)
		scenario_begin_starts(&scenario, seed, number);
	else if (world->machine)
		scenario_begin_machine(&scenario, seed, number, world->tries);
	else
		scenario_begin(&scenario, seed, number);
	const unsigned most = world->machine ? 5u : 3u;
	const unsigned disturbances =
	    world->tries || world->pokes || world->starts ? 0u : 1u + scenario_draw(&scenario.random, most);
	for (unsigned i = 0; i < disturbances; i++) {
		const enum scenario_kind kind = i != 0u || !scenario.waits ? scenario_kind(&scenario)
		                              : scenario_chance(&scenario.random, 70) ? SCENARIO_SYNC
		                                                                      : SCENARIO_RUN;
		struct action action = scenario_disturbance(&scenario, kind);

		open_world(&scout, &scenario, NULL, NULL);
		player_actions(&player, &scenario, scenario.prologue + (i == 0u ? 0u : scenario.count));
		world_run(&scout, SCOUT_CLOCKS);
		player_aim(&scout, &scenario.random, kind, &action);
		scenario_add(&scenario, &action);
		if (action.kind == ACTION_RESET && action.clocks > 4u * RESET_MARGIN) {
			/* a frame that starts during a reset is ignored */
			struct action within = scenario_disturbance(&scenario,
			    scenario_chance(&scenario.random, 50) ? SCENARIO_ENABLE : SCENARIO_RUN);

			within.at = action.at + 1u
			          + scenario_draw(&scenario.random, action.clocks - 2u * RESET_MARGIN);
			within.clocks = 2;
			scenario_add(&scenario, &within);
		}
		counts->kinds[kind]++;
		if (action.event < EVENT_KINDS) {
			counts->aimed++;
			counts->events[action.event]++;
		}
	}

	struct scenario_random random = scenario.random;
	player = (struct player){.world = world, .counts = counts, .print = print};
	if (world->mutants && !mutants_fork(world, number))
		return;
	open_world(world, &scenario, rtl, record);
	player_actions(&player, &scenario, SIZE_MAX);
	if (world->pokes)
		player_pokes(&player, &random);
	else if (world->machine)
		player_end_machine(&player);
	player_end(&player, &random, brief);
	world_end_record(world);
	if (record && world->machine)
		world_record_estop(world);
	counts->clocks += world->clock;
	/* what the pins show before is the cause of what the last moves show */
	const uint64_t late = world->failed_at >= world->known_from ? world->failed_at : 0u;
	char text[WORLD_TEXT];

	memcpy(text, world->failure, sizeof text);
	if (late != 0u && world->known_from != 0u)
		world->failed_at = 0;
	if (!world->failed_at && !world->pokes)
		judge_history(world, &counts->judge);
	if (!world->failed_at && late != 0u)
		world_fail(world, late, "%s", text);
	if (world->mutants)
		mutants_end(world);
	world_close(world);
}
