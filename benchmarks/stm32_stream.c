/* SPDX-License-Identifier: MIT
 * Measures the lines per second of the driver on an STM32F103, for `passo firmware --table`.
 *
 * Streams a path of short lines under one long ramp. The bench writes `stream_substeps`, `stream_fast` and
 * `stream_lines` (0: without end), then `stream_go`, and reads the number of lines requested over time.
 */
#include "board.h"
#include "passo.h"
#include "spi.h"

#define CLOCK_HZ 72000000u
#define HALF_VELOCITY (UINT64_C(1) << 47) /* a substep every two clocks */
#define AXES 4u

volatile uint32_t stream_go, stream_substeps, stream_fast, stream_lines, stream_asked, stream_error;

static struct passo_host host;
static struct passo passo;

static bool next_line(void *context, struct passo_line *line)
{
	(void)context;
	stream_asked++;
	*line = (struct passo_line){.substeps = stream_substeps, .last = stream_asked == stream_lines};
	for (unsigned axis = 0; axis < AXES; axis++)
		line->steps[axis] = 1;
	return true;
}

static bool next_ramp(void *context, struct passo_ramp *ramp)
{
	static bool begun;

	(void)context;
	*ramp = (struct passo_ramp){.velocity_end = HALF_VELOCITY};
	if (begun) {
		ramp->ticks = UINT32_C(1) << 24;
		ramp->progress_step = UINT64_C(1) << 24;
		ramp->last = true;
	}
	begun = true;
	return true;
}

static enum passo_error configure(void)
{
	const struct passo_axis_config config = {
	    .step_high_ns = 500, .step_low_ns = 500, .dir_setup_ns = 500, .dir_hold_ns = 500};
	enum passo_error error = PASSO_OK;

	for (uint8_t axis = 0; error == PASSO_OK && axis < AXES; axis++)
		error = passo_configure_axis(&passo, axis, &config);
	return error;
}

int main(void)
{
	static uint32_t spare[PASSO_FRAME_WORDS_MAX];
	static const struct passo_hardware hardware = {.transfer = spi_transfer,
	    .microseconds = board_microseconds,
	    .irq = board_core_calls,
	    .start = spi_begin,
	    .finish = spi_finish,
	    .spare = spare};
	static const struct passo_source source = {.line = next_line, .ramp = next_ramp};
	const struct passo_options options = {.clock_hz = CLOCK_HZ};

	stream_go = 0;
	board_start();
	spi_start();
	crc_start();
	while (!stream_go)
		continue;
	spi_set_fast(stream_fast != 0u);
	stream_error = passo_open(&passo, &host, &hardware, &options);
	if (stream_error == PASSO_OK)
		stream_error = configure();
	if (stream_error == PASSO_OK)
		stream_error = passo_stream(&passo, &source);
	while (stream_error == PASSO_OK)
		stream_error = passo_poll(&passo);
	for (;;)
		continue;
}
