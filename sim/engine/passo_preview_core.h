/* SPDX-License-Identifier: MIT
 * Internal: what a driver sees of a core, without any steps: its two queues, which empty in time. It takes
 * the place of the link (stm32_bridge/driver/passo_host.h), so there are no frames either, only their times.
 */
#ifndef PASSO_PREVIEW_CORE_H
#define PASSO_PREVIEW_CORE_H

#include "passo.h"
#include "passo_words.h"

struct passo_preview_core {
	struct passo_host host; /* first: the functions of the link find the core by it */
	uint32_t clock_hz;
	struct passo_parameters_word parameters;
	/* called with each line and ramp that the core receives */
	void (*line)(void *context, const struct passo_line *line);
	void (*ramp)(void *context, const struct passo_ramp *ramp);
	void *context;
	uint64_t clock;
	struct passo_line *lines; /* rings; the first one of each is in motion */
	struct passo_ramp *ramps;
	uint32_t first_line, first_ramp, line_count, ramp_count;
	int32_t positions[PASSO_AXES_MAX];
	bool runs, dry;    /* a motion; it has run out of ramps */
	uint64_t began;    /* clock at which the ramp did */
	uint64_t velocity; /* then, UQ0.48 */
	double distance;   /* then: substeps into the line */
	double way;        /* then: substeps of all ramps */
	double stepped;    /* of `way`, at the last step that was noted, */
	uint64_t step;     /* and its clock */
	uint16_t address;  /* of what is posted */
	size_t length;
	uint32_t word;
	bool pushes;
};

/* Room for the queues; false: out of memory. */
bool passo_preview_core_open(struct passo_preview_core *core);
void passo_preview_core_close(struct passo_preview_core *core);
/* Its clock, for the driver. */
struct passo_hardware passo_preview_core_hardware(struct passo_preview_core *core);
/* Lets time pass: clocks; whole periods until a queue has changed, or the motion ends. */
void passo_preview_core_run(struct passo_preview_core *core, uint64_t clocks);
void passo_preview_core_rest(struct passo_preview_core *core, uint64_t period);

#endif
