/* SPDX-License-Identifier: MIT
 * Three axes in millimeters: home x, go to a place, hold and resume during the move. The C model of the core
 * takes the place of the FPGA, so it runs on a desktop; on a board, the first three functions and `core`
 * differ.
 */
#include <stdio.h>
#include <stdlib.h>

#define PASSO_CLOCK_HZ 72000000 /* of the core */
#include "passo.h"
#include "passo_engine.h"

static bool transfer(void *engine, const uint32_t *send, uint32_t *receive, size_t words)
{
	passo_engine_transfer(engine, send, receive, words, PASSO_US(1));
	return true;
}

static uint32_t microseconds(void *engine)
{
	return (uint32_t)(passo_engine_clock(engine) / PASSO_US(1));
}

static void wait(void *engine, uint32_t time)
{
	static struct passo_pin_event pins[65536]; /* the pulses so far, which nobody looks at here */

	passo_engine_drain(engine, pins, 65536);
	passo_engine_run(engine, time * PASSO_US(1));
}

static void must(enum passo_error error)
{
	if (error != PASSO_OK)
		exit(printf("%s: %s\n", passo_error_name(error), passo_error_text(error)));
}

int main(void)
{
	static struct passo_host host;
	static struct passo passo;
	/* 1 channel, 4 axes, ticks of 2^7 clocks, queues of 2^6 places */
	const struct passo_engine_config core = {.core = {1, 4, 7, 6, 6}, .spi_half_period = 2};
	const struct passo_hardware hardware = {
	    transfer, microseconds, wait, .context = passo_engine_create(&core)};
	/* STEP high and low, DIR setup and hold, in nanoseconds; the scale */
	const struct passo_axis_config pin = {2000, 2000, 500, 500, .steps_per_unit = PASSO_STEPS_PER_MM(80)};
	const struct passo_axis_limits max = {0, PASSO_MM_PER_S(250), PASSO_MM_PER_S2(2000), 0};
	const struct passo_move_straight home = {{PASSO_MM(-300)}, PASSO_MM_PER_S(20), {max}};
	const struct passo_move_straight place = {
	    {PASSO_MM(120.5), PASSO_MM(-40), PASSO_MM(2.25)}, PASSO_MM_PER_S(200), {max, max, max}};
	int64_t mm[PASSO_AXES_MAX];

	must(passo_open(&passo, &host, &hardware, &(struct passo_options){.clock_hz = PASSO_CLOCK_HZ}));
	for (uint8_t axis = 0; axis < 3; axis++) {
		must(passo_configure_axis(&passo, axis, &pin));
		must(passo_enable(&passo, axis, true));
	}
	must(passo_move_straight(&passo, &home));
	if (passo_wait(&passo, PASSO_MS(500)) == PASSO_ERROR_TIMEOUT) { /* here the switch of x closes */
		must(passo_abort(&passo));
		must(passo_clear(&passo));
		must(passo_set_position(&passo, 0, 0));
	}
	must(passo_move_to_straight(&passo, 7, &place)); /* bits 0 to 2: x, y and z */
	wait(hardware.context, 100000);
	must(passo_hold(&passo));
	wait(hardware.context, 400000);
	must(passo_resume(&passo));
	must(passo_wait(&passo, 0));
	must(passo_positions_units(&passo, NULL, mm));
	for (unsigned axis = 0; axis < 3; axis++)
		printf("%c = %.3f mm\n", "xyz"[axis], (double)mm[axis] / PASSO_UNIT_Q32);
}
