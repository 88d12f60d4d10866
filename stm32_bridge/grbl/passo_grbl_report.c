/* SPDX-License-Identifier: MIT
 * Reports: state, modes, offsets. Lengths are millimetres with three decimals.
 */
#include "passo_grbl_private.h"
#include "passo_inputs.h"
#include "passo_math.h"

#define DIGITS_MAX 20u
#define NANOMETRES_PER_INCH 25400000u
#define REPORT_MACHINE 1u /* bits of $10 */
#define REPORT_BUFFER 2u

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

static void say_decimals(struct passo_grbl *grbl, bool negative, uint64_t units, unsigned digits)
{
	uint64_t one = 1;

	for (unsigned i = 0; i < digits; i++)
		one *= 10;
	if (negative && units > 0)
		passo_grbl_say(grbl, "-");
	say_digits(grbl, units / one, 1);
	passo_grbl_say(grbl, ".");
	say_digits(grbl, units % one, digits);
}

static bool in_inches(const struct passo_grbl *grbl)
{
	return passo_grbl_is_on(&grbl->stored.settings, PASSO_GRBL_INCHES);
}

void passo_grbl_say_thousandths(struct passo_grbl *grbl, int64_t millionths)
{
	const uint64_t size = millionths < 0 ? 0 - (uint64_t)millionths : (uint64_t)millionths;

	say_decimals(grbl, millionths < 0, (size + 500) / 1000, 3);
}

/* In the units of reports. */
void passo_grbl_say_length(struct passo_grbl *grbl, int64_t nanometres)
{
	const uint64_t size = nanometres < 0 ? 0 - (uint64_t)nanometres : (uint64_t)nanometres;
	const uint64_t inches = passo_mul_div(2 * size, 10000, NANOMETRES_PER_INCH); /* halves of 1/10000 */

	if (in_inches(grbl))
		say_decimals(grbl, nanometres < 0, (inches + 1) / 2, 4);
	else
		passo_grbl_say_thousandths(grbl, nanometres);
}

uint64_t passo_grbl_in_units(const struct passo_grbl *grbl, uint64_t millimetres)
{
	return in_inches(grbl) ? passo_mul_div(millimetres, 10, 254) : millimetres;
}

void passo_grbl_say_position(struct passo_grbl *grbl, const char *name, const int64_t *position)
{
	passo_grbl_say(grbl, name);
	for (unsigned axis = 0; axis < grbl->player->gcode->settings.axes; axis++) {
		passo_grbl_say(grbl, axis > 0 ? "," : ":");
		passo_grbl_say_length(grbl, position[axis]);
	}
}

static const char *state_of(const struct passo_grbl *grbl)
{
	const struct passo_path_feed *feed = grbl->player->feed;

	if (grbl->homes)
		return "Home";
	if (grbl->locked)
		return "Alarm";
	if (grbl->door)
		return grbl->held && passo_snapshot(feed->passo)->rate > 0 ? "Door:2" : "Door:0";
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

/* Switches that are active, in the letters of grbl. */
static void report_inputs(struct passo_grbl *grbl)
{
	struct passo *passo = grbl->player->feed->passo;
	struct passo_readings readings;

	if (!passo->has_inputs || passo_read_inputs(passo, &readings) != PASSO_OK)
		return;
	const unsigned switches = (readings.limit_low & grbl->setup->limits_low)
	                        | (readings.limit_high & grbl->setup->limits_high)
	                        | (readings.home & grbl->setup->homes);
	const bool probe = readings.probe && grbl->setup->probe;
	if (switches == 0 && !probe && !readings.estop)
		return;
	passo_grbl_say(grbl, "|Pn:");
	if (probe)
		passo_grbl_say(grbl, "P");
	for (unsigned axis = 0; axis < grbl->player->gcode->settings.axes; axis++) {
		if (switches >> axis & 1u)
			passo_grbl_say(grbl, (const char[]){passo_gcode_axis_letter(axis), '\0'});
	}
	if (readings.estop)
		passo_grbl_say(grbl, "R");
}

static void report_overrides(struct passo_grbl *grbl)
{
	passo_grbl_say(grbl, "|Ov:");
	passo_grbl_say_number(grbl, grbl->feed);
	passo_grbl_say(grbl, ",");
	passo_grbl_say_number(grbl, grbl->rapid);
	passo_grbl_say(grbl, ",");
	passo_grbl_say_number(grbl, grbl->spindle);
}

static void report_position(struct passo_grbl *grbl, bool machine)
{
	struct passo_player *player = grbl->player;
	int32_t steps[PASSO_AXES_MAX] = {0};
	passo_gcode_position position = {0};

	passo_positions(player->feed->passo, steps);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++) {
		position[axis] = passo_player_nanometres(player, axis, steps[axis]);
		position[axis] -= machine ? 0 : passo_gcode_offset(player->gcode, axis);
	}
	passo_grbl_say_position(grbl, machine ? "|MPos" : "|WPos", position);
}

void passo_grbl_report(struct passo_grbl *grbl)
{
	const struct passo_player *player = grbl->player;
	const unsigned shown =
	    (unsigned)(grbl->stored.settings.value[PASSO_GRBL_REPORT] / PASSO_GCODE_MILLION);
	passo_gcode_position offset = {0};

	passo_grbl_say(grbl, "<");
	passo_grbl_say(grbl, state_of(grbl));
	report_position(grbl, (shown & REPORT_MACHINE) != 0);
	if (shown & REPORT_BUFFER) {
		passo_grbl_say(grbl, "|Bf:");
		passo_grbl_say_number(grbl, passo_path_room(player->feed->path));
		passo_grbl_say(grbl, ",");
		passo_grbl_say_number(grbl, (uint8_t)(grbl->tail - grbl->head - 1u));
	}
	if (player->gcode->line > 0) {
		passo_grbl_say(grbl, "|Ln:");
		passo_grbl_say_number(grbl, player->gcode->line);
	}
	passo_grbl_say(grbl, "|FS:");
	passo_grbl_say_number(grbl, passo_grbl_in_units(grbl, feed_of(player->feed)));
	passo_grbl_say(grbl, ",");
	passo_grbl_say_number(grbl, (uint64_t)player->gcode->spindle / PASSO_GCODE_MILLION);
	report_inputs(grbl);
	if (grbl->reports == 0) {
		for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
			offset[axis] = passo_gcode_offset(player->gcode, axis);
		passo_grbl_say_position(grbl, "|WCO", offset);
		grbl->reports = PASSO_GRBL_REPORTS;
	} else if (grbl->reports-- == PASSO_GRBL_REPORTS) {
		report_overrides(grbl);
	}
	passo_grbl_say(grbl, ">\r\n");
}
