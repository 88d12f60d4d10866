/* SPDX-License-Identifier: MIT
 * The program of a preview, and its results.
 */
#include "passo_preview.h"

#include <stdlib.h>
#include <string.h>

#include "passo_preview_core.h"

#define PATIENCE 3600u       /* seconds without a line or step that are too many */
#define SLEWS_PER_SECOND 20u /* of hold and stop, from full speed */

/* An array that grows. */
struct list {
	void *items;
	size_t count, room, size;
};

/* What a line of the path is of. */
struct origin {
	uint32_t source;
	uint8_t tool;
};

struct passo_preview {
	struct passo_preview_config config;
	struct passo_preview_core core;
	struct passo_program program;
	struct passo_path_item *items;
	struct passo passo;
	struct origin *origin; /* of the items */
	size_t at;             /* in the text */
	uint32_t taken, noted;
	struct list lines, ramps, refusals;
	bool failed;
};

static bool append(struct list *list, const void *item)
{
	if (list->count == list->room) {
		const size_t room = list->room ? 2 * list->room : 1024;
		void *items = realloc(list->items, room * list->size);

		if (!items)
			return false;
		list->items = items;
		list->room = room;
	}
	memcpy((char *)list->items + list->count++ * list->size, item, list->size);
	return true;
}

static size_t copy(const struct list *list, void *items)
{
	if (items && list->count)
		memcpy(items, list->items, list->count * list->size);
	return list->count;
}

/* ---------------------------------------------------------------------------------------- the play ---- */

/* Notes which line of the program the new lines of the path are of. */
static void note_origins(struct passo_preview *preview)
{
	const uint32_t added = preview->program.path.added;

	for (; preview->noted < added; preview->noted++)
		preview->origin[preview->noted % preview->config.look_ahead] =
		    (struct origin){preview->taken - 1u, preview->program.gcode.loaded};
	preview->noted = added; /* a line may have been taken back */
}

/* The core has a line: of the item that the planner still knows. The poll that sends it may have added it. */
static void keep_line(void *context, const struct passo_line *line)
{
	struct passo_preview *preview = context;

	note_origins(preview);
	const size_t place = preview->lines.count % preview->config.look_ahead;
	const struct passo_path_item *item = &preview->items[place];
	struct passo_preview_line made = {.substeps = line->substeps,
	    .feed = item->feed,
	    .limit = item->limit,
	    .source = preview->origin[place].source,
	    .tool = preview->origin[place].tool,
	    .rapid = item->rapid};

	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		made.steps[i] =
		    line->directions >> i & 1u ? -(int32_t)line->steps[i] : (int32_t)line->steps[i];
	preview->failed |= !append(&preview->lines, &made);
}

static void keep_ramp(void *context, const struct passo_ramp *ramp)
{
	struct passo_preview *preview = context;

	preview->failed |= !append(&preview->ramps,
	    &(struct passo_preview_ramp){ramp->velocity_end, ramp->ticks, (uint8_t)ramp->shape, ramp->last});
}

static enum passo_error open_all(struct passo_preview *preview)
{
	const struct passo_preview_config *config = &preview->config;
	const uint32_t clock_hz = config->program.path.machine.clock_hz, slew = clock_hz / SLEWS_PER_SECOND;
	const struct passo_hardware hardware = passo_preview_core_hardware(&preview->core);
	const struct passo_axis_config pins = {
	    config->step_high, config->step_low, config->dir_setup, config->dir_hold, .in_clocks = true};
	enum passo_error error = passo_open(
	    &preview->passo, &preview->core.host, &hardware, &(struct passo_options){.clock_hz = clock_hz});

	for (uint8_t axis = 0; axis < config->core_axes && error == PASSO_OK; axis++)
		error = passo_configure_axis(&preview->passo, axis, &pins);
	if (error == PASSO_OK)
		error = passo_configure_motion(&preview->passo, slew, slew, PASSO_RATE_FULL);
	if (error == PASSO_OK)
		error = passo_program_open(
		    &preview->program, &preview->passo, &config->program, preview->items, config->look_ahead);
	return error;
}

struct passo_preview *passo_preview_create(const struct passo_preview_config *config, enum passo_error *error)
{
	struct passo_preview *preview = calloc(1, sizeof *preview);

	*error = PASSO_OK;
	if (!preview)
		return NULL;
	preview->config = *config;
	preview->items = calloc(config->look_ahead, sizeof *preview->items);
	preview->origin = calloc(config->look_ahead, sizeof *preview->origin);
	preview->lines.size = sizeof(struct passo_preview_line);
	preview->ramps.size = sizeof(struct passo_preview_ramp);
	preview->refusals.size = sizeof(struct passo_preview_refusal);
	preview->core = (struct passo_preview_core){
	    .clock_hz = config->program.path.machine.clock_hz,
	    .parameters = {.channels = 1,
		.axes = config->core_axes,
		.tick_log2 = config->program.path.machine.tick_log2,
		.line_queue_log2 = config->line_queue_log2,
		.ramp_queue_log2 = config->ramp_queue_log2,
		.outputs = config->program.spin_up > 0u},
	    .line = keep_line,
	    .ramp = keep_ramp,
	    .context = preview,
	};
	if (preview->items && preview->origin && passo_preview_core_open(&preview->core))
		*error = open_all(preview);
	else
		preview->failed = true;
	if (!preview->failed && *error == PASSO_OK)
		return preview;
	passo_preview_destroy(preview);
	return NULL;
}

void passo_preview_destroy(struct passo_preview *preview)
{
	if (!preview)
		return;
	passo_preview_core_close(&preview->core);
	free(preview->items);
	free(preview->origin);
	free(preview->lines.items);
	free(preview->ramps.items);
	free(preview->refusals.items);
	free(preview);
}

void passo_preview_begin(
    struct passo_preview *preview, const struct passo_gcode *gcode, const int32_t *positions)
{
	preview->program.gcode = *gcode;
	preview->program.machine.rehearses = true;
	passo_path_restart(&preview->program.path, positions);
}

static void refuse(struct passo_preview *preview, int32_t error)
{
	preview->failed |=
	    !append(&preview->refusals, &(struct passo_preview_refusal){preview->taken - 1u, error});
}

static void poll(struct passo_preview *preview)
{
	const enum passo_error error = passo_program_poll(&preview->program);

	note_origins(preview);
	if (error != PASSO_OK)
		refuse(preview, -1 - (int32_t)error);
}

static void take_line(struct passo_preview *preview)
{
	const char *text = preview->config.text + preview->at;
	const size_t left = preview->config.length - preview->at;

	if (left == 0) {
		passo_program_end(&preview->program);
		return;
	}
	const size_t length = passo_gcode_line_count(text, left);
	preview->at += length;
	preview->taken++;
	const enum passo_gcode_error error = passo_program_line(&preview->program, text, length);
	if (error != PASSO_GCODE_OK)
		refuse(preview, (int32_t)error);
}

/* Whether polls would only read the state until that has changed: as `rests` of sim/passo/program.py. */
static bool rests(const struct passo_preview *preview)
{
	const struct passo_player *player = &preview->program.player;
	const struct passo *passo = &preview->passo;
	const bool fits = player->action.kind == PASSO_GCODE_LINE && passo_path_room(&preview->program.path);
	const bool ended = preview->program.ends && passo_player_is_ready(player);
	const bool runs = passo->stream == PASSO_STREAM_RUNS;
	const bool ends = passo->stream == PASSO_STREAM_NONE && passo->expects != PASSO_EXPECT_NOTHING;

	return ((player->waits && !fits) || ended) && (runs || ends) && !preview->program.feed.gave
	    && passo->ramps != PASSO_SUPPLY_DRY && passo_idle_time(passo) > 0u;
}

bool passo_preview_play(struct passo_preview *preview, uint32_t lines)
{
	const uint32_t until = preview->taken + lines;
	const uint64_t patience = (uint64_t)PATIENCE * preview->core.clock_hz;
	uint64_t quiet = preview->core.clock;

	while (!passo_program_is_done(&preview->program)) {
		if (preview->core.step > quiet)
			quiet = preview->core.step;
		if (preview->failed || preview->core.clock - quiet > patience)
			return false;
		while (passo_program_is_ready(&preview->program)) {
			if (preview->taken == until)
				return true;
			quiet = preview->core.clock;
			take_line(preview);
			poll(preview);
		}
		const uint64_t began = preview->core.clock;
		poll(preview);
		const uint64_t look = preview->core.clock - began;
		passo_preview_core_run(&preview->core, preview->config.period);
		if (look > 0u && rests(preview))
			passo_preview_core_rest(&preview->core, look + preview->config.period);
	}
	return false;
}

uint32_t passo_preview_taken(const struct passo_preview *preview)
{
	return preview->taken;
}

bool passo_preview_is_done(const struct passo_preview *preview)
{
	return !preview->failed && passo_program_is_done(&preview->program);
}

bool passo_preview_ran_dry(const struct passo_preview *preview)
{
	return preview->core.dry;
}

uint32_t passo_preview_substeps_per_mm(const struct passo_preview *preview)
{
	return preview->program.path.substeps_per_mm;
}

size_t passo_preview_lines(const struct passo_preview *preview, struct passo_preview_line *lines)
{
	return copy(&preview->lines, lines);
}

size_t passo_preview_ramps(const struct passo_preview *preview, struct passo_preview_ramp *ramps)
{
	return copy(&preview->ramps, ramps);
}

size_t passo_preview_refusals(const struct passo_preview *preview, struct passo_preview_refusal *refusals)
{
	return copy(&preview->refusals, refusals);
}
