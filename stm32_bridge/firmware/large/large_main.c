/* SPDX-License-Identifier: MIT
 * The images for chips with 128 KiB of flash. A smaller chip holds their beginning, and that is this file and what
 * it calls.
 */
#include "board.h"
#include "uart.h"

#define NEEDED 128u /* KiB */

int image_main(void);

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
	return image_main();
}
