/* SPDX-License-Identifier: MIT
 * Events in the model at which disturbances can be aimed.
 */
#include "world_private.h"

/* Clocks at rest between two consecutive queued motions. */
#define GAP_CLOCKS 4u

static void add_event(struct world *world, enum world_event_kind kind, unsigned channel)
{
	if (world->event_count == world->event_room)
		world->events = world_more(world->events, &world->event_room, sizeof *world->events);
	world->events[world->event_count++] = (struct world_event){world->clock, kind, (uint8_t)channel};
}

static uint8_t waits_of(const struct passo_channel *channel)
{
	uint8_t waits = 0;

	for (unsigned i = 0; i < channel->axes; i++)
		waits |= (uint8_t)((channel->axis[i].waits != 0u ? 1u : 0u) << i);
	return waits;
}

static bool axes_rest(const struct passo_channel *channel)
{
	for (unsigned i = 0; i < channel->axes; i++)
		if (channel->axis[i].state != PASSO_AXIS_READY || channel->axis[i].waits != 0u)
			return false;
	return true;
}

struct world_before world_look(const struct passo_channel *channel)
{
	return (struct world_before){.state = channel->motion.state,
	    .stopping = channel->motion.stopping,
	    .at_rest = axes_rest(channel),
	    .rate = channel->timescale.rate,
	    .line = channel->line_queue.next_line,
	    .ramp = channel->ramp_queue.read_ramp,
	    .tick = (uint16_t)channel->ramp.tick_count,
	    .waits = waits_of(channel)};
}

void world_note_events(
    struct world *world, const struct world_before *before, const struct passo_outputs *pins)
{
	const unsigned axes = world->model.parameters.axes;

	for (unsigned i = 0; i < world->model.parameters.channels; i++) {
		const struct passo_channel *channel = &world->model.channel[i];
		const struct world_before *was = &before[i];
		const struct world_before now = world_look(channel);
		const uint64_t mine = ((UINT64_C(1) << axes) - 1u) << (i * axes);

		if (was->state != now.state)
			add_event(world, EVENT_STATE, i);
		if (was->state == PASSO_STATE_IDLE && now.state == PASSO_STATE_PREPARE
		    && world->clock <= world->idle_since[i] + GAP_CLOCKS)
			add_event(world, EVENT_GAP, i);
		if (was->state != PASSO_STATE_IDLE && now.state == PASSO_STATE_IDLE)
			world->idle_since[i] = world->clock;
		if (was->stopping != now.stopping)
			add_event(world, EVENT_STOPPING, i);
		if (world->model.slew_tick && now.state >= PASSO_STATE_RUN && now.state <= PASSO_STATE_DRAIN)
			add_event(world, EVENT_SLEW, i);
		if (was->rate != now.rate)
			add_event(world, EVENT_RATE, i);
		if (was->line != now.line)
			add_event(world, EVENT_LINE, i);
		if (was->ramp != now.ramp)
			add_event(world, EVENT_RAMP, i);
		if (now.tick < was->tick && now.state == PASSO_STATE_RUN)
			add_event(world, EVENT_TICK, i);
		if ((pins->step ^ world->outputs.step) & mine)
			add_event(world, EVENT_STEP, i);
		if ((pins->dir ^ world->outputs.dir) & mine)
			add_event(world, EVENT_DIR, i);
		if (was->waits != now.waits)
			add_event(world, EVENT_WAITS, i);
		if (!was->at_rest && now.at_rest)
			add_event(world, EVENT_QUIET, i);
	}
}
