/* SPDX-License-Identifier: MIT
 * Real-time requests: they pass the lines that wait. What they do in each state: passo_grbl_state.c.
 */
#include "passo_encoder.h"
#include "passo_grbl_private.h"
#include "passo_inputs.h"

#define PERCENT_FULL 100u

enum passo_grbl_state passo_grbl_state(const struct passo_grbl *grbl)
{
	if (grbl->homes)
		return PASSO_GRBL_STATE_HOME;
	if (grbl->sleeps)
		return PASSO_GRBL_STATE_SLEEP;
	if (grbl->locked)
		return PASSO_GRBL_STATE_ALARM;
	if (grbl->door)
		return PASSO_GRBL_STATE_DOOR;
	if (grbl->held)
		return PASSO_GRBL_STATE_HOLD;
#ifndef PASSO_PLAIN_GCODE
	if (grbl->player->changes && (!grbl->admits || grbl->player->paused))
		return PASSO_GRBL_STATE_TOOL;
#endif
	if (grbl->player->paused)
		return PASSO_GRBL_STATE_HOLD;
	if (grbl->checks)
		return PASSO_GRBL_STATE_CHECK;
	if (grbl->jogs)
		return PASSO_GRBL_STATE_JOG;
#ifndef PASSO_PLAIN_GCODE
	if (grbl->player->changes && passo_grbl_is_idle(grbl))
		return PASSO_GRBL_STATE_TOUCH;
#endif
	return passo_grbl_is_idle(grbl) ? PASSO_GRBL_STATE_IDLE : PASSO_GRBL_STATE_RUN;
}

static bool moves(const struct passo_grbl *grbl)
{
	return passo_path_feed_is_moving(grbl->player->feed) || passo_is_moving(grbl->player->feed->passo);
}

bool passo_grbl_slows(const struct passo_grbl *grbl)
{
	const struct passo *passo = grbl->player->feed->passo;

	return passo_is_moving(passo) && (grbl->stopping || passo_snapshot(passo)->rate > 0);
}

void passo_grbl_begin_stop(struct passo_grbl *grbl)
{
	if (moves(grbl))
		passo_stop(grbl->player->feed->passo);
	grbl->stopping = true;
}

/* Check mode leaves no trace: offsets are those stored, the tool is the one before, and modes are those of a
 * reset, as outputs follow them. */
static void leave_check(struct passo_grbl *grbl)
{
	if (grbl->checks) {
		passo_gcode_set_offsets(grbl->player->gcode, &grbl->stored.offsets);
#ifndef PASSO_PLAIN_GCODE
		passo_gcode_load(grbl->player->gcode, grbl->loaded);
#endif
		passo_gcode_reset(grbl->player->gcode);
	}
	grbl->checks = grbl->player->checks = false;
}

static void lock(struct passo_grbl *grbl, enum passo_grbl_alarm alarm)
{
	grbl->locked = true;
	grbl->homes = grbl->door = false;
	passo_grbl_say(grbl, "ALARM:");
	passo_grbl_say_number(grbl, (uint64_t)alarm);
	passo_grbl_say(grbl, "\r\n");
	leave_check(grbl);
}

void passo_grbl_fail(struct passo_grbl *grbl, enum passo_grbl_alarm alarm)
{
	const bool missed = alarm == PASSO_GRBL_PROBE_MISSED;

	lock(grbl, alarm);
	if (missed)
		passo_grbl_report_probe(grbl);
	if (grbl->owes)
		passo_grbl_answer(
		    grbl, missed || alarm == PASSO_GRBL_PROBE_LEVEL ? PASSO_GCODE_OK : PASSO_GCODE_LOCKED);
	grbl->owes = false;
#ifndef PASSO_PLAIN_GCODE
	grbl->touch = 0;
#endif
	passo_grbl_begin_stop(grbl);
}

void passo_grbl_fault(struct passo_grbl *grbl, enum passo_error error)
{
	enum passo_grbl_alarm alarm = PASSO_GRBL_ABORTED;

	if (error == PASSO_ERROR_SWITCH_MISSED)
		alarm = PASSO_GRBL_HOME_MISSED;
	else if (error == PASSO_ERROR_SWITCH_LEVEL)
		alarm = PASSO_GRBL_HOME_PULL_OFF;
	else if (error == PASSO_ERROR_LIMIT)
		alarm = PASSO_GRBL_HARD_LIMIT;
	passo_grbl_fail(grbl, alarm);
}

/* Ctrl-X drops everything, and owes no answer. */
static void reset(struct passo_grbl *grbl, bool homed)
{
	if (homed)
		lock(grbl, PASSO_GRBL_HOME_RESET);
	else if (moves(grbl) && !grbl->stopping)
		lock(grbl, PASSO_GRBL_ABORTED);
	grbl->owes = false;
#ifndef PASSO_PLAIN_GCODE
	grbl->touch = 0;
	passo_player_give_up(grbl->player);
#endif
	passo_grbl_begin_stop(grbl);
	grbl->greets = true;
}

#ifndef PASSO_CARTESIAN
/* The motors are where their encoders say; nowhere if one is too far away for that. */
static void adopt(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;

	for (uint8_t motor = 0; motor < passo_grbl_motors(grbl); motor++) {
		if (passo_grbl_has_encoder(grbl, motor)
		    && passo_adopt_encoder(passo, motor) == PASSO_ERROR_OFF_SCALE) {
			passo_grbl_apply_encoders(grbl);
			return;
		}
	}
}
#endif

/* After e-stop, alarm, watchdog and following error as well. Whether the channel can move again. Only here an
 * e-stop or a limit shows that came after another stop, on the way to rest. */
static bool clear(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;
	struct passo_readings now = {.estop = false};

	if (passo->has_inputs && passo_read_inputs(passo, &now) != PASSO_OK)
		return false;
	if (!grbl->locked && (now.estop || now.axes != 0u))
		passo_grbl_fault(grbl, now.estop || now.alarm ? PASSO_ERROR_ESTOP : PASSO_ERROR_LIMIT);
	if (now.estop && passo_clear_estop(passo) != PASSO_OK)
		return false;
#ifndef PASSO_CARTESIAN
	if (passo_fault(passo) == PASSO_ERROR_FOLLOWING)
		adopt(grbl);
#endif
	return passo_clear(passo) == PASSO_OK && passo_grbl_drive(grbl, true) == PASSO_OK;
}

/* Whether no tracker is on its way: then positions are exact. */
static bool has_taken_up(struct passo *passo)
{
#ifdef PASSO_WITHOUT_TRACKERS
	(void)passo;
	return true;
#else
	return passo_track_again(passo) == PASSO_OK && !passo_is_moving(passo);
#endif
}

bool passo_grbl_end_stop(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;

	passo_poll(passo);
	if (passo_is_moving(passo) || !clear(grbl) || !has_taken_up(passo)
	    || passo_player_restart(grbl->player) != PASSO_OK)
		return false;
	if (grbl->held)
		passo_resume(passo);
	grbl->stopping = grbl->jogs = grbl->held = false;
	if (grbl->owes) /* by a jog that was canceled */
		passo_grbl_answer(grbl, PASSO_GCODE_OK);
	grbl->owes = false;
	if (!grbl->greets)
		return true;
	leave_check(grbl);
	passo_grbl_drop_input(grbl); /* what came before the greeting */
	passo_gcode_reset(grbl->player->gcode);
	grbl->greets = grbl->door = grbl->sleeps = false;
	passo_grbl_greet(grbl);
	return true;
}

/* Jogs have the feed that they name. */
static uint8_t feed_of(const struct passo_grbl *grbl)
{
	return grbl->jogs ? PERCENT_FULL : grbl->feed;
}

/* Feeds above 100 % are replanned; those below are the rate of the core. */
void passo_grbl_override(struct passo_grbl *grbl)
{
	const uint32_t feed = feed_of(grbl), above = feed > PERCENT_FULL ? feed : PERCENT_FULL;

	grbl->feed_now = (uint8_t)feed;
	grbl->rapid_now = grbl->rapid;
	grbl->spindle_now = grbl->spindle;
	passo_path_override(grbl->player->feed->path, PASSO_PATH_OVERRIDE_MIN * above / PERCENT_FULL);
	grbl->player->gcode->spindle_percent = grbl->spindle_now;
}

/* The rate is that of what moves, or is about to: of a feed, a rapid, or the full one of home and probe. */
void passo_grbl_mind_rate(struct passo_grbl *grbl)
{
	const enum passo_player_motion motion = passo_player_motion(grbl->player);
	uint8_t percent = PERCENT_FULL;

	if (motion == PASSO_PLAYER_AT_REST)
		return;
	if (motion == PASSO_PLAYER_RAPID)
		percent = grbl->rapid_now;
	else if (motion == PASSO_PLAYER_FEED && grbl->feed_now < PERCENT_FULL)
		percent = grbl->feed_now;
	if (percent != grbl->rate && passo_override(grbl->player->feed->passo, percent) == PASSO_OK)
		grbl->rate = percent;
}

static bool has_changed(const struct passo_grbl *grbl)
{
	return feed_of(grbl) != grbl->feed_now || grbl->rapid != grbl->rapid_now
	    || grbl->spindle != grbl->spindle_now;
}

/* A hold that is not acknowledged is sent again by the driver. A motion in step with the spindle is made to
 * its end: passo_grbl_poll(). */
static void hold(struct passo_grbl *grbl)
{
	if (!passo_player_follows(grbl->player))
		passo_hold(grbl->player->feed->passo);
	grbl->held = true;
}

static void cancel(struct passo_grbl *grbl)
{
	if (!grbl->stopping)
		passo_grbl_begin_stop(grbl);
	passo_grbl_drop_jogs(grbl);
}

/* A resume that is not acknowledged is tried again. */
static void go_on(struct passo_grbl *grbl)
{
	if (grbl->held && passo_resume(grbl->player->feed->passo) != PASSO_OK) {
		grbl->asked[PASSO_GRBL_ASK_RESUME] = true;
		return;
	}
#ifndef PASSO_PLAIN_GCODE
	if (!grbl->held && !grbl->door)
		passo_grbl_end_change(grbl);
	else if (!grbl->player->changes)
#endif
		passo_player_go_on(grbl->player);
	grbl->held = grbl->door = false;
}

static void act(struct passo_grbl *grbl, enum passo_grbl_act act)
{
	switch (act) {
	case PASSO_GRBL_ACT_NOTHING:
		break;
	case PASSO_GRBL_ACT_RESETS:
	case PASSO_GRBL_ACT_FAILS:
		reset(grbl, act == PASSO_GRBL_ACT_FAILS);
		break;
	case PASSO_GRBL_ACT_OPENS:
		grbl->door = true;
		hold(grbl);
		break;
	case PASSO_GRBL_ACT_HOLDS:
		hold(grbl);
		break;
	case PASSO_GRBL_ACT_CLOSES:
		grbl->door = true;
		cancel(grbl);
		break;
	case PASSO_GRBL_ACT_CANCELS:
		cancel(grbl);
		break;
	case PASSO_GRBL_ACT_STOPS:
		passo_grbl_fail(grbl, PASSO_GRBL_HOME_DOOR);
		break;
	case PASSO_GRBL_ACT_GOES_ON:
		go_on(grbl);
		break;
#ifndef PASSO_PLAIN_GCODE
	case PASSO_GRBL_ACT_ADMITS:
		passo_grbl_admit(grbl);
		break;
#endif
	case PASSO_GRBL_ACT_REPORTS:
		passo_grbl_report(grbl);
		break;
	}
}

/* Clears a flag that an interrupt may set at any moment; returns what it was. */
static bool take(volatile bool *flag)
{
	if (!*flag)
		return false;
	*flag = false;
	return true;
}

void passo_grbl_obey(struct passo_grbl *grbl)
{
	bool asked[PASSO_GRBL_ASKS];

	for (unsigned ask = 0; ask < PASSO_GRBL_ASKS; ask++)
		asked[ask] = take(&grbl->asked[ask]);
	if (asked[PASSO_GRBL_ASK_PAUSE] || asked[PASSO_GRBL_ASK_OPEN])
		asked[PASSO_GRBL_ASK_RESUME] = false;
	if (asked[PASSO_GRBL_ASK_CANCEL])
		passo_grbl_drop_jogs(grbl);
	for (enum passo_grbl_request ask = PASSO_GRBL_ASK_RESET; ask < PASSO_GRBL_ASK_REPORT; ask++) {
		/* nothing passes a reset */
		if (asked[ask] && (!grbl->greets || ask == PASSO_GRBL_ASK_RESET))
			act(grbl, passo_grbl_request_rule(passo_grbl_state(grbl), ask));
	}
	if (has_changed(grbl)) {
		passo_grbl_override(grbl);
		grbl->reports = grbl->reports > 0 ? PASSO_GRBL_REPORTS : 0;
	}
	if (asked[PASSO_GRBL_ASK_REPORT])
		passo_grbl_report(grbl);
}
