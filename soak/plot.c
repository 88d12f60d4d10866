/* SPDX-License-Identifier: MIT */
#include "plot.h"

#include <string.h>

#define TICK_CLOCKS 128u /* TICK_LOG2 is 7 in all sets */

/* ---- chance ---- */

void plot_seed(struct plot_random *random, uint64_t seed, uint64_t number)
{
	uint64_t z = seed * UINT64_C(0x9E3779B97F4A7C15) + number + 1u;

	for (unsigned i = 0; i < 3u; i++) {
		z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
		z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
		z ^= z >> 31;
	}
	random->state = z | 1u;
}

uint32_t plot_draw(struct plot_random *random, uint32_t below)
{
	uint64_t x = random->state;

	x ^= x >> 12;
	x ^= x << 25;
	x ^= x >> 27;
	random->state = x;
	return below == 0u ? 0u : (uint32_t)((x * UINT64_C(0x2545F4914F6CDD1D) >> 32) % below);
}

bool plot_chance(struct plot_random *random, uint32_t percent)
{
	return plot_draw(random, 100) < percent;
}

uint32_t plot_log(struct plot_random *random, uint32_t from, uint32_t to)
{
	uint32_t doublings = 0;

	while (from << doublings < to)
		doublings++;
	const uint32_t low = from << plot_draw(random, doublings + 1u);
	const uint32_t value = low + plot_draw(random, low);
	return value > to ? to : value;
}

/* ---- frames ---- */

static uint16_t channel_address(unsigned channel, unsigned place)
{
	return (uint16_t)(PASSO_ADDRESS_CHANNEL_BASE + channel * PASSO_ADDRESS_CHANNEL_STRIDE + place);
}

static uint16_t axis_address(unsigned channel, unsigned axis, unsigned place)
{
	return channel_address(channel, PASSO_CHANNEL_AXIS_BASE + axis * PASSO_CHANNEL_AXIS_STRIDE + place);
}

/* Chip select stays high for a little, or as little as it may. */
static uint32_t gap(struct plot *plot)
{
	return plot_chance(&plot->random, 40) ? 2u : 2u + plot_draw(&plot->random, 60);
}

static struct action frame(struct plot *plot, enum passo_operation operation, uint16_t address)
{
	return (struct action){.kind = ACTION_FRAME,
	    .clocks = gap(plot),
	    .operation = (uint16_t)operation,
	    .address = address,
	    .event = EVENT_KINDS};
}

static void add_word(struct action *action, uint32_t word)
{
	action->payload[action->length++] = word;
}

static struct action write_word(struct plot *plot, uint16_t address, uint32_t word)
{
	struct action action = frame(plot, PASSO_OPERATION_WRITE, address);

	add_word(&action, word);
	return action;
}

static void add(struct plot *plot, const struct action *action)
{
	if (plot->count < PLOT_ACTIONS_MAX)
		plot->actions[plot->count++] = *action;
}

static unsigned any_channel(struct plot *plot)
{
	return plot_draw(&plot->random, plot->parameters.channels);
}

/* ---- settings ---- */

static uint32_t some_pins(struct plot *plot)
{
	const uint32_t both = plot_chance(&plot->random, 20) ? 1u : 0u;

	return plot_draw(&plot->random, 8) << PASSO_AXIS_PINS_STEP_INVERTED_LSB
	     | both << PASSO_AXIS_PINS_BOTH_EDGES_LSB;
}

static uint32_t some_time(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	if (plot_chance(random, 60))
		return plot_draw(random, 4); /* 0 counts as 1 */
	return plot_chance(random, 80) ? 1u + plot_draw(random, 30) : plot_log(random, 32, 1500);
}

static uint32_t some_step_timing(struct plot *plot)
{
	const uint32_t high = some_time(plot);

	return (high > 200u ? 200u : high) << 16 | (some_time(plot) & 0xFFu);
}

static uint32_t some_dir_timing(struct plot *plot)
{
	const uint32_t setup =
	    plot_chance(&plot->random, 10) ? plot_log(&plot->random, 64, 1024) : some_time(plot);

	return setup << 16 | some_time(plot);
}

static uint32_t some_rate(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	return plot_chance(random, 40) ? PASSO_RATE_ONE
	     : plot_chance(random, 30) ? 0u
	                               : plot_log(random, 256, PASSO_RATE_ONE);
}

static uint32_t some_slew(struct plot *plot)
{
	struct plot_random *random = &plot->random;

	return plot_chance(random, 25) ? PASSO_RATE_ONE
	     : plot_chance(random, 25) ? plot_draw(random, 3)
	                               : plot_log(random, 16, PASSO_RATE_ONE);
}

static uint32_t some_drain(struct plot *plot)
{
	return plot_chance(&plot->random, 15) ? 0u : plot_log(&plot->random, 1u << 24, 1u << 31);
}

/* ---- motions ---- */

/* Of one frame. */
#define LINES_MAX 20u
#define RAMPS_MAX 12u

/* A motion drawn so that its lines are about as long as the way under its ramps. */
struct motion {
	struct passo_line lines[LINES_MAX];
	struct passo_ramp ramps[RAMPS_MAX];
	unsigned line_count, ramp_count;
};

static void add_ramp(struct motion *motion, uint64_t velocity, uint32_t ticks, enum passo_shape shape)
{
	struct passo_ramp *ramp = &motion->ramps[motion->ramp_count++];

	*ramp = (struct passo_ramp){.velocity_end = velocity, .ticks = ticks, .shape = shape};
	if (ticks != 0u) {
		const uint64_t step = (PASSO_ONE_Q48 + ticks / 2u) / ticks;
		ramp->progress_step = step > PASSO_PROGRESS_STEP_MAX ? PASSO_PROGRESS_STEP_MAX : step;
	}
}

/* Substeps made by the ramps, about. */
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

static void draw_ramps(struct plot *plot, struct motion *motion, bool constant, unsigned speed)
{
	struct plot_random *random = &plot->random;
	const uint64_t velocity = PASSO_VELOCITY_MAX >> speed;

	if (constant) {
		add_ramp(motion, velocity, 0, PASSO_SHAPE_LINEAR);
		add_ramp(motion, velocity, 4u + plot_draw(random, 16), PASSO_SHAPE_LINEAR);
	} else {
		const unsigned count = 1u + plot_draw(random, 4);

		for (unsigned i = 0; i < count; i++) {
			const uint64_t end =
			    plot_chance(random, 25) ? 0u : velocity - (velocity >> 3) * plot_draw(random, 6);
			add_ramp(motion, end, plot_draw(random, 7), (enum passo_shape)plot_draw(random, 4));
			motion->ramps[i].mirror = plot_chance(random, 20);
		}
	}
	if (plot_chance(random, 88))
		motion->ramps[motion->ramp_count - 1u].last = true;
}

/* Substeps from step to step that the pins can follow; now and then too few. */
static uint32_t closest(struct plot *plot, bool constant, unsigned speed, uint32_t timing)
{
	const uint32_t clocks = (timing >> 16) + (timing & 0xFFFFu) + 2u;
	const uint32_t substeps = clocks >> (speed + 1u);

	return !constant && plot_chance(&plot->random, 5) ? 1u : 1u + substeps;
}

static void draw_lines(struct plot *plot, struct motion *motion, unsigned channel, bool constant,
    unsigned speed, const uint32_t *timing)
{
	struct plot_random *random = &plot->random;
	const uint32_t want = way(motion);
	const uint32_t delta = plot_draw(random, 12);
	uint32_t left = plot_chance(random, 55) ? want
	              : plot_chance(random, 50) ? want + delta
	              : want > 2u * delta       ? want - delta
	                                        : want;
	const unsigned count = 1u + plot_draw(random, 3);
	uint32_t period[PASSO_AXES_MAX];

	for (unsigned a = 0; a < plot->parameters.axes; a++) {
		period[a] = closest(plot, constant, speed, timing[a]) + plot_draw(random, 5);
	}
	if (constant) {
		uint32_t *gap = &plot->gap_enabled[channel][0];

		period[0] = *gap != 0u ? *gap >> (speed + 1u) : 2u * ((period[0] + 1u) / 2u);
		*gap = period[0] << (speed + 1u);
		left = want - want / 8u;
	}
	for (unsigned i = 0; i < count; i++) {
		struct passo_line *line = &motion->lines[motion->line_count++];
		uint32_t substeps = i + 1u == count ? left : left / 4u + plot_draw(random, left / 2u + 1u);

		*line = (struct passo_line){
		    .directions = (uint8_t)plot_draw(random, 1u << plot->parameters.axes)};
		if (substeps > left)
			substeps = left;
		left -= substeps;
		line->substeps = substeps == 0u ? 1u : substeps;
		for (unsigned a = 0; a < plot->parameters.axes; a++) {
			const uint32_t steps = line->substeps / period[a];

			line->steps[a] = plot_chance(random, 15) ? 0u : steps;
		}
		if (constant
		    && line->substeps >= period[0]) { /* exactly so many substeps from step to step */
			line->steps[0] = line->substeps / period[0];
			line->substeps = line->steps[0] * period[0];
			line->directions = motion->lines[0].directions;
			for (unsigned a = 1; a < plot->parameters.axes; a++)
				if (line->steps[a] > line->substeps)
					line->steps[a] = line->substeps;
		}
	}
	motion->lines[motion->line_count - 1u].last = constant || plot_chance(random, 90);
	motion->lines[motion->line_count - 1u].endless = !constant && plot_chance(random, 12);
}

static struct action push_lines(struct plot *plot, unsigned channel, const struct motion *motion)
{
	struct action action =
	    frame(plot, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_LINE));

	for (unsigned i = 0; i < motion->line_count; i++)
		action.length += (uint16_t)passo_line_words(
		    action.payload + action.length, &motion->lines[i], plot->parameters.axes);
	return action;
}

static struct action push_ramps(struct plot *plot, unsigned channel, const struct motion *motion)
{
	struct action action =
	    frame(plot, PASSO_OPERATION_PUSH, channel_address(channel, PASSO_CHANNEL_RAMP));

	for (unsigned i = 0; i < motion->ramp_count; i++)
		action.length +=
		    (uint16_t)passo_ramp_words(action.payload + action.length, &motion->ramps[i]);
	return action;
}

/* As many lines and ramps as go into a frame and into the queues. */
static void fill_frames(
    const struct plot *plot, struct motion *motion, unsigned line_places, unsigned ramp_places)
{
	const unsigned fit = PASSO_FRAME_PAYLOAD_MAX / PASSO_LINE_WORDS((unsigned)plot->parameters.axes);

	while (motion->line_count < fit && motion->line_count < LINES_MAX && motion->line_count < line_places)
		motion->lines[motion->line_count++] = (struct passo_line){.substeps = 9, .steps = {1}};
	while (motion->ramp_count < RAMPS_MAX && motion->ramp_count < ramp_places)
		add_ramp(motion, PASSO_VELOCITY_MAX >> 3, 1, PASSO_SHAPE_LINEAR);
}

/* Several motions behind one another, as far as the queues have room. */
static void draw_motions(struct plot *plot, unsigned channel, bool constant, const uint32_t *timing)
{
	struct plot_random *random = &plot->random;
	const unsigned speed = plot_draw(random, plot_chance(random, 30) ? 5 : 3);
	const unsigned wanted = 1u + plot_draw(random, constant ? 2 : 3);
	const unsigned line_places = 1u << plot->parameters.line_queue_log2;
	const unsigned ramp_places = 1u << plot->parameters.ramp_queue_log2;
	struct motion all = {0};

	for (unsigned i = 0; i < wanted; i++) {
		struct motion motion = {0};

		draw_ramps(plot, &motion, constant, speed);
		draw_lines(plot, &motion, channel, constant, speed, timing);
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
	if (plot_chance(random, 12))
		fill_frames(plot, &all, line_places, ramp_places);
	if (plot_chance(random, 3))
		all.ramps[0].now = true;
	const struct action lines = push_lines(plot, channel, &all);
	const struct action ramps = push_ramps(plot, channel, &all);
	const bool lines_first = plot_chance(random, 50);
	add(plot, lines_first ? &lines : &ramps);
	add(plot, lines_first ? &ramps : &lines);
}

/* ---- the set-up ---- */

struct passo_parameters plot_parameters(unsigned set)
{
	static const struct passo_parameters sets[PLOT_SETS] = {
	    {.channels = 1, .axes = 1, .tick_log2 = 7, .line_queue_log2 = 5, .ramp_queue_log2 = 3},
	    {.channels = 1,
		.axes = 3,
		.tick_log2 = 7,
		.line_queue_log2 = 2,
		.ramp_queue_log2 = 2,
		.step_reset = 5,
		.dir_reset = 3,
		.enable_reset = 6},
	    {.channels = 2,
		.axes = 2,
		.tick_log2 = 7,
		.line_queue_log2 = 3,
		.ramp_queue_log2 = 4,
		.step_reset = 1,
		.dir_reset = 4,
		.enable_reset = 15},
	};

	return sets[set % PLOT_SETS];
}

static struct action rates(struct plot *plot, unsigned channel, uint32_t command)
{
	struct action action =
	    frame(plot, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_COMMAND));
	const uint32_t drain = some_drain(plot);

	add_word(&action, command);
	add_word(&action, some_rate(plot));
	add_word(&action, some_slew(plot));
	add_word(&action, some_slew(plot));
	add_word(&action, drain == 0u ? 1u << 30 : drain);
	return action;
}

static uint32_t all_run(const struct plot *plot)
{
	return ((1u << plot->parameters.channels) - 1u) << PASSO_RUN_RUN_LSB;
}

static void set_up_channel(struct plot *plot, unsigned channel)
{
	struct plot_random *random = &plot->random;
	const bool constant = plot_chance(random, 40);
	uint32_t timing[PASSO_AXES_MAX];
	struct action action;

	for (unsigned a = 0; a < plot->parameters.axes; a++) {
		action = frame(plot, PASSO_OPERATION_WRITE, axis_address(channel, a, PASSO_AXIS_PINS));
		timing[a] = some_step_timing(plot);
		add_word(&action, some_pins(plot));
		add_word(&action, timing[a]);
		add_word(&action, constant ? 0x20002u : some_dir_timing(plot));
		if (plot_chance(random, 85))
			add(plot, &action);
		else
			timing[a] = 0;
	}
	if (plot_chance(random, 60)) {
		action = rates(plot, channel, 0);
		if (plot_chance(random, 50))
			action.payload[1] = PASSO_RATE_ONE;
		add(plot, &action);
	}
	draw_motions(plot, channel, constant, timing);
}

/* A slow rate that rises slowly while the motion runs: what a stop must not speed up. */
static void draw_rise(struct plot *plot, unsigned channel)
{
	struct action action =
	    frame(plot, PASSO_OPERATION_WRITE, channel_address(channel, PASSO_CHANNEL_RATE_TARGET));

	add_word(&action, plot_log(&plot->random, 2048, 32768));
	add_word(&action, 1u + plot_draw(&plot->random, 64));
	add_word(&action, some_slew(plot));
	add(plot, &action);
	action = write_word(plot, channel_address(channel, PASSO_CHANNEL_RATE_TARGET), PASSO_RATE_ONE);
	action.clocks = 2000u + plot_draw(&plot->random, 1000);
	add(plot, &action);
}

void plot_begin(struct plot *plot, uint64_t seed, uint64_t number)
{
	memset(plot, 0, sizeof *plot);
	plot->parameters = plot_parameters((unsigned)(number % PLOT_SETS));
	plot_seed(&plot->random, seed, number);
	struct plot_random *random = &plot->random;
	plot->half_period = plot_chance(random, 80) ? 2u : 3u;
	plot->setup = 2u + plot_draw(random, 4);
	const bool early = plot_chance(random, 25);
	const uint32_t waits =
	    plot_chance(random, 20) ? plot_draw(random, 1u << plot->parameters.channels) : 0u;
	struct action run =
	    write_word(plot, PASSO_ADDRESS_RUN, all_run(plot) | waits << PASSO_RUN_WAIT_SYNC_LSB);

	if (early)
		add(plot, &run);
	for (unsigned c = 0; c < plot->parameters.channels; c++)
		set_up_channel(plot, c);
	const unsigned rising = any_channel(plot);
	const bool rises = plot_chance(random, 25);
	if (!early && !rises)
		add(plot, &run);
	plot->prologue = plot->count;
	if (rises) {
		draw_rise(plot, rising);
		if (!early) { /* between the two frames of the rise */
			plot->actions[plot->count] = plot->actions[plot->count - 1u];
			plot->actions[plot->count - 1u] = run;
			plot->count++;
			plot->prologue++;
		}
		plot->prologue++;
	}
	plot->waits = waits != 0u;
}

/* ---- disturbances ---- */

static const struct {
	const char *name;
	uint32_t weight;
} kinds[PLOT_KINDS] = {
    [PLOT_STOP] = {"stop", 12},
    [PLOT_ABORT] = {"abort", 10},
    [PLOT_CLEAR] = {"clear", 4},
    [PLOT_ZERO] = {"zero", 10},
    [PLOT_COMMAND] = {"command bits", 4},
    [PLOT_RATE] = {"rate target", 8},
    [PLOT_RATES] = {"command and rates", 6},
    [PLOT_SLEW] = {"slews", 3},
    [PLOT_DRAIN] = {"drain velocity", 2},
    [PLOT_PINS] = {"pins", 8},
    [PLOT_ENABLE] = {"enable", 2},
    [PLOT_TIMING] = {"timing", 10},
    [PLOT_RUN] = {"run, wait for sync", 5},
    [PLOT_SYNC] = {"sync", 3},
    [PLOT_RESET] = {"core reset", 6},
    [PLOT_NOW] = {"NOW ramp", 8},
    [PLOT_MOTION] = {"lines or ramps", 6},
    [PLOT_TABLE] = {"table", 6},
    [PLOT_READ] = {"read", 4},
    [PLOT_BAD] = {"bad frame", 4},
};

const char *plot_kind_name(enum plot_kind kind)
{
	return kinds[kind].name;
}

enum plot_kind plot_kind(struct plot *plot)
{
	uint32_t sum = 0, drawn;
	unsigned kind = 0;

	for (unsigned i = 0; i < PLOT_KINDS; i++)
		sum += kinds[i].weight;
	drawn = plot_draw(&plot->random, sum);
	while (drawn >= kinds[kind].weight)
		drawn -= kinds[kind++].weight;
	return (enum plot_kind)kind;
}

static struct action command(struct plot *plot, uint32_t bits)
{
	return write_word(plot, channel_address(any_channel(plot), PASSO_CHANNEL_COMMAND), bits);
}

/* From the register on so many consecutive ones, drawn by their functions. */
static struct action timings(struct plot *plot)
{
	const unsigned channel = any_channel(plot), axis = plot_draw(&plot->random, plot->parameters.axes);
	const unsigned which = plot_draw(&plot->random, 3);
	struct action action = frame(plot, PASSO_OPERATION_WRITE,
	    axis_address(channel, axis, which == 1u ? PASSO_AXIS_DIR_TIMING : PASSO_AXIS_STEP_TIMING));

	if (which != 1u)
		add_word(&action, some_step_timing(plot));
	if (which != 0u)
		add_word(&action, some_dir_timing(plot));
	return action;
}

static struct action pins(struct plot *plot)
{
	const unsigned channel = any_channel(plot), axis = plot_draw(&plot->random, plot->parameters.axes);
	struct action action =
	    frame(plot, PASSO_OPERATION_WRITE, axis_address(channel, axis, PASSO_AXIS_PINS));

	add_word(&action, some_pins(plot));
	if (plot_chance(&plot->random, 30))
		add_word(&action, some_step_timing(plot));
	return action;
}

static struct action now_ramp(struct plot *plot)
{
	struct motion motion = {0};
	const uint64_t velocity =
	    plot_chance(&plot->random, 40) ? 0u : PASSO_VELOCITY_MAX >> plot_draw(&plot->random, 5);

	add_ramp(&motion, velocity, plot_draw(&plot->random, 6), PASSO_SHAPE_LINEAR);
	motion.ramps[0].now = true;
	motion.ramps[0].last = plot_chance(&plot->random, 60);
	return push_ramps(plot, any_channel(plot), &motion);
}

static struct action more_motion(struct plot *plot)
{
	const unsigned channel = any_channel(plot);
	const uint32_t timing[PASSO_AXES_MAX] = {0};
	struct motion motion = {0};

	draw_ramps(plot, &motion, false, plot_draw(&plot->random, 4));
	if (plot_chance(&plot->random, 50)) {
		motion.ramp_count = motion.ramp_count > 2u ? 2u : motion.ramp_count;
		return push_ramps(plot, channel, &motion);
	}
	draw_lines(plot, &motion, channel, false, 0, timing);
	motion.line_count = motion.line_count > 2u ? 2u : motion.line_count;
	return push_lines(plot, channel, &motion);
}

static struct action table_points(struct plot *plot)
{
	const unsigned place = plot_draw(&plot->random, 3u * PASSO_TABLE_POINTS - 4u);
	struct action action =
	    frame(plot, PASSO_OPERATION_WRITE, (uint16_t)(PASSO_ADDRESS_COSINE_BASE + place));
	const unsigned count = 1u + plot_draw(&plot->random, 4);

	/* a ramp of any table stays between its ends */
	for (unsigned i = 0; i < count; i++)
		add_word(&action, plot_draw(&plot->random, 0x10000));
	return action;
}

static struct action read(struct plot *plot)
{
	const bool positions = plot_chance(&plot->random, 50);
	struct action action = frame(plot, PASSO_OPERATION_READ,
	    channel_address(
		any_channel(plot), positions ? PASSO_CHANNEL_POSITION_BASE : PASSO_CHANNEL_STATE));

	action.length = positions ? plot->parameters.axes : 3u;
	return action;
}

static struct action bad_frame(struct plot *plot)
{
	struct action action = plot_disturbance(plot, (enum plot_kind)plot_draw(&plot->random, PLOT_SYNC));

	switch (plot_draw(&plot->random, 3)) {
	case 0:
		action.fault = FAULT_CRC;
		break;
	case 1:
		action.fault = FAULT_REPEATED;
		break;
	default:
		action.fault = FAULT_CUT;
		action.bits = (uint16_t)plot_draw(&plot->random, 32u * (action.length + 2u));
		break;
	}
	return action;
}

static struct action set_run(struct plot *plot)
{
	struct plot_random *random = &plot->random;
	const unsigned channels = plot->parameters.channels;
	const uint32_t run = plot_chance(random, 70) ? all_run(plot) : plot_draw(random, 1u << channels);
	const uint32_t wait = plot_chance(random, 60) ? 0u : plot_draw(random, 1u << channels);
	const uint32_t status = plot_draw(random, channels);

	return write_word(plot, PASSO_ADDRESS_RUN,
	    run << PASSO_RUN_RUN_LSB | wait << PASSO_RUN_WAIT_SYNC_LSB
	        | status << PASSO_RUN_STATUS_CHANNEL_LSB);
}

/* After these the gaps from step to step are not known any more. */
static void forget_gaps(struct plot *plot, enum plot_kind kind)
{
	if (kind == PLOT_NOW || kind == PLOT_MOTION || kind == PLOT_TIMING || kind == PLOT_PINS
	    || kind == PLOT_DRAIN || kind == PLOT_RESET)
		memset(plot->gap_enabled, 0, sizeof plot->gap_enabled);
}

struct action plot_disturbance(struct plot *plot, enum plot_kind kind)
{
	struct plot_random *random = &plot->random;
	struct action action;

	forget_gaps(plot, kind);
	switch (kind) {
	case PLOT_STOP:
		return command(plot, 1u << PASSO_CHANNEL_COMMAND_STOP_LSB);
	case PLOT_ABORT:
		return command(
		    plot, 1u << PASSO_CHANNEL_COMMAND_ABORT_LSB
		              | (plot_chance(random, 20) ? 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB : 0u));
	case PLOT_CLEAR:
		return command(plot, 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB);
	case PLOT_ZERO:
		return command(
		    plot, 1u << PASSO_CHANNEL_COMMAND_ZERO_LSB
		              | (plot_chance(random, 20) ? 1u << PASSO_CHANNEL_COMMAND_CLEAR_LSB : 0u));
	case PLOT_COMMAND:
		return command(plot, plot_draw(random, 16));
	case PLOT_RATE:
		return write_word(
		    plot, channel_address(any_channel(plot), PASSO_CHANNEL_RATE_TARGET), some_rate(plot));
	case PLOT_RATES:
		return rates(plot, any_channel(plot), plot_chance(random, 50) ? 1u : 0u);
	case PLOT_SLEW:
		action = write_word(
		    plot, channel_address(any_channel(plot), PASSO_CHANNEL_RATE_SLEW), some_slew(plot));
		add_word(&action, some_slew(plot));
		return action;
	case PLOT_DRAIN:
		action = write_word(
		    plot, channel_address(any_channel(plot), PASSO_CHANNEL_DRAIN_VELOCITY), some_drain(plot));
		if (action.payload[0] == 0u)
			action.fault = FAULT_VALUE;
		return action;
	case PLOT_PINS:
		return pins(plot);
	case PLOT_ENABLE:
		return write_word(plot,
		    axis_address(
			any_channel(plot), plot_draw(random, plot->parameters.axes), PASSO_AXIS_ENABLE),
		    plot_chance(random, 70) ? 1u : 0u);
	case PLOT_TIMING:
		return timings(plot);
	case PLOT_RUN:
		return set_run(plot);
	case PLOT_SYNC:
		return (struct action){
		    .kind = ACTION_SYNC, .clocks = 1u + plot_draw(random, 20), .event = EVENT_KINDS};
	case PLOT_RESET:
		return (struct action){.kind = ACTION_RESET,
		    .clocks =
			plot_chance(random, 50) ? 1u + plot_draw(random, 8) : 24u + plot_draw(random, 40),
		    .event = EVENT_KINDS};
	case PLOT_NOW:
		return now_ramp(plot);
	case PLOT_MOTION:
		return more_motion(plot);
	case PLOT_TABLE:
		return table_points(plot);
	case PLOT_READ:
		return read(plot);
	case PLOT_BAD:
	case PLOT_KINDS:
		break;
	}
	return bad_frame(plot);
}

/* ---- for people ---- */

const char *plot_event_name(enum world_event_kind kind)
{
	static const char *const names[EVENT_KINDS] = {"state", "gap", "stop", "slew tick", "rate", "line",
	    "ramp", "tick", "STEP", "DIR", "waiting step", "quiet"};

	return kind < EVENT_KINDS ? names[kind] : "nothing";
}

static const char *register_name(uint16_t address)
{
	static const char *const in_channel[] = {
	    "COMMAND", "RATE_TARGET", "RATE_SLEW", "STOP_SLEW", "DRAIN_VELOCITY"};
	static const char *const in_axis[] = {"PINS", "STEP_TIMING", "DIR_TIMING", "LOST_STEPS", "ENABLE"};
	const unsigned place = address & 0xFFu;

	if (address >= PASSO_ADDRESS_COSINE_BASE)
		return "TABLE";
	if (address < PASSO_ADDRESS_CHANNEL_BASE)
		return address == PASSO_ADDRESS_RUN ? "RUN" : "";
	if (place < 5u)
		return in_channel[place];
	if (place >= PASSO_CHANNEL_AXIS_BASE && place % PASSO_CHANNEL_AXIS_STRIDE < 5u)
		return in_axis[place % PASSO_CHANNEL_AXIS_STRIDE];
	return place == PASSO_CHANNEL_STATE         ? "STATE"
	     : place == PASSO_CHANNEL_LINE          ? "LINE"
	     : place == PASSO_CHANNEL_RAMP          ? "RAMP"
	     : place >= PASSO_CHANNEL_POSITION_BASE ? "POSITION"
	                                            : "";
}

void plot_print(const struct action *action, char *text, size_t size)
{
	static const char *const operations[] = {"", "read", "write", "push"};
	static const char *const faults[] = {"", " (bad CRC)", " (repeated)", " (cut)", " (bad value)"};
	size_t at;

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
