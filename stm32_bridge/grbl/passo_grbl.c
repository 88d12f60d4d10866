/* SPDX-License-Identifier: MIT
 * A line is taken from the ring only when the line before has handed out all its actions: that is what paces
 * the host, whether it waits for each answer or counts characters.
 */
#include "passo_grbl_private.h"

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
	*grbl = (struct passo_grbl){
	    .player = player, .sink = *sink, .setup = setup, .feed = 100, .rapid = 100, .spindle = 100};
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
	return passo_player_is_idle(grbl->player) && !grbl->stopping && !grbl->homes;
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

void passo_grbl_alarm(struct passo_grbl *grbl, enum passo_grbl_alarm alarm)
{
	grbl->locked = true;
	passo_grbl_say(grbl, "ALARM:");
	passo_grbl_say_number(grbl, (uint64_t)alarm);
	passo_grbl_say(grbl, "\r\n");
}

static enum passo_gcode_error execute(struct passo_grbl *grbl)
{
	struct passo_gcode *gcode = grbl->player->gcode;
	const char *text = grbl->line.text;

	if (grbl->line.overflow || passo_grbl_take(&grbl->lost))
		return PASSO_GCODE_LINE_OVERFLOW;
	if (text[0] == '\0')
		return PASSO_GCODE_OK;
	if (text[0] == '$')
		return passo_grbl_system(grbl, text);
	if (grbl->locked || grbl->jogs)
		return PASSO_GCODE_LOCKED;
	const enum passo_gcode_error error = passo_gcode_execute(gcode, text);
	grbl->reports = error == PASSO_GCODE_OK ? 0 : grbl->reports;
	if (grbl->checks && error == PASSO_GCODE_OK) { /* nothing of it is done */
		passo_gcode_position position;

		for (unsigned axis = 0; axis < gcode->settings.axes; axis++)
			position[axis] = gcode->position[axis];
		passo_gcode_set_position(gcode, position);
	}
	return error;
}

/* The next line of `$N`. */
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

/* One line at most, and only when the one before has been taken. */
static void take_line(struct passo_grbl *grbl)
{
	const bool ready = passo_player_is_ready(grbl->player) && !grbl->homes && !grbl->door
	                && !passo_path_feed_is_urgent(grbl->player->feed);

	if (ready && !grbl->locked && grbl->starts < PASSO_GRBL_STARTS) {
		take_start(grbl);
		return;
	}
	while ((ready || (grbl->locked && !grbl->homes)) && grbl->tail != grbl->head) {
		const char byte = grbl->received[grbl->tail];

		grbl->tail = (uint8_t)(grbl->tail + 1u);
		if (byte != '\n' && byte != '\r') {
			passo_gcode_line_add(&grbl->line, byte);
			continue;
		}
		const enum passo_gcode_error error = execute(grbl);

		if (!grbl->homes)
			passo_grbl_answer(grbl, error);
		passo_gcode_line_clear(&grbl->line);
		return;
	}
}

static void heed(struct passo_grbl *grbl, enum passo_player_event event, enum passo_error error)
{
	if (event == PASSO_PLAYER_TRAVEL)
		passo_grbl_alarm(grbl, PASSO_GRBL_SOFT_LIMIT);
	else if (event == PASSO_PLAYER_UNEXPECTED)
		passo_grbl_alarm(grbl, PASSO_GRBL_PROBE_LEVEL);
	else if (event == PASSO_PLAYER_UNTOUCHED || event == PASSO_PLAYER_NO_PROBE)
		passo_grbl_alarm(grbl, PASSO_GRBL_PROBE_MISSED);
	else if (event == PASSO_PLAYER_OFFSETS)
		grbl->keeps = true;
	else if (event == PASSO_PLAYER_PROBED)
		passo_grbl_report_probe(grbl);
	else if (event == PASSO_PLAYER_ENDED)
		passo_grbl_say(grbl, "[MSG:Pgm End]\r\n");
	else if (error != PASSO_OK)
		passo_grbl_alarm(
		    grbl, error == PASSO_ERROR_LIMIT ? PASSO_GRBL_HARD_LIMIT : PASSO_GRBL_ABORTED);
	else
		return;
	if (grbl->locked)
		passo_grbl_begin_stop(grbl, false);
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
	const enum passo_error error = passo_player_poll(grbl->player, &event);

	heed(grbl, event, error);
	if (!passo_grbl_is_idle(grbl))
		return;
	grbl->jogs = false;
	if (grbl->keeps && passo_grbl_save(grbl) != PASSO_GCODE_OK)
		passo_grbl_say(grbl, "[MSG:Offsets are not stored]\r\n");
	grbl->keeps = false;
}
