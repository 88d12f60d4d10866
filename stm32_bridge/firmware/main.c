/* SPDX-License-Identifier: MIT
 * Main loop: passes serial input to the console, polls the core and feeds the watchdog.
 */
#include "board.h"
#include "image.h"
#include "passo_console.h"
#include "spi.h"
#include "uart.h"

#define BYTES_PER_ROUND 64u /* so that a flood of text does not starve the core */

/* What the image has not, behind the name of the chip. */
#if defined PASSO_WITHOUT_GOTO && defined PASSO_WITHOUT_PARTS
#define LEFT_OUT "%s: no goto, outputs, encoders"
#else
#define LEFT_OUT "%s"
#endif

static struct passo_console console ONLY_CONSOLE;

static void write_text(void *context, const char *text)
{
	(void)context;
	uart_write(text);
}

/* A sleep can take a millisecond, so it is used only for longer waits. */
static void wait(void *context, uint32_t duration)
{
	(void)context;
	if (duration > 2000u)
		board_sleep();
}

static uint32_t lost_bytes(void *context)
{
	(void)context;
	return uart_losses();
}

static void set_baud(void *context, uint32_t baud)
{
	(void)context;
	uart_set_baud(baud);
}

static void set_spi_fast(void *context, bool fast)
{
	(void)context;
	spi_set_fast(fast);
}

/* Prints the cause of the last reset and hardware problems. */
static void report(const struct passo_sink *sink, bool crystal, bool crc_unit)
{
	struct board_fault fault = board_last_fault();

	passo_say(sink, "\nnote: reset by %s\nnote: " LEFT_OUT "\n", board_reset_cause(), board_chip());
	if (fault.exception != 0u)
		passo_say(sink, "note: exception %u at 0x%x\n", fault.exception, fault.address);
	if (!crystal)
		passo_say(sink, "note: no crystal: 64 MHz, all times to 1 %%\n");
	if (!crc_unit)
		passo_say(sink, "note: CRC unit faulty: CRCs in software\n");
}

int main(void)
{
	static const struct passo_sink sink = {.write = write_text};
	static const struct passo_hardware hardware = {.transfer = spi_transfer,
	    .microseconds = board_microseconds,
	    .wait = wait,
	    .irq = board_core_calls};
	static const struct passo_console_board board = {.set_baud = set_baud,
	    .set_spi_fast = set_spi_fast,
	    .spi_fast_hz = SPI_FAST_HZ,
	    .lost_bytes = lost_bytes,
#ifdef PASSO_BOTH
	    .leave = image_choose_grbl
#endif
	};
	bool crystal = board_start();

	board_watchdog_start();
	uart_start(UART_BAUD_RESET);
	spi_start();
	report(&sink, crystal, crc_start());
	passo_console_start(&console, &sink, &hardware, &board, 0, UART_BAUD_RESET);
	for (;;) {
		char byte;
		unsigned bytes = 0;

		while (bytes < BYTES_PER_ROUND && uart_read(&byte)) {
			passo_console_receive(&console, byte);
			bytes++;
			if (byte == '\r' || byte == '\n')
				break; /* an answer can take long: the core stops if it is not polled in
				          between */
		}
		passo_console_poll(&console);
		board_led(!passo_console_is_well(&console));
		board_watchdog_feed();
		image_mind_choice();
		if (bytes == 0u)
			board_sleep();
	}
}
