/* SPDX-License-Identifier: MIT
 * The C model of the core for WebAssembly: its pins are recorded, its host's text is kept for the page.
 */
#include "passo_web.h"

#include <stdlib.h>
#include <string.h>

#include "passo_engine.h"

enum {
	GAP = 64, /* clocks after a frame of the console, and for each word */
	GAP_PER_WORD = 4,
	TEXT = 1 << 16,
	EVENTS = 4096,
	DRAIN = 1 << 15, /* events that are worth to be collected */
	KINDS = 3,       /* of edges of an axis: rises of STEP, falls of STEP, DIR */
	RUNNING = KINDS * PASSO_AXES_MAX,
	LISTS,
};

/* Clocks of edges, which are low at first. */
struct list {
	double *clocks;
	size_t count, room;
};

static struct {
	struct passo_engine *engine;
	uint32_t clock_hz;
	char text[TEXT];
	size_t length;
	struct passo_pin_event last;
	uint64_t stepped; /* clock of the last step */
	struct list list[LISTS];
} web;

static void append(unsigned number, uint64_t clock)
{
	struct list *list = &web.list[number];

	if (list->count == list->room) {
		list->room = 2 * list->room + EVENTS;
		list->clocks = realloc(list->clocks, list->room * sizeof *list->clocks);
		if (!list->clocks)
			abort();
	}
	list->clocks[list->count++] = (double)clock;
}

static void take(const struct passo_pin_event *event)
{
	const uint32_t step = (uint32_t)(event->step ^ web.last.step),
		       dir = (uint32_t)(event->dir ^ web.last.dir);

	for (unsigned axis = 0; (step | dir) >> axis != 0u; axis++) {
		if (step >> axis & 1u)
			append(KINDS * axis + (event->step >> axis & 1u ? 0u : 1u), event->clock);
		if (dir >> axis & 1u)
			append(KINDS * axis + 2u, event->clock);
	}
	if (step != 0u)
		web.stepped = event->clock;
	if (event->running != web.last.running)
		append(RUNNING, event->clock);
	web.last = *event;
}

static void collect(void)
{
	static struct passo_pin_event events[EVENTS];
	size_t got;

	do {
		got = passo_engine_drain(web.engine, events, EVENTS);
		for (size_t i = 0; i < got; i++)
			take(&events[i]);
	} while (got == EVENTS);
}

struct passo_engine *web_engine(void)
{
	return web.engine;
}

uint64_t web_last_step(void)
{
	collect();
	return web.stepped;
}

void web_run(uint64_t clocks)
{
	while (clocks) {
		if (passo_engine_waiting(web.engine) > DRAIN)
			collect();
		clocks -= passo_engine_run(web.engine, clocks);
	}
}

bool web_transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count)
{
	(void)context;
	passo_engine_transfer(web.engine, mosi, miso, count, GAP + GAP_PER_WORD * count);
	return true;
}

uint32_t web_advance(void *context, uint32_t microseconds)
{
	(void)context;
	web_run(((uint64_t)microseconds * web.clock_hz + 999999) / 1000000);
	return (uint32_t)(passo_engine_clock(web.engine) * 1000000 / web.clock_hz);
}

bool web_irq(void *context)
{
	(void)context;
	return passo_engine_irq(web.engine) != 0;
}

void web_write(void *context, const char *text)
{
	size_t length = strlen(text);

	(void)context;
	if (length > TEXT - web.length)
		length = TEXT - web.length;
	memcpy(web.text + web.length, text, length);
	web.length += length;
}

bool web_start(uint32_t axes, uint32_t clock_hz, bool encoders, bool outputs)
{
	const struct passo_engine_config config = {.core = {.channels = 1,
						       .axes = (uint8_t)axes,
						       .tick_log2 = 7,
						       .line_queue_log2 = 8,
						       .ramp_queue_log2 = 4,
						       .encoders = encoders,
						       .outputs = outputs},
	    .clock_hz = clock_hz,
	    .spi_half_period = 2};

	if (web.engine)
		passo_engine_destroy(web.engine);
	for (unsigned number = 0; number < LISTS; number++)
		web.list[number].count = 0;
	web.last = (struct passo_pin_event){0};
	web.stepped = 0;
	web.length = 0;
	web.clock_hz = clock_hz;
	web.engine = passo_engine_create(&config);
	return web.engine != NULL;
}

EXPORT("text") char *web_text(void)
{
	return web.text;
}

/* Length of the text since the last call. */
EXPORT("said") size_t web_said(void)
{
	const size_t length = web.length;

	web.length = 0;
	return length;
}

/* Edges so far: list 3 * axis + 0 rises of STEP, 1 falls of STEP, 2 those of DIR; the last list: of running.
 */
EXPORT("count") size_t web_count(uint32_t list)
{
	collect();
	return web.list[list].count;
}

/* Their clocks since reset. */
EXPORT("clocks") double *web_clocks(uint32_t list)
{
	return web.list[list].clocks;
}

EXPORT("clock") double web_clock(void)
{
	return (double)passo_engine_clock(web.engine);
}
