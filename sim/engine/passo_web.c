/* SPDX-License-Identifier: MIT
 * The C model of the core for WebAssembly: its pins are recorded, its host's text is kept for the page.
 */
#include "passo_web.h"

#include <stdlib.h>
#include <string.h>

#include "passo_engine.h"

enum {
	GAP = 64, /* clocks after a frame, and for each word */
	GAP_PER_WORD = 4,
	TEXT = 1 << 16,
	EVENTS = 4096,
};

/* An event for the page. */
struct row {
	double clock;
	uint32_t step, dir, running, irq;
};

static struct {
	struct passo_engine *engine;
	uint32_t clock_hz;
	char text[TEXT];
	size_t length;
	struct row *rows;
	size_t count, room;
} web;

static void collect(void)
{
	static struct passo_pin_event events[EVENTS];
	size_t got;

	do {
		got = passo_engine_drain(web.engine, events, EVENTS);
		if (web.count + got > web.room) {
			web.room = 2 * web.room + got;
			web.rows = realloc(web.rows, web.room * sizeof *web.rows);
			if (!web.rows)
				abort();
		}
		for (size_t i = 0; i < got; i++)
			web.rows[web.count++] = (struct row){.clock = (double)events[i].clock,
			    .step = (uint32_t)events[i].step,
			    .dir = (uint32_t)events[i].dir,
			    .running = (uint32_t)events[i].running,
			    .irq = (uint32_t)events[i].irq};
	} while (got == EVENTS);
}

bool web_transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count)
{
	(void)context;
	passo_engine_transfer(web.engine, mosi, miso, count, GAP + GAP_PER_WORD * count);
	collect();
	return true;
}

uint32_t web_advance(void *context, uint32_t microseconds)
{
	uint64_t clocks = ((uint64_t)microseconds * web.clock_hz + 999999) / 1000000;

	(void)context;
	while (clocks) {
		clocks -= passo_engine_run(web.engine, clocks);
		collect();
	}
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

bool web_start(uint32_t axes, uint32_t clock_hz)
{
	const struct passo_engine_config config = {.core = {.channels = 1,
						       .axes = (uint8_t)axes,
						       .tick_log2 = 7,
						       .line_queue_log2 = 8,
						       .ramp_queue_log2 = 4},
	    .clock_hz = clock_hz,
	    .spi_half_period = 2};

	if (web.engine)
		passo_engine_destroy(web.engine);
	web.count = web.length = 0;
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

EXPORT("rows") struct row *web_rows(void)
{
	return web.rows;
}

EXPORT("count") size_t web_count(void)
{
	return web.count;
}
