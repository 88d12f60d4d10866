/* SPDX-License-Identifier: MIT
 * Histories on a link that dies during a call and recovers.
 */
#include <string.h>

#include "bridge_host.h"

#define POLLS 50u

/* Lets the link die in one of the next frames. */
static void arm(struct bridge *bridge)
{
	bridge->wire.level = scenario_chance(bridge->random, 50);
	bridge->wire.dies_in = 1u + scenario_draw(bridge->random, 3);
	bridge->wire.dies_at = scenario_draw(bridge->random, 32u * 12u);
}

static void reconnect(struct bridge *bridge)
{
	bridge_poll(bridge, scenario_draw(bridge->random, 4));
	bridge->wire.dead = false;
	bridge->wire.dies_in = 0;
	bridge_poll(bridge, POLLS);
}

static void expect_standstill(struct bridge *bridge)
{
	struct world *world = bridge->world;

	world_run(world, 2u * HOLD_MICROSECONDS);
	bridge_count_pins(bridge);
	int64_t before[PASSO_AXES_MAX];
	memcpy(before, bridge->pulses, sizeof before);
	bridge_poll(bridge, 20);
	bridge_count_pins(bridge);
	if (memcmp(before, bridge->pulses, sizeof before) != 0)
		world_fail(world, world->clock, "it moves although a hold was commanded: %s",
		    passo_error_name(passo_fault(&bridge->passo)));
}

static void die_in_move(struct bridge *bridge)
{
	struct world *world = bridge->world;
	const struct passo_move_by_speed move = bridge_draw_move(bridge);

	arm(bridge);
	enum passo_error error = passo_move_by_speed(&bridge->passo, &move);
	bridge_note(bridge, "move while the link fails", error);
	reconnect(bridge);
	world_run(world, 30000);
	bridge_count_pins(bridge);
	const bool none = memcmp(bridge->made, bridge->wanted, sizeof bridge->made) == 0;
	bridge_want(bridge, &move);
	const bool all = memcmp(bridge->made, bridge->wanted, sizeof bridge->made) == 0;
	if (!all && (error == PASSO_OK || !none))
		world_fail(world, world->clock, "move while the link failed, %s: neither made nor left out",
		    passo_error_name(error));
	bridge_agree(bridge);
	if (error != PASSO_OK) {
		passo_abort(&bridge->passo);
		bridge_recover(bridge);
	}
}

static void die_in_enable(struct bridge *bridge)
{
	bridge_finish(bridge);
	arm(bridge);
	bridge_note(bridge, "disable while the link fails", passo_enable(&bridge->passo, 0, false));
	reconnect(bridge);
	bridge_must(bridge, "disable", passo_enable(&bridge->passo, 0, false));
	world_run(bridge->world, 100);
	if ((bridge->world->outputs.enable & 1u) != 0u)
		world_fail(bridge->world, bridge->world->clock, "axis 0 is enabled");
	bridge_must(bridge, "enable", passo_enable(&bridge->passo, 0, true));
}

static void die_in_zero(struct bridge *bridge)
{
	bridge_finish(bridge);
	arm(bridge);
	bridge_note(bridge, "zero while the link fails", passo_zero(&bridge->passo));
	reconnect(bridge);
	bridge_must(bridge, "zero", passo_zero(&bridge->passo));
	memset(bridge->made, 0, sizeof bridge->made);
	bridge_agree(bridge);
	bridge_check_positions(bridge);
}

static void die_in_rate(struct bridge *bridge, unsigned which)
{
	enum passo_error error;

	if (which == 1u)
		bridge_must(bridge, "hold", passo_hold(&bridge->passo));
	arm(bridge);
	if (which == 0u)
		error = passo_hold(&bridge->passo);
	else if (which == 1u)
		error = passo_resume(&bridge->passo);
	else
		error = passo_override(&bridge->passo, 1u + scenario_draw(bridge->random, 100));
	bridge_note(bridge,
	    which == 0u   ? "hold while the link fails"
	    : which == 1u ? "resume ..."
	                  : "override ...",
	    error);
	reconnect(bridge);
	if (which == 0u || (which == 1u && error != PASSO_OK))
		expect_standstill(bridge);
	bridge_must(bridge, "resume", passo_resume(&bridge->passo));
	bridge_must(bridge, "override", passo_override(&bridge->passo, 100));
	bridge_finish(bridge);
}

static void die_in_stop(struct bridge *bridge, bool softly)
{
	const char *what = softly ? "stop while the link fails" : "abort while the link fails";

	arm(bridge);
	bridge_note(bridge, what, softly ? passo_stop(&bridge->passo) : passo_abort(&bridge->passo));
	reconnect(bridge);
	bridge_check_stopped(bridge, what);
	if (scenario_chance(bridge->random, 50)) {
		arm(bridge);
		bridge_note(bridge, "clear while the link fails", passo_clear(&bridge->passo));
		reconnect(bridge);
	}
	bridge_recover(bridge);
}

void bridge_play_death(struct bridge *bridge)
{
	struct scenario_random *random = bridge->random;
	const unsigned kind = scenario_draw(random, 8);
	enum passo_error error;

	for (unsigned i = 1u + scenario_draw(random, 6); i != 0u; i--)
		bridge_move(bridge, &error);
	bridge_poll(bridge, scenario_draw(random, 6));
	if (kind <= 1u)
		die_in_stop(bridge, kind == 0u);
	else if (kind <= 4u)
		die_in_rate(bridge, kind - 2u);
	else if (kind == 5u)
		die_in_move(bridge);
	else if (kind == 6u)
		die_in_enable(bridge);
	else
		die_in_zero(bridge);
	if (bridge->world->failed_at)
		return;
	bridge_must(bridge, "finish", bridge_move(bridge, &error) ? PASSO_OK : error);
	bridge_finish(bridge);
	bridge_check_positions(bridge);
}
