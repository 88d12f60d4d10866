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

#include "fuzz.h"
#include "grbl_bench.h"
#include "passo_grbl_private.h"

enum {
	SAID = 1 << 16,
	LINES = 150,     /* of a session */
	PATIENCE = 5000, /* rounds until all is answered */
	RESET = 0x18,
};

static struct {
	char said[SAID];
	size_t length;
	unsigned sent;     /* lines since the last reset */
	unsigned answered; /* of them */
	bool noise;        /* on the link */
	bool tells;        /* all that is said */
	unsigned long good, bad, alarms, reports, resets, motions;
} seen;

static void fail(const char *what)
{
	fprintf(stderr, "%s\n--- it said:\n%s\n", what, seen.said);
	exit(1);
}

/* ------------------------------------------------------------------------------------ the bench ---- */

static void see(const struct passo_pin_event *event)
{
	seen.motions += event->running & 1u;
}

static void disturb(uint32_t *words, size_t count)
{
	if (seen.noise && below(300) == 0)
		words[below((uint32_t)count)] ^= 1u << below(32);
}

static bool refuses(void)
{
	return below(40) == 0;
}

static void hear(void *context, const char *text)
{
	const size_t length = strlen(text);

	(void)context;
	if (seen.length + length >= SAID)
		fail("too much was said");
	memcpy(seen.said + seen.length, text, length + 1);
	seen.length += length;
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

	if (seen.tells)
		printf("< %s\n", line);
	if (strcmp(line, "ok") == 0) {
		seen.good++;
		seen.answered++;
	} else if (strcmp(line, "error:7") == 0 && seen.sent == 0) {
		seen.bad++; /* at the start: no copy of the settings is valid */
	} else if (begins(line, "error:") && is_number(line + 6)) {
		seen.bad++;
		seen.answered++;
	} else if (begins(line, "ALARM:") && is_number(line + 6)) {
		seen.alarms++;
	} else if (line[0] == '<' && line[length - 1] == '>') {
		seen.reports++;
	} else if (strcmp(line, "Grbl 1.1h ['$' for help]") == 0) {
		seen.sent = seen.answered = 0;
		seen.resets++;
	} else if (length > 0 && !(line[0] == '[' && line[length - 1] == ']')
	           && !(line[0] == '$' && strchr(line, '=')) && line[0] != '>') {
		fail(line);
	}
	if (seen.answered > seen.sent)
		fail("an answer too many");
}

/* Takes all whole lines of what was said. */
static void judge(void)
{
	char *line = seen.said, *end;

	for (; (end = strstr(line, "\r\n")) != NULL; line = end + 2) {
		*end = '\0';
		judge_line(line);
		*end = '\r';
	}
	seen.length -= (size_t)(line - seen.said);
	memmove(seen.said, line, seen.length + 1);
	if (seen.length > 400)
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
    "G1", "X1 X2", "G99", "N5 G1 X1 F100", "%", "/G0 X1", "G20", "G21", "G53 G0 X0", "G93 G1 X1 F60", "T1 M6",
    "T2 M6", "M6", "M61 Q1", "G43 H1", "G43.2 H2", "G49", "G10 L1 P1 Z2", "$TPW", "$TLR", "$342=1",
    "$394=0.02", "$394=0.1", "M4"};
static const char REAL_TIME[] = {'?', '?', '?', '!', '~', '~', '~', '\x84', '\x85', '\x90', '\x91', '\x92',
    '\x93', '\x94', '\x95', '\x96', '\x97', '\x99', '\x9A', '\x9E', '\x9D', '\xA3', '\xA3'};

/* Waits until there is room, as a sender that counts characters does. */
static void type(char byte)
{
	for (unsigned i = 0; i < PATIENCE; i++) {
		if (passo_grbl_room(&bench.grbl) > 8u)
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
	seen.sent++;
	if (seen.tells)
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

static void turn_on(void)
{
	const struct passo_grbl_setup fitted = {.limits_low = 7,
	    .homes = 7,
	    .homed = (uint8_t)(below(3) ? 0 : 7),
	    .at_speed = (uint8_t)(below(3) ? 0 : 1 + below(3)),
	    .probe = below(3) != 0,
	    .pages = below(3) ? &PAGES : NULL};

	seen.noise = false;
	seen.length = 0;
	seen.sent = seen.answered = 0;
	if (!power_up(fitted))
		fail("no core");
	poll(2);
}

/* All lines are answered, once nothing holds the machine. */
static void settle(void)
{
	for (unsigned i = 0; seen.answered < seen.sent || !passo_grbl_is_idle(&bench.grbl); i++) {
		if (i == PATIENCE)
			fail("lines are left without an answer");
		if (i % 8 == 0)
			passo_grbl_receive(&bench.grbl, '~');
		if (i % 64 == 63 && seen.answered == seen.sent)
			return; /* held by an alarm: nothing is owed */
		poll(1);
	}
}

/* A reset, and its greeting: what comes before that is lost. It waits for the end of an e-stop. */
static void reset(void)
{
	const unsigned long before = seen.resets;

	passo_engine_set(bench.engine, PASSO_INPUT_ESTOP_N, 1);
	passo_grbl_receive(&bench.grbl, RESET);
	for (unsigned i = 0; seen.resets == before; i++) {
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

	seen.noise = false;
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
	good = seen.good;
	moved = seen.motions;
	static const char MOVE[] = "G91 G1 X1 F600";
	type_line(MOVE, sizeof MOVE - 1, false);
	settle();
	for (unsigned i = 0; i < 1000 && !passo_grbl_is_idle(&bench.grbl); i++)
		poll(1);
	if (seen.good != good + 1 || seen.motions == moved)
		fail("it does not move after a reset");
}

int main(int count, char **arguments)
{
	char line[512];

	seen.tells = count > 3;
	fuzz_begin(count, arguments);
	memset(bench.pages, 0xFF, sizeof bench.pages);
	while (fuzz_goes_on()) {
		if (below(3) == 0)
			bench.pages[below(2)][below(PAGE_WORDS)] ^= 1u << below(32);
		turn_on();
		seen.noise = below(2) == 0;
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
	printf("ok %lu\nerror %lu\nalarm %lu\nreport %lu\nreset %lu\nmotion %lu\n", seen.good, seen.bad,
	    seen.alarms, seen.reports, seen.resets, seen.motions);
	return 0;
}
