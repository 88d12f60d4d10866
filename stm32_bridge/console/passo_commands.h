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

/* Records which drives an error has disabled. */
void passo_commands_see(
    struct passo_console *console, struct passo_console_channel *channel, enum passo_error error);

/* Whether a channel moves. A reset core does not, regardless of the queues. */
bool passo_commands_is_moving(const struct passo_console *console);

/* Retries the waiting line, for a move by executing it again: it keeps waiting, or is answered. */
void passo_commands_try_again(struct passo_console *console);

/* The same for a line other than a move. */
void passo_tasks_try_again(struct passo_console *console);
/* The reason why a line waits. */
const char *passo_tasks_name(enum passo_awaited awaited);

/* Configures the inputs of an axis. */
enum passo_error passo_commands_set_inputs(
    const struct passo_console_inputs *inputs, struct passo *passo, uint8_t axis);
/* Sets filter and watchdog of the core, if it has inputs. */
enum passo_error passo_commands_set_core(struct passo_console *console);

#ifndef PASSO_WITHOUT_PARTS
/* Configures the outputs of a channel, and takes over their levels, if it has outputs. */
enum passo_error passo_commands_set_outputs(struct passo_console_channel *channel);
/* Configures the encoders that were given, if the channel has encoders. */
enum passo_error passo_commands_set_encoders(struct passo_console_channel *channel);
/* Default settings of outputs and encoders. */
void passo_commands_reset_outputs(struct passo_console_channel *channel, uint32_t clock_hz);
void passo_commands_reset_encoders(struct passo_console_channel *channel);
#endif

#ifndef PASSO_WITHOUT_TRACKERS
/* Configures the trackers that were given, if the channel has trackers. */
enum passo_error passo_commands_set_trackers(struct passo_console_channel *channel);
#endif

/* Number of channels of the core; 0 while it is not open. */
uint8_t passo_commands_channels(const struct passo_console *console);

/* Default settings that depend on the clock: all pin times 1 us, the watchdog half a second, or the longest
 * time of the core. */
void passo_commands_reset_times(struct passo_console *console);

/* Prints a note about an error other than PASSO_OK, of the core. */
void passo_say_error_note(struct passo_console *console, enum passo_error error);

#endif
