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

/* Default axis settings: all pin times 1 us. */
void passo_commands_reset_axes(struct passo_console *console);

/* Prints a note about an error other than PASSO_OK. */
void passo_say_error_note(struct passo_console *console, enum passo_error error);

#endif
