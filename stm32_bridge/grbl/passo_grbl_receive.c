/* SPDX-License-Identifier: MIT
 * Input: bytes of lines into a ring, real-time requests into a set, overrides into their percentages.
 *
 * A ring that is full loses all bytes until its contents have been read, so that it is known which lines have
 * lost some: the one at its end, and those whose ends were lost.
 */
#include "passo_grbl_private.h"

#define CONTROL_X 0x18
#define FEED_CODES 0x90u
#define RAPID_CODES 0x95u
#define SPINDLE_CODES 0x99u
#define CODES_END 0x9Du
#define PERCENT_MIN 10
#define PERCENT_MAX 200
#define PERCENT_FULL 100u

void passo_grbl_end_overrides(struct passo_grbl *grbl)
{
	grbl->feed = grbl->rapid = grbl->spindle = PERCENT_FULL;
}

void passo_grbl_ask_reset(struct passo_grbl *grbl)
{
	passo_grbl_end_overrides(grbl);
	grbl->asked[PASSO_GRBL_ASK_RESET] = true;
}

/* Codes from that of 100 % on: +10, -10, +1, -1. */
static uint8_t changed(uint8_t percent, unsigned step)
{
	static const int8_t CHANGES[] = {0, 10, -10, 1, -1};
	const int wanted = step == 0 ? (int)PERCENT_FULL : percent + CHANGES[step];

	return (uint8_t)(wanted < PERCENT_MIN ? PERCENT_MIN : wanted > PERCENT_MAX ? PERCENT_MAX : wanted);
}

static void change(struct passo_grbl *grbl, uint8_t code)
{
	static const uint8_t RAPIDS[] = {100, 50, 25};

	if (code < RAPID_CODES)
		grbl->feed = changed(grbl->feed, code - FEED_CODES);
	else if (code < RAPID_CODES + sizeof RAPIDS)
		grbl->rapid = RAPIDS[code - RAPID_CODES];
	else if (code >= SPINDLE_CODES)
		grbl->spindle = changed(grbl->spindle, code - SPINDLE_CODES);
}

#ifdef PASSO_PLAIN_GCODE

static uint8_t end_of(const struct passo_grbl *grbl)
{
	return grbl->head;
}

uint8_t passo_grbl_room(const struct passo_grbl *grbl)
{
	return (uint8_t)(grbl->tail - grbl->head - 1u);
}

#else

/* Behind the last byte that counts. `head` is written by passo_grbl_receive() alone. */
static uint8_t end_of(const struct passo_grbl *grbl)
{
	return grbl->rejoins ? grbl->typed : grbl->head;
}

/* Where the next byte goes: that of other lines to where they began, once those before have been taken. */
static uint8_t next_of(const struct passo_grbl *grbl)
{
	return grbl->admits && grbl->tail == grbl->head ? grbl->typed : end_of(grbl);
}

/* Lines of the program that wait while others are taken keep their place. */
uint8_t passo_grbl_room(const struct passo_grbl *grbl)
{
	const uint8_t first = grbl->admits ? grbl->program : grbl->tail;

	return (uint8_t)(first - next_of(grbl) - 1u);
}

void passo_grbl_admit(struct passo_grbl *grbl)
{
	if (!grbl->admits) {
		grbl->program = grbl->tail;
		grbl->typed = end_of(grbl);
		grbl->tail = grbl->typed;
		grbl->admits = true;
	}
	passo_player_admit(grbl->player);
}

void passo_grbl_end_change(struct passo_grbl *grbl)
{
	if (grbl->admits) {
		grbl->admits = grbl->begun = false;
		grbl->rejoins = true;
		grbl->tail = grbl->program;
		grbl->late = 0;
		passo_gcode_line_clear(&grbl->line);
	}
	passo_player_go_on(grbl->player);
}

#endif

static bool ends_line(char byte)
{
	return byte == '\n' || byte == '\r';
}

static void keep(struct passo_grbl *grbl, char byte)
{
	if (grbl->full || passo_grbl_room(grbl) == 0) {
		grbl->full = true;
		grbl->lost_part = !ends_line(byte);
		grbl->lost_lines = (uint16_t)(grbl->lost_lines + ends_line(byte));
		return;
	}
#ifndef PASSO_PLAIN_GCODE
	if (grbl->admits && grbl->tail == grbl->head)
		grbl->head = grbl->tail = grbl->typed;
#endif
	grbl->received[grbl->head] = byte;
	grbl->head = (uint8_t)(grbl->head + 1u);
}

void passo_grbl_receive(struct passo_grbl *grbl, char byte)
{
	static const uint8_t BYTES[PASSO_GRBL_ASKS] = {[PASSO_GRBL_ASK_CANCEL] = 0x85,
	    [PASSO_GRBL_ASK_PAUSE] = '!',
	    [PASSO_GRBL_ASK_OPEN] = 0x84,
	    [PASSO_GRBL_ASK_RESUME] = '~',
#ifndef PASSO_PLAIN_GCODE
	    [PASSO_GRBL_ASK_ADMIT] = 0xA3,
#endif
	    [PASSO_GRBL_ASK_REPORT] = '?'};
	const uint8_t code = (uint8_t)byte;

#ifndef PASSO_PLAIN_GCODE
	if (grbl->rejoins) {
		grbl->head = grbl->typed;
		grbl->rejoins = false;
	}
#endif
	if (byte == CONTROL_X) {
		passo_grbl_ask_reset(grbl);
		return;
	}
	for (unsigned ask = PASSO_GRBL_ASK_CANCEL; ask < PASSO_GRBL_ASKS; ask++) {
		if (code != BYTES[ask])
			continue;
		if (ask <= PASSO_GRBL_ASK_OPEN)
			grbl->mark = grbl->head;
		grbl->asked[ask] = true;
		return;
	}
	if (code >= FEED_CODES && code <= CODES_END)
		change(grbl, code);
	else if (code < 0x80) /* other real-time commands do nothing */
		keep(grbl, byte);
}

bool passo_grbl_next(struct passo_grbl *grbl, char *byte)
{
	if (grbl->tail == end_of(grbl))
		return false;
	*byte = grbl->received[grbl->tail];
	grbl->tail = (uint8_t)(grbl->tail + 1u);
	grbl->dropped = grbl->begun ? grbl->dropped : grbl->late > 0;
	grbl->begun = !ends_line(*byte);
	grbl->late = (uint8_t)(grbl->late - (grbl->late > 0));
	return true;
}

unsigned passo_grbl_lost(struct passo_grbl *grbl)
{
	if (grbl->tail != end_of(grbl) || !grbl->full)
		return 0;
	grbl->full = false; /* from here on bytes are kept again, and none is lost before the ring is full */
	const uint16_t lines = (uint16_t)(grbl->lost_lines - grbl->found_lines);

	grbl->found_lines = grbl->lost_lines;
	if (lines > 0)
		passo_gcode_line_clear(&grbl->line);
	grbl->line.overflow = grbl->line.overflow || grbl->lost_part;
	return lines;
}

void passo_grbl_drop_input(struct passo_grbl *grbl)
{
#ifndef PASSO_PLAIN_GCODE
	grbl->admits = false;
	grbl->messages = 0;
#endif
	grbl->tail = end_of(grbl);
	passo_grbl_lost(grbl);
	grbl->late = 0;
	grbl->begun = false;
	passo_gcode_line_clear(&grbl->line);
}

/* The mark may have been passed before the request was served. */
void passo_grbl_drop_jogs(struct passo_grbl *grbl)
{
	const uint8_t before = (uint8_t)(grbl->mark - grbl->tail);

	grbl->late = before <= (uint8_t)(end_of(grbl) - grbl->tail) ? before : 0;
	grbl->dropped = grbl->begun;
}
