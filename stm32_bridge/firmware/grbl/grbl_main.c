/* SPDX-License-Identifier: MIT
 * The grbl image: the UART feeds the protocol, which feeds the core.
 */
#include <string.h>

#include "board.h"
#include "flash.h"
#include "grbl_machine.h"
#include "image.h"
#include "spi.h"
#include "uart.h"

/* Lines: those of the large chip have more axes and jerk, and rounding where there is no console. */
#ifdef PASSO_LINEAR_PATHS
#define LOOK_AHEAD 48u
#elif defined PASSO_WITHOUT_ROUNDING
#define LOOK_AHEAD 40u
#else
#define LOOK_AHEAD 30u
#endif
#define SLEWS_PER_SECOND 20u /* of hold and stop, from full speed */
#define DRAIN_VELOCITY 65536u
#define SLEEP_MICROSECONDS 4000u /* a sleep takes up to a quarter */
#define REPORT_BYTES 384u        /* a report of six axes, and some answers */
#define SEARCH_MILLISECONDS 100u

/* What the image has not, behind the name of the chip. */
#if defined PASSO_LINEAR_PATHS
#define LEFT_OUT ": no jerk, no axes A B C, no tools, no console"
#elif defined PASSO_BOTH
#define LEFT_OUT ": no tools"
#else
#define LEFT_OUT ": no console"
#endif

static struct passo_path_item items[LOOK_AHEAD] ONLY_GRBL;
static struct passo_path_planner path ONLY_GRBL;
static struct passo_path_feed feed ONLY_GRBL;
static struct passo_gcode gcode ONLY_GRBL;
static struct passo_player player ONLY_GRBL;
static struct passo_grbl_setup setup ONLY_GRBL;
static struct passo_grbl grbl ONLY_GRBL;
static struct passo_host host ONLY_GRBL;
static struct passo passo ONLY_GRBL;

static void write_text(void *context, const char *text)
{
	(void)context;
	uart_write(text);
}

static const struct passo_grbl_sink sink = {.write = write_text};

/* A sleep can take a millisecond, so it is used only for longer waits. */
static void wait(void *context, uint32_t duration)
{
	(void)context;
	if (duration > 2000u)
		board_sleep();
}

static uint32_t spare[PASSO_FRAME_WORDS_MAX] ONLY_GRBL;

static const struct passo_hardware hardware = {.transfer = spi_transfer,
    .microseconds = board_microseconds,
    .wait = wait,
    .irq = board_core_calls,
    .start = spi_begin,
    .finish = spi_finish,
    .spare = spare};

/* Reports faster than the line can take them become one: waiting for it would starve the core. */
static void receive(void)
{
	static bool asked; /* for a status report */
	char byte;

	while (uart_read(&byte)) {
		if (byte == '?')
			asked = true;
		else
			passo_grbl_receive(&grbl, byte); /* UART_LOST: the line is refused */
	}
	if (asked && uart_room() >= REPORT_BYTES) {
		asked = false;
		passo_grbl_receive(&grbl, '?');
	}
}

static void say(const char *text)
{
	uart_write("[MSG:");
	uart_write(text);
	uart_write("]\r\n");
}

static void report(bool crystal, bool crc_unit)
{
	uart_write("\r\n[MSG:Reset by ");
	uart_write(board_reset_cause());
	uart_write("]\r\n[MSG:");
	uart_write(board_chip());
	uart_write(LEFT_OUT "]\r\n");
	if (!crystal)
		say("No crystal: internal 64 MHz");
	if (!crc_unit)
		say("CRC unit faulty: CRCs in software");
}

static void pause(uint32_t milliseconds, bool fault)
{
	const uint32_t began = board_milliseconds();

	while (board_milliseconds() - began < milliseconds) {
		board_led(fault);
		board_watchdog_feed();
		board_sleep();
	}
}

static void say_error(enum passo_error error)
{
	uart_write("[MSG:");
	uart_write(passo_error_name(error));
#ifndef PASSO_LINEAR_PATHS /* they do not fit into the small chip */
	uart_write(": ");
	uart_write(passo_error_text(error));
#endif
	uart_write("]\r\n");
}

/* A motion that an earlier start of the board has left running is stopped. */
static enum passo_error open_core(void)
{
	spi_set_fast(false); /* any core can follow */
	enum passo_error error = passo_open(&passo, &host, &hardware, &(struct passo_options){0});
	const uint32_t clock_hz = passo_machine(&passo)->clock_hz, slew = clock_hz / SLEWS_PER_SECOND;

	if (error == PASSO_ERROR_ESTOP && passo_clear_estop(&passo) == PASSO_OK)
		error = passo_clear(&passo);
	if (error == PASSO_OK)
		error = grbl_machine_check(&passo);
	if (error == PASSO_OK) {
		spi_set_fast(clock_hz >= SPI_FAST_HZ);
		return passo_configure_motion(&passo, slew, slew, DRAIN_VELOCITY);
	}
	if (error == PASSO_ERROR_MOVING)
		passo_stop(&passo);
	return error;
}

#ifdef PASSO_BOTH
static bool take_line(const char *text)
{
	if (strcmp(text, "CONSOLE") != 0)
		return false;
	image_choose_console();
	return true;
}
#else
static bool (*const take_line)(const char *text) = NULL;
#endif

/* Until there is a core at rest. Each new error is reported. */
static void connect(void)
{
	enum passo_error told = PASSO_OK;

	for (;;) {
		const enum passo_error error = open_core();

		if (error == PASSO_OK)
			return;
		if (error != told)
			say_error(error);
		told = error;
		pause(SEARCH_MILLISECONDS, true);
	}
}

/* Lines that came while there was no core are dropped, as before a reset. */
static void start(void)
{
	char byte;

	connect();
	while (uart_read(&byte))
		continue;
	path.items = items;
	path.capacity = LOOK_AHEAD;
	grbl_machine(&setup, &passo, &flash_pages);
	setup.take_line = take_line;
	passo_gcode_open(
	    &gcode, &(struct passo_gcode_settings){
			.axes = setup.path.machine.axes, .left_out = AXES_LEFT_OUT, .arc_tolerance = 1});
	passo_path_feed_open(&feed, &passo, &path);
	passo_player_open(&player, &gcode, &feed, NULL);
	passo_grbl_open(&grbl, &player, &sink, &setup);
}

/* Changes when anything has been done that can lead to more. */
static uint32_t progress(void)
{
	return grbl.tail + path.added + feed.lines + feed.ramps + host.counters.frames;
}

int main(void)
{
	const bool crystal = board_start();

	board_watchdog_start();
	uart_start(BAUD);
	spi_start();
	report(crystal, crc_start());
	for (;;) {
		start();
		while (!host.lost) {
			const uint32_t before = progress();

			receive();
			passo_grbl_poll(&grbl);
			board_led(passo_fault(&passo) != PASSO_OK);
			board_watchdog_feed();
			image_mind_choice();
			if (progress() == before && !passo_path_feed_is_short(&feed, SLEEP_MICROSECONDS))
				board_sleep();
		}
	}
}
