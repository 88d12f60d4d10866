/* SPDX-License-Identifier: MIT
 * Skipping quiet time in a channel with a running profile. See passo_advance.c.
 *
 * The pipeline from path to DDA can hold up to three substeps in flight. A skip therefore first completes
 * them all (`struct progress`), advances the counts, and then refills the pipeline: the phase alone
 * determines which clocks had a carry, provided that the velocity was constant for the last four clocks.
 */
#include "passo_advance.h"
#include "passo_registers.h"

/* By then a ramp has always computed the next velocity and advanced. */
static const uint32_t RAMP_DONE_TICK_COUNT = 100;

static const uint64_t PHASE_MASK = PASSO_ONE_Q48 - 1u;

/* Of a jump, so that their phase has 63 bits. */
static const uint64_t SUBSTEPS_MAX = (1u << 15) - 2u;

/* State of path, line and DDAs with all substeps completed. */
struct progress {
	uint64_t phase;    /* UQ0.48 */
	int64_t remaining; /* of the line: 1 - M + substeps */
	int64_t e[PASSO_AXES_MAX];
};

/* Completes all substeps in flight; false if one of them has an effect other than counting. */
static bool take_to_end(const struct passo_channel *channel, struct progress *progress)
{
	const struct passo_path *path = &channel->path;
	const struct passo_line_unit *line = &channel->line;
	uint64_t phase_high = path->phase_high;
	int64_t on_the_way = 0;

	if (!line->active && (line->add_n || line->decide_step))
		return false; /* the last substep of the last line */
	if (path->advance_q)
		phase_high += path->velocity_high + (path->phase_low_carry ? 1u : 0u);
	progress->phase = (phase_high << 24 & PHASE_MASK) | path->phase_low;
	if (line->active)
		on_the_way = (path->substep ? 1 : 0) + (phase_high >> 24 != 0u ? 1 : 0);
	progress->remaining =
	    (int64_t)line->substep_number + on_the_way - (int64_t)channel->line_queue.last_substep;
	on_the_way += line->add_n ? 1 : 0;
	for (unsigned i = 0; i < channel->axes; i++) {
		const struct passo_dda *dda = &channel->dda[i];
		const int64_t steps = (int64_t)channel->line_queue.steps[i];
		if ((line->decide_step && dda->e_minus_m >= 0)
		    || (!line->decide_step && dda->addend != steps))
			return false;
		progress->e[i] = dda->e_minus_m + on_the_way * steps;
		if (line->active && progress->e[i] >= 0)
			return false;
	}
	return !line->active || progress->remaining <= 0;
}

/* Counts substeps of an active line; false if one of them ends it or makes a step. */
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

/* Number of substeps before one ends the line or makes a step. */
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

/* Integrates the velocity over clocks of one tick; returns the substeps. */
static int64_t sum_phase(struct progress *progress, uint64_t velocity, uint64_t clocks)
{
	/* at most 2^16 clocks at 1/2: 2^15 substeps, 63 bits */
	const uint64_t sum = progress->phase + velocity * clocks;

	progress->phase = sum & PHASE_MASK;
	return (int64_t)(sum >> 48);
}

/* Refills the pipeline with the substeps of the last clocks; the velocity must have been constant for
 * PASSO_ADVANCE_PIPELINE clocks. */
static void put_back(struct passo_channel *channel, const struct progress *progress)
{
	struct passo_path *path = &channel->path;
	struct passo_line_unit *line = &channel->line;
	const uint64_t velocity = velocity_of(path);
	uint64_t phase = progress->phase;
	bool carry[PASSO_ADVANCE_PIPELINE]; /* of the last clock, the one before it, ... */
	uint64_t phase_before_last = 0;

	for (unsigned i = 0; i < PASSO_ADVANCE_PIPELINE; i++) {
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
	line->add_n = carry[2];
	line->decide_step = carry[3];
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

bool passo_advance_profile_counts(const struct passo_channel *channel)
{
	return channel->motion.state == PASSO_STATE_RUN && channel->timescale.enable
	    && !channel->encoders.follow;
}

uint64_t passo_advance_profile_quiet(
    const struct passo_channel *channel, const struct passo_parameters *parameters, uint64_t limit)
{
	const uint64_t velocity = velocity_of(&channel->path);
	const uint32_t tick_last = (1u << parameters->tick_log2) - 1u;
	const uint32_t tick_count = channel->ramp.tick_count;
	/* first to the point from which passo_advance_skip_ticks() can continue */
	const bool before_place = channel->ramp.ready && tick_count < RAMP_DONE_TICK_COUNT;
	const uint32_t goal = before_place ? RAMP_DONE_TICK_COUNT : tick_last;
	struct progress progress;

	if (channel->ramp_queue.now_pending || channel->path.take_q || channel->path.refresh
	    || !take_to_end(channel, &progress))
		return 0;
	uint64_t clocks = passo_least(limit, goal - tick_count);
	if (channel->line.active && velocity != 0u) {
		struct progress then = progress;
		const int64_t substeps = sum_phase(&then, velocity, clocks);
		if (!count_substeps(channel, &then, substeps)) {
			const uint64_t allowed = substeps_to_event(channel, &progress);
			clocks =
			    passo_least(clocks, (((allowed + 1u) << 48) - 1u - progress.phase) / velocity);
		}
	}
	return clocks < PASSO_ADVANCE_PIPELINE ? 0u : clocks;
}

uint64_t passo_advance_channel_quiet(const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, uint64_t clocks_to_slew, uint64_t limit)
{
	uint64_t clocks =
	    passo_least(limit, passo_advance_surroundings_quiet(channel, inputs, clocks_to_slew));

	clocks = passo_least(clocks, passo_advance_ramp_quiet(&channel->ramp));
	for (unsigned i = 0; i < channel->axes && clocks != 0u; i++)
		clocks = passo_least(clocks, passo_advance_axis_quiet(channel, i));
	if (clocks == 0u)
		return 0;
	if (passo_advance_profile_counts(channel))
		return passo_advance_profile_quiet(channel, inputs->parameters, clocks);
	return passo_advance_slots_empty(channel) ? clocks : 0u;
}

static void skip_outputs(struct passo_channel *channel, uint64_t clocks, uint32_t substeps)
{
	const struct passo_outputs_skipped skipped = {
	    .running = channel->motion.running,
	    .velocity = passo_channel_registers_value(channel, PASSO_CHANNEL_VELOCITY),
	    .rate = channel->timescale.rate,
	    .substeps = substeps,
	    .pwm_step = channel->output_registers.settings.pwm_step,
	};

	passo_outputs_skip(&channel->outputs, &skipped, clocks);
}

void passo_advance_surroundings_skip(struct passo_channel *channel, uint64_t clocks, uint32_t substeps)
{

	passo_positions_skip(&channel->positions, clocks);
	passo_inputs_skip(&channel->inputs, clocks);
	if (channel->has_outputs)
		skip_outputs(channel, clocks, substeps);
	passo_encoders_skip(channel, clocks);
	if (channel->trackers.present)
		passo_trackers_skip(channel, clocks);
}

void passo_advance_profile_skip(struct passo_channel *channel, uint64_t clocks)
{
	struct passo_ramp_unit *ramp = &channel->ramp;
	struct progress progress;

	ramp->unready = !ramp->ready;
	if (ramp->step != PASSO_RAMP_CHOOSE)
		ramp->wait -= (uint32_t)clocks;
	if (!passo_advance_profile_counts(channel))
		return;
	take_to_end(channel, &progress);
	const int64_t substeps = sum_phase(&progress, velocity_of(&channel->path), clocks);
	count_substeps(channel, &progress, substeps);
	ramp->tick_count += (uint32_t)clocks;
	put_back(channel, &progress);
}

void passo_advance_channel_skip(struct passo_channel *channel, uint64_t clocks)
{
	const uint32_t before = channel->line.substep_number;

	for (unsigned i = 0; i < channel->axes; i++)
		passo_axis_skip(&channel->axis[i], clocks);
	passo_advance_profile_skip(channel, clocks);
	passo_advance_surroundings_skip(channel, clocks, channel->line.substep_number - before);
}

/* Whether the velocity is that of all ticks that are left of the ramp. */
static bool is_constant(const struct passo_ramp_unit *ramp, uint64_t velocity)
{
	return ramp->v_start == velocity && ramp->v_end == velocity && ramp->velocity_next == velocity;
}

/* Ticks that are quiet even at the highest velocity that the ramp can have in them, at most `most`. */
static uint64_t ticks_to_event(
    const struct passo_channel *channel, const struct progress *progress, uint64_t most, uint32_t tick_log2)
{
	const struct passo_ramp_unit *ramp = &channel->ramp;
	uint64_t velocity = velocity_of(&channel->path), substeps = SUBSTEPS_MAX;

	velocity = velocity < ramp->v_start ? ramp->v_start : velocity;
	velocity = velocity < ramp->v_end ? ramp->v_end : velocity;
	if (velocity == 0u)
		return most;
	if (channel->line.active)
		substeps = passo_least(substeps, substeps_to_event(channel, progress));
	return passo_least(most, (((substeps + 1u) << 48) - 1u - progress->phase) / (velocity << tick_log2));
}

/* Integrates the velocity over ticks, from a place in one to the same place in another; returns the substeps.
 */
static int64_t sum_ticks(struct passo_channel *channel, struct progress *progress, uint64_t ticks,
    const struct passo_channel_inputs *inputs)
{
	struct passo_ramp_unit *ramp = &channel->ramp;
	struct passo_path *path = &channel->path;
	const uint64_t tick = UINT64_C(1) << inputs->parameters->tick_log2;
	const uint64_t place = ramp->tick_count;
	uint64_t velocity = velocity_of(path);
	uint64_t sum = progress->phase;

	if (is_constant(ramp, velocity)) {
		sum += velocity * tick * ticks;
		passo_ramp_hold(ramp, (uint32_t)ticks);
	} else {
		for (uint64_t i = 0; i < ticks; i++) {
			sum += velocity * (tick - place) + ramp->velocity_next * place;
			velocity = ramp->velocity_next;
			passo_ramp_make_velocity(ramp, inputs->tables);
		}
		path->velocity_low = (uint32_t)(velocity & 0xFFFFFFu);
		path->velocity_high = (uint32_t)(velocity >> 24);
	}
	progress->phase = sum & PHASE_MASK;
	return (int64_t)(sum >> 48);
}

uint64_t passo_advance_skip_ticks(
    struct passo_channel *channel, const struct passo_channel_inputs *inputs, uint64_t limit)
{
	struct passo_ramp_unit *ramp = &channel->ramp;
	const uint32_t tick_log2 = inputs->parameters->tick_log2;
	struct progress progress;
	uint64_t skipped = 0;

	if (limit >> tick_log2 == 0u || !passo_advance_profile_counts(channel)
	    || ramp->step != PASSO_RAMP_CHOOSE || ramp->unready || !ramp->loaded
	    || ramp->tick_count < RAMP_DONE_TICK_COUNT || channel->ramp_queue.now_pending
	    || !take_to_end(channel, &progress))
		return 0;
	/* stop before the last tick of the ramp, which takes the ramp from the queue */
	while (ramp->ticks > 1u && skipped < limit >> tick_log2) {
		const uint64_t most = passo_least(ramp->ticks - 1u, (limit >> tick_log2) - skipped);
		const uint64_t ticks = ticks_to_event(channel, &progress, most, tick_log2);

		if (ticks == 0u)
			break;
		count_substeps(channel, &progress, sum_ticks(channel, &progress, ticks, inputs));
		skipped += ticks;
	}
	if (skipped != 0u)
		put_back(channel, &progress);
	return skipped << tick_log2;
}
