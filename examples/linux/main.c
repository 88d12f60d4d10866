/* SPDX-License-Identifier: MIT
 * Three axes in millimeters on Linux: to a place and back. The device is that of an SPI controller, or the
 * socket of `passo serve`:
 *
 *     ./linux /dev/spidev0.0
 *     ./linux unix:/tmp/passo
 */
#include <stdio.h>
#include <stdlib.h>

#define PASSO_CLOCK_HZ 100000000 /* of the core */
#include "passo_linux.h"

#define AXES 3u

static void must(enum passo_error error)
{
	if (error != PASSO_OK) {
		fprintf(stderr, "%s: %s\n", passo_error_name(error), passo_error_text(error));
		exit(1);
	}
}

static void tell(struct passo *passo)
{
	int64_t mm[PASSO_AXES_MAX];

	must(passo_positions_units(passo, NULL, mm));
	for (unsigned axis = 0; axis < AXES; axis++)
		printf("%c = %.3f mm\n", "xyz"[axis], (double)mm[axis] / PASSO_UNIT_Q32);
}

int main(int count, char **arguments)
{
	static struct passo_host host;
	static struct passo passo;
	static struct passo_linux linux_host;
	const struct passo_linux_options device = {
	    .device = count > 1 ? arguments[1] : "/dev/spidev0.0", .axes = AXES};
	/* STEP high and low, DIR setup and hold, in nanoseconds; the scale */
	const struct passo_axis_config pin = {2000, 2000, 500, 500, .steps_per_unit = PASSO_STEPS_PER_MM(80)};
	const struct passo_axis_limits max = {0, PASSO_MM_PER_S(250), PASSO_MM_PER_S2(2000), 0};
	const struct passo_move_straight place = {
	    {PASSO_MM(120.5), PASSO_MM(-40), PASSO_MM(2.25)}, PASSO_MM_PER_S(200), {max, max, max}};
	const struct passo_move_straight origin = {{0}, PASSO_MM_PER_S(200), {max, max, max}};

	if (passo_open_linux(
		&passo, &host, &linux_host, &device, &(struct passo_options){.clock_hz = PASSO_CLOCK_HZ})
	    != PASSO_OK) {
		fprintf(stderr, "%s\n", linux_host.problem);
		return 1;
	}
	for (uint8_t axis = 0; axis < AXES; axis++) {
		must(passo_configure_axis(&passo, axis, &pin));
		must(passo_enable(&passo, axis, true));
	}
	must(passo_move_to_straight(&passo, 7, &place)); /* bits 0 to 2: x, y and z */
	must(passo_wait(&passo, 0));
	tell(&passo);
	must(passo_move_to_straight(&passo, 7, &origin));
	must(passo_wait(&passo, 0));
	tell(&passo);
	passo_close_linux(&linux_host);
}
