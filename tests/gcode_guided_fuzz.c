/* SPDX-License-Identifier: MIT
 * Entry of libFuzzer: a program of G-code whose first byte chooses the machine.
 *
 * Bits 0 .. 2: axes less one, modulo 6; bit 3: laser; the others: the tolerance of arcs, 4^n nm. Lines
 * that begin with `$J=` are jogs.
 */
#include "gcode_checks.h"

#define LINES_MAX 200u
#define JOG "$J="

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct passo_path_planner path;
	static struct passo_gcode gcode;

	if (size == 0)
		return 0;
	begin(&path, &gcode,
	    &(struct passo_gcode_settings){.axes = (uint8_t)(1 + (*data & 7u) % PASSO_GCODE_AXES_MAX),
		.arc_tolerance = UINT32_C(1) << 2 * (*data >> 4),
		.spindle_maximum = 1000,
		.laser = (*data & 8u) != 0u});
	const char *text = (const char *)data + 1;
	size--;
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
