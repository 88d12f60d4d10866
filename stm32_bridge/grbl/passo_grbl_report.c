/* SPDX-License-Identifier: MIT
 * Reports: state, modes, offsets. Lengths are millimetres with three decimals.
 */
#include "passo_grbl.h"
#include "passo_math.h"

#define DIGITS_MAX 20u
#define NANOMETRES_PER_MICROMETRE 1000u
#define REPORTS_MOVING 30u /* status reports from one with offsets to the next */

void passo_grbl_say(struct passo_grbl *grbl, const char *text)
{
	grbl->sink.write(grbl->sink.context, text);
}

static void say_digits(struct passo_grbl *grbl, uint64_t number, unsigned least)
{
	char text[DIGITS_MAX + 1u];
	unsigned at = DIGITS_MAX;

	text[at] = '\0';
	for (unsigned count = 0; count < least || number > 0; count++) {
		text[--at] = (char)('0' + number % 10);
		number /= 10;
	}
	passo_grbl_say(grbl, &text[at]);
}

void passo_grbl_say_number(struct passo_grbl *grbl, uint64_t number)
{
	say_digits(grbl, number, 1);
}

void passo_grbl_say_millimetres(struct passo_grbl *grbl, int64_t nanometres)
{
	const uint64_t size = nanometres < 0 ? 0 - (uint64_t)nanometres : (uint64_t)nanometres;
	const uint64_t micrometres = (size + NANOMETRES_PER_MICROMETRE / 2) / NANOMETRES_PER_MICROMETRE;

	if (nanometres < 0 && micrometres > 0)
		passo_grbl_say(grbl, "-");
	say_digits(grbl, micrometres / 1000, 1);
	passo_grbl_say(grbl, ".");
	say_digits(grbl, micrometres % 1000, 3);
}

static void say_position(struct passo_grbl *grbl, const char *name, const int64_t *position)
{
	passo_grbl_say(grbl, name);
	for (unsigned axis = 0; axis < grbl->player->gcode->settings.axes; axis++) {
		passo_grbl_say(grbl, axis > 0 ? "," : ":");
		passo_grbl_say_millimetres(grbl, position[axis]);
	}
}

static const char *state_of(const struct passo_grbl *grbl)
{
	const struct passo_path_feed *feed = grbl->player->feed;

	if (grbl->alarm != PASSO_GRBL_NO_ALARM)
		return "Alarm";
	if (grbl->held || grbl->player->paused)
		return grbl->held && passo_snapshot(feed->passo)->rate > 0 ? "Hold:1" : "Hold:0";
	if (grbl->checks)
		return "Check";
	if (passo_grbl_is_idle(grbl))
		return "Idle";
	return grbl->jogs ? "Jog" : "Run";
}

/* mm/min along the path at present */
static uint64_t feed_of(const struct passo_path_feed *feed)
{
	const struct passo_snapshot *now = passo_snapshot(feed->passo);
	const uint64_t velocity = (uint64_t)now->velocity * now->rate; /* UQ0.48 substeps per clock */
	const uint64_t clocks = UINT64_C(60) * feed->path->machine.clock_hz;
	const uint64_t substeps = passo_mul_div(velocity, clocks, UINT64_C(1) << 48);
	const uint32_t scale = feed->path->substeps_per_mm;

	return passo_is_moving(feed->passo) ? (substeps + scale / 2) / scale : 0;
}

void passo_grbl_report(struct passo_grbl *grbl)
{
	struct passo_player *player = grbl->player;
	int32_t steps[PASSO_AXES_MAX] = {0};
	passo_gcode_position position = {0};

	passo_positions(player->feed->passo, steps);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		position[axis] = passo_player_nanometres(player, axis, steps[axis]);
	passo_grbl_say(grbl, "<");
	passo_grbl_say(grbl, state_of(grbl));
	say_position(grbl, "|MPos", position);
	passo_grbl_say(grbl, "|Bf:");
	passo_grbl_say_number(grbl, passo_path_room(player->feed->path));
	passo_grbl_say(grbl, ",");
	passo_grbl_say_number(grbl, (uint8_t)(grbl->tail - grbl->head - 1u));
	if (player->gcode->line > 0) {
		passo_grbl_say(grbl, "|Ln:");
		passo_grbl_say_number(grbl, player->gcode->line);
	}
	passo_grbl_say(grbl, "|FS:");
	passo_grbl_say_number(grbl, feed_of(player->feed));
	passo_grbl_say(grbl, ",");
	passo_grbl_say_number(grbl, (uint64_t)player->gcode->spindle / PASSO_GCODE_MILLION);
	if (grbl->reports == 0) {
		for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
			position[axis] = passo_gcode_offset(player->gcode, axis);
		say_position(grbl, "|WCO", position);
		grbl->reports = REPORTS_MOVING;
	} else if (grbl->reports-- == REPORTS_MOVING) {
		passo_grbl_say(grbl, "|Ov:");
		passo_grbl_say_number(grbl, grbl->feed_percent);
		passo_grbl_say(grbl, ",100,100");
	}
	passo_grbl_say(grbl, ">\r\n");
}

static void say_command(struct passo_grbl *grbl, const char *letter, passo_gcode_command command)
{
	passo_grbl_say(grbl, letter);
	passo_grbl_say_number(grbl, (uint64_t)command / 10);
	if (command % 10 > 0) {
		passo_grbl_say(grbl, ".");
		passo_grbl_say_number(grbl, (uint64_t)command % 10);
	}
}

void passo_grbl_report_modes(struct passo_grbl *grbl)
{
	static const uint8_t SHOWN[] = {PASSO_GCODE_MOTION, PASSO_GCODE_SYSTEM, PASSO_GCODE_PLANE,
	    PASSO_GCODE_UNITS, PASSO_GCODE_DISTANCE, PASSO_GCODE_FEED_MODE};
	const struct passo_gcode *gcode = grbl->player->gcode;

	passo_grbl_say(grbl, "[GC:");
	for (unsigned i = 0; i < sizeof SHOWN; i++)
		say_command(grbl, i > 0 ? " G" : "G", gcode->mode[SHOWN[i]]);
	say_command(grbl, " M", gcode->mode[PASSO_GCODE_SPINDLE]);
	passo_grbl_say(grbl, gcode->mist ? " M7" : "");
	passo_grbl_say(grbl, gcode->flood ? " M8" : "");
	passo_grbl_say(grbl, gcode->mist || gcode->flood ? "" : " M9");
	passo_grbl_say(grbl, " T");
	passo_grbl_say_number(grbl, gcode->tool);
	passo_grbl_say(grbl, " F");
	passo_grbl_say_number(grbl, (uint64_t)gcode->feed / PASSO_GCODE_MILLION);
	passo_grbl_say(grbl, " S");
	passo_grbl_say_number(grbl, (uint64_t)gcode->spindle / PASSO_GCODE_MILLION);
	passo_grbl_say(grbl, "]\r\n");
}

void passo_grbl_report_offsets(struct passo_grbl *grbl)
{
	static const char *const SYSTEMS[] = {"[G54", "[G55", "[G56", "[G57", "[G58", "[G59"};
	const struct passo_gcode *gcode = grbl->player->gcode;

	for (unsigned system = 0; system < PASSO_GCODE_SYSTEMS; system++) {
		say_position(grbl, SYSTEMS[system], gcode->offsets.system[system]);
		passo_grbl_say(grbl, "]\r\n");
	}
	say_position(grbl, "[G28", gcode->offsets.home[0]);
	say_position(grbl, "]\r\n[G30", gcode->offsets.home[1]);
	say_position(grbl, "]\r\n[G92", gcode->shift);
	passo_grbl_say(grbl, "]\r\n[TLO:");
	passo_grbl_say_millimetres(grbl, gcode->tool_length);
	say_position(grbl, "]\r\n[PRB", grbl->player->touch);
	passo_grbl_say(grbl, grbl->player->touched ? ":1]\r\n" : ":0]\r\n");
}
