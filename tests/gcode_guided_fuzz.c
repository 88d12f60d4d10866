/* SPDX-License-Identifier: MIT
 * Entry of libFuzzer: a program of G-code whose first two bytes choose the machine.
 *
 * The first one: bits 0 .. 2: axes less one; 6, 7: 2, 3 axes, without Y; bit 3: laser; the
 * others: the tolerance of arcs, 4^n nm. The second one: bits 0 .. 2: A, B, C are left out; bits 3 and 4: the
 * last n of X, Y, Z; the others: inputs, and counts of the spindle. Lines that begin with `$J=` are jogs.
 */
#include "gcode_checks.h"

#define LINES_MAX 200u
#define JOG "$J="
#define Y 2u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint8_t left_out_of(uint8_t byte)
{
	static const uint8_t LINEAR[] = {0, 4, 6, 7};

	return (uint8_t)((byte & 7u) << 3 | LINEAR[byte >> 3 & 3u]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct passo_path_planner path;
	static struct passo_gcode gcode;

	if (size < 2)
		return 0;
	const bool lathe = (*data & 7u) >= PASSO_GCODE_AXES_MAX;
	const uint8_t left_out = left_out_of(data[1]) | (lathe ? Y : 0u);
	unsigned axes = (*data & 7u) + 1u - (lathe ? 5u : 0u), left = PASSO_GCODE_AXES_MAX;
	for (unsigned axis = 0; axis < PASSO_GCODE_AXES_MAX; axis++)
		left -= left_out >> axis & 1u;
	if (left == 0)
		return 0;
	axes = axes < left ? axes : left;
	begin(&path, &gcode,
	    &(struct passo_gcode_settings){.axes = (uint8_t)axes,
		.left_out = left_out,
		.inputs = data[1] >> 5,
		.power = data[1] >> 5 != 0,
		.turn_counts = data[1] >> 5,
		.arc_tolerance = UINT32_C(1) << 2 * (*data >> 4),
		.spindle_maximum = 1000,
		.laser = (*data & 8u) != 0u});
	const char *text = (const char *)data + 2;
	size -= 2;
	for (unsigned lines = 0; size > 0 && lines < LINES_MAX; lines++) {
		const size_t count = passo_gcode_line_count(text, size);
		const size_t mark =
		    count >= sizeof JOG && memcmp(text, JOG, sizeof JOG - 1u) == 0 ? sizeof JOG - 1u : 0;

		execute(&path, &gcode, mark > 0, text + mark, count - mark);
		text += count;
		size -= count;
	}
	return 0;
}
