/* SPDX-License-Identifier: MIT
 * Fuzzes the G-code interpreter with words that often make sense: gcode_fuzz SEED SECONDS.
 */
#include "fuzz.h"
#include "gcode_checks.h"

#define TEXT 200u

static size_t add_number(char *text)
{
	static const char *const ODD[] = {"", "-", ".", "1e9", "999999999.9999999", "-999999999", "0",
	    "-0.0000004", "12345678901", "0.000001", "00000000000000000001", "1.2.3"};

	if (below(12) == 0)
		return (size_t)sprintf(text, "%s", ODD[below(sizeof ODD / sizeof *ODD)]);
	const unsigned whole = below(3) ? below(30) : below(1u << below(30));
	return (size_t)sprintf(text, "%s%u.%0*u", below(3) ? "" : "-", whole, (int)below(8), below(1000));
}

/* Words of the language with numbers that often make sense, or any bytes. */
static size_t any_line(char *text)
{
	static const char *const COMMANDS[] = {"G0", "G1", "G2", "G3", "G4P.1", "G10L2P1", "G10L20P0", "G17",
	    "G18", "G19", "G20", "G21", "G28", "G28.1", "G30", "G30.1", "G38.2", "G40", "G43.1", "G49", "G53",
	    "G54", "G59", "G61", "G80", "G90", "G91", "G91.1", "G92", "G92.1", "G93", "G94", "M0", "M2", "M3",
	    "M5", "M8", "M30", "M6", "M61Q3", "M62P1", "M63", "M64P3", "M65P0", "M66P1L3Q2", "M66P0",
	    "M67E0Q50", "M68E0", "G43", "G43H2", "G43.2H1", "G10L1P1", "G10L1P2Z3", "G73", "G81", "G82",
	    "G83Q1", "G89", "G33K1", "G33.1", "G7", "G8", "G95", "G96S5", "G97", "M4S9", "G98", "G99",
	    "G61.1", "G64P.1", "G", "M", "G38.9", "(", ")", ";", "/", "%"};
	size_t length = 0;

	if (below(20) == 0) {
		for (length = below(TEXT); length > 0; length--)
			*text++ = (char)below(256);
		return TEXT / 2;
	}
	for (unsigned words = below(7); words > 0; words--) {
		if (below(3) == 0) {
			length += (size_t)sprintf(
			    text + length, "%s", COMMANDS[below(sizeof COMMANDS / sizeof *COMMANDS)]);
		} else {
			text[length++] = "XYZABCIJKRFPLSTNHQED"[below(20)];
			length += add_number(text + length);
		}
	}
	return length;
}

static void fuzz(void)
{
	struct passo_path_planner path;
	struct passo_gcode gcode;

	begin(&path, &gcode,
	    &(struct passo_gcode_settings){.axes = (uint8_t)(1 + below(5)),
		.arc_tolerance = 1 + below(1u << below(20)),
		.spindle_maximum = below(20000),
		.laser = below(2) != 0u,
		.spindle_minimum = below(2000),
		.left_out = below(4) == 0u ? 2u : 0u,
		.inputs = (uint8_t)below(8),
		.power = below(2) != 0u,
		.turn_counts = below(2)});
	for (unsigned count = below(200); count > 0; count--) {
		char text[TEXT] = "";
		const size_t length = any_line(text);

		execute(&path, &gcode, below(10) == 0, text, length);
	}
}

int main(int count, char **words)
{
	uint64_t rounds = 0;

	for (fuzz_begin(count, words); rounds == 0 || fuzz_goes_on(); rounds++)
		fuzz();
	printf("%llu programs\n", (unsigned long long)rounds);
	return 0;
}
