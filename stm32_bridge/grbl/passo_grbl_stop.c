/* SPDX-License-Identifier: MIT
 * Real-time bytes: they pass the lines that wait.
 */
#include "passo_grbl_private.h"

#define CONTROL_X 0x18
#define PERCENT_MIN 10
#define PERCENT_MAX 200
#define PERCENT_FULL 100u

void passo_grbl_receive(struct passo_grbl *grbl, char byte)
{
	const uint8_t code = (uint8_t)byte;

	if (byte == '?')
		grbl->asks = true;
	else if (byte == '!')
		grbl->pauses = true;
	else if (code == 0x84)
		grbl->opens = true;
	else if (byte == '~')
		grbl->resumes = true;
	else if (byte == CONTROL_X)
		grbl->resets = true;
	else if (code == 0x85)
		grbl->cancels = true;
	else if (code >= 0x90 && code <= 0x9D) {
		grbl->change[grbl->changed % PASSO_GRBL_CHANGES] = code;
		grbl->changed++;
	} else if (code >= 0x80)
		return; /* other real-time commands do nothing */
	else if ((uint8_t)(grbl->head + 1u) == grbl->tail)
		grbl->lost = true;
	else {
		grbl->received[grbl->head] = byte;
		grbl->head = (uint8_t)(grbl->head + 1u);
	}
}

bool passo_grbl_take(volatile bool *flag)
{
	if (!*flag) /* an interrupt may set it at any moment */
		return false;
	*flag = false;
	return true;
}

static void drop_input(struct passo_grbl *grbl)
{
	grbl->tail = grbl->head;
	grbl->lost = false;
	passo_gcode_line_clear(&grbl->line);
}

static bool moves(const struct passo_grbl *grbl)
{
	return passo_path_feed_is_moving(grbl->player->feed) || passo_is_moving(grbl->player->feed->passo);
}

void passo_grbl_begin_stop(struct passo_grbl *grbl, bool resets)
{
	drop_input(grbl);
	if (moves(grbl))
		passo_stop(grbl->player->feed->passo);
	grbl->stopping = true;
	grbl->greets = grbl->greets || resets;
}

/* Ctrl-X drops everything. */
static void reset(struct passo_grbl *grbl)
{
	if (grbl->homes)
		passo_grbl_alarm(grbl, PASSO_GRBL_HOME_RESET);
	else if (moves(grbl) && !grbl->stopping)
		passo_grbl_alarm(grbl, PASSO_GRBL_ABORTED);
	passo_grbl_begin_stop(grbl, true);
}

/* After e-stop, alarm and watchdog as well. Whether the channel can move again. */
static bool clear(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;

	if (passo->has_inputs && passo_fault(passo) == PASSO_ERROR_ESTOP
	    && passo_clear_estop(passo) != PASSO_OK)
		return false;
	if (passo_clear(passo) != PASSO_OK)
		return false;
	for (uint8_t axis = 0; axis < grbl->player->gcode->settings.axes; axis++) {
		if (passo_enable(passo, axis, true) != PASSO_OK)
			return false;
	}
	return true;
}

bool passo_grbl_end_stop(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;

	passo_poll(passo);
	if (passo_is_moving(passo) || !clear(grbl) || passo_player_restart(grbl->player) != PASSO_OK)
		return false;
	if (grbl->held)
		passo_resume(passo);
	grbl->stopping = grbl->jogs = grbl->held = false;
	if (grbl->homes)
		passo_grbl_answer(grbl, PASSO_GCODE_LOCKED);
	grbl->homes = false;
	if (!grbl->greets)
		return true;
	drop_input(grbl); /* what came before the greeting */
	passo_gcode_reset(grbl->player->gcode);
	grbl->checks = grbl->greets = grbl->door = false;
	grbl->feed = grbl->rapid = grbl->spindle = PERCENT_FULL;
	passo_grbl_override(grbl);
	passo_grbl_greet(grbl);
	return true;
}

/* Feeds up to 100 % by the time scale of the core, above by planning anew. */
void passo_grbl_override(struct passo_grbl *grbl)
{
	struct passo_path_planner *path = grbl->player->feed->path;
	const uint32_t above = grbl->feed > PERCENT_FULL ? grbl->feed : PERCENT_FULL;

	passo_override(grbl->player->feed->passo, grbl->feed < PERCENT_FULL ? grbl->feed : PERCENT_FULL);
	passo_path_override(path, PASSO_PATH_OVERRIDE_MIN * above / PERCENT_FULL);
	passo_path_rapid(path, PASSO_PATH_RAPID_FULL * grbl->rapid / PERCENT_FULL);
	grbl->player->gcode->spindle_percent = grbl->spindle;
}

/* The byte after that of 100 %: +10, -10, +1, -1. */
static void change_percent(uint8_t *percent, unsigned step)
{
	static const int8_t CHANGES[] = {0, 10, -10, 1, -1};
	const int wanted = step == 0 ? (int)PERCENT_FULL : *percent + CHANGES[step];

	if (wanted >= PERCENT_MIN && wanted <= PERCENT_MAX)
		*percent = (uint8_t)wanted;
}

static void change(struct passo_grbl *grbl, uint8_t code)
{
	static const uint8_t RAPIDS[] = {100, 50, 25};

	if (code <= 0x94)
		change_percent(&grbl->feed, code - 0x90u);
	else if (code <= 0x97)
		grbl->rapid = RAPIDS[code - 0x95];
	else if (code >= 0x99)
		change_percent(&grbl->spindle, code - 0x99u);
	grbl->reports = grbl->reports > 0 ? PASSO_GRBL_REPORTS : 0;
	passo_grbl_override(grbl);
}

static void hold(struct passo_grbl *grbl)
{
	if (!passo_path_feed_is_moving(grbl->player->feed))
		return;
	if (grbl->jogs)
		passo_grbl_begin_stop(grbl, false);
	else
		grbl->held = passo_hold(grbl->player->feed->passo) == PASSO_OK;
}

/* As hold, and lines wait as well. */
static void open_door(struct passo_grbl *grbl)
{
	if (grbl->homes) {
		passo_grbl_alarm(grbl, PASSO_GRBL_HOME_DOOR);
		passo_grbl_begin_stop(grbl, false);
		return;
	}
	hold(grbl);
	grbl->door = !grbl->locked;
}

void passo_grbl_obey(struct passo_grbl *grbl)
{
	if (passo_grbl_take(&grbl->resets))
		reset(grbl);
	if (passo_grbl_take(&grbl->cancels) && grbl->jogs && !grbl->stopping)
		passo_grbl_begin_stop(grbl, false);
	if (passo_grbl_take(&grbl->pauses) && !grbl->stopping)
		hold(grbl);
	if (passo_grbl_take(&grbl->opens) && !grbl->stopping)
		open_door(grbl);
	if (passo_grbl_take(&grbl->resumes)) {
		grbl->door = false;
		if (grbl->held && passo_resume(grbl->player->feed->passo) == PASSO_OK)
			grbl->held = false;
		passo_player_go_on(grbl->player);
	}
	for (; grbl->heeded != grbl->changed; grbl->heeded++)
		change(grbl, grbl->change[grbl->heeded % PASSO_GRBL_CHANGES]);
	if (passo_grbl_take(&grbl->asks))
		passo_grbl_report(grbl);
}
