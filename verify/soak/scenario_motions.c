/* SPDX-License-Identifier: MIT
 * Random motions: ramps, and lines about as long as the area under them.
 */
#include <string.h>

#include "scenario_draw.h"

void scenario_add_ramp(struct motion *motion, uint64_t velocity, uint32_t ticks, enum passo_shape shape)
{
	struct passo_ramp *ramp = &motion->ramps[motion->ramp_count++];

	*ramp = (struct passo_ramp){.velocity_end = velocity, .ticks = ticks, .shape = shape};
	if (ticks != 0u) {
		const uint64_t step = (PASSO_ONE_Q48 + ticks / 2u) / ticks;
		ramp->progress_step = step > PASSO_PROGRESS_STEP_MAX ? PASSO_PROGRESS_STEP_MAX : step;
	}
}

/* Approximate number of substeps of the ramps. */
static uint32_t way(const struct motion *motion)
{
	uint64_t from = 0, sum = 0;

	for (unsigned i = 0; i < motion->ramp_count; i++) {
		const struct passo_ramp *ramp = &motion->ramps[i];
		sum += ((from >> 24) + (ramp->velocity_end >> 24)) / 2u * ramp->ticks * TICK_CLOCKS;
		from = ramp->velocity_end;
	}
	return (uint32_t)(sum >> 24);
}

void scenario_draw_ramps(struct scenario *scenario, struct motion *motion, bool constant, unsigned speed)
{
	struct scenario_random *random = &scenario->random;
	const uint64_t velocity = PASSO_VELOCITY_MAX >> speed;

	if (constant) {
		scenario_add_ramp(motion, velocity, 0, PASSO_SHAPE_LINEAR);
		scenario_add_ramp(motion, velocity, 4u + scenario_draw(random, 16), PASSO_SHAPE_LINEAR);
	} else {
		const unsigned count = 1u + scenario_draw(random, 4);

		for (unsigned i = 0; i < count; i++) {
			const uint64_t end = scenario_chance(random, 25)
			                       ? 0u
			                       : velocity - (velocity >> 3) * scenario_draw(random, 6);
			scenario_add_ramp(motion, end, scenario_draw(random, 7),
			    (enum passo_shape)scenario_draw(random, PASSO_BANKS + 1u));
			motion->ramps[i].mirror = scenario_chance(random, 20);
		}
	}
	if (scenario_chance(random, 88))
		motion->ramps[motion->ramp_count - 1u].last = true;
}

/* Substeps per step that the pins can follow; sometimes too few. */
static uint32_t closest(struct scenario *scenario, bool constant, unsigned speed, uint32_t timing)
{
	const uint32_t clocks = (timing >> 16) + (timing & 0xFFFFu) + 2u;
	const uint32_t substeps = clocks >> (speed + 1u);

	return !constant && scenario_chance(&scenario->random, 5) ? 1u : 1u + substeps;
}

void scenario_draw_lines(struct scenario *scenario, struct motion *motion, unsigned channel, bool constant,
    unsigned speed, const uint32_t *timing)
{
	struct scenario_random *random = &scenario->random;
	const uint32_t want = way(motion);
	const uint32_t delta = scenario_draw(random, 12);
	uint32_t left = scenario_chance(random, 55) ? want
	              : scenario_chance(random, 50) ? want + delta
	              : want > 2u * delta           ? want - delta
	                                            : want;
	const unsigned count = 1u + scenario_draw(random, 3);
	uint32_t period[PASSO_AXES_MAX];

	for (unsigned a = 0; a < scenario->parameters.axes; a++) {
		period[a] = closest(scenario, constant, speed, timing[a]) + scenario_draw(random, 5);
	}
	if (constant) {
		uint32_t *gap = &scenario->gap_enabled[channel][0];

		period[0] = *gap != 0u ? *gap >> (speed + 1u) : 2u * ((period[0] + 1u) / 2u);
		*gap = period[0] << (speed + 1u);
		left = want - want / 8u;
	}
	for (unsigned i = 0; i < count; i++) {
		struct passo_line *line = &motion->lines[motion->line_count++];
		uint32_t substeps =
		    i + 1u == count ? left : left / 4u + scenario_draw(random, left / 2u + 1u);

		*line = (struct passo_line){
		    .directions = (uint8_t)scenario_draw(random, 1u << scenario->parameters.axes)};
		if (substeps > left)
			substeps = left;
		left -= substeps;
		line->substeps = substeps == 0u ? 1u : substeps;
		for (unsigned a = 0; a < scenario->parameters.axes; a++) {
			const uint32_t steps = line->substeps / period[a];

			line->steps[a] = scenario_chance(random, 15) ? 0u : steps;
		}
		if (constant && line->substeps >= period[0]) { /* exactly period[0] substeps per step */
			line->steps[0] = line->substeps / period[0];
			line->substeps = line->steps[0] * period[0];
			line->directions = motion->lines[0].directions;
			for (unsigned a = 1; a < scenario->parameters.axes; a++)
				if (line->steps[a] > line->substeps)
					line->steps[a] = line->substeps;
		}
	}
	motion->lines[motion->line_count - 1u].last = constant || scenario_chance(random, 90);
	motion->lines[motion->line_count - 1u].endless = !constant && scenario_chance(random, 12);
}

struct action scenario_push_lines(struct scenario *scenario, unsigned channel, const struct motion *motion)
{
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_LINE));

	for (unsigned i = 0; i < motion->line_count; i++) {
		action.length += (uint16_t)passo_line_words(
		    action.payload + action.length, &motion->lines[i], scenario->parameters.axes);
		if (scenario->parameters.outputs != 0u)
			scenario_add_word(&action, motion->lines[i].output);
	}
	return action;
}

struct action scenario_push_ramps(struct scenario *scenario, unsigned channel, const struct motion *motion)
{
	struct action action =
	    scenario_frame(scenario, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_RAMP));

	for (unsigned i = 0; i < motion->ramp_count; i++)
		action.length +=
		    (uint16_t)passo_ramp_words(action.payload + action.length, &motion->ramps[i]);
	return action;
}

/* As many lines and ramps as fit into a frame and into the queues. */
static void fill_frames(
    const struct scenario *scenario, struct motion *motion, unsigned line_places, unsigned ramp_places)
{
	const unsigned fit = PASSO_FRAME_PAYLOAD_MAX / world_line_words(&scenario->parameters);

	while (motion->line_count < fit && motion->line_count < LINES_MAX && motion->line_count < line_places)
		motion->lines[motion->line_count++] = (struct passo_line){.substeps = 9, .steps = {1}};
	while (motion->ramp_count < RAMPS_MAX && motion->ramp_count < ramp_places)
		scenario_add_ramp(motion, PASSO_VELOCITY_MAX >> 3, 1, PASSO_SHAPE_LINEAR);
}

void scenario_draw_motions(struct scenario *scenario, unsigned channel, bool constant, const uint32_t *timing)
{
	struct scenario_random *random = &scenario->random;
	const unsigned speed = scenario_draw(random, scenario_chance(random, 30) ? 5 : 3);
	const unsigned wanted = 1u + scenario_draw(random, constant ? 2 : 3);
	const unsigned line_places = 1u << scenario->parameters.line_queue_log2;
	const unsigned ramp_places = 1u << scenario->parameters.ramp_queue_log2;
	struct motion all = {0};

	for (unsigned i = 0; i < wanted; i++) {
		struct motion motion = {0};

		scenario_draw_ramps(scenario, &motion, constant, speed);
		scenario_draw_lines(scenario, &motion, channel, constant, speed, timing);
		if (all.line_count + motion.line_count > line_places
		    || all.line_count + motion.line_count > 6u
		    || all.ramp_count + motion.ramp_count > ramp_places
		    || all.ramp_count + motion.ramp_count > 6u)
			break;
		memcpy(all.lines + all.line_count, motion.lines, motion.line_count * sizeof *motion.lines);
		memcpy(all.ramps + all.ramp_count, motion.ramps, motion.ramp_count * sizeof *motion.ramps);
		all.line_count += motion.line_count;
		all.ramp_count += motion.ramp_count;
	}
	if (all.line_count == 0u)
		return;
	if (scenario_chance(random, 12))
		fill_frames(scenario, &all, line_places, ramp_places);
	if (scenario_chance(random, 3))
		all.ramps[0].now = true;
	const struct action lines = scenario_push_lines(scenario, channel, &all);
	const struct action ramps = scenario_push_ramps(scenario, channel, &all);
	const bool lines_first = scenario_chance(random, 50);
	scenario_add(scenario, lines_first ? &lines : &ramps);
	scenario_add(scenario, lines_first ? &ramps : &lines);
}
