/* SPDX-License-Identifier: MIT
 * Messages of the program: (MSG,...).
 *
 * Each appears when the motion before its line has ended; earlier, if too many wait.
 */
#include "passo_grbl_private.h"

#ifndef PASSO_PLAIN_GCODE

#include <string.h>

static void say_first(struct passo_grbl *grbl)
{
	passo_grbl_say(grbl, "[MSG:");
	passo_grbl_say(grbl, grbl->message[0].text);
	passo_grbl_say(grbl, "]\r\n");
	grbl->messages--;
	memmove(&grbl->message[0], &grbl->message[1], sizeof grbl->message - sizeof grbl->message[0]);
}

void passo_grbl_poll_message(struct passo_grbl *grbl)
{
	const struct passo_path_feed *feed = grbl->player->feed;

	while (
	    grbl->messages > 0
	    && (!passo_path_feed_is_moving(feed) || (int32_t)(feed->moving - grbl->message[0].before) >= 0))
		say_first(grbl);
}

void passo_grbl_take_message(struct passo_grbl *grbl)
{
	if (grbl->line.message[0] == '\0')
		return;
	if (grbl->messages == PASSO_GRBL_MESSAGES)
		say_first(grbl);
	memcpy(grbl->message[grbl->messages].text, grbl->line.message, PASSO_GCODE_MESSAGE_SIZE);
	grbl->message[grbl->messages++].before = grbl->player->feed->path->added;
	passo_grbl_poll_message(grbl);
}

#endif
