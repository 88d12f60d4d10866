/* SPDX-License-Identifier: MIT
 * Random input for the protocol of grbl over the C model: grbl_fuzz SEED SECONDS.
 *
 * Lines, real-time bytes and garbage at random times, on a machine whose switches act at random, over a link
 * with bit errors, with pages of settings that lose bits. Promises:
 *   - all that is said are lines of the protocol;
 *   - each line has one answer, in the end, unless a reset came first; none has two;
 *   - after a reset and $X the machine moves again, if its core can be reached.
 * Prints how often what happened.
 */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "passo_engine.h"
#include "passo_grbl.h"

enum {
	CLOCK_HZ = 2000000,
	AXES = 3,
	ITEMS = 16,
	SAID = 1 << 16,
	ROUND = 1000,    /* microseconds */
	LINES = 150,     /* of a session */
	PATIENCE = 5000, /* rounds until all is answered */
	PAGE_WORDS = 256,
	RESET = 0x18,
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
	uint32_t pages[2][PAGE_WORDS];
	char said[SAID];
	size_t length;
	unsigned sent;     /* lines since the last reset */
	unsigned answered; /* of them */
	bool noise;        /* on the link */
	bool tells;        /* all that is said */
	unsigned long good, bad, alarms, reports, resets, motions;
} bench;

static void fail(const char *what)
{
	fprintf(stderr, "%s\n--- it said:\n%s\n", what, bench.said);
	exit(1);
}

/* ------------------------------------------------------------------------------------- hardware ---- */

static void drain(void)
{
	struct passo_pin_event events[256];
	size_t got;

	do {
		got = passo_engine_drain(bench.engine, events, 256);
		for (size_t i = 0; i < got; i++)
			bench.motions += events[i].running & 1u;
	} while (got == 256);
}

static bool transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count)
{
	(void)context;
	passo_engine_transfer(bench.engine, mosi, miso, count, 64 + 4 * count);
	if (bench.noise && below(300) == 0)
		miso[below((uint32_t)count)] ^= 1u << below(32);
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
	if (at + count > PAGE_WORDS || below(40) == 0)
		return false;
	memcpy(bench.pages[page] + at, words, count * sizeof *words);
	return true;
}

static const struct passo_storage_pages PAGES = {.read = page_read, .erase = page_erase, .write = page_write};

static void write_text(void *context, const char *text)
{
	const size_t length = strlen(text);

	(void)context;
	if (bench.length + length >= SAID)
		fail("too much was said");
	memcpy(bench.said + bench.length, text, length + 1);
	bench.length += length;
}

/* ------------------------------------------------------------------------------------ the judge ---- */

static bool begins(const char *line, const char *word)
{
	return strncmp(line, word, strlen(word)) == 0;
}

static bool is_number(const char *text)
{
	if (*text == '\0')
		return false;
	while (isdigit((unsigned char)*text))
		text++;
	return *text == '\0';
}

static void judge_line(const char *line)
{
	const size_t length = strlen(line);

	if (bench.tells)
		printf("< %s\n", line);
	if (strcmp(line, "ok") == 0) {
		bench.good++;
		bench.answered++;
	} else if (strcmp(line, "error:7") == 0 && bench.sent == 0) {
		bench.bad++; /* at the start: no copy of the settings is valid */
	} else if (begins(line, "error:") && is_number(line + 6)) {
		bench.bad++;
		bench.answered++;
	} else if (begins(line, "ALARM:") && is_number(line + 6)) {
		bench.alarms++;
	} else if (line[0] == '<' && line[length - 1] == '>') {
		bench.reports++;
	} else if (strcmp(line, "Grbl 1.1h ['$' for help]") == 0) {
		bench.sent = bench.answered = 0;
		bench.resets++;
	} else if (length > 0 && !(line[0] == '[' && line[length - 1] == ']')
	           && !(line[0] == '$' && strchr(line, '=')) && line[0] != '>') {
		fail(line);
	}
	if (bench.answered > bench.sent)
		fail("an answer too many");
}

/* Takes all whole lines of what was said. */
static void judge(void)
{
	char *line = bench.said, *end;

	for (; (end = strstr(line, "\r\n")) != NULL; line = end + 2) {
		*end = '\0';
		judge_line(line);
		*end = '\r';
	}
	bench.length -= (size_t)(line - bench.said);
	memmove(bench.said, line, bench.length + 1);
	if (bench.length > 400)
		fail("a line without an end");
}

static void poll(unsigned rounds)
{
	for (; rounds > 0; rounds--) {
		passo_grbl_poll(&bench.grbl);
		advance(ROUND);
		judge();
	}
}

/* ------------------------------------------------------------------------------------- the host ---- */

static const char *const LINES_OF[] = {"G0 X1 Y2", "G1 X-1 F600", "G1 Y3 Z1 F900", "G2 X2 Y0 I1 J0 F500",
    "G91 G1 X.5", "G90", "G4 P0.02", "M3 S500", "M5", "M0", "M30", "G38.2 Z-2 F100", "G92 X0", "G10 L2 P1 X1",
    "G28", "G28.1", "$$", "$#", "$G", "$I", "$N", "$N0=G21", "$N1=", "$H", "$X", "$C", "$J=G91 X1 F900",
    "$J=X0 F300", "$RST=$", "$RST=*", "$110=600", "$120=50", "$100=20", "$10=3", "$21=1", "$20=1", "$22=1",
    "$32=1", "$13=1", "$11=0.02", "$130=10", "$P", "$", "$999=1", "$0=-1", "", "(a comment)", "; another",
    "G1", "X1 X2", "G99", "N5 G1 X1 F100", "%", "/G0 X1", "G20", "G21", "G53 G0 X0", "G93 G1 X1 F60"};
static const char REAL_TIME[] = {'?', '?', '?', '!', '~', '~', '~', '\x84', '\x85', '\x90', '\x91', '\x92',
    '\x93', '\x94', '\x95', '\x96', '\x97', '\x99', '\x9A', '\x9E', '\x9D'};

/* Waits until there is room, as a sender that counts characters does. */
static void type(char byte)
{
	for (unsigned i = 0; i < PATIENCE; i++) {
		if ((uint8_t)(bench.grbl.tail - bench.grbl.head - 1u) > 8u)
			break;
		poll(1);
		if (i % 16 == 15)
			passo_grbl_receive(&bench.grbl, '~'); /* a hold takes no lines */
		if (i == PATIENCE - 1)
			fail("no line is taken any more");
	}
	passo_grbl_receive(&bench.grbl, byte);
}

static void type_line(const char *line, size_t length, bool disturbed)
{
	for (size_t i = 0; i < length; i++) {
		type(line[i]);
		if (disturbed && below(10) == 0)
			passo_grbl_receive(&bench.grbl, REAL_TIME[below(sizeof REAL_TIME)]);
	}
	type('\n');
	bench.sent++;
	if (bench.tells)
		printf("> %.*s\n", (int)length, line);
}

/* A line of the list, sometimes with a few other bytes, or garbage; without real-time bytes. */
static size_t make_line(char *line)
{
	size_t length = (size_t)sprintf(line, "%s", PICK(LINES_OF));

	if (below(30) == 0)
		for (length = below(250); length > 0 && below(200) > 0;)
			line[--length] = (char)(' ' + below(90));
	for (uint32_t i = below(10) ? 0 : 1 + below(3); i > 0 && length > 0; i--)
		line[below((uint32_t)length)] = (char)(1 + below(127));
	for (size_t i = 0; i < length; i++) {
		if (strchr("\n\r?!~\x18", line[i]))
			line[i] = 'X';
	}
	return length;
}

static void poke(void)
{
	static const enum passo_input PINS[] = {PASSO_INPUT_HOME, PASSO_INPUT_LIMIT_LOW, PASSO_INPUT_PROBE};

	if (below(12) == 0)
		passo_engine_set(bench.engine, PICK(PINS), below(8));
	if (below(12) == 0)
		passo_engine_set(bench.engine, PICK(PINS), 0);
	passo_engine_set(bench.engine, PASSO_INPUT_ESTOP_N, below(300) != 0);
}

/* ---------------------------------------------------------------------------------- the machine ---- */

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

static void set_up(void)
{
	struct passo_grbl_setup *setup = &bench.setup;

	*setup = (struct passo_grbl_setup){
	    .path = {.machine = {.clock_hz = CLOCK_HZ, .tick_log2 = 7, .axes = AXES},
		.junction_deviation = q32(1) / 100},
	    .limits_low = 7,
	    .homes = 7,
	    .homed = (uint8_t)(below(3) ? 0 : 7),
	    .probe = below(3) != 0,
	    .defaults = set_defaults,
	    .pages = below(3) ? &PAGES : NULL};
	for (unsigned axis = 0; axis < AXES; axis++) {
		setup->path.axis[axis] = (struct passo_path_axis){
		    .steps_per_mm = q32(STEPS_PER_MM), .speed = q32(40), .acceleration = q32(2000)};
	}
}

static void power_up(void)
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

	set_up();
	bench.noise = false;
	bench.engine = passo_engine_create(&config);
	bench.length = 0;
	bench.sent = bench.answered = 0;
	if (!bench.engine
	    || passo_open(&bench.passo, &bench.host, &hardware, &(struct passo_options){.clock_hz = CLOCK_HZ})
	           != PASSO_OK
	    || passo_path_open(&bench.path, &bench.setup.path, bench.items, ITEMS) != PASSO_PLAN_OK)
		fail("no core");
	bench.machine = (struct passo_player_machine){.axis = bench.setup.path.axis};
	passo_gcode_open(&bench.gcode, &(struct passo_gcode_settings){.axes = AXES, .arc_tolerance = 2000});
	passo_path_feed_open(&bench.feed, &bench.passo, &bench.path);
	passo_player_open(&bench.player, &bench.gcode, &bench.feed, &bench.machine);
	passo_grbl_open(&bench.grbl, &bench.player, &sink, &bench.setup);
	poll(2);
}

/* All lines are answered, once nothing holds the machine. */
static void settle(void)
{
	for (unsigned i = 0; bench.answered < bench.sent || !passo_grbl_is_idle(&bench.grbl); i++) {
		if (i == PATIENCE)
			fail("lines are left without an answer");
		if (i % 8 == 0)
			passo_grbl_receive(&bench.grbl, '~');
		if (i % 64 == 63 && bench.answered == bench.sent)
			return; /* held by an alarm: nothing is owed */
		poll(1);
	}
}

/* A reset, and its greeting: what comes before that is lost. It waits for the end of an e-stop. */
static void reset(void)
{
	const unsigned long before = bench.resets;

	passo_engine_set(bench.engine, PASSO_INPUT_ESTOP_N, 1);
	passo_grbl_receive(&bench.grbl, RESET);
	for (unsigned i = 0; bench.resets == before; i++) {
		if (i == PATIENCE)
			fail("a reset is not answered");
		poll(1);
	}
}

/* After a reset it takes lines again, and moves. */
static void revive(void)
{
	static const enum passo_input PINS[] = {PASSO_INPUT_HOME, PASSO_INPUT_LIMIT_LOW, PASSO_INPUT_PROBE};
	unsigned long good, moved;

	bench.noise = false;
	for (unsigned i = 0; i < 3; i++)
		passo_engine_set(bench.engine, PINS[i], 0);
	passo_engine_set(bench.engine, PASSO_INPUT_ESTOP_N, 1);
	reset();
	type_line("$RST=$", 6, false);
	poll(100); /* which is a reset as well */
	static const char *const UNLOCK[] = {"$X", "$21=0", "$20=0", "G21 G90 G94 M5"};
	for (unsigned i = 0; i < sizeof UNLOCK / sizeof *UNLOCK; i++) {
		type_line(UNLOCK[i], strlen(UNLOCK[i]), false);
		settle();
	}
	good = bench.good;
	moved = bench.motions;
	static const char MOVE[] = "G91 G1 X1 F600";
	type_line(MOVE, sizeof MOVE - 1, false);
	settle();
	for (unsigned i = 0; i < 1000 && !passo_grbl_is_idle(&bench.grbl); i++)
		poll(1);
	if (bench.good != good + 1 || bench.motions == moved)
		fail("it does not move after a reset");
}

int main(int count, char **arguments)
{
	char line[512];

	bench.tells = count > 3;
	fuzz_begin(count, arguments);
	memset(bench.pages, 0xFF, sizeof bench.pages);
	while (fuzz_goes_on()) {
		if (below(3) == 0)
			bench.pages[below(2)][below(PAGE_WORDS)] ^= 1u << below(32);
		power_up();
		bench.noise = below(2) == 0;
		for (unsigned i = 0; i < LINES; i++) {
			poke();
			type_line(line, make_line(line), true);
			poll(below(4) ? below(3) : below(60));
			if (below(40) == 0)
				reset();
			if (below(50) == 0)
				passo_grbl_receive(&bench.grbl, '\0'); /* a byte was lost */
		}
		revive();
		passo_engine_destroy(bench.engine);
	}
	printf("ok %lu\nerror %lu\nalarm %lu\nreport %lu\nreset %lu\nmotion %lu\n", bench.good, bench.bad,
	    bench.alarms, bench.reports, bench.resets, bench.motions);
	return 0;
}
