/* SPDX-License-Identifier: MIT
 * Plays histories of a sender on the protocol of grbl over the C model, and logs what can be seen from
 * outside. Commands, one a line: begin HOMED    a new machine, with homes or without send HEX       bytes of
 * one batch wait MS        time passes worn 0|1       whether the pages of the settings refuse writes pins
 * PROBE     the level of the probe end The log: `> ms hex` sent, `< ms text` said, `p ms x y z` steps made at
 * the pins, `end`.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "passo_engine.h"
#include "passo_grbl.h"

enum {
	CLOCK_HZ = 2000000,
	AXES = 3,
	ITEMS = 16,
	ROUND = 1000, /* microseconds */
	PAGE_WORDS = 256,
	STEPS_PER_MM = 20,
	LINE = 4096,
	PATIENCE = 60000, /* rounds until all is answered */
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
	uint32_t pages[2][PAGE_WORDS];
	bool worn;
	long steps[AXES], told[AXES];
	uint32_t step; /* levels */
	char said[LINE];
	size_t length;
} bench;

static unsigned now(void)
{
	return (unsigned)(passo_engine_clock(bench.engine) * 1000u / CLOCK_HZ);
}

static void drain(void)
{
	struct passo_pin_event events[256];
	size_t got;

	do {
		got = passo_engine_drain(bench.engine, events, 256);
		for (size_t i = 0; i < got; i++) {
			const uint32_t rising = (uint32_t)events[i].step & ~bench.step;

			for (unsigned axis = 0; axis < AXES; axis++)
				if (rising >> axis & 1u)
					bench.steps[axis] += events[i].dir >> axis & 1u ? -1 : 1;
			bench.step = (uint32_t)events[i].step;
		}
	} while (got == 256);
}

static bool transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count)
{
	(void)context;
	passo_engine_transfer(bench.engine, mosi, miso, count, 64 + 4 * count);
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
	if (at + count > PAGE_WORDS || bench.worn)
		return false;
	memcpy(bench.pages[page] + at, words, count * sizeof *words);
	return true;
}

static const struct passo_storage_pages PAGES = {.read = page_read, .erase = page_erase, .write = page_write};

static void write_text(void *context, const char *text)
{
	(void)context;
	for (; *text != '\0'; text++) {
		if (*text == '\n') {
			printf("< %u %.*s\n", now(), (int)bench.length, bench.said);
			bench.length = 0;
		} else if (*text != '\r' && bench.length < LINE) {
			bench.said[bench.length++] = *text;
		}
	}
}

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

static void set_up(bool homed)
{
	struct passo_grbl_setup *setup = &bench.setup;

	*setup = (struct passo_grbl_setup){
	    .path = {.machine = {.clock_hz = CLOCK_HZ, .tick_log2 = 7, .axes = AXES},
		.junction_deviation = q32(1) / 100},
	    .homes = homed ? 7 : 0,
	    .homed = homed ? 7 : 0,
	    .probe = true,
	    .defaults = set_defaults,
	    .pages = &PAGES};
	for (unsigned axis = 0; axis < AXES; axis++) {
		setup->path.axis[axis] = (struct passo_path_axis){
		    .steps_per_mm = q32(STEPS_PER_MM), .speed = q32(40), .acceleration = q32(2000)};
	}
}

static void power_up(bool homed)
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
	static const struct passo_grbl_sink sink = {.write = write_text};

	set_up(homed);
	bench.engine = passo_engine_create(&config);
	if (!bench.engine
	    || passo_open(&bench.passo, &bench.host, &hardware, &(struct passo_options){.clock_hz = CLOCK_HZ})
	           != PASSO_OK
	    || passo_path_open(&bench.path, &bench.setup.path, bench.items, ITEMS) != PASSO_PLAN_OK)
		exit(2);
	bench.machine = (struct passo_player_machine){.axis = bench.setup.path.axis};
	passo_gcode_open(&bench.gcode, &(struct passo_gcode_settings){.axes = AXES, .arc_tolerance = 2000});
	passo_path_feed_open(&bench.feed, &bench.passo, &bench.path);
	passo_player_open(&bench.player, &bench.gcode, &bench.feed, &bench.machine);
	passo_grbl_open(&bench.grbl, &bench.player, &sink, &bench.setup);
}

static void tell_steps(void)
{
	if (memcmp(bench.steps, bench.told, sizeof bench.told) == 0)
		return;
	memcpy(bench.told, bench.steps, sizeof bench.told);
	printf("p %u %ld %ld %ld\n", now(), bench.steps[0], bench.steps[1], bench.steps[2]);
}

static void poll(unsigned rounds)
{
	for (; rounds > 0; rounds--) {
		passo_grbl_poll(&bench.grbl);
		advance(ROUND);
		tell_steps();
	}
}

static void send(const char *hex)
{
	unsigned byte;

	printf("> %u %s\n", now(), hex);
	for (; sscanf(hex, "%2x", &byte) == 1; hex += 2)
		passo_grbl_receive(&bench.grbl, (char)byte);
}

/* Sleep ends with a reset alone. */
static void settle(void)
{
	const struct passo_grbl *grbl = &bench.grbl;

	for (unsigned i = 0; i < PATIENCE && !grbl->sleeps; i++) {
		const bool waits = grbl->owes || grbl->full || grbl->tail != grbl->head || grbl->door
		                || grbl->held || grbl->player->paused;

		if (!waits && passo_grbl_is_idle(grbl))
			return;
		if (i % 50 == 0)
			send("7e");
		poll(1);
	}
}

static void begin(bool homed)
{
	memset(&bench, 0, sizeof bench);
	memset(bench.pages, 0xFF, sizeof bench.pages);
	power_up(homed);
	poll(2);
}

int main(void)
{
	static char line[LINE], word[16], text[LINE];

	while (fgets(line, sizeof line, stdin)) {
		text[0] = '\0';
		if (sscanf(line, "%15s %4095s", word, text) < 1)
			continue;
		if (strcmp(word, "begin") == 0)
			begin(text[0] == '1');
		else if (strcmp(word, "send") == 0)
			send(text);
		else if (strcmp(word, "wait") == 0)
			poll((unsigned)strtoul(text, NULL, 10));
		else if (strcmp(word, "settle") == 0)
			settle();
		else if (strcmp(word, "worn") == 0)
			bench.worn = text[0] == '1';
		else if (strcmp(word, "pins") == 0)
			passo_engine_set(bench.engine, PASSO_INPUT_PROBE, text[0] == '1');
		else if (strcmp(word, "end") == 0) {
			printf("end\n");
			fflush(stdout);
			passo_engine_destroy(bench.engine);
		}
	}
	return 0;
}
