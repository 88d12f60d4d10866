/* SPDX-License-Identifier: MIT
 * endings SEED FIRST COUNT [OPERATION [ENDING]]
 * Plays histories FIRST, FIRST + 1, ... of one operation ended early, all kinds one after the other unless
 * named by number. Prints lines "failed NUMBER CLOCK TEXT" and "count NAME VALUE".
 */
#include <stdio.h>
#include <stdlib.h>

#include "endings.h"

int main(int argc, char **argv)
{
	static struct bench bench;
	static unsigned long played[OPERATIONS][ENDINGS];
	struct scene scene;
	unsigned long failures = 0;

	if (argc < 4) {
		fputs("endings SEED FIRST COUNT [OPERATION [ENDING]]\n", stderr);
		return 2;
	}
	const unsigned long seed = strtoul(argv[1], NULL, 10), first = strtoul(argv[2], NULL, 10);
	const unsigned long count = strtoul(argv[3], NULL, 10);
	const enum operation operation = argc > 4 ? (enum operation)atoi(argv[4]) : OPERATIONS;
	const enum ending ending = argc > 5 ? (enum ending)atoi(argv[5]) : ENDINGS;
	for (unsigned long number = first; number < first + count; number++) {
		if (!ending_play(&bench, (uint32_t)(seed * 1000003u + number), operation, ending, &scene)) {
			printf("failed %lu 0 %s, %s: %s: %ld, %ld\n", number, operation_name(scene.operation),
			    ending_name(scene.ending), bench.fault, bench.values[0], bench.values[1]);
			failures++;
		}
		played[scene.operation][scene.ending]++;
	}
	printf("count histories %lu\n", count);
	for (unsigned o = 0; o < OPERATIONS; o++)
		for (unsigned e = 0; e < ENDINGS; e++)
			if (played[o][e] != 0u)
				printf("count %s:%s %lu\n", operation_name((enum operation)o),
				    ending_name((enum ending)e), played[o][e]);
	return failures != 0u;
}
