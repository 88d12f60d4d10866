/* SPDX-License-Identifier: MIT
 * Answers to `$G`, `$#`, `$$` and `$N`.
 */
#include "passo_grbl_private.h"
#include "passo_math.h"
#include "passo_release.h"

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
	passo_grbl_say(grbl, gcode->flood ? " M8 T" : gcode->mist ? " T" : " M9 T");
	passo_grbl_say_number(grbl, gcode->tool);
	passo_grbl_say(grbl, " F");
	passo_grbl_say_rate(grbl, passo_mul_div((uint64_t)gcode->feed, 1u << 16, PASSO_GCODE_MILLION));
	passo_grbl_say(grbl, " S");
	passo_grbl_say_number(grbl, (uint64_t)gcode->spindle / PASSO_GCODE_MILLION);
	passo_grbl_say(grbl, "]\r\n");
}

#ifndef PASSO_CARTESIAN
/* Where the motors are, which the axes do not tell. */
static void report_motors(struct passo_grbl *grbl)
{
	const struct passo_motors *motors = &grbl->path.motors;
	int32_t steps[PASSO_AXES_MAX] = {0};

	if (motors->count == 0)
		return;
	passo_positions(grbl->player->feed->passo, steps);
	for (unsigned motor = 0; motor < motors->count; motor++) {
		const unsigned axis = passo_motor_axis(motors, motor);

		passo_grbl_say(grbl, motor > 0 ? "," : "[MOTORS:");
		passo_grbl_say_length(
		    grbl, passo_player_length(steps[motor], grbl->path.axis[axis].steps_per_mm));
	}
	passo_grbl_say(grbl, "]\r\n");
}
#endif

void passo_grbl_report_offsets(struct passo_grbl *grbl)
{
	const struct passo_gcode *gcode = grbl->player->gcode;
	char name[] = "[G54:";

	for (unsigned system = 0; system < PASSO_GCODE_SYSTEMS; system++, name[3]++) {
		passo_grbl_say_position(grbl, name, gcode->offsets.system[system]);
		passo_grbl_say(grbl, "]\r\n");
	}
	passo_grbl_say_position(grbl, "[G28:", gcode->offsets.home[0]);
	passo_grbl_say_position(grbl, "]\r\n[G30:", gcode->offsets.home[1]);
	passo_grbl_say_position(grbl, "]\r\n[G92:", gcode->shift);
	passo_grbl_say(grbl, "]\r\n");
#ifndef PASSO_PLAIN_GCODE
	passo_grbl_report_tools(grbl);
#endif
	passo_grbl_say(grbl, "[TLO:");
	passo_grbl_say_length(grbl, gcode->tool_length);
	passo_grbl_say(grbl, "]\r\n");
	passo_grbl_report_probe(grbl);
#ifndef PASSO_CARTESIAN
	report_motors(grbl);
#endif
#ifndef PASSO_PLAIN_GCODE
	if (grbl->measured) {
		passo_grbl_say(grbl, "[TLR:");
		passo_grbl_say_length(grbl, grbl->reference);
		passo_grbl_say(grbl, "]\r\n");
	}
#endif
}

/* Of an image that has no other machines. */
#ifdef PASSO_CARTESIAN
#define KINEMATICS "[KINEMATICS:Cartesian]\r\n"
#else
#define KINEMATICS ""
#endif

/* Versions of the firmware and of the core; its clock in Hz and its build. */
void passo_grbl_report_build(struct passo_grbl *grbl)
{
	uint32_t words[PASSO_ADDRESS_BUILD - PASSO_ADDRESS_VERSION + 1u] = {0};
	const uint32_t *const clock_and_build = &words[PASSO_ADDRESS_CLOCK - PASSO_ADDRESS_VERSION];

	passo_host_read(
	    grbl->player->feed->passo->host, PASSO_ADDRESS_VERSION, words, sizeof words / sizeof *words);
	passo_grbl_say(grbl, "[VER:1.1h.passo:]\r\n[OPT:VNM,");
	passo_grbl_say_number(grbl, grbl->player->feed->path->capacity);
	passo_grbl_say(grbl, ",255]\r\n[FIRMWARE:Passo " PASSO_RELEASE "]\r\n" KINEMATICS "[CORE:");
	for (unsigned bit = PASSO_VERSION_MAJOR_LSB + 8u; bit > 0; bit -= 8u) {
		passo_grbl_say_number(grbl, words[0] >> (bit - 8u) & 0xFFu);
		passo_grbl_say(grbl, bit > 8u ? "." : ":");
	}
	passo_grbl_say_number(grbl, clock_and_build[0]);
	passo_grbl_say(grbl, ":");
	passo_grbl_say_number(grbl, clock_and_build[1]);
	passo_grbl_say(grbl, "]\r\n");
}

void passo_grbl_report_probe(struct passo_grbl *grbl)
{
	passo_grbl_say_position(grbl, "[PRB:", grbl->player->touch);
	passo_grbl_say(grbl, grbl->player->touched ? ":1]\r\n" : ":0]\r\n");
}

#ifndef PASSO_PLAIN_GCODE
void passo_grbl_report_input(struct passo_grbl *grbl)
{
	const int8_t input = grbl->player->input;

	passo_grbl_say(grbl, input < 0   ? "[MSG:M66:-1]\r\n"
	                     : input > 0 ? "[MSG:M66:1]\r\n"
	                                 : "[MSG:M66:0]\r\n");
}
#endif

void passo_grbl_report_settings(struct passo_grbl *grbl)
{
	const struct passo_grbl_counts counts = passo_grbl_counts(grbl);
	unsigned number;
	bool whole;

	for (unsigned i = 0; (number = passo_grbl_setting_number(i, counts, &whole)) != PASSO_GRBL_NO_SETTING;
	    i++) {
		const int64_t value = *passo_grbl_setting(&grbl->stored.settings, number, counts);

		passo_grbl_say(grbl, "$");
		passo_grbl_say_number(grbl, number);
		passo_grbl_say(grbl, "=");
		if (whole)
			passo_grbl_say_number(grbl, (uint64_t)value / PASSO_GCODE_MILLION);
		else
			passo_grbl_say_thousandths(grbl, value);
		passo_grbl_say(grbl, "\r\n");
	}
}

void passo_grbl_report_starts(struct passo_grbl *grbl)
{
	for (unsigned i = 0; i < PASSO_GRBL_STARTS; i++) {
		passo_grbl_say(grbl, "$N");
		passo_grbl_say_number(grbl, i);
		passo_grbl_say(grbl, "=");
		passo_grbl_say(grbl, grbl->stored.start[i]);
		passo_grbl_say(grbl, "\r\n");
	}
}
