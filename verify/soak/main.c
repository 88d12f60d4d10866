/* SPDX-License-Identifier: MIT
 * soak SEED FIRST COUNT [--rtl LIBRARY] [--record FOLDER] [--set N] [--driver | --machine | --tries |
 * --starts | --pokes]
 *     [--short] [--print] [--keep-on] [--mutants [--off]]
 * Plays histories FIRST, FIRST + 1, ... at register level, or with --driver through the driver. --set N: only
 * those of one parameter set; --short: without the last move. Stops at the first failure unless --keep-on is
 * given. --mutants: each with the mutants of the library whose numbers are on standard input, until it is
 * killed; prints "killed MUTANT HISTORY CLOCK TEXT". Prints lines "progress HISTORIES", "failed NUMBER CLOCK
 * TEXT", "count NAME VALUE".
 */
#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "bridge.h"
#include "history.h"
#include "mutants.h"

struct options {
	uint64_t seed, first, count;
	const char *library, *folder;
	unsigned set; /* SCENARIO_SETS: all */
	bool print, keep_on, driver, brief, blind, machine, tries, pokes, starts, mutants, off;
};

static bool parse(int argc, char **argv, struct options *options)
{
	if (argc < 4)
		return false;
	*options = (struct options){.seed = strtoull(argv[1], NULL, 10),
	    .first = strtoull(argv[2], NULL, 10),
	    .count = strtoull(argv[3], NULL, 10),
	    .set = SCENARIO_SETS};
	for (int i = 4; i < argc; i++) {
		if (strcmp(argv[i], "--print") == 0)
			options->print = true;
		else if (strcmp(argv[i], "--keep-on") == 0)
			options->keep_on = true;
		else if (strcmp(argv[i], "--blind") == 0)
			options->blind = true;
		else if (strcmp(argv[i], "--machine") == 0)
			options->machine = true;
		else if (strcmp(argv[i], "--tries") == 0)
			options->machine = options->tries = true;
		else if (strcmp(argv[i], "--pokes") == 0)
			options->machine = options->pokes = true;
		else if (strcmp(argv[i], "--starts") == 0)
			options->machine = options->starts = true;
		else if (strcmp(argv[i], "--off") == 0)
			options->off = true;
		else if (strcmp(argv[i], "--mutants") == 0)
			options->mutants = true;
		else if (strcmp(argv[i], "--short") == 0)
			options->brief = true;
		else if (strcmp(argv[i], "--driver") == 0)
			options->driver = true;
		else if (i + 1 == argc)
			return false;
		else if (strcmp(argv[i], "--rtl") == 0)
			options->library = argv[++i];
		else if (strcmp(argv[i], "--record") == 0)
			options->folder = argv[++i];
		else if (strcmp(argv[i], "--set") == 0)
			options->set = (unsigned)strtoul(argv[++i], NULL, 10);
		else
			return false;
	}
	return true;
}

static void say(const char *name, uint64_t value)
{
	printf("count %s %" PRIu64 "\n", name, value);
}

/* A member of a struct of counts, and its name. */
struct said {
	const char *name;
	size_t offset;
};

static void say_all(const struct said *table, size_t count, const void *counts, uint64_t played)
{
	say("histories", played);
	for (size_t i = 0; i < count; i++) {
		uint64_t value;

		memcpy(&value, (const char *)counts + table[i].offset, sizeof value);
		say(table[i].name, value);
	}
}

#define COUNT(table) (sizeof(table) / sizeof(table)[0])

static void say_history(const struct history_counts *counts, uint64_t played)
{
#define SAID(member) {#member, offsetof(struct history_counts, member)}
#define JUDGED(member)                                                                                       \
	{                                                                                                    \
		#member, offsetof(struct history_counts, judge.member)                                       \
	}
	static const struct said table[] = {SAID(clocks), SAID(frames), SAID(refused), SAID(busy),
	    SAID(aimed), SAID(hit), JUDGED(steps), JUDGED(turns), JUDGED(quiets), JUDGED(positions),
	    JUDGED(paths), JUDGED(aborts), JUDGED(stops), JUDGED(gaps), JUDGED(resets), JUDGED(gates),
	    JUDGED(causes), JUDGED(slews), JUDGED(tries), JUDGED(latches), JUDGED(fired), JUDGED(levels),
	    JUDGED(glitches), JUDGED(estops), JUDGED(compares), JUDGED(words), JUDGED(holds), JUDGED(counted),
	    JUDGED(encoders)};
#undef JUDGED
#undef SAID

	say_all(table, COUNT(table), counts, played);
	for (unsigned i = 0; i < SCENARIO_KINDS; i++)
		printf("count kind:%s %" PRIu64 "\n", scenario_kind_name((enum scenario_kind)i),
		    counts->kinds[i]);
	for (unsigned i = 0; i < EVENT_KINDS; i++)
		printf("count event:%s %" PRIu64 "\n", scenario_event_name((enum world_event_kind)i),
		    counts->events[i]);
}

static void say_bridge(const struct bridge_counts *counts, uint64_t played)
{
#define SAID(name, member)                                                                                   \
	{                                                                                                    \
		name, offsetof(struct bridge_counts, member)                                                 \
	}
	static const struct said table[] = {SAID("clocks", clocks), SAID("frames", frames),
	    SAID("retries", retries), SAID("flips", flips), SAID("lost clocks", lost),
	    SAID("doubled clocks", doubled), SAID("cuts", cuts), SAID("deaths", deaths), SAID("moves", moves),
	    SAID("lines", lines), SAID("stops", stops), SAID("steps", steps), SAID("errors", errors)};
#undef SAID

	say_all(table, COUNT(table), counts, played);
}

int main(int argc, char **argv)
{
	struct options options;
	struct world_latency latency;
	static struct world world;
	const struct world_rtl *rtl = NULL;
	static struct history_counts counts;
	static struct bridge_counts bridged;
	static struct world_mutants mutants;
	uint64_t played = 0, failures = 0;

	if (!parse(argc, argv, &options)) {
		fputs("soak SEED FIRST COUNT [options], see main.c\n", stderr);
		return 2;
	}
	if (!world_measure(&latency)) {
		puts("failed 0 0 writes have no effect at the pins");
		return 1;
	}
	if (options.library && !(rtl = world_load(options.library)))
		return 2;
	if (options.mutants && !(options.library && mutants_read(&mutants)))
		return 2;
	world.mutants = options.mutants ? &mutants : NULL;
	world.latency = &latency;
	world.blind = options.blind;
	world.machine = options.machine;
	world.tries = options.tries;
	world.pokes = options.pokes;
	world.starts = options.starts;
	world.off = options.off;
	for (uint64_t number = options.first; played < options.count; number++) {
		char path[WORLD_TEXT];
		FILE *record = NULL;

		if (options.set != SCENARIO_SETS && number % SCENARIO_SETS != options.set)
			continue;
		if (options.folder) {
			snprintf(path, sizeof path, "%s/%" PRIu64 ".txt", options.folder, number);
			record = fopen(path, "w");
			if (!record)
				return 2;
		}
		FILE *print = options.print ? stdout : NULL;
		if (options.driver)
			bridge_play(&world, rtl, options.seed, number, print, &bridged);
		else
			history_play(
			    &world, rtl, options.seed, number, options.brief, record, print, &counts);
		if (record)
			fclose(record);
		played++;
		if (world.failed_at) {
			printf("failed %" PRIu64 " %" PRIu64 " %s\n", number, world.failed_at, world.failure);
			failures++;
			if (!options.keep_on)
				break;
		}
		if (played % 100u == 0u) {
			printf("progress %" PRIu64 "\n", played);
			fflush(stdout);
		}
	}
	if (options.driver)
		say_bridge(&bridged, played);
	else
		say_history(&counts, played);
	return failures != 0u;
}
