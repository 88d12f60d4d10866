/* SPDX-License-Identifier: MIT
 * Plays histories of a sender on the protocol of grbl over the C model, and logs what can be seen from
 * outside.
 *
 * Commands, one a line:
 *   begin HOMED   a new machine, with homes (1) or without
 *   send HEX      bytes of one batch
 *   wait MS       time passes
 *   settle        until all is answered, and nothing moves
 *   worn 0|1      whether the pages of the settings refuse writes
 *   pins PROBE    the level of the probe
 *   end
 * The log: `> ms hex` sent, `< ms text` said, `p ms x y z` steps made at the pins, `end`.
 */
#include <stdio.h>
#include <stdlib.h>

#include "grbl_bench.h"

enum {
	LINE = 4096,
	AT_REST = 10,     /* rounds from one poll to the next while there is nothing to do */
	PATIENCE = 60000, /* rounds until all is answered */
};

static struct {
	bool worn;
	long steps[AXES], told[AXES];
	uint32_t step; /* levels */
	char said[LINE];
	size_t length;
} seen;

static unsigned now(void)
{
	return (unsigned)(passo_engine_clock(bench.engine) * 1000u / CLOCK_HZ);
}

static void see(const struct passo_pin_event *event)
{
	const uint32_t rising = (uint32_t)event->step & ~seen.step;

	for (unsigned axis = 0; axis < AXES; axis++)
		if (rising >> axis & 1u)
			seen.steps[axis] += event->dir >> axis & 1u ? -1 : 1;
	seen.step = (uint32_t)event->step;
}

static void disturb(uint32_t *words, size_t count)
{
	(void)words;
	(void)count;
}

static bool refuses(void)
{
	return seen.worn;
}

static void hear(void *context, const char *text)
{
	(void)context;
	for (; *text != '\0'; text++) {
		if (*text == '\n') {
			printf("< %u %.*s\n", now(), (int)seen.length, seen.said);
			seen.length = 0;
		} else if (*text != '\r' && seen.length < LINE) {
			seen.said[seen.length++] = *text;
		}
	}
}

static void tell_steps(void)
{
	if (memcmp(seen.steps, seen.told, sizeof seen.told) == 0)
		return;
	memcpy(seen.told, seen.steps, sizeof seen.told);
	printf("p %u %ld %ld %ld\n", now(), seen.steps[0], seen.steps[1], seen.steps[2]);
}

/* A controller at rest without input has nothing to do but to look at its switches. */
static void poll(unsigned rounds)
{
	const struct passo_grbl *grbl = &bench.grbl;

	while (rounds > 0) {
		passo_grbl_poll(&bench.grbl);
		const bool rests = passo_grbl_is_idle(grbl) && grbl->tail == grbl->head && rounds > AT_REST;
		const unsigned passed = rests ? AT_REST : 1;

		advance(passed * ROUND);
		tell_steps();
		rounds -= passed;
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
	const uint8_t homes = homed ? 7 : 0;

	memset(&bench, 0, sizeof bench);
	memset(&seen, 0, sizeof seen);
	memset(bench.pages, 0xFF, sizeof bench.pages);
	if (!power_up(
		(struct passo_grbl_setup){.homes = homes, .homed = homes, .probe = true, .pages = &PAGES}))
		exit(2);
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
			seen.worn = text[0] == '1';
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
