/* SPDX-License-Identifier: MIT
 * Internal: the commands of the console.
 */
#ifndef PASSO_COMMANDS_H
#define PASSO_COMMANDS_H

#include "passo_console.h"

/* Executes a line, which is modified, and prints the answer. */
void passo_commands_execute(struct passo_console *console, char *line);

/* Opens the core and applies the settings of the console to it. */
enum passo_error passo_commands_open(struct passo_console *console);

/* Leaves the stopped state of a channel, and applies settings that could not be applied before. */
enum passo_error passo_commands_clear(struct passo_console *console, struct passo_console_channel *channel);

/* Whether a channel moves. A core that was reset does not, whatever was queued. */
bool passo_commands_is_moving(const struct passo_console *console);

/* Executes the line of the waiting move once more: it waits on, or is answered. */
void passo_commands_try_again(struct passo_console *console);

/* Number of channels of the core; 0 while it is not open. */
uint8_t passo_commands_channels(const struct passo_console *console);

/* Default axis settings: all pin times 1 us. */
void passo_commands_reset_axes(struct passo_console *console);

/* Prints a note about an error other than PASSO_OK, of the core. */
void passo_say_error_note(struct passo_console *console, enum passo_error error);

#endif
