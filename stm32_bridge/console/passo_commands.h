/* SPDX-License-Identifier: MIT
 * The commands of the console.
 */
#ifndef PASSO_COMMANDS_H
#define PASSO_COMMANDS_H

#include "passo_console.h"

/* Execute a line, in place, and answer it. */
void passo_commands_execute(struct passo_console *console, char *line);

/* Open the core and give it the settings that the console keeps. */
enum passo_error passo_commands_open(struct passo_console *console);

/* The settings of a fresh start: all pin times 1 us. */
void passo_commands_reset_axes(struct passo_console *console);

/* A note about an error, if it is one. */
void passo_say_error_note(struct passo_console *console, enum passo_error error);

#endif
