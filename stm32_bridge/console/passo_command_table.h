/* SPDX-License-Identifier: MIT
 * Internal: the table of all commands.
 */
#ifndef PASSO_COMMAND_TABLE_H
#define PASSO_COMMAND_TABLE_H

#include "passo_call.h"

struct passo_command {
	const char *name;
	bool (*run)(const struct passo_call *call);
	const struct passo_key *keys;
	uint8_t count;
	uint8_t bare; /* number of keys that can be given as values alone */
	bool passes;  /* is also executed while a move waits for queue space */
	const char *text;
};

extern const struct passo_command passo_command_table[];
extern const unsigned passo_command_count;

/* The key `channel`, which every command of a channel has. */
extern const struct passo_key passo_channel_key;

/* The command of a name, or null. */
const struct passo_command *passo_command_find(const char *name);

#endif
