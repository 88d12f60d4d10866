/* SPDX-License-Identifier: MIT
 * The image with console and grbl, for chips with 128 KiB of flash. A smaller chip holds its beginning, and that
 * is this file and what it calls.
 */
#include "board.h"
#include "image.h"
#include "uart.h"

#define CONSOLE 0x434F4E53u
#define NEEDED 128u /* KiB */

static uint32_t chosen __attribute__((section(".noinit"))); /* any other value: grbl */
static bool changes;

int console_main(void);
int grbl_main(void);

static void choose(uint32_t image)
{
	chosen = image;
	changes = true;
}

void image_choose_console(void)
{
	choose(CONSOLE);
}

void image_choose_grbl(void)
{
	choose(0);
}

void image_mind_choice(void)
{
	if (!changes)
		return;
	uart_finish();
	board_reset();
}

/* Says so again after each line. */
static void refuse(void)
{
	char byte = '\n';

	board_start();
	board_watchdog_start();
	uart_start(UART_BAUD_RESET);
	for (;;) {
		if (byte == '\n') {
			uart_write("\r\n[MSG:This image needs 128 KB of flash, this ");
			uart_write(board_chip());
			uart_write(" has less: nothing moves]\r\n");
		}
		board_led(true);
		board_watchdog_feed();
		if (!uart_read(&byte)) {
			byte = '\0';
			board_sleep();
		}
	}
}

int main(void)
{
	if (board_flash_kilobytes() < NEEDED)
		refuse();
	if (board_was_off())
		chosen = 0;
	return chosen == CONSOLE ? console_main() : grbl_main();
}
