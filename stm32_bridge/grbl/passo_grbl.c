/* SPDX-License-Identifier: MIT
 * A line is taken from the ring only when the line before has been answered, and it is answered when it has
 * handed out all its actions: that is what paces the host, whether it waits for each answer or counts
 * characters.
 */
#include "passo_grbl_private.h"

#include <string.h>

static const char GREETING[] = "\r\nGrbl 1.1h ['$' for help]\r\n";

/* A machine with homes is locked until it knows where it is. */
void passo_grbl_greet(struct passo_grbl *grbl)
{
	grbl->starts = 0;
	grbl->reports = 0;
	passo_grbl_say(grbl, GREETING);
	if (grbl->locked)
		passo_grbl_say(grbl, "[MSG:'$H'|'$X' to unlock]\r\n");
}

void passo_grbl_open(struct passo_grbl *grbl, struct passo_player *player, const struct passo_grbl_sink *sink,
    const struct passo_grbl_setup *setup)
{
	*grbl = (struct passo_grbl){.player = player, .sink = *sink, .setup = setup, .rate = 100};
	passo_grbl_end_overrides(grbl);
	player->answers = true;
	passo_gcode_line_clear(&grbl->line);
	const enum passo_gcode_error loaded = passo_grbl_load(grbl);

	if (loaded != PASSO_GCODE_OK) {
		passo_grbl_answer(grbl, loaded);
		passo_grbl_report_settings(grbl);
	}
	grbl->locked = passo_grbl_is_on(&grbl->stored.settings, PASSO_GRBL_HOMING);
	passo_grbl_greet(grbl);
}

bool passo_grbl_is_idle(const struct passo_grbl *grbl)
{
	return passo_player_is_idle(grbl->player) && !grbl->stopping && !grbl->homes
	    && !grbl->asked[PASSO_GRBL_ASK_RESET];
}

void passo_grbl_answer(struct passo_grbl *grbl, enum passo_gcode_error error)
{
	if (error == PASSO_GCODE_OK) {
		passo_grbl_say(grbl, "ok\r\n");
		return;
	}
	passo_grbl_say(grbl, "error:");
	passo_grbl_say_number(grbl, (uint64_t)error);
	passo_grbl_say(grbl, "\r\n");
}

static enum passo_grbl_kind kind_of(const char *text)
{
	static const struct {
		char text[4];
		uint8_t kind;
	} EXACT[] = {{"$", PASSO_GRBL_KIND_MODES}, {"$G", PASSO_GRBL_KIND_MODES},
	    {"$$", PASSO_GRBL_KIND_SETTINGS}, {"$X", PASSO_GRBL_KIND_UNLOCK}, {"$C", PASSO_GRBL_KIND_CHECK}};

	if (text[0] != '$')
		return PASSO_GRBL_KIND_GCODE;
	if (text[1] == 'J')
		return PASSO_GRBL_KIND_JOG;
	for (unsigned i = 0; i < sizeof EXACT / sizeof *EXACT; i++) {
		if (strcmp(text, EXACT[i].text) == 0)
			return (enum passo_grbl_kind)EXACT[i].kind;
	}
	return PASSO_GRBL_KIND_OTHER;
}

static enum passo_gcode_error execute(struct passo_grbl *grbl)
{
	const char *text = grbl->line.text;
	const enum passo_grbl_kind kind = kind_of(text);
	const uint8_t rule = passo_grbl_line_rule(passo_grbl_state(grbl), kind);

	if (grbl->line.overflow)
		return PASSO_GCODE_LINE_OVERFLOW;
	if (text[0] == '\0') {
		passo_grbl_take_message(grbl);
		return PASSO_GCODE_OK;
	}
	if (rule != PASSO_GRBL_TAKEN)
		return (enum passo_gcode_error)rule;
	if (kind == PASSO_GRBL_KIND_JOG && grbl->dropped)
		return PASSO_GCODE_OK;
	if (kind != PASSO_GRBL_KIND_GCODE)
		return passo_grbl_system(grbl, kind, text);
	const enum passo_gcode_error error = passo_gcode_execute(grbl->player->gcode, text);

	if (error == PASSO_GCODE_OK)
		passo_grbl_take_message(grbl);
	grbl->reports = error == PASSO_GCODE_OK ? 0 : grbl->reports;
	return error;
}

static bool is_busy(const struct passo_grbl *grbl)
{
#ifndef PASSO_PLAIN_GCODE
	if (grbl->touch > 0)
		return true;
#endif
	return grbl->homes || !passo_player_has_taken(grbl->player);
}

static void take_start(struct passo_grbl *grbl)
{
	const char *text = grbl->stored.start[grbl->starts++];

	if (text[0] == '\0')
		return;
	const enum passo_gcode_error error = passo_gcode_execute(grbl->player->gcode, text);

	passo_grbl_say(grbl, ">");
	passo_grbl_say(grbl, text);
	passo_grbl_say(grbl, ":");
	passo_grbl_answer(grbl, error);
}

static void end_line(struct passo_grbl *grbl)
{
	const enum passo_gcode_error error = execute(grbl);

	grbl->owes = error == PASSO_GCODE_OK && is_busy(grbl);
	if (!grbl->owes)
		passo_grbl_answer(grbl, error);
	passo_gcode_line_clear(&grbl->line);
}

/* One line at most, and only when the one before has been taken. In Alarm lines are refused immediately. */
static void take_line(struct passo_grbl *grbl)
{
	const enum passo_grbl_state state = passo_grbl_state(grbl);
	const bool ready = !grbl->stopping && passo_player_is_ready(grbl->player)
	                && !passo_path_feed_is_urgent(grbl->player->feed);
	char byte;

	if ((state != PASSO_GRBL_STATE_ALARM && !ready) || grbl->greets || grbl->owes
	    || passo_grbl_line_rule(state, PASSO_GRBL_KIND_GCODE) == PASSO_GRBL_WAITS)
		return;
	if (state == PASSO_GRBL_STATE_ALARM) {
		grbl->starts = PASSO_GRBL_STARTS; /* none until `$H`: they may move */
	} else if (grbl->starts < PASSO_GRBL_STARTS) {
		take_start(grbl);
		return;
	}
	while (passo_grbl_next(grbl, &byte)) {
		if (byte == '\n' || byte == '\r') {
			end_line(grbl);
			return;
		}
		if (byte == '\0') /* the serial line has lost a byte */
			grbl->line.overflow = true;
		passo_gcode_line_add(&grbl->line, byte);
	}
	for (unsigned lost = passo_grbl_lost(grbl); lost > 0; lost--)
		passo_grbl_answer(grbl, PASSO_GCODE_LINE_OVERFLOW);
}

static void heed(struct passo_grbl *grbl, enum passo_player_event event, enum passo_error error)
{
	switch (event) {
	case PASSO_PLAYER_TRAVEL:
		passo_grbl_fail(grbl, PASSO_GRBL_SOFT_LIMIT);
		return;
	case PASSO_PLAYER_UNEXPECTED:
		passo_grbl_fail(grbl, PASSO_GRBL_PROBE_LEVEL);
		return;
	case PASSO_PLAYER_UNTOUCHED:
	case PASSO_PLAYER_NO_PROBE:
		passo_grbl_fail(grbl, PASSO_GRBL_PROBE_MISSED);
		return;
#ifndef PASSO_PLAIN_GCODE
	case PASSO_PLAYER_SLOW:
		passo_gcode_stop_spindle(grbl->player->gcode);
		passo_grbl_fail(grbl, PASSO_GRBL_SPINDLE_SLOW);
		return;
#endif
	case PASSO_PLAYER_OFFSETS:
		grbl->keeps = true;
		break;
	case PASSO_PLAYER_PROBED:
		passo_grbl_report_probe(grbl);
		break;
	case PASSO_PLAYER_ENDED:
		passo_grbl_end_overrides(grbl);
		passo_grbl_say(grbl, "[MSG:Pgm End]\r\n");
		break;
	case PASSO_PLAYER_TOOL:
#ifndef PASSO_PLAIN_GCODE
		passo_grbl_begin_change(grbl);
#endif
		break;
	case PASSO_PLAYER_INPUT:
#ifndef PASSO_PLAIN_GCODE
		passo_grbl_report_input(grbl);
#endif
		break;
	default: /* nothing, a pause */
		break;
	}
	if (error != PASSO_OK)
		passo_grbl_fault(grbl, error);
}

void passo_grbl_poll(struct passo_grbl *grbl)
{
	enum passo_player_event event = PASSO_PLAYER_NOTHING;

	passo_grbl_obey(grbl);
	if (grbl->stopping && passo_grbl_end_stop(grbl))
		return;
	if (grbl->homes) {
		passo_grbl_poll_home(grbl);
		return;
	}
	take_line(grbl);
	if (grbl->stopping)
		return;
	passo_grbl_mind_drives(grbl);
	passo_grbl_mind_rate(grbl);
	grbl->player->held = grbl->held;
	const bool follows = passo_player_follows(grbl->player);
	const enum passo_error error = passo_player_poll(grbl->player, &event);

	if (grbl->held && follows && !passo_player_follows(grbl->player))
		passo_hold(grbl->player->feed->passo);
	passo_grbl_poll_message(grbl);
	heed(grbl, event, error);
	passo_grbl_poll_touch(grbl);
	if (grbl->owes && !is_busy(grbl)) {
		grbl->owes = false;
		passo_grbl_answer(grbl, PASSO_GCODE_OK);
	}
	if (!passo_grbl_is_idle(grbl))
		return;
	grbl->jogs = false;
	if (grbl->keeps && passo_grbl_save(grbl) != PASSO_GCODE_OK)
		passo_grbl_say(grbl, "[MSG:Offsets are not stored]\r\n");
	grbl->keeps = false;
}
