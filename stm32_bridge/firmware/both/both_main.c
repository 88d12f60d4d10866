/* SPDX-License-Identifier: MIT
 * The image with console and grbl: which of them runs.
 */
#include "board.h"
#include "image.h"
#include "uart.h"

#define CONSOLE 0x434F4E53u

static uint32_t chosen __attribute__((section(".noinit"))); /* any other value: grbl */
static bool changes;

int console_main(void);
int grbl_main(void);
int image_main(void);

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

int image_main(void)
{
	if (board_was_off())
		chosen = 0;
	return chosen == CONSOLE ? console_main() : grbl_main();
}
