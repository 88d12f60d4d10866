/* SPDX-License-Identifier: MIT
 * A process for each mutant: what a history draws and aims at is found once for all of them.
 */
#define _GNU_SOURCE /* fork(), setenv() */
#include "mutants.h"

#include <inttypes.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Seconds of the processor after which a history has hung. */
#define HANGS 10u

static uint32_t mutant;
static uint64_t history;

bool mutants_read(struct world_mutants *mutants)
{
	size_t room = 0;
	unsigned long number;

	*mutants = (struct world_mutants){0};
	while (scanf("%lu", &number) == 1) {
		if (mutants->count == room) {
			room = room ? 2u * room : 256u;
			mutants->numbers = realloc(mutants->numbers, room * sizeof *mutants->numbers);
			if (!mutants->numbers)
				return false;
		}
		mutants->numbers[mutants->count++] = (uint32_t)number;
	}
	return mutants->count != 0u;
}

static void begin(struct world *world, uint32_t number)
{
	const struct rlimit limit = {HANGS, HANGS};
	char text[16];

	snprintf(text, sizeof text, "%" PRIu32, number);
	setrlimit(RLIMIT_CPU, &limit);
	setenv("PASSO_MUTANT", text, 1);
	mutant = number;
	world->alone = true;
}

bool mutants_fork(struct world *world, uint64_t number)
{
	struct world_mutants *mutants = world->mutants;
	size_t living = 0;

	history = number;
	bool fair = true; /* the core itself plays it without fault */
	for (size_t i = 0; i < mutants->count && fair; i++) {
		int status = 0;

		fflush(stdout);
		const pid_t process = fork();
		if (process == 0) {
			begin(world, mutants->numbers[i]);
			return true;
		}
		if (process < 0 || waitpid(process, &status, 0) < 0)
			abort();
		fair = mutants->numbers[i] != 0u || (WIFEXITED(status) && WEXITSTATUS(status) == 0);
		if (!fair)
			return false;
		if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
			mutants->numbers[living++] = mutants->numbers[i];
		else if (!WIFEXITED(status))
			printf("killed %" PRIu32 " %" PRIu64 " 0 the history does not end\n",
			    mutants->numbers[i], number);
	}
	mutants->count = living;
	return false;
}

void mutants_end(const struct world *world)
{
	if (world->failed_at)
		printf("killed %" PRIu32 " %" PRIu64 " %" PRIu64 " %s\n", mutant, history, world->failed_at,
		    world->failure);
	fflush(stdout);
	_exit(world->failed_at != 0u);
}
