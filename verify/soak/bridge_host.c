/* SPDX-License-Identifier: MIT */
#include "bridge_host.h"

#include <string.h>

/* Longer than all queued moves, even if each frame takes a hundred tries. */
#define WAIT_MICROSECONDS 4000000u
#define POLL_CLOCKS 150u

void bridge_count_pins(struct bridge *bridge)
{
	struct world *world = bridge->world;
	const unsigned axes = world->model.parameters.axes;

	for (; bridge->row + 1u < world->row_count; bridge->row++) {
		const struct world_row *row = &world->rows[bridge->row + 1u];
		const uint64_t edges = row->pins.step ^ world->rows[bridge->row].pins.step;

		for (unsigned a = 0; a < axes; a++) {
			const struct passo_axis_config *config = &bridge->config[a];
			const bool level = (row->pins.step >> a & 1u) != 0u;
			const bool down = ((row->pins.dir >> a & 1u) != 0u) != config->direction_inverted;

			if ((edges >> a & 1u) == 0u
			    || (!config->both_edges && level == config->step_inverted))
				continue;
			bridge->made[a] += down ? -1 : 1;
			bridge->pulses[a]++;
			bridge->counts->steps++;
			if (bridge->disabled[a])
				world_fail(world, row->clock,
				    "axis %u: a step to a drive that the driver disabled", a);
		}
	}
}

void bridge_agree(struct bridge *bridge)
{
	bridge_count_pins(bridge);
	memcpy(bridge->wanted, bridge->made, sizeof bridge->wanted);
	memcpy(bridge->wanted_pulses, bridge->pulses, sizeof bridge->wanted_pulses);
}

void bridge_note(struct bridge *bridge, const char *what, enum passo_error error)
{
	bridge->counts->errors += error != PASSO_OK ? 1u : 0u;
	if (bridge->print)
		fprintf(bridge->print, "%8llu  %s: %s\n", (unsigned long long)bridge->world->clock, what,
		    passo_error_name(error));
}

static void check_made(struct bridge *bridge, const char *when)
{
	struct world *world = bridge->world;

	bridge_count_pins(bridge);
	for (unsigned a = 0; a < world->model.parameters.axes; a++)
		if (bridge->made[a] != bridge->wanted[a] || bridge->pulses[a] != bridge->wanted_pulses[a])
			world_fail(world, world->clock,
			    "axis %u %s: at %lld after %lld steps, wanted %lld and %lld", a, when,
			    (long long)bridge->made[a], (long long)bridge->pulses[a],
			    (long long)bridge->wanted[a], (long long)bridge->wanted_pulses[a]);
}

void bridge_must(struct bridge *bridge, const char *what, enum passo_error error)
{
	bridge_note(bridge, what, error);
	if (error != PASSO_OK)
		world_fail(bridge->world, bridge->world->clock, "%s: %s", what, passo_error_name(error));
}

void bridge_check_positions(struct bridge *bridge)
{
	struct world *world = bridge->world;
	int32_t positions[PASSO_AXES_MAX];

	bridge_must(bridge, "positions", passo_positions(&bridge->passo, positions));
	bridge_count_pins(bridge);
	for (unsigned a = 0; a < world->model.parameters.axes && !world->failed_at; a++)
		if (positions[a] != (int32_t)bridge->made[a])
			world_fail(world, world->clock, "axis %u: position %d after %lld steps", a,
			    positions[a], (long long)bridge->made[a]);
}

void bridge_poll(struct bridge *bridge, unsigned times)
{
	while (times-- != 0u) {
		enum passo_error error = passo_poll(&bridge->passo);

		if (error != PASSO_OK)
			bridge_note(bridge, "poll", error);
		world_run(bridge->world, POLL_CLOCKS);
	}
}

struct passo_move_by_speed bridge_draw_move(struct bridge *bridge)
{
	const unsigned axes = bridge->world->model.parameters.axes;
	struct passo_move_by_speed move = {.profile = (enum passo_profile)scenario_draw(bridge->random, 4),
	    .acceleration = 40000000u * PASSO_UNIT_Q32};

	/* within the setup time, no more steps come than the queue of the axis holds */
	move.speed = bridge->slow_turns ? 3000u : 10000u + scenario_draw(bridge->random, 40000);
	move.speed *= PASSO_UNIT_Q32;

	for (unsigned a = 0; a < axes; a++)
		move.steps[a] = (int32_t)scenario_draw(bridge->random, 41) - 20;
	move.steps[scenario_draw(bridge->random, axes)] = 21;
	return move;
}

void bridge_want(struct bridge *bridge, const struct passo_move_by_speed *move)
{
	for (unsigned a = 0; a < bridge->world->model.parameters.axes; a++) {
		bridge->wanted[a] += move->steps[a];
		bridge->wanted_pulses[a] += move->steps[a] < 0 ? -move->steps[a] : move->steps[a];
	}
	bridge->counts->moves++;
}

bool bridge_move(struct bridge *bridge, enum passo_error *error)
{
	const struct passo_move_by_speed move = bridge_draw_move(bridge);

	*error = passo_move_by_speed(&bridge->passo, &move);
	bridge_note(bridge, "move", *error);
	if (*error == PASSO_OK)
		bridge_want(bridge, &move);
	return *error == PASSO_OK;
}

void bridge_finish(struct bridge *bridge)
{
	bridge_must(
	    bridge, "wait", passo_wait(&bridge->passo, passo_clocks(&bridge->passo, WAIT_MICROSECONDS)));
	if (!bridge->world->failed_at)
		check_made(bridge, "at rest");
}

void bridge_check_stopped(struct bridge *bridge, const char *what)
{
	struct world *world = bridge->world;

	for (unsigned i = 0; i < 20u && !world->outputs.irq; i++)
		bridge_poll(bridge, 5);
	if (!world->outputs.irq)
		world_fail(world, world->clock, "%s: nothing is stopped, %s", what,
		    passo_error_name(passo_fault(&bridge->passo)));
	bridge->counts->stops++;
}

void bridge_recover(struct bridge *bridge)
{
	enum passo_error error = PASSO_ERROR_MOVING;

	for (unsigned i = 0; i < 20u && error != PASSO_OK; i++) {
		error = passo_clear(&bridge->passo);
		bridge_note(bridge, "clear", error);
		if (error != PASSO_OK)
			bridge_poll(bridge, 10);
	}
	if (error != PASSO_OK)
		world_fail(
		    bridge->world, bridge->world->clock, "clear never succeeds: %s", passo_error_name(error));
	world_run(bridge->world, 3000);
	bridge_agree(bridge);
	bridge_check_positions(bridge);
}
