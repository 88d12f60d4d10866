/* SPDX-License-Identifier: MIT
 * A line is taken from the ring only when the line before has handed out all its actions: that is what paces
 * the host, whether it waits for each answer or counts characters.
 */
#include "passo_grbl.h"

#define CONTROL_X 0x18
#define PERCENT_MIN 10
#define PERCENT_MAX 200
#define PERCENT_FULL 100u

static const char GREETING[] = "\r\nGrbl 1.1h ['$' for help]\r\n";

void passo_grbl_open(struct passo_grbl *grbl, struct passo_player *player, const struct passo_grbl_sink *sink)
{
	*grbl = (struct passo_grbl){.player = player, .sink = *sink, .feed_percent = PERCENT_FULL};
	passo_gcode_line_clear(&grbl->line);
	passo_grbl_say(grbl, GREETING);
}

bool passo_grbl_is_idle(const struct passo_grbl *grbl)
{
	return passo_player_is_idle(grbl->player) && !grbl->stopping;
}

void passo_grbl_receive(struct passo_grbl *grbl, char byte)
{
	const uint8_t code = (uint8_t)byte;

	if (byte == '?')
		grbl->asks = true;
	else if (byte == '!' || code == 0x84)
		grbl->holds = true;
	else if (byte == '~')
		grbl->resumes = true;
	else if (byte == CONTROL_X)
		grbl->resets = true;
	else if (code == 0x85)
		grbl->cancels = true;
	else if (code >= 0x90 && code <= 0x94)
		grbl->feed_change = code;
	else if (code >= 0x80)
		return; /* other real-time commands do nothing */
	else if ((uint8_t)(grbl->head + 1u) == grbl->tail)
		grbl->lost = true;
	else {
		grbl->received[grbl->head] = byte;
		grbl->head = (uint8_t)(grbl->head + 1u);
	}
}

static void answer(struct passo_grbl *grbl, enum passo_gcode_error error)
{
	if (error == PASSO_GCODE_OK) {
		passo_grbl_say(grbl, "ok\r\n");
		return;
	}
	passo_grbl_say(grbl, "error:");
	passo_grbl_say_number(grbl, (uint64_t)error);
	passo_grbl_say(grbl, "\r\n");
}

static void raise_alarm(struct passo_grbl *grbl, enum passo_grbl_alarm alarm)
{
	grbl->alarm = alarm;
	passo_grbl_say(grbl, "ALARM:");
	passo_grbl_say_number(grbl, (uint64_t)alarm);
	passo_grbl_say(grbl, "\r\n");
}

static void drop_input(struct passo_grbl *grbl)
{
	grbl->tail = grbl->head;
	grbl->lost = false;
	passo_gcode_line_clear(&grbl->line);
}

/* Ctrl-X drops everything; a jog that is cancelled only the jogs. */
static void begin_stop(struct passo_grbl *grbl, bool resets)
{
	struct passo *passo = grbl->player->feed->passo;
	const bool moves = passo_path_feed_is_moving(grbl->player->feed);

	drop_input(grbl);
	if (moves)
		passo_stop(passo);
	if (resets && moves)
		raise_alarm(grbl, PASSO_GRBL_ABORTED);
	grbl->stopping = true;
	grbl->greets = resets;
}

/* Once the machine rests: the program goes on from where it is. */
static void end_stop(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;

	passo_poll(passo);
	if (passo_is_moving(passo) || passo_clear(passo) != PASSO_OK
	    || passo_player_restart(grbl->player) != PASSO_OK)
		return;
	if (grbl->held)
		passo_resume(passo);
	grbl->stopping = grbl->jogs = grbl->held = false;
	if (!grbl->greets)
		return;
	passo_gcode_reset(grbl->player->gcode);
	grbl->checks = false;
	grbl->reports = 0;
	passo_grbl_say(grbl, GREETING);
	if (grbl->alarm != PASSO_GRBL_NO_ALARM)
		passo_grbl_say(grbl, "[MSG:'$H'|'$X' to unlock]\r\n");
}

static bool take(volatile bool *flag)
{
	const bool set = *flag;

	*flag = false;
	return set;
}

/* Up to 100 % by the time scale of the core, above by planning anew. */
static void change_feed(struct passo_grbl *grbl, uint8_t code)
{
	static const int8_t CHANGES[] = {0, 10, -10, 1, -1};
	const int percent = code == 0x90 ? (int)PERCENT_FULL : grbl->feed_percent + CHANGES[code - 0x90];

	if (percent < PERCENT_MIN || percent > PERCENT_MAX)
		return;
	grbl->feed_percent = (uint8_t)percent;
	const uint32_t above = grbl->feed_percent > PERCENT_FULL ? grbl->feed_percent : PERCENT_FULL;
	passo_override(
	    grbl->player->feed->passo, grbl->feed_percent < PERCENT_FULL ? grbl->feed_percent : PERCENT_FULL);
	passo_path_override(grbl->player->feed->path, PASSO_PATH_OVERRIDE_MIN * above / PERCENT_FULL);
}

static void obey(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;

	if (take(&grbl->resets))
		begin_stop(grbl, true);
	if (take(&grbl->cancels) && grbl->jogs && !grbl->stopping)
		begin_stop(grbl, false);
	if (take(&grbl->holds) && passo_path_feed_is_moving(grbl->player->feed)) {
		if (grbl->jogs)
			begin_stop(grbl, false);
		else
			grbl->held = passo_hold(passo) == PASSO_OK;
	}
	if (take(&grbl->resumes)) {
		if (grbl->held && passo_resume(passo) == PASSO_OK)
			grbl->held = false;
		passo_player_go_on(grbl->player);
	}
	if (grbl->feed_change != 0) {
		const uint8_t code = grbl->feed_change;

		grbl->feed_change = 0;
		change_feed(grbl, code);
	}
	if (take(&grbl->asks))
		passo_grbl_report(grbl);
}

static enum passo_gcode_error execute(struct passo_grbl *grbl)
{
	struct passo_gcode *gcode = grbl->player->gcode;
	const char *text = grbl->line.text;

	if (grbl->line.overflow || take(&grbl->lost))
		return PASSO_GCODE_LINE_OVERFLOW;
	if (text[0] == '\0')
		return PASSO_GCODE_OK;
	if (text[0] == '$')
		return passo_grbl_system(grbl, text);
	if (grbl->alarm != PASSO_GRBL_NO_ALARM || grbl->jogs)
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

/* One line at most, and only when the one before has been taken. */
static void take_line(struct passo_grbl *grbl)
{
	while (passo_player_is_ready(grbl->player) && grbl->tail != grbl->head) {
		const char byte = grbl->received[grbl->tail];

		grbl->tail = (uint8_t)(grbl->tail + 1u);
		if (byte != '\n' && byte != '\r') {
			passo_gcode_line_add(&grbl->line, byte);
			continue;
		}
		answer(grbl, execute(grbl));
		passo_gcode_line_clear(&grbl->line);
		return;
	}
}

static void heed(struct passo_grbl *grbl, enum passo_player_event event, enum passo_error error)
{
	if (event == PASSO_PLAYER_TRAVEL)
		raise_alarm(grbl, PASSO_GRBL_SOFT_LIMIT);
	else if (event == PASSO_PLAYER_UNEXPECTED)
		raise_alarm(grbl, PASSO_GRBL_PROBE_LEVEL);
	else if (event == PASSO_PLAYER_UNTOUCHED || event == PASSO_PLAYER_NO_PROBE)
		raise_alarm(grbl, PASSO_GRBL_PROBE_MISSED);
	else if (event == PASSO_PLAYER_ENDED)
		passo_grbl_say(grbl, "[MSG:Pgm End]\r\n");
	else if (error != PASSO_OK)
		raise_alarm(grbl, error == PASSO_ERROR_LIMIT ? PASSO_GRBL_HARD_LIMIT : PASSO_GRBL_ABORTED);
	else
		return;
	if (grbl->alarm != PASSO_GRBL_NO_ALARM) {
		passo_stop(grbl->player->feed->passo);
		drop_input(grbl);
		grbl->stopping = true;
		grbl->greets = false;
	}
}

void passo_grbl_poll(struct passo_grbl *grbl)
{
	enum passo_player_event event = PASSO_PLAYER_NOTHING;

	obey(grbl);
	if (grbl->stopping) {
		end_stop(grbl);
		return;
	}
	take_line(grbl);
	const enum passo_error error = passo_player_poll(grbl->player, &event);
	heed(grbl, event, error);
	if (grbl->jogs && passo_grbl_is_idle(grbl))
		grbl->jogs = false;
}
