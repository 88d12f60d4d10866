/* SPDX-License-Identifier: MIT
 * endings endings | sessions SEED FIRST COUNT [OPERATION [ENDING]]
 * Plays histories FIRST, FIRST + 1, ... of one operation ended early, of any kind unless it is named by
 * number, or of a host that dies in an operation and another one. Prints lines "failed NUMBER CLOCK TEXT" and
 * "count NAME VALUE".
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sessions.h"

int main(int argc, char **argv)
{
	static struct bench bench;
	static unsigned long played[OPERATIONS][ENDINGS];
	struct scene scene;
	unsigned long failures = 0;

	setvbuf(stdout, NULL, _IOLBF, 0);
	if (argc < 5) {
		fputs("endings endings | sessions SEED FIRST COUNT [OPERATION [ENDING]]\n", stderr);
		return 2;
	}
	const bool sessions = strcmp(argv[1], "sessions") == 0;
	const unsigned long seed = strtoul(argv[2], NULL, 10), first = strtoul(argv[3], NULL, 10);
	const unsigned long count = strtoul(argv[4], NULL, 10);
	const enum operation operation = argc > 5 ? (enum operation)atoi(argv[5]) : OPERATIONS;
	const enum ending ending = argc > 6 ? (enum ending)atoi(argv[6]) : ENDINGS;
	for (unsigned long number = first; number < first + count; number++) {
		const uint32_t mixed = (uint32_t)(seed * 1000003u + number);
		if (!(sessions ? session_play(&bench, mixed, &scene)
		               : ending_play(&bench, mixed, operation, ending, &scene))) {
			printf("failed %lu 0 %s, %s: %s: %ld, %ld\n", number, operation_name(scene.operation),
			    sessions ? "death" : ending_name(scene.ending), bench.fault, bench.values[0],
			    bench.values[1]);
			failures++;
		}
		played[scene.operation][scene.ending]++;
	}
	printf("count histories %lu\n", count);
	for (unsigned o = 0; o < OPERATIONS; o++)
		for (unsigned e = 0; e < ENDINGS; e++)
			if (played[o][e] != 0u)
				printf("count %s:%s %lu\n", operation_name((enum operation)o),
				    sessions ? "death" : ending_name((enum ending)e), played[o][e]);
	return failures != 0u;
}
