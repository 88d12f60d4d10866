/* SPDX-License-Identifier: MIT
 * Jumping over quiet time: passo_core_advance().
 *
 * While a profile runs, a clock is quiet if it moves only counters and sums whose later values can be told at
 * once: the tick counter, the phase, e of each DDA, the substeps of the line, timers. It is not quiet if a
 * step is made, a line or a tick ends, a ramp is chosen, or anything arrives from outside.
 *
 * The pipeline from path to DDA makes this less simple than it sounds: at any time up to three substeps are
 * on their way. So a jump first takes them all to their end (`struct progress`), counts there, and then puts
 * the last ones back on their way: which clocks had a carry follows from the phase alone, as long as the
 * velocity stood still for the last four clocks.
 */
#include "passo_core.h"

#include "passo_registers_core.h"

/* Clocks from the phase to the DDA whose substeps are on their way. */
enum { PIPELINE_CLOCKS = 4 };

/* Clocks from a slew tick until the rate has changed: see passo_timescale_clock(). */
enum { SLEW_CLOCKS = 6 };

/* A ramp has made the next velocity by then, in any case, and stepped. */
static const uint32_t RAMP_DONE_TICK_COUNT = 100;

static const uint64_t PHASE_MASK = PASSO_ONE_Q48 - 1u;

/* Path, line and DDAs as if every substep so far had arrived. */
struct progress {
	uint64_t phase;    /* UQ0.48 */
	int64_t remaining; /* of the line: 1 - M + substeps */
	int64_t e[PASSO_AXES_MAX];
};

static uint64_t min_u64(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

/* ---- what must stand still ---- */

static bool lines_settled(const struct passo_channel *channel, const struct passo_parameters *parameters)
{
	const struct passo_line_queue *queue = &channel->line_queue;
	const struct passo_line *current = &queue->lines[queue->current_line];
	const unsigned depth = 1u << parameters->line_queue_log2;
	const unsigned used = ((unsigned)queue->write_line - queue->next_line) & (2u * depth - 1u);

	for (unsigned i = 0; i < channel->axes; i++)
		if (queue->steps[i] != current->steps[i])
			return false;
	return queue->room == depth - used - (queue->has_place ? 1u : 0u) && queue->next_valid == (used != 0u)
	    && queue->directions == current->directions;
}

static bool ramps_settled(const struct passo_ramp_queue *queue, const struct passo_parameters *parameters)
{
	const unsigned depth = 1u << parameters->ramp_queue_log2;
	const unsigned used = ((unsigned)queue->write_ramp - queue->read_ramp) & (2u * depth - 1u);

	return !queue->write_low && queue->room == depth - used && queue->valid == (used != 0u);
}

static bool commands_settled(const struct passo_channel *channel, const struct passo_bus *bus)
{
	const struct passo_channel_registers *registers = &channel->registers;
	const uint8_t in_axes = (uint8_t)((uint8_t)bus->address - PASSO_CHANNEL_AXIS_BASE);

	return !registers->command_stop && !registers->command_abort && !registers->command_clear
	    && !registers->command_zero && !registers->drain_velocity_written && !channel->writes_axis
	    && channel->written_register == in_axes;
}

static bool slots_empty(const struct passo_channel *channel)
{
	const struct passo_line_unit *line = &channel->line;
	const bool stopped = passo_channel_stopped(channel);

	if (line->on_last != (line->substep_number == channel->line_queue.last_substep))
		return false;
	for (unsigned i = 0; i < channel->axes; i++)
		if (channel->dda[i].addend != (int64_t)channel->line_queue.steps[i])
			return false;
	if (channel->path.refresh != stopped || channel->path.take_q != stopped)
		return false;
	if (stopped && (channel->path.velocity_low != 0u || channel->path.velocity_high != 0u))
		return false;
	return !channel->path.advance_q && !channel->path.substep && !line->slot_add && !line->slot_step;
}

/* Clocks for which the rate stands still: all, or until the next slew tick. */
static uint64_t timescale_quiet(const struct passo_channel *channel, bool moving, uint64_t clocks_to_slew)
{
	const struct passo_timescale *timescale = &channel->timescale;
	const uint32_t target = channel->registers.rate_target;
	const uint32_t slew = channel->registers.rate_slew == 0u ? 1u : channel->registers.rate_slew;

	if (timescale->rate != timescale->goal || timescale->after != 0u)
		return 0;
	if (!moving)
		return timescale->rate == target && timescale->still && timescale->rate_sum == 0u
		            && !timescale->enable
		         ? UINT64_MAX
		         : 0u;
	const bool steady = timescale->enable ? timescale->rate == PASSO_RATE_ONE : timescale->rate == 0u;
	if (!steady || timescale->still)
		return 0;
	return timescale->goal == target && timescale->slew == slew && !timescale->down && !timescale->stops
	         ? UINT64_MAX
	         : clocks_to_slew;
}

static uint64_t ramp_quiet(const struct passo_ramp_unit *ramp)
{
	if (ramp->take_now || ramp->dry || ramp->step == PASSO_RAMP_TAKE)
		return 0;
	if (ramp->step == PASSO_RAMP_CHOOSE)
		return !ramp->ready && !ramp->ends_next ? 0u : UINT64_MAX;
	return ramp->wait - 1u;
}

/* Motions at rest: nothing starts. Motions that run: their pin is up, nothing stops. */
static bool motion_settled(const struct passo_channel *channel, const struct passo_channel_inputs *inputs)
{
	const struct passo_motion *motion = &channel->motion;

	if (motion->stopping || motion->stop_due || motion->settling != 0u || motion->aborted != 0u
	    || motion->rate_was_zero != (channel->timescale.rate == 0u))
		return false;
	switch (motion->state) {
	case PASSO_STATE_IDLE:
		return !motion->running && !motion->startable
		    && !(inputs->run && channel->line_queue.next_valid && channel->ramp_queue.valid);
	case PASSO_STATE_PREPARE:
		return !motion->running && !channel->ramp.ready;
	case PASSO_STATE_ARMED:
		return !motion->running && inputs->wait_sync && !motion->begin_profile;
	case PASSO_STATE_STOPPED:
		return !motion->running;
	case PASSO_STATE_RUN:
		return motion->running && motion->count == 6u;
	default:
		return false;
	}
}

/* Whether the channel is at rest is known. */
static bool rest_settled(const struct passo_channel *channel)
{
	const bool occupied = passo_channel_occupied(channel);
	bool at_rest = !occupied;

	for (unsigned i = 0; i < channel->axes; i++)
		at_rest = at_rest && channel->axis[i].quiet;
	return channel->occupied_before == (occupied ? 7u : 0u) && channel->at_rest == at_rest;
}

/* Clocks for which everything in the channel is quiet, but for what a running profile moves. */
static uint64_t surroundings_quiet(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew)
{
	const struct passo_line_unit *line = &channel->line;
	const bool moving = channel->motion.state == PASSO_STATE_RUN;

	if (!motion_settled(channel, inputs) || !rest_settled(channel) || channel->positions.snapshot_waits
	    || !commands_settled(channel, inputs->bus) || line->slot_load || line->slot_load_q
	    || line->underrun || !ramps_settled(&channel->ramp_queue, inputs->parameters)
	    || !lines_settled(channel, inputs->parameters))
		return 0;
	uint64_t clocks =
	    min_u64(ramp_quiet(&channel->ramp), timescale_quiet(channel, moving, clocks_to_slew));
	for (unsigned i = 0; i < channel->axes && clocks != 0u; i++) {
		const uint32_t quiet =
		    passo_axis_quiet(&channel->axis[i], (line->directions >> i & 1u) != 0u);
		clocks = quiet == UINT32_MAX ? clocks : min_u64(clocks, quiet);
	}
	return clocks;
}

/* ---- the pipeline ---- */

/* Takes all substeps to their end; false if one of them does more than count. */
static bool take_to_end(const struct passo_channel *channel, struct progress *progress)
{
	const struct passo_path *path = &channel->path;
	const struct passo_line_unit *line = &channel->line;
	uint64_t phase_high = path->phase_high;
	int64_t on_the_way = 0;

	if (!line->active && (line->slot_add || line->slot_step))
		return false; /* the last substep of the last line */
	if (path->advance_q)
		phase_high += path->velocity_high + (path->phase_low_carry ? 1u : 0u);
	progress->phase = (phase_high << 24 & PHASE_MASK) | path->phase_low;
	if (line->active)
		on_the_way = (path->substep ? 1 : 0) + (phase_high >> 24 != 0u ? 1 : 0);
	progress->remaining =
	    (int64_t)line->substep_number + on_the_way - (int64_t)channel->line_queue.last_substep;
	on_the_way += line->slot_add ? 1 : 0;
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_dda *dda = &channel->dda[i];
		const int64_t steps = (int64_t)channel->line_queue.steps[i];
		if ((line->slot_step && dda->e_minus_m >= 0) || (!line->slot_step && dda->addend != steps))
			return false;
		progress->e[i] = dda->e_minus_m + on_the_way * steps;
		if (line->active && progress->e[i] >= 0)
			return false;
	}
	return !line->active || progress->remaining <= 0;
}

/* Substeps of an active line, if none of them ends it or makes a step. */
static bool count_substeps(const struct passo_channel *channel, struct progress *progress, int64_t substeps)
{
	if (!channel->line.active)
		return true;
	if (progress->remaining + substeps > 0)
		return false;
	for (unsigned i = 0; i < channel->axes; i++)
		if (progress->e[i] + substeps * (int64_t)channel->line_queue.steps[i] >= 0)
			return false;
	progress->remaining += substeps;
	for (unsigned i = 0; i < channel->axes; i++)
		progress->e[i] += substeps * (int64_t)channel->line_queue.steps[i];
	return true;
}

/* How many substeps may follow before one ends the line or makes a step. */
static uint64_t substeps_to_event(const struct passo_channel *channel, const struct progress *progress)
{
	uint64_t substeps = (uint64_t)-progress->remaining;

	for (unsigned i = 0; i < channel->axes; i++) {
		const uint64_t steps = channel->line_queue.steps[i];
		const uint64_t distance = (uint64_t)(-progress->e[i] - 1);
		if (steps != 0u && distance / steps < substeps)
			substeps = distance / steps;
	}
	return substeps;
}

static uint64_t velocity_of(const struct passo_path *path)
{
	return (uint64_t)path->velocity_high << 24 | path->velocity_low;
}

/* Sums the velocity over some clocks of one tick; returns the substeps. */
static int64_t sum_phase(struct progress *progress, uint64_t velocity, uint64_t clocks)
{
	/* at most 2^16 clocks at 1/2: 2^15 substeps, 63 bits */
	const uint64_t sum = progress->phase + velocity * clocks;

	progress->phase = sum & PHASE_MASK;
	return (int64_t)(sum >> 48);
}

/* Puts the substeps of the last clocks back on their way; the velocity has stood for PIPELINE_CLOCKS clocks.
 */
static void put_back(struct passo_channel *channel, const struct progress *progress)
{
	struct passo_path *path = &channel->path;
	struct passo_line_unit *line = &channel->line;
	const uint64_t velocity = velocity_of(path);
	uint64_t phase = progress->phase;
	bool carry[PIPELINE_CLOCKS]; /* of the last clock, the one before it, ... */
	uint64_t phase_before_last = 0;

	for (unsigned i = 0; i < PIPELINE_CLOCKS; i++) {
		carry[i] = phase < velocity;
		phase = (phase - velocity) & PHASE_MASK;
		if (i == 0u)
			phase_before_last = phase;
	}
	path->phase_low = (uint32_t)(progress->phase & 0xFFFFFFu);
	path->phase_low_carry = path->phase_low < (uint32_t)(velocity & 0xFFFFFFu);
	path->phase_high = (uint32_t)(phase_before_last >> 24);
	path->advance_q = true;
	path->substep = carry[1];
	if (!line->active)
		return;
	line->slot_add = carry[2];
	line->slot_step = carry[3];
	const int64_t not_counted = (carry[0] ? 1 : 0) + (carry[1] ? 1 : 0);
	const int64_t not_added = not_counted + (carry[2] ? 1 : 0);
	const int64_t last_substep = (int64_t)channel->line_queue.last_substep;
	line->substep_number = (uint32_t)(progress->remaining + last_substep - not_counted);
	line->on_last = progress->remaining - not_added == 0;
	for (unsigned i = 0; i < channel->axes; i++) {
		const int64_t steps = (int64_t)channel->line_queue.steps[i];
		channel->dda[i].e_minus_m = progress->e[i] - not_added * steps;
		channel->dda[i].addend = carry[3] ? -1 - last_substep : steps;
	}
}

/* ---- a channel ---- */

static bool profile_counts(const struct passo_channel *channel)
{
	return channel->motion.state == PASSO_STATE_RUN && channel->timescale.enable;
}

/* Clocks to the next event of a running profile, within its tick. */
static uint64_t profile_quiet(
    const struct passo_channel *channel, const struct passo_parameters *parameters, uint64_t limit)
{
	const uint64_t velocity = velocity_of(&channel->path);
	const uint32_t tick_last = (1u << parameters->tick_log2) - 1u;
	const uint32_t tick_count = channel->ramp.tick_count;
	/* first to the place from which skip_ticks() can go on */
	const bool before_place = channel->ramp.ready && tick_count < RAMP_DONE_TICK_COUNT;
	const uint32_t goal = before_place ? RAMP_DONE_TICK_COUNT : tick_last;
	struct progress progress;

	if (channel->ramp_queue.now_pending || channel->path.take_q || channel->path.refresh
	    || !take_to_end(channel, &progress))
		return 0;
	uint64_t clocks = min_u64(limit, goal - tick_count);
	if (channel->line.active && velocity != 0u) {
		struct progress then = progress;
		const int64_t substeps = sum_phase(&then, velocity, clocks);
		if (!count_substeps(channel, &then, substeps)) {
			const uint64_t allowed = substeps_to_event(channel, &progress);
			clocks = min_u64(clocks, (((allowed + 1u) << 48) - 1u - progress.phase) / velocity);
		}
	}
	return clocks < PIPELINE_CLOCKS ? 0u : clocks;
}

static uint64_t channel_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs,
    uint64_t clocks_to_slew, uint64_t limit)
{
	const uint64_t clocks = min_u64(limit, surroundings_quiet(channel, inputs, clocks_to_slew));

	if (clocks == 0u)
		return 0;
	if (profile_counts(channel))
		return profile_quiet(channel, inputs->parameters, clocks);
	return slots_empty(channel) ? clocks : 0u;
}

/* What runs on its own: timers and waits. */
static void skip_surroundings(struct passo_channel *channel, uint64_t clocks)
{
	for (unsigned i = 0; i < channel->axes; i++)
		passo_axis_skip(&channel->axis[i], clocks);
	passo_positions_skip(&channel->positions, clocks);
}

static void channel_skip(struct passo_channel *channel, uint64_t clocks)
{
	struct passo_ramp_unit *ramp = &channel->ramp;
	struct progress progress;

	skip_surroundings(channel, clocks);
	ramp->unready = !ramp->ready;
	if (ramp->step != PASSO_RAMP_CHOOSE)
		ramp->wait -= (uint32_t)clocks;
	if (!profile_counts(channel))
		return;
	take_to_end(channel, &progress);
	const int64_t substeps = sum_phase(&progress, velocity_of(&channel->path), clocks);
	count_substeps(channel, &progress, substeps);
	ramp->tick_count += (uint32_t)clocks;
	put_back(channel, &progress);
}

/* Jumps from one place in a tick to the same place in a later one, over ticks without any event; returns the
 * clocks. The place is one at which the next velocity is ready, and the ramp goes on. */
static uint64_t skip_ticks(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit)
{
	struct passo_ramp_unit *ramp = &channel->ramp;
	struct passo_path *path = &channel->path;
	const uint64_t tick = UINT64_C(1) << inputs->parameters->tick_log2;
	const uint64_t place = ramp->tick_count;
	struct progress progress;
	uint64_t clocks = 0;

	if (!profile_counts(channel) || ramp->step != PASSO_RAMP_CHOOSE || ramp->unready || !ramp->loaded
	    || place < RAMP_DONE_TICK_COUNT || channel->ramp_queue.now_pending
	    || !take_to_end(channel, &progress))
		return 0;
	/* the last velocity of a ramp takes it from the queue */
	while (ramp->ticks > 1u && clocks + tick <= limit) {
		struct progress then = progress;
		int64_t substeps = sum_phase(&then, velocity_of(path), tick - place);
		substeps += sum_phase(&then, ramp->velocity_next, place);
		if (!count_substeps(channel, &then, substeps))
			break;
		progress = then;
		path->velocity_low = (uint32_t)(ramp->velocity_next & 0xFFFFFFu);
		path->velocity_high = (uint32_t)(ramp->velocity_next >> 24);
		passo_ramp_make_velocity(ramp, inputs->tables);
		clocks += tick;
	}
	if (clocks != 0u) {
		skip_surroundings(channel, clocks);
		put_back(channel, &progress);
	}
	return clocks;
}

/* ---- the core ---- */

static bool same_inputs(const struct passo_inputs *a, const struct passo_inputs *b)
{
	return a->spi_sclk == b->spi_sclk && a->spi_mosi == b->spi_mosi && a->spi_cs_n == b->spi_cs_n
	    && a->sync == b->sync && a->rst == b->rst;
}

static bool link_side_quiet(const struct passo_core *core, const struct passo_inputs *inputs)
{
	const uint8_t selected = inputs->spi_cs_n ? 0 : 7;
	const uint8_t toggled = core->spi.half_toggle ? 7 : 0;
	const uint8_t synced = inputs->sync ? 7 : 0;

	return same_inputs(inputs, &core->inputs) && core->spi.select_sync == selected
	    && core->spi.toggle_sync == toggled && core->sync_q == synced && passo_link_quiet(&core->link)
	    && core->link.status == passo_registers_status(core) && !core->response.claim
	    && core->response.refusal == 0u && core->response.read_data == 0u && !core->response.late
	    && core->outputs.irq == passo_registers_any_stopped(core);
}

static struct passo_channel_inputs inputs_of(const struct passo_core *core, unsigned channel)
{
	return (struct passo_channel_inputs){
	    .parameters = &core->parameters,
	    .tables = &core->tables,
	    .bus = &core->link.bus,
	    .run = (core->registers.run >> channel & 1u) != 0u,
	    .wait_sync = (core->registers.wait_sync >> channel & 1u) != 0u,
	};
}

uint64_t passo_core_advance(struct passo_core *core, const struct passo_inputs *inputs, uint64_t limit)
{
	const uint32_t tick = 1u << core->parameters.tick_log2;
	const uint64_t clocks_to_slew = core->slew_tick ? 0u : tick - core->slew_count;
	const unsigned channels = core->parameters.channels;
	unsigned moving = channels; /* the only one that moves */
	uint64_t clocks = limit;

	if (clocks == 0u || inputs->rst || !link_side_quiet(core, inputs))
		return 0;
	for (unsigned i = 0; i < channels; i++) {
		const struct passo_channel_inputs channel_inputs = inputs_of(core, i);
		if (moving == channels && profile_counts(&core->channel[i])) {
			moving = i;
			continue;
		}
		clocks = min_u64(
		    clocks, channel_quiet(&core->channel[i], &channel_inputs, clocks_to_slew, clocks));
		if (clocks == 0u)
			return 0;
	}
	if (moving != channels) {
		const struct passo_channel_inputs channel_inputs = inputs_of(core, moving);
		struct passo_channel *channel = &core->channel[moving];
		const uint64_t quiet =
		    min_u64(clocks, surroundings_quiet(channel, &channel_inputs, clocks_to_slew));
		/* the others are quiet within their ticks only, if they move */
		uint64_t skipped = skip_ticks(channel, &channel_inputs, quiet);
		if (skipped == 0u) {
			skipped = quiet == 0u ? 0u : profile_quiet(channel, &core->parameters, quiet);
			if (skipped == 0u)
				return 0;
			channel_skip(channel, skipped);
		}
		clocks = skipped;
	}
	for (unsigned i = 0; i < channels; i++)
		if (i != moving)
			channel_skip(&core->channel[i], clocks);

	core->slew_tick = (core->slew_count + clocks - 1u) % tick == tick - 1u;
	core->slew_count = (uint32_t)((core->slew_count + clocks) % tick);
	/* a slew tick on the way is still at work */
	for (unsigned i = 0; i < channels; i++)
		if (core->channel[i].motion.state == PASSO_STATE_RUN && core->slew_count <= SLEW_CLOCKS
		    && core->slew_count <= clocks)
			core->channel[i].timescale.after = (uint8_t)core->slew_count;
	core->tables.slot = (uint8_t)((core->tables.slot + clocks) % (2u * channels));
	return clocks;
}
