/* SPDX-License-Identifier: MIT */
#include "history.h"

#include <string.h>

#include "history_player.h"
#include "mutants.h"

static void open_world(
    struct world *world, const struct plot *plot, const struct world_rtl *rtl, FILE *record)
{
	world_open(world, &plot->parameters, rtl);
	world->record = record;
	world->half_period = plot->half_period;
	world->setup = plot->setup;
	memcpy(world->gap_enabled, plot->gap_enabled, sizeof world->gap_enabled);
	if (world->machine) {
		world->levels = world->inputs = plot->levels;
		for (unsigned a = 0; a < plot->parameters.axes; a++)
			world->shafts[a] = (struct world_shaft){
			    .coupled = (plot->coupled >> a & 1u) != 0u, .period = plot->shaft_period};
	}
	world_run(world, 8);
}

void history_play(struct world *world, const struct world_rtl *rtl, uint64_t seed, uint64_t number,
    bool brief, FILE *record, FILE *print, struct history_counts *counts)
{
	static struct plot plot;
	static struct world scout;
	struct history_counts ignored = {0};
	struct player player = {.world = &scout, .counts = &ignored};

	scout.latency = world->latency;
	scout.machine = world->machine;
	if (world->pokes)
		plot_begin_pokes(&plot, seed, number);
	else if (world->starts)
		plot_begin_starts(&plot, seed, number);
	else if (world->machine)
		plot_begin_machine(&plot, seed, number, world->tries);
	else
		plot_begin(&plot, seed, number);
	const unsigned most = world->machine ? 5u : 3u;
	const unsigned disturbances =
	    world->tries || world->pokes || world->starts ? 0u : 1u + plot_draw(&plot.random, most);
	for (unsigned i = 0; i < disturbances; i++) {
		const enum plot_kind kind = i != 0u || !plot.waits        ? plot_kind(&plot)
		                          : plot_chance(&plot.random, 70) ? PLOT_SYNC
		                                                          : PLOT_RUN;
		struct action action = plot_disturbance(&plot, kind);

		open_world(&scout, &plot, NULL, NULL);
		player_actions(&player, &plot, plot.prologue + (i == 0u ? 0u : plot.count));
		world_run(&scout, SCOUT_CLOCKS);
		player_aim(&scout, &plot.random, kind, &action);
		plot_add(&plot, &action);
		if (action.kind == ACTION_RESET && action.clocks > 4u * RESET_MARGIN) {
			/* a frame that starts during a reset is ignored */
			struct action within =
			    plot_disturbance(&plot, plot_chance(&plot.random, 50) ? PLOT_ENABLE : PLOT_RUN);

			within.at =
			    action.at + 1u + plot_draw(&plot.random, action.clocks - 2u * RESET_MARGIN);
			within.clocks = 2;
			plot_add(&plot, &within);
		}
		counts->kinds[kind]++;
		if (action.event < EVENT_KINDS) {
			counts->aimed++;
			counts->events[action.event]++;
		}
	}

	struct plot_random random = plot.random;
	player = (struct player){.world = world, .counts = counts, .print = print};
	if (world->mutants && !mutants_fork(world, number))
		return;
	open_world(world, &plot, rtl, record);
	player_actions(&player, &plot, SIZE_MAX);
	if (world->pokes)
		player_pokes(&player, &random);
	else if (world->machine)
		player_end_machine(&player);
	player_end(&player, &random, brief);
	world_end_record(world);
	if (record && world->machine)
		world_record_estop(world);
	counts->clocks += world->clock;
	if (!world->failed_at && !world->pokes)
		judge_history(world, &counts->judge);
	if (world->mutants)
		mutants_end(world);
	world_close(world);
}
