/* SPDX-License-Identifier: MIT
 * The protocol of grbl over the C model, as grbl_play.c and grbl_fuzz.c use it: transport, clock, pages of
 * the settings, and a machine of three axes. A program that includes this file defines the four functions
 * below.
 */
#ifndef GRBL_BENCH_H
#define GRBL_BENCH_H

#include <string.h>

#include "passo_engine.h"
#include "passo_grbl.h"

enum {
	CLOCK_HZ = 2000000,
	AXES = 3,
	ITEMS = 16,
	ROUND = 1000, /* microseconds from one poll to the next */
	PAGE_WORDS = 512,
	STEPS_PER_MM = 20,
};

static struct {
	struct passo_engine *engine;
	struct passo passo;
	struct passo_host host;
	struct passo_path_item items[ITEMS];
	struct passo_path_planner path;
	struct passo_path_feed feed;
	struct passo_gcode gcode;
	struct passo_player player;
	struct passo_player_machine machine;
	struct passo_grbl_setup setup;
	struct passo_grbl grbl;
	uint32_t pages[2][PAGE_WORDS]; /* outlive the power */
} bench;

/* An event of the pins. */
static void see(const struct passo_pin_event *event);
/* The words of a reply may be disturbed. */
static void disturb(uint32_t *words, size_t count);
/* Whether a page refuses a write. */
static bool refuses(void);
/* What the controller says. */
static void hear(void *context, const char *text);

static void drain(void)
{
	struct passo_pin_event events[256];
	size_t got;

	do {
		got = passo_engine_drain(bench.engine, events, 256);
		for (size_t i = 0; i < got; i++)
			see(&events[i]);
	} while (got == 256);
}

static bool transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count)
{
	(void)context;
	passo_engine_transfer(bench.engine, mosi, miso, count, 64 + 4 * count);
	disturb(miso, count);
	drain();
	return true;
}

static bool irq(void *context)
{
	(void)context;
	return passo_engine_irq(bench.engine) != 0;
}

static void advance(uint32_t microseconds)
{
	uint64_t left = (uint64_t)microseconds * CLOCK_HZ / 1000000u;

	while (left > 0) {
		left -= passo_engine_run(bench.engine, left);
		drain();
	}
}

static uint32_t microseconds(void *context)
{
	(void)context;
	return (uint32_t)(passo_engine_clock(bench.engine) * 1000000u / CLOCK_HZ);
}

static void wait(void *context, uint32_t duration)
{
	(void)context;
	advance(duration + 1);
}

static bool page_read(void *context, unsigned page, size_t at, uint32_t *words, size_t count)
{
	(void)context;
	if (at + count > PAGE_WORDS)
		return false;
	memcpy(words, bench.pages[page] + at, count * sizeof *words);
	return true;
}

static bool page_erase(void *context, unsigned page)
{
	(void)context;
	memset(bench.pages[page], 0xFF, sizeof bench.pages[page]);
	return true;
}

static bool page_write(void *context, unsigned page, size_t at, const uint32_t *words, size_t count)
{
	(void)context;
	if (at + count > PAGE_WORDS || refuses())
		return false;
	memcpy(bench.pages[page] + at, words, count * sizeof *words);
	return true;
}

static const struct passo_storage_pages PAGES = {.read = page_read, .erase = page_erase, .write = page_write};

static const int64_t MILLION = 1000000;

static uint64_t q32(uint32_t value)
{
	return (uint64_t)value << 32;
}

static void set_defaults(struct passo_grbl_settings *defaults)
{
	*defaults = (struct passo_grbl_settings){.value = {0}};
	defaults->value[PASSO_GRBL_PULSE] = 2 * MILLION;
	defaults->value[PASSO_GRBL_IDLE_DELAY] = 255 * MILLION;
	defaults->value[PASSO_GRBL_REPORT] = 3 * MILLION;
	defaults->value[PASSO_GRBL_DEVIATION] = MILLION / 100;
	defaults->value[PASSO_GRBL_ARC_TOLERANCE] = MILLION / 500;
	defaults->value[PASSO_GRBL_HOMING] = bench.setup.homed ? MILLION : 0;
	defaults->value[PASSO_GRBL_HOME_FEED] = 60 * MILLION;
	defaults->value[PASSO_GRBL_HOME_SEEK] = 300 * MILLION;
	defaults->value[PASSO_GRBL_DEBOUNCE] = MILLION / 10;
	defaults->value[PASSO_GRBL_PULL_OFF] = MILLION;
	for (unsigned axis = 0; axis < AXES; axis++) {
		defaults->axis[PASSO_GRBL_STEPS][axis] = STEPS_PER_MM * MILLION;
		defaults->axis[PASSO_GRBL_SPEED][axis] = 2400 * MILLION;
		defaults->axis[PASSO_GRBL_ACCELERATION][axis] = 2000 * MILLION;
		defaults->axis[PASSO_GRBL_TRAVEL][axis] = 20 * MILLION;
	}
}

/* Turns a new core and the controller on; of the setup, switches, probe and pages are the caller's. False:
 * there is no core. */
static bool power_up(struct passo_grbl_setup fitted)
{
	const struct passo_engine_config config = {.core = {.channels = 1,
						       .axes = AXES,
						       .tick_log2 = 7,
						       .line_queue_log2 = 5,
						       .ramp_queue_log2 = 4,
						       .inputs = 1},
	    .clock_hz = CLOCK_HZ,
	    .spi_half_period = 2};
	static const struct passo_hardware hardware = {
	    .transfer = transfer, .microseconds = microseconds, .wait = wait, .irq = irq};
	static const struct passo_grbl_sink sink = {.write = hear};

	bench.setup = fitted;
	bench.setup.defaults = set_defaults;
	bench.setup.path =
	    (struct passo_path_settings){.machine = {.clock_hz = CLOCK_HZ, .tick_log2 = 7, .axes = AXES},
		.junction_deviation = q32(1) / 100};
	for (unsigned axis = 0; axis < AXES; axis++)
		bench.setup.path.axis[axis] = (struct passo_path_axis){
		    .steps_per_mm = q32(STEPS_PER_MM), .speed = q32(40), .acceleration = q32(2000)};
	bench.engine = passo_engine_create(&config);
	if (!bench.engine
	    || passo_open(&bench.passo, &bench.host, &hardware, &(struct passo_options){.clock_hz = CLOCK_HZ})
	           != PASSO_OK
	    || passo_path_open(&bench.path, &bench.setup.path, bench.items, ITEMS) != PASSO_PLAN_OK)
		return false;
	bench.machine = (struct passo_player_machine){.axis = bench.setup.path.axis};
	passo_gcode_open(&bench.gcode, &(struct passo_gcode_settings){.axes = AXES, .arc_tolerance = 2000});
	passo_path_feed_open(&bench.feed, &bench.passo, &bench.path);
	passo_player_open(&bench.player, &bench.gcode, &bench.feed, &bench.machine);
	passo_grbl_open(&bench.grbl, &bench.player, &sink, &bench.setup);
	return true;
}

#endif
