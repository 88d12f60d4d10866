/* SPDX-License-Identifier: MIT
 * Reports: state, modes, offsets. Lengths are millimeters with three decimals.
 */
#include "passo_grbl_private.h"
#include "passo_inputs.h"
#include "passo_math.h"

#define DIGITS_MAX 20u
#define NANOMETRES_PER_INCH 25400000u
#define LETTERS_TOLD 3u   /* what senders read: X, Y and Z, 0 where there is no such axis */
#define REPORT_MACHINE 1u /* bits of $10 */
#define REPORT_BUFFER 2u
#define POWER_FULL 65535u
#define ACCESSORIES_AT 16u
#define ACCESSORIES                                                                                          \
	(PASSO_GCODE_OUTPUT_SPINDLE | PASSO_GCODE_OUTPUT_REVERSE | PASSO_GCODE_OUTPUT_FLOOD                  \
	    | PASSO_GCODE_OUTPUT_MIST)

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

void passo_grbl_say_rate(struct passo_grbl *grbl, uint64_t rate)
{
	if (in_inches(grbl)) /* tenths of an inch */
		say_decimals(grbl, false, (passo_mul_div(rate, 200, UINT64_C(254) << 16) + 1) / 2, 1);
	else
		passo_grbl_say_number(grbl, (rate + 0x8000u) >> 16);
}

void passo_grbl_say_position(struct passo_grbl *grbl, const char *head, const int64_t *position)
{
	const struct passo_gcode_settings *settings = &grbl->player->gcode->settings;
	unsigned axis = 0;

	for (unsigned letter = 0; letter < LETTERS_TOLD || axis < settings->axes; letter++) {
		const bool has = axis < settings->axes && (settings->left_out >> letter & 1) == 0;

		if (!has && letter >= LETTERS_TOLD)
			continue;
		passo_grbl_say(grbl, letter > 0 ? "," : head);
		passo_grbl_say_length(grbl, has ? position[axis] : 0);
		axis += has ? 1 : 0;
	}
}

static void report_state(struct passo_grbl *grbl)
{
	const enum passo_grbl_state state = passo_grbl_state(grbl);

	passo_grbl_say(grbl, passo_grbl_state_name(state));
	if (state == PASSO_GRBL_STATE_DOOR || state == PASSO_GRBL_STATE_HOLD)
		passo_grbl_say(grbl, !passo_grbl_slows(grbl)          ? ":0"
		                     : state == PASSO_GRBL_STATE_DOOR ? ":2"
		                                                      : ":1");
}

/* That of what moves; at rest, the one commanded. */
static struct passo_player_line line_of(const struct passo_grbl *grbl)
{
	struct passo_player_line line = {0, passo_gcode_output(grbl->player->gcode)};

	passo_player_moving_line(grbl->player, &line);
	return line;
}

static uint64_t spindle_of(const struct passo_grbl *grbl, uint32_t output)
{
	const struct passo_gcode *gcode = grbl->player->gcode;
	const uint64_t maximum = gcode->settings.spindle_maximum;

	if (!(output & PASSO_GCODE_OUTPUT_SPINDLE))
		return 0;
	if (maximum == 0) /* the power does not tell */
		return passo_mul_div(
		    (uint64_t)gcode->spindle, gcode->spindle_percent, 100u * (uint64_t)PASSO_GCODE_MILLION);
	return (maximum * (output & POWER_FULL) + POWER_FULL / 2) / POWER_FULL;
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
		if (switches & passo_grbl_motors_of(grbl, axis))
			passo_grbl_say(grbl,
			    (const char[]){
				passo_gcode_axis_letter(grbl->player->gcode->settings.left_out, axis), '\0'});
	}
	if (readings.estop)
		passo_grbl_say(grbl, "R");
}

/* Letters of what is on. */
static void report_accessories(struct passo_grbl *grbl, uint32_t output)
{
	const bool reverse = output & (PASSO_GCODE_OUTPUT_REVERSE | PASSO_GCODE_OUTPUT_PROPORTIONAL);

	if (!(output & ACCESSORIES))
		return;
	passo_grbl_say(grbl, "|A:");
	if (output & PASSO_GCODE_OUTPUT_SPINDLE)
		passo_grbl_say(grbl, reverse ? "C" : "S");
	passo_grbl_say(grbl, output & PASSO_GCODE_OUTPUT_FLOOD ? "F" : "");
	passo_grbl_say(grbl, output & PASSO_GCODE_OUTPUT_MIST ? "M" : "");
}

static void report_overrides(struct passo_grbl *grbl, uint32_t output)
{
	const uint8_t percent[] = {grbl->feed, grbl->rapid, grbl->spindle};

	for (unsigned i = 0; i < sizeof percent; i++) {
		passo_grbl_say(grbl, i > 0 ? "," : "|Ov:");
		passo_grbl_say_number(grbl, percent[i]);
	}
	report_accessories(grbl, output);
}

static void report_position(struct passo_grbl *grbl, bool machine)
{
	struct passo_player *player = grbl->player;
	int32_t steps[PASSO_AXES_MAX] = {0};
	passo_gcode_position position = {0};

	passo_positions(player->feed->passo, steps);
	passo_player_place(player, steps, position);
	for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
		position[axis] -= machine ? 0 : passo_gcode_offset(player->gcode, axis);
	passo_grbl_say_position(grbl, machine ? "|MPos:" : "|WPos:", position);
}

void passo_grbl_report(struct passo_grbl *grbl)
{
	const struct passo_player *player = grbl->player;
	const unsigned shown =
	    (unsigned)(grbl->stored.settings.value[PASSO_GRBL_REPORT] / PASSO_GCODE_MILLION);
	const struct passo_player_line line = line_of(grbl);
	const uint8_t accessories = (uint8_t)((line.output & ACCESSORIES) >> ACCESSORIES_AT);
	passo_gcode_position offset = {0};

	passo_grbl_say(grbl, "<");
	report_state(grbl);
	report_position(grbl, (shown & REPORT_MACHINE) != 0);
	if (shown & REPORT_BUFFER) {
		const uint8_t room = passo_grbl_room(grbl);

		passo_grbl_say(grbl, "|Bf:");
		passo_grbl_say_number(grbl, passo_path_room(player->feed->path));
		passo_grbl_say(grbl, ",");
		passo_grbl_say_number(grbl, room < PASSO_GRBL_TOLD_ROOM ? room : PASSO_GRBL_TOLD_ROOM);
	}
	if (line.number > 0) {
		passo_grbl_say(grbl, "|Ln:");
		passo_grbl_say_number(grbl, line.number);
	}
	passo_grbl_say(grbl, "|FS:");
	passo_grbl_say_rate(grbl, passo_player_speed(player));
	passo_grbl_say(grbl, ",");
	passo_grbl_say_number(grbl, spindle_of(grbl, line.output));
	report_inputs(grbl);
	if (grbl->reports > 0 && accessories != grbl->accessories)
		grbl->reports = PASSO_GRBL_REPORTS;
	if (grbl->reports == 0) {
		for (unsigned axis = 0; axis < player->gcode->settings.axes; axis++)
			offset[axis] = passo_gcode_offset(player->gcode, axis);
		passo_grbl_say_position(grbl, "|WCO:", offset);
		grbl->reports = PASSO_GRBL_REPORTS;
	} else if (grbl->reports-- == PASSO_GRBL_REPORTS) {
		grbl->accessories = accessories;
		report_overrides(grbl, line.output);
	}
	passo_grbl_say(grbl, ">\r\n");
}
