/* SPDX-License-Identifier: MIT
 * A ramp lasts its ticks; a line leaves its queue when the ramps have covered its substeps.
 */
#include "passo_preview_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WORD_CLOCKS 128u /* of a word on the SPI: as the engines have it */
#define GAP_CLOCKS 16u
#define MICROSECONDS 1000000u
#define PI 3.14159265358979
#define ROUNDING 0.5 /* substeps */

/* -------------------------------------------------------------------------------------- the queues ---- */

static uint32_t places(uint8_t log2)
{
	return UINT32_C(1) << log2;
}

bool passo_preview_core_open(struct passo_preview_core *core)
{
	core->lines = calloc(places(core->parameters.line_queue_log2), sizeof *core->lines);
	core->ramps = calloc(places(core->parameters.ramp_queue_log2), sizeof *core->ramps);
	return core->lines && core->ramps;
}

void passo_preview_core_close(struct passo_preview_core *core)
{
	free(core->lines);
	free(core->ramps);
}

static struct passo_line *line_at(struct passo_preview_core *core, uint32_t place)
{
	return &core->lines[(core->first_line + place) % places(core->parameters.line_queue_log2)];
}

static struct passo_ramp *ramp_at(struct passo_preview_core *core, uint32_t place)
{
	return &core->ramps[(core->first_ramp + place) % places(core->parameters.ramp_queue_log2)];
}

static void pop_line(struct passo_preview_core *core)
{
	const struct passo_line *line = line_at(core, 0);

	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		core->positions[i] +=
		    line->directions >> i & 1u ? -(int32_t)line->steps[i] : (int32_t)line->steps[i];
	core->distance -= line->substeps;
	core->first_line++;
	core->line_count--;
}

/* ------------------------------------------------------------------------------------------ motion ---- */

/* Substeps that a ramp has covered after a share of its time. All shapes are symmetric. */
static double covered(const struct passo_preview_core *core, const struct passo_ramp *ramp, double u)
{
	const double begin = ldexp((double)core->velocity, -48), end = ldexp((double)ramp->velocity_end, -48);
	const double clocks = ldexp(ramp->ticks, core->parameters.tick_log2);
	/* a shape is near the cosine */
	const double rise = ramp->shape == PASSO_SHAPE_LINEAR ? u * u / 2 : u / 2 - sin(PI * u) / (2 * PI);

	return clocks * (begin * u + (end - begin) * rise);
}

static void pass_lines(struct passo_preview_core *core, double way)
{
	while (core->line_count > 0u && core->distance + way >= line_at(core, 0)->substeps - ROUNDING)
		pop_line(core);
}

/* Notes a step of the axis with the most of them: of its line, it lasts the same share. */
static void note_step(struct passo_preview_core *core, double way, uint64_t clock)
{
	uint32_t most = 0;

	if (core->line_count == 0u)
		return;
	const struct passo_line *line = line_at(core, 0);
	for (unsigned i = 0; i < PASSO_AXES_MAX; i++)
		most = line->steps[i] > most ? line->steps[i] : most;
	if (most * (way - core->stepped) < line->substeps)
		return;
	core->stepped = way;
	core->step = clock;
}

static void end_ramp(struct passo_preview_core *core, uint64_t clock)
{
	const struct passo_ramp ramp = *ramp_at(core, 0);
	const double way = covered(core, &ramp, 1);

	core->distance += way;
	core->way += way;
	note_step(core, core->way, clock);
	pass_lines(core, 0);
	core->velocity = ramp.velocity_end;
	core->began = clock;
	core->first_ramp++;
	core->ramp_count--;
	if (ramp.last) {
		while (core->line_count > 0u && !line_at(core, 0)->last)
			pop_line(core);
		if (core->line_count > 0u)
			pop_line(core);
		core->distance = 0;
		core->velocity = 0;
		core->runs = false;
	}
}

static void begin(struct passo_preview_core *core)
{
	if (core->runs || core->line_count == 0u || core->ramp_count == 0u
	    || !(passo_unpack_run(core->host.run).run & 1u))
		return;
	core->runs = true;
	core->began = core->clock;
	core->distance = 0;
}

void passo_preview_core_run(struct passo_preview_core *core, uint64_t clocks)
{
	core->clock += clocks;
	begin(core);
	while (core->runs && core->ramp_count > 0u) {
		const uint64_t end =
		    core->began + ((uint64_t)ramp_at(core, 0)->ticks << core->parameters.tick_log2);

		if (end > core->clock)
			break;
		end_ramp(core, end);
	}
	if (core->runs && core->ramp_count == 0u) {
		core->dry |= core->velocity > 0u;
		core->began = core->clock;
	} else if (core->runs) {
		const struct passo_ramp *ramp = ramp_at(core, 0);
		const double all = ldexp(ramp->ticks, core->parameters.tick_log2);

		const double way = covered(core, ramp, (double)(core->clock - core->began) / all);

		note_step(core, core->way + way, core->clock);
		pass_lines(core, way);
	}
}

void passo_preview_core_rest(struct passo_preview_core *core, uint64_t period)
{
	const uint32_t line = core->first_line, ramp = core->first_ramp;

	while (core->runs && core->ramp_count > 0u && core->first_line == line && core->first_ramp == ramp)
		passo_preview_core_run(core, period);
}

/* ---------------------------------------------------------------------------- registers of the core ---- */

static struct passo_preview_core *core_of(struct passo_host *host)
{
	return (struct passo_preview_core *)(void *)host;
}

static uint32_t line_room(const struct passo_preview_core *core)
{
	return places(core->parameters.line_queue_log2) - core->line_count;
}

static uint32_t ramp_room(const struct passo_preview_core *core)
{
	return places(core->parameters.ramp_queue_log2) - core->ramp_count;
}

/* A frame takes its time. */
static void pass_frame(struct passo_preview_core *core, size_t payload)
{
	passo_preview_core_run(core, (payload + PASSO_FRAME_OVERHEAD) * WORD_CLOCKS + GAP_CLOCKS);
}

/* After a frame: what its status says. */
static void note_room(struct passo_preview_core *core)
{
	const uint32_t lines = line_room(core), ramps = ramp_room(core);

	core->host.line_room = (uint8_t)(lines < UINT8_MAX ? lines : UINT8_MAX);
	core->host.ramp_room = (uint8_t)(ramps < UINT8_MAX ? ramps : UINT8_MAX);
}

static uint32_t read_register(const struct passo_preview_core *core, uint16_t address)
{
	const uint32_t channel = address - PASSO_ADDRESS_CHANNEL_BASE;

	switch (address) {
	case PASSO_ADDRESS_IDENTIFICATION:
		return PASSO_IDENTIFICATION_RESET;
	case PASSO_ADDRESS_IDENTIFICATION + 1u:
		return passo_pack_version(&(struct passo_version){
		    .major = PASSO_VERSION_MAJOR_RESET, .minor = PASSO_VERSION_MINOR_RESET});
	case PASSO_ADDRESS_IDENTIFICATION + 2u:
		return passo_pack_parameters(&core->parameters);
	case PASSO_ADDRESS_RUN:
		return core->host.run;
	case PASSO_ADDRESS_CLOCK:
		return core->clock_hz;
	default:
		break;
	}
	if (channel == PASSO_CHANNEL_STATE)
		return passo_pack_channel_state(&(struct passo_channel_state){
		    .state = core->runs ? PASSO_STATE_RUN : PASSO_STATE_IDLE, .quiet = !core->runs});
	if (channel == PASSO_CHANNEL_RATE)
		return PASSO_RATE_FULL;
	if (channel == PASSO_CHANNEL_ROOM)
		return passo_pack_channel_room(&(struct passo_channel_room){
		    .line_room = (uint16_t)line_room(core), .ramp_room = (uint16_t)ramp_room(core)});
	if (channel == PASSO_CHANNEL_VELOCITY)
		return (uint32_t)(core->velocity >> 16);
	if (channel - PASSO_CHANNEL_POSITION_BASE < core->parameters.axes)
		return (uint32_t)core->positions[channel - PASSO_CHANNEL_POSITION_BASE];
	return 0;
}

static void push_line(struct passo_preview_core *core, const uint32_t *words)
{
	const struct passo_line_control control = passo_unpack_line_control(words[0]);
	struct passo_line line = {
	    .last = control.last, .directions = (uint8_t)control.directions, .substeps = words[1]};

	memcpy(line.steps, words + 2, core->parameters.axes * sizeof *words);
	*line_at(core, core->line_count++) = line;
	core->line(core->context, &line);
}

static void push_ramp(struct passo_preview_core *core, const uint32_t *words)
{
	const struct passo_ramp_control control = passo_unpack_ramp_control(words[0]);
	const struct passo_ramp ramp = {.last = control.last,
	    .shape = control.shape,
	    .velocity_end = (uint64_t)control.velocity_high << 32 | words[1],
	    .ticks = words[2]};

	*ramp_at(core, core->ramp_count++) = ramp;
	core->ramp(core->context, &ramp);
}

static void push(struct passo_preview_core *core, uint16_t address, const uint32_t *words, size_t length)
{
	const bool lines = address == PASSO_ADDRESS_CHANNEL_BASE + PASSO_CHANNEL_LINE;
	const size_t size = lines ? core->host.line_words : PASSO_RAMP_WORDS;

	pass_frame(core, length);
	for (size_t at = 0; at < length; at += size)
		(lines ? push_line : push_ramp)(core, words + at);
	begin(core);
	note_room(core);
}

/* -------------------------------------------------------------------- the functions of passo_host.h ---- */

static uint32_t microseconds(void *context)
{
	const struct passo_preview_core *core = context;
	const uint64_t seconds = core->clock / core->clock_hz, rest = core->clock % core->clock_hz;

	return (uint32_t)(seconds * MICROSECONDS + rest * MICROSECONDS / core->clock_hz);
}

static void wait(void *context, uint32_t duration)
{
	struct passo_preview_core *core = context;

	passo_preview_core_run(core, (uint64_t)duration * core->clock_hz / MICROSECONDS + 1u);
}

struct passo_hardware passo_preview_core_hardware(struct passo_preview_core *core)
{
	return (struct passo_hardware){.microseconds = microseconds, .wait = wait, .context = core};
}

enum passo_error passo_host_open(struct passo_host *host, const struct passo_hardware *hardware)
{
	*host = (struct passo_host){.hardware = *hardware, .opened = true, .fresh = true};
	host->send = host->ahead = host->frame;
	host->hardware.tries = PASSO_TRIES;
	return PASSO_OK;
}

enum passo_error passo_host_guard(struct passo_host *host, uint8_t line_words)
{
	host->guarded = true;
	host->line_words = line_words;
	return PASSO_OK;
}

enum passo_error passo_host_read(struct passo_host *host, uint16_t address, uint32_t *words, size_t length)
{
	struct passo_preview_core *core = core_of(host);

	pass_frame(core, length);
	for (size_t i = 0; i < length; i++)
		words[i] = read_register(core, (uint16_t)(address + i));
	note_room(core);
	return PASSO_OK;
}

enum passo_error passo_host_read_once(
    struct passo_host *host, uint16_t address, uint32_t *words, size_t length)
{
	return passo_host_read(host, address, words, length);
}

enum passo_error passo_host_write(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length)
{
	pass_frame(core_of(host), length);
	if (address == PASSO_ADDRESS_RUN)
		host->run = words[0];
	begin(core_of(host));
	note_room(core_of(host));
	return PASSO_OK;
}

enum passo_error passo_host_push(
    struct passo_host *host, uint16_t address, const uint32_t *words, size_t length)
{
	push(core_of(host), address, words, length);
	return PASSO_OK;
}

enum passo_error passo_host_post_write(
    struct passo_host *host, uint16_t address, uint32_t word, enum passo_error *result)
{
	struct passo_preview_core *core = core_of(host);

	core->pushes = false;
	core->address = address;
	core->word = word;
	*result = PASSO_PENDING;
	host->posted = result;
	return PASSO_OK;
}

uint32_t *passo_host_payload(struct passo_host *host)
{
	return host->frame;
}

void passo_host_prepare_push(struct passo_host *host, uint16_t address, size_t length)
{
	core_of(host)->address = address;
	core_of(host)->length = length;
	host->prepared = 1;
}

enum passo_error passo_host_post_push(struct passo_host *host, enum passo_error *result)
{
	core_of(host)->pushes = true;
	host->prepared = 0;
	*result = PASSO_PENDING;
	host->posted = result;
	return PASSO_OK;
}

enum passo_error passo_host_step(struct passo_host *host)
{
	struct passo_preview_core *core = core_of(host);
	enum passo_error *result = host->posted;

	if (!result)
		return PASSO_OK;
	if (core->pushes)
		push(core, core->address, host->frame, core->length);
	else
		passo_host_write(host, core->address, &core->word, 1);
	host->posted = NULL;
	*result = PASSO_OK;
	return PASSO_OK;
}

void passo_host_drop(struct passo_host *host)
{
	host->posted = NULL;
}

bool passo_host_is_unsure(const struct passo_host *host)
{
	(void)host;
	return false;
}
